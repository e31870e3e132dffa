#include "tenon/solvers/newton_kkt/sparse_kkt.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "tenon/solvers/newton_kkt/equilibration.hpp"

namespace tenon {
namespace {

constexpr int kSweeps = 3;        // of the equilibration
constexpr int kRefinements = 10;   // at most

}  // namespace

SparseKkt::SparseKkt(const SparsePattern& hessian, const SparsePattern& jacobian) : n_(hessian.cols), m_(jacobian.rows) {
  assert(hessian.rows == n_ && jacobian.cols == n_);
  lower_ = {size(), size(), {0}, {}};
  for (int j = 0; j < size(); ++j) {
    lower_.inner.push_back(j);
    if (j < n_) {
      for (int k = hessian.outer[j]; k < hessian.outer[j + 1]; ++k) {
        assert(hessian.inner[k] >= j);
        hessian_places_.push_back(hessian.inner[k] == j ? lower_.outer[j] : lower_.nonzeros());
        if (hessian.inner[k] != j) lower_.inner.push_back(hessian.inner[k]);
      }
      for (int k = jacobian.outer[j]; k < jacobian.outer[j + 1]; ++k) {
        jacobian_places_.push_back(lower_.nonzeros());
        lower_.inner.push_back(n_ + jacobian.inner[k]);
      }
    }
    lower_.outer.push_back(lower_.nonzeros());
  }

  ldlt_.emplace(lower_, n_);
  values_.setZero(lower_.nonzeros());
  for (Vector* vector : {&scale_, &row_max_, &rhs_, &solution_, &previous_, &residual_, &weight_}) vector->setZero(size());
}

Inertia SparseKkt::factor(const SparseMatrix& hessian, const SparseMatrix& jacobian, ConstVectorRef sigma, ConstVectorRef d) {
  assemble(hessian, jacobian, sigma, d);
  if (!std::isfinite(values_.sum())) {  // all zero eigenvalues, and solves to zero
    values_.setZero();
    scale_.setOnes();
    return ldlt_->factor(values_.data());
  }
  equilibrate();
  return ldlt_->factor(values_.data());
}

void SparseKkt::assemble(const SparseMatrix& hessian, const SparseMatrix& jacobian, ConstVectorRef sigma, ConstVectorRef d) {
  assert(hessian.nonZeros() == static_cast<Eigen::Index>(hessian_places_.size()) && sigma.size() == n_);
  assert(jacobian.nonZeros() == static_cast<Eigen::Index>(jacobian_places_.size()) && d.size() == m_);
  for (int i = 0; i < n_; ++i) values_[lower_.outer[i]] = sigma[i];
  for (int i = 0; i < m_; ++i) values_[lower_.outer[n_ + i]] = -d[i];
  for (std::size_t k = 0; k < jacobian_places_.size(); ++k) values_[jacobian_places_[k]] = jacobian.valuePtr()[k];
  for (int j = 0, k = 0; j < n_; ++j) {
    for (; k < hessian.outerIndexPtr()[j + 1]; ++k) {
      double& value = values_[hessian_places_[k]];
      const bool diagonal = hessian_places_[k] == lower_.outer[j];
      value = hessian.valuePtr()[k] + (diagonal ? value : 0);
    }
  }
}

// (1.2)
void SparseKkt::equilibrate() {
  scale_.setOnes();
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    row_max_.setZero();
    for (int j = 0; j < size(); ++j) {
      double column_max = 0;
      for (int k = lower_.outer[j]; k < lower_.outer[j + 1]; ++k) {
        const int i = lower_.inner[k];
        const double value = std::abs(values_[k]) * scale_[j] * scale_[i];
        column_max = std::max(column_max, value);
        row_max_[i] = std::max(row_max_[i], value);
      }
      row_max_[j] = std::max(row_max_[j], column_max);
    }
    for (int j = 0; j < size(); ++j) scale_[j] *= inverse_root_scale(row_max_[j]);
  }
  for (int j = 0; j < size(); ++j) {
    for (int k = lower_.outer[j]; k < lower_.outer[j + 1]; ++k) values_[k] *= scale_[j] * scale_[lower_.inner[k]];
  }
}

// residual = r - K x, and its size (1.4)
BackwardError<double> SparseKkt::backward_error() {
  residual_ = rhs_;
  weight_ = rhs_.cwiseAbs();
  for (int j = 0; j < size(); ++j) {
    const double x = solution_[j];
    const int diagonal = lower_.outer[j];
    double sum = values_[diagonal] * x;
    double weight = std::abs(sum);
    for (int k = diagonal + 1; k < lower_.outer[j + 1]; ++k) {
      const int i = lower_.inner[k];
      const double mine = values_[k] * solution_[i];
      const double theirs = values_[k] * x;
      sum += mine;
      weight += std::abs(mine);
      residual_[i] -= theirs;
      weight_[i] += std::abs(theirs);
    }
    residual_[j] -= sum;
    weight_[j] += weight;
  }
  constexpr double floor = std::numeric_limits<double>::min();  // 0 / 0 is 0
  return {(residual_.array().abs() / (weight_.array() + floor)).maxCoeff(), residual_.lpNorm<Eigen::Infinity>()};
}

double SparseKkt::solve(ConstVectorRef r_x, ConstVectorRef r_c, VectorRef dx, VectorRef dlambda) {
  assert(r_x.size() == n_ && r_c.size() == m_ && dx.size() == n_ && dlambda.size() == m_);
  rhs_.head(n_) = scale_.head(n_).cwiseProduct(r_x);
  rhs_.tail(m_) = scale_.tail(m_).cwiseProduct(r_c);
  solution_ = rhs_;
  ldlt_->solve_in_place(solution_.data());

  const BackwardError<double> error = refine(solution_, residual_, previous_, kRefinements,
                              [this](Vector& x) { ldlt_->solve_in_place(x.data()); }, [this] { return backward_error(); });
  dx = scale_.head(n_).cwiseProduct(solution_.head(n_));
  dlambda = scale_.tail(m_).cwiseProduct(solution_.tail(m_));
  return error.largest / std::max(rhs_.lpNorm<Eigen::Infinity>(), std::numeric_limits<double>::min());  // (1.5)
}

}  // namespace tenon
