#include "tenon/solvers/newton_kkt/sparse_kkt.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "tenon/solvers/newton_kkt/dense_kkt.hpp"

namespace tenon {
namespace {

constexpr int kDenseSize = 40;     // up to here the dense factorisation is the faster one
constexpr int kSweeps = 3;         // of the equilibration
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

  const int padded = lanes::padded<double>(size());
  values_.setZero(lower_.nonzeros());
  for (Vector* vector : {&scale_, &sweep_scale_, &rhs_, &solution_, &previous_, &residual_, &weight_}) vector->setZero(size());
  if (size() <= kDenseSize) {
    dense_ = std::make_unique<DenseLdlt<double, Dynamic>>(size());
    dense_values_.setZero(padded, size());
    padded_.setZero(padded);
  } else {
    sparse_ = std::make_unique<MultifrontalLdlt>(lower_, n_);
  }
}

Inertia SparseKkt::factor(const SparseMatrix& hessian, const SparseMatrix& jacobian, ConstVectorRef sigma, ConstVectorRef d) {
  assemble(hessian, jacobian, sigma, d);
  if (!std::isfinite(values_.sum())) {  // all zero eigenvalues, and solves to zero
    values_.setZero();
    scale_.setOnes();
    return factor_values();
  }
  equilibrate();
  return factor_values();
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

// (1.2) s_i <- s_i / sqrt(max_j |s_i K_ij s_j|), rounded down to a power of two, for all rows at once; an empty row keeps its scale
void SparseKkt::equilibrate() {
  scale_.setOnes();
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    Vector& row_max = sweep_scale_;
    row_max.setZero();
    for (int j = 0; j < size(); ++j) {
      double column_max = row_max[j];
      for (int k = lower_.outer[j]; k < lower_.outer[j + 1]; ++k) {
        const double value = std::abs(values_[k]);
        column_max = std::max(column_max, value);
        row_max[lower_.inner[k]] = std::max(row_max[lower_.inner[k]], value);
      }
      row_max[j] = column_max;
    }
    for (double& scale : sweep_scale_) scale = scale > 0 ? detail::power_of_two_below(1 / std::sqrt(scale)) : 1;
    for (int j = 0; j < size(); ++j) {
      for (int k = lower_.outer[j]; k < lower_.outer[j + 1]; ++k) values_[k] *= sweep_scale_[j] * sweep_scale_[lower_.inner[k]];
    }
    scale_.array() *= sweep_scale_.array();
  }
}

Inertia SparseKkt::factor_values() {
  if (sparse_) return sparse_->factor(values_.data());
  dense_values_.setZero();
  for (int j = 0; j < size(); ++j) {
    for (int k = lower_.outer[j]; k < lower_.outer[j + 1]; ++k) dense_values_(lower_.inner[k], j) = values_[k];
  }
  return dense_->factor(dense_values_);
}

void SparseKkt::apply_inverse(Vector& x) {
  if (sparse_) return sparse_->solve_in_place(x.data());
  padded_.head(size()) = x;
  dense_->solve_in_place(padded_);
  x = padded_.head(size());
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

void SparseKkt::solve(ConstVectorRef r_x, ConstVectorRef r_c, VectorRef dx, VectorRef dlambda) {
  assert(r_x.size() == n_ && r_c.size() == m_ && dx.size() == n_ && dlambda.size() == m_);
  rhs_.head(n_) = scale_.head(n_).cwiseProduct(r_x);
  rhs_.tail(m_) = scale_.tail(m_).cwiseProduct(r_c);
  solution_ = rhs_;
  apply_inverse(solution_);

  refine(solution_, residual_, previous_, kRefinements, [this](Vector& x) { apply_inverse(x); }, [this] { return backward_error(); });
  dx = scale_.head(n_).cwiseProduct(solution_.head(n_));
  dlambda = scale_.tail(m_).cwiseProduct(solution_.tail(m_));
}

}  // namespace tenon
