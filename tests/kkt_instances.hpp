// Seeded random KKT systems with a known character, for the conformance of the KKT kinds.
//
//     K = [ H + diag(sigma)    J'      ]
//         [ J                 -diag(D) ]
#pragma once

#include <random>
#include <string>
#include <utility>
#include <vector>

#include "tenon/core/sparse_pattern.hpp"

namespace tenon {

struct KktInstance {
  std::string name;
  int n = 0, m = 0;
  SparsePattern hessian_pattern, jacobian_pattern;
  SparseMatrix hessian, jacobian;  // the lower triangle of H
  Vector sigma, d;

  Eigen::MatrixXd matrix() const {
    Eigen::MatrixXd k = Eigen::MatrixXd::Zero(n + m, n + m);
    k.topLeftCorner(n, n) = Eigen::MatrixXd(hessian).selfadjointView<Eigen::Lower>();
    k.topLeftCorner(n, n).diagonal() += sigma;
    k.bottomLeftCorner(m, n) = jacobian;
    k.topRightCorner(n, m) = k.bottomLeftCorner(m, n).transpose();
    k.bottomRightCorner(m, m).diagonal() = -d;
    return k;
  }
};

enum class Structure { dense, random, banded, arrow };

class KktGenerator {
 public:
  explicit KktGenerator(unsigned seed) : random_(seed) {}

  double normal() { return std::normal_distribution<double>()(random_); }
  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  int integer(int low, int high) { return std::uniform_int_distribution<int>(low, high)(random_); }
  Vector normal_vector(int size) { return Vector::NullaryExpr(size, [this] { return normal(); }); }

  /// H strictly diagonally dominant, J of full row rank with a large entry of each row in a column of its own, sigma = 0,
  /// D = 0.
  KktInstance convex(int n, int m, Structure structure) {
    KktInstance instance;
    instance.name = "convex";
    instance.n = n;
    instance.m = m;
    std::vector<std::pair<int, int>> hessian, jacobian;
    for (int j = 0; j < n; ++j) {
      hessian.emplace_back(j, j);
      for (int i : neighbours(j, n, structure)) hessian.emplace_back(std::max(i, j), std::min(i, j));
    }
    std::vector<int> own(static_cast<std::size_t>(m));
    for (int i = 0; i < m; ++i) {
      own[static_cast<std::size_t>(i)] = static_cast<int>((static_cast<long>(i) * n) / m);
      jacobian.emplace_back(i, own[static_cast<std::size_t>(i)]);
      for (int j : neighbours(own[static_cast<std::size_t>(i)], n, structure)) jacobian.emplace_back(i, j);
    }
    instance.hessian_pattern = SparsePattern::from_entries(n, n, std::move(hessian));
    instance.jacobian_pattern = SparsePattern::from_entries(m, n, std::move(jacobian));
    instance.hessian = instance.hessian_pattern.zero_matrix();
    instance.jacobian = instance.jacobian_pattern.zero_matrix();
    Vector row_sum = Vector::Zero(n);
    for (int j = 0; j < n; ++j) {
      for (SparseMatrix::InnerIterator entry(instance.hessian, j); entry; ++entry) {
        if (entry.row() == j) continue;
        entry.valueRef() = normal();
        row_sum[j] += std::abs(entry.value());
        row_sum[entry.row()] += std::abs(entry.value());
      }
      for (SparseMatrix::InnerIterator entry(instance.jacobian, j); entry; ++entry) entry.valueRef() = normal();
    }
    for (int j = 0; j < n; ++j) instance.hessian.coeffRef(j, j) = row_sum[j] + uniform(0.5, 2);
    for (int i = 0; i < m; ++i) instance.jacobian.coeffRef(i, own[static_cast<std::size_t>(i)]) += normal() > 0 ? 5 : -5;
    instance.sigma = Vector::Zero(n);
    instance.d = Vector::Zero(m);
    return instance;
  }

 private:
  std::vector<int> neighbours(int j, int n, Structure structure) {
    std::vector<int> found;
    auto add = [&](int i) {
      if (i >= 0 && i < n && i != j) found.push_back(i);
    };
    switch (structure) {
      case Structure::dense:
        for (int i = 0; i < n; ++i) add(i);
        break;
      case Structure::random:
        for (int count = 0; count < 2; ++count) add(integer(0, n - 1));
        break;
      case Structure::banded:
        for (int i = j - 3; i <= j + 3; ++i) add(i);
        break;
      case Structure::arrow:
        add(j - 1), add(n - 1), add(n - 2);
        break;
    }
    return found;
  }

  std::mt19937 random_;
};

}  // namespace tenon
