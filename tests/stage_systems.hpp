// Seeded random KKT systems with stages, for the conformance of the stage-structured kind.
#pragma once

#include "tenon/core/stages.hpp"
#include "tenon/tests/kkt_instances.hpp"

namespace tenon {

/// What a random system with stages is made of.
struct StageShape {
  int intervals = 4;
  int states = 3, inputs = 2;
  int globals = 0;
  int equalities = 0, inequalities = 0;  // rows of each stage beside the dynamics: D = 0, D > 0
  int slacks = 0;                        // of each interval, in the rows beside the dynamics or, without those, in the dynamics
  bool implicit = false;                 // dynamics that mix the entries of the next state, also in the Hessian
  bool indefinite = false;               // Hessians without a sign
};

struct StageInstance : KktInstance {
  Stages stages;
};

class StageGenerator {
 public:
  explicit StageGenerator(unsigned seed) : random_(seed) {}

  StageInstance make(const StageShape& shape) {
    StageInstance out;
    const int nx = shape.states, nu = shape.inputs, size = nx + nu, rows = shape.equalities + shape.inequalities;
    out.n = size * shape.intervals + nx + shape.globals;
    out.m = (nx + rows) * shape.intervals + shape.equalities;
    const int first_global = out.n - shape.globals;
    std::vector<std::pair<int, int>> hessian, jacobian;
    const auto couple = [&](int i, int j) { hessian.emplace_back(std::max(i, j), std::min(i, j)); };
    for (int k = 0; k <= shape.intervals; ++k) {
      const bool last = k == shape.intervals;
      const IndexRange own = {size * k, size * k + (last ? nx : size)};
      const int row = (nx + rows) * k, more = last ? shape.equalities : rows;
      out.stages.stages.push_back({own, {row, row + (last ? 0 : nx) + more}});
      for (int i = own.begin; i < own.end; ++i) {
        for (int j = own.begin; j <= i; ++j) couple(i, j);
        for (int g = first_global; g < out.n; ++g) couple(i, g);
        for (int r = out.stages.stages.back().rows.begin; r < out.stages.stages.back().rows.end; ++r) jacobian.emplace_back(r, i);
      }
      for (int r = out.stages.stages.back().rows.begin; r < out.stages.stages.back().rows.end; ++r) {
        for (int g = first_global; g < out.n; ++g) jacobian.emplace_back(r, g);
      }
      if (last) continue;
      for (int r = 0; r < nx; ++r) {
        for (int i = 0; i < nx; ++i) {
          if (i == r || shape.implicit) jacobian.emplace_back(row + r, size * (k + 1) + i);
        }
        if (shape.implicit) couple(size * (k + 1) + r, own.begin + r);
      }
    }
    for (int g = first_global; g < out.n; ++g) {
      for (int h = first_global; h <= g; ++h) couple(g, h);
    }
    out.stages.globals = {first_global, out.n};
    const int first_slack = out.n;
    for (int k = 0; k < shape.intervals; ++k) {
      for (int s = 0; s < shape.slacks; ++s, ++out.n) {
        jacobian.emplace_back((nx + rows) * k + (rows > 0 ? nx + s % rows : s % nx), out.n);
        if (s % 2 == 0) couple(out.n, out.n);
      }
      out.stages.stages[std::size_t(k)].slacks = {out.n - shape.slacks, out.n};
    }
    out.hessian_pattern = SparsePattern::from_entries(out.n, out.n, std::move(hessian));
    out.jacobian_pattern = SparsePattern::from_entries(out.m, out.n, std::move(jacobian));
    out.hessian = out.hessian_pattern.zero_matrix();
    out.jacobian = out.jacobian_pattern.zero_matrix();
    for (int j = 0; j < out.n; ++j) {
      for (SparseMatrix::InnerIterator entry(out.hessian, j); entry; ++entry) {
        entry.valueRef() = entry.row() == j ? (shape.indefinite ? 3 * normal() : 3 * size + uniform()) : normal();
      }
      for (SparseMatrix::InnerIterator entry(out.jacobian, j); entry; ++entry) entry.valueRef() = normal();
    }
    out.sigma.setZero(out.n);
    out.d.setZero(out.m);
    for (double& sigma : out.sigma.tail(out.n - first_slack)) sigma = 0.1 + uniform();
    for (int k = 0; k < shape.intervals; ++k) {
      for (int r = 0; r < nx; ++r) out.jacobian.coeffRef((nx + rows) * k + r, size * (k + 1) + r) = k % 2 == 0 ? -1 : 4 + uniform();
      for (int r = 0; r < shape.inequalities; ++r) out.d[(nx + rows) * k + nx + shape.equalities + r] = std::pow(10, 4 * uniform() - 2);
    }
    return out;
  }

  double normal() { return std::normal_distribution<double>()(random_); }
  double uniform() { return std::uniform_real_distribution<double>(0, 1)(random_); }
  Vector normal_vector(int size) {
    return Vector::NullaryExpr(size, [this] { return normal(); });
  }

 private:
  std::mt19937 random_;
};

}  // namespace tenon
