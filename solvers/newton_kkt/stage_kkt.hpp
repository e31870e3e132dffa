// The KKT system of a problem with stages:
//
//     K = [ H + diag(sigma)    J'      ]  n        eliminated backwards along the stages, in time and memory linear in their number
//         [ J                 -diag(D) ]  m
//
// A regular stage (explicit hard dynamics, inputs with positive curvature) costs a step of the Riccati recursion, with kernels of constant
// size where `Sizes` knows it; any other becomes a dense front with pivoting. Inertia: exact. Solves are refined. Equations: stage_kkt.md.
#pragma once

#include <algorithm>

#include "tenon/solvers/newton_kkt/inertia.hpp"
#include "tenon/solvers/newton_kkt/stage_elimination.hpp"
#include "tenon/solvers/newton_kkt/stage_fronts.hpp"

namespace tenon {

template <class Sizes = StageSizes<Dynamic, Dynamic>>
class StageKkt {
 public:
  /// hessian: lower triangle, n x n; jacobian: m x n. Nothing allocates after construction.
  /// Throws std::invalid_argument where the patterns do not fit the stages.
  StageKkt(const Stages& stages, const SparsePattern& hessian, const SparsePattern& jacobian)
      : system_(stages, hessian, jacobian), fronts_(system_), regular_(stages.stages.size()) {
    std::size_t scratch = 0;
    for (int k = 0; k < system_.size(); ++k) scratch = std::max(scratch, RegularStage<Dynamic, Dynamic>::scratch_size(system_.stage(k)));
    scratch_.setZero(static_cast<Eigen::Index>(scratch));
    for (Vector* v : {&rhs_, &value_rhs_, &solution_, &correction_, &residual_}) v->setZero(system_.vector_size());
    nothing_.setZero(static_cast<Eigen::Index>(lanes_of(system_.stage(0).states)) + 4);
  }

  /// hessian, jacobian: with these patterns; sigma: n, >= 0, 1e30 where a variable is held; d: m, >= 0.
  Inertia factor(const SparseMatrix& hessian, const SparseMatrix& jacobian, ConstVectorRef sigma, ConstVectorRef d) {
    trusted_ = false;
    finite_ = system_.assemble(hessian, jacobian, sigma, d);
    if (!finite_) return {0, 0, system_.n() + system_.m()};
    Inertia inertia = system_.slack_inertia();
    for (int k = system_.size() - 1; k >= 0; --k) {
      regular_[k] =
          may_be_regular(k) && visit(k, [&](auto stage) { return stage.factor(next_value(k), compliance_of_rows(k), scratch_.data()); });
      if (is_regular(k)) {
        const StageBlocks& b = system_.stage(k);
        fronts_.nothing_left_over(k);
        inertia.positive += b.locals + b.own_next_states;
        inertia.negative += b.own_next_states + b.rows;
      } else {
        fronts_.factor(k, system_, inertia);
      }
    }
    fronts_.factor(-1, system_, inertia);
    return inertia;
  }

  /// K [dx; dlambda] = [r_x; r_c]; a held variable has dx = 0. Returns the largest residual relative to the largest right-hand side; 0 where
  /// it is not measured, since the factors have solved another right-hand side without refinement.
  double solve(ConstVectorRef r_x, ConstVectorRef r_c, VectorRef dx, VectorRef dlambda) {
    if (!finite_) {
      dx.setZero(), dlambda.setZero();
      return 0;
    }
    system_.gather(r_x, r_c, rhs_.data());
    const double rhs_size = rhs_.lpNorm<Eigen::Infinity>();
    solve(rhs_, solution_);
    if (trusted_) {
      system_.scatter(solution_.data(), r_x, dx, dlambda);
      return 0;
    }
    const double size = rhs_size + solution_.lpNorm<Eigen::Infinity>();
    double error = measure();
    trusted_ = error <= kAccuracy * size;
    for (int step = 0; step < kRefinements && error > kAccuracy * size; ++step) {
      solve(residual_, correction_);
      solution_ += correction_;
      const double next = measure();
      if (!(next < error)) {
        solution_ -= correction_;
        break;
      }
      const bool slow = next > error / 2;
      error = next;
      if (slow) break;
    }
    system_.scatter(solution_.data(), r_x, dx, dlambda);
    return error / std::max(rhs_size, std::numeric_limits<double>::min());
  }

  /// How many stages took a front in the last factorisation.
  int fronts() const { return static_cast<int>(std::ranges::count(regular_, 0)); }

 private:
  static constexpr double kAccuracy = 1e-13;
  static constexpr int kRefinements = 5;  // at most

  bool is_regular(int k) const { return regular_[k] != 0; }
  const double* next_value(int k) const { return k + 1 < system_.size() ? fronts_.value(k + 1, system_) : nothing_.data(); }
  const double* compliance_of_rows(int k) const { return system_.compliance() + system_.stage(k).at_rows; }

  /// Calls f with stage k as one of constant size where it fits.
  template <class F>
  auto visit(int k, F&& f) const {
    const StageBlocks& b = system_.stage(k);
    if constexpr (Sizes::kStates != Dynamic) {
      using Fixed = RegularStage<Sizes::kStates, Sizes::kInputs>;
      if (Fixed::fits(b)) return f(Fixed(b));
    }
    return f(RegularStage<Dynamic, Dynamic>(b));
  }

  bool may_be_regular(int k) const {
    const StageBlocks& b = system_.stage(k);
    if (!b.is_explicit) return false;
    if (k + 1 < system_.size() && fronts_.left_over(k + 1) > 0) return false;
    for (int i = 0; i < b.own_next_states; ++i) {
      if (system_.link()[b.at_dynamics + i] != -1 || system_.compliance()[b.at_dynamics + i] != 0) return false;
    }
    for (int i = 0; i < b.rows; ++i) {
      if (!(compliance_of_rows(k)[i] > kStiff)) return false;
    }
    return true;
  }
  static constexpr double kStiff = 1e-10;  // a row with less compliance than this is not condensed into the Hessian

  // K z = r, by (2.4) and (2.5)
  void solve(const Vector& r, Vector& z) {
    double* value_rhs = value_rhs_.data();
    const double* rhs = r.data();
    for (int k = system_.size() - 1; k >= 0; --k) {
      if (!is_regular(k)) {
        fronts_.backward(k, system_, rhs, value_rhs);
        continue;
      }
      visit(k, [&](auto stage) {
        stage.backward(next_value(k), next_part(k, value_rhs), compliance_of_rows(k), rhs, value_rhs, scratch_.data());
      });
    }
    fronts_.backward(-1, system_, rhs, value_rhs);
    fronts_.forward(-1, system_, value_rhs, z.data());
    for (int k = 0; k < system_.size(); ++k) {
      if (!is_regular(k)) {
        fronts_.forward(k, system_, value_rhs, z.data());
        continue;
      }
      visit(k, [&](auto stage) {
        stage.forward(next_value(k), next_part(k, value_rhs), compliance_of_rows(k), rhs, value_rhs, next_part(k, z.data()), z.data(),
                      scratch_.data());
      });
    }
  }
  /// The state of the next stage in a vector; some zeros behind the last one.
  double* next_part(int k, double* vector) { return k + 1 < system_.size() ? vector + system_.stage(k + 1).at_s_vector : nothing_.data(); }

  // residual = rhs - K solution; returns its largest entry
  double measure() {
    residual_ = rhs_;
    for (int k = 0; k < system_.size(); ++k) {
      visit(k, [&](auto stage) {
        stage.subtract(solution_.data(), next_part(k, solution_.data()), system_.compliance(), system_.link(), residual_.data(),
                       next_part(k, residual_.data()));
      });
      if (!system_.stage(k).is_explicit)
        subtract_coupling(system_.stage(k), next_part(k, solution_.data()), next_part(k, residual_.data()));
    }
    return residual_.lpNorm<Eigen::Infinity>();
  }

  /// What rows and Hessian of a stage that is not explicit share with the next state.
  void subtract_coupling(const StageBlocks& b, const double* next_state, double* next_residual) {
    const int stride = lanes::padded<double>(b.own_next_states);
    const auto couple = [&](const double* column, int place) {
      residual_[place] -= lanes::dot(column, next_state, 0, b.own_next_states);
      stage::add_times(column, stride, &solution_[place], b.own_next_states, 1, next_residual, -1);
    };
    for (int r = 0; r < b.rows; ++r) couple(b.c_n + r * stride, b.at_rows + r);
    for (int j = 0; j < b.states; ++j) couple(b.h_ns + j * stride, b.at_s_vector + j);
    for (int j = 0; j < b.locals; ++j) couple(b.h_nl + j * stride, b.at_l_vector + j);
  }

  StageSystem system_;
  StageFronts fronts_;
  std::vector<char> regular_;
  bool finite_ = false, trusted_ = false;
  Vector scratch_, rhs_, value_rhs_, solution_, correction_, residual_, nothing_;
};

}  // namespace tenon
