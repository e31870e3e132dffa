// Elimination of a regular stage: the next state by the dynamics, the locals by a Cholesky-like L D L', as in the Riccati recursion.
//
//     M = H + A' P A + C' D^-1 C,     M_ll = L D L',   G = M_sl L^-T D^-1,     P <- M_ss - G D G',     K' = G L^-1     stage_kkt.md (2.3)
//
// P on the right belongs to the next stage, on the left to this one. Sizes are constants, or Dynamic and taken from the stage.
#pragma once

#include <cmath>
#include <limits>

#include "tenon/solvers/newton_kkt/stage_products.hpp"
#include "tenon/solvers/newton_kkt/stage_system.hpp"

namespace tenon {

/// States: of this stage and of the next one; Locals: what is eliminated here. The other rows are as many as the stage has.
template <int States, int Locals>
class RegularStage {
 public:
  explicit RegularStage(const StageBlocks& blocks) : b_(blocks) {}

  static bool fits(const StageBlocks& b) {
    return States == Dynamic || (b.states == States && b.next_states == States && b.locals == Locals);
  }
  /// Numbers that `scratch` must hold.
  static std::size_t scratch_size(const StageBlocks& b) {
    return panel_size(b.next_states, b.states + b.locals) + panel_size(b.states, b.locals) + panel_size(b.states, b.rows) +
           panel_size(b.locals, b.rows) + lanes_of(b.next_states) + lanes_of(b.locals);
  }

  /// next_value: P of the next stage; d: compliance of the other rows, > 0. False where M_ll is not clearly positive.
  bool factor(const double* next_value, const double* d, double* scratch) const {
    double* t_l = scratch;
    double* t_s = t_l + next_stride() * locals();
    double* w = t_s + next_stride() * states();
    double* e_l = w + state_stride() * locals();  // D^-1 C, transposed
    double* e_s = e_l + local_stride() * rows();
    for (int r = 0; r < rows(); ++r) {
      scale(b_.c_l + r * local_stride(), 1 / d[r], e_l + r * local_stride(), local_stride());
      scale(b_.c_s + r * state_stride(), 1 / d[r], e_s + r * state_stride(), state_stride());
    }
    stage::product(next_value, next_stride(), {b_.a_l, 1, next_stride()}, next(), t_l, next_stride(), next(), locals());
    stage::product(next_value, next_stride(), {b_.a_s, 1, next_stride()}, next(), t_s, next_stride(), next(), states());
    stage::over_tiles(
        locals(), locals(), false, [&](auto tile, int i, int j) __attribute__((always_inline)) {
          tile.read(b_.h_ll + i + j * local_stride(), local_stride());
          tile.add(b_.at_l + i, local_stride(), {t_l + j * next_stride(), 1, next_stride()}, next());
          tile.add(b_.c_l + i, local_stride(), {e_l + j, local_stride(), 1}, rows());
          tile.write(b_.l_ll + i + j * local_stride(), local_stride());
        });
    stage::over_tiles(
        states(), locals(), false, [&](auto tile, int i, int j) __attribute__((always_inline)) {
          tile.read(b_.h_sl + i + j * state_stride(), state_stride());
          tile.add(b_.at_s + i, state_stride(), {t_l + j * next_stride(), 1, next_stride()}, next());
          tile.add(b_.c_s + i, state_stride(), {e_l + j, local_stride(), 1}, rows());
          tile.write(w + i + j * state_stride(), state_stride());
        });
    if (!factor_locals(w)) return false;
    stage::over_tiles(
        states(), states(), true, [&](auto tile, int i, int j) __attribute__((always_inline)) {
          tile.read(b_.h_ss + i + j * state_stride(), state_stride());
          tile.add(b_.at_s + i, state_stride(), {t_s + j * next_stride(), 1, next_stride()}, next());
          tile.add(b_.c_s + i, state_stride(), {e_s + j, state_stride(), 1}, rows());
          tile.add(w + i, state_stride(), {b_.gain + j, state_stride(), 1}, locals(), -1);
          tile.write(b_.value + i + j * state_stride(), state_stride());
        });
    stage::symmetrise(b_.value, state_stride(), states());
    finish_gain();
    return true;
  }

  /// rhs: in; value_rhs: what the later stages leave of it, at the state, and M_ll^-1 of it at the locals. (2.4)
  void backward(const double* next_value, const double* next_rhs, const double* d, const double* rhs, double* value_rhs,
                double* scratch) const {
    double* q = scratch;
    copy(next_rhs, q, next());
    stage::add_times(next_value, next_stride(), rhs + b_.at_dynamics, next(), next(), q);
    double* l = value_rhs + b_.at_l_vector;
    double* s = value_rhs + b_.at_s_vector;
    copy(rhs + b_.at_l_vector, l, locals());
    copy(rhs + b_.at_s_vector, s, states());
    stage::add_times(b_.at_l, local_stride(), q, locals(), next(), l);
    stage::add_times(b_.at_s, state_stride(), q, states(), next(), s);
    for (int r = 0; r < rows(); ++r) {
      const double pull = rhs[b_.at_rows + r] / d[r];
      stage::add_times(b_.c_l + r * local_stride(), local_stride(), &pull, locals(), 1, l);
      stage::add_times(b_.c_s + r * state_stride(), state_stride(), &pull, states(), 1, s);
    }
    stage::add_times(b_.gain, state_stride(), l, states(), locals(), s, -1);
    for (int j = 0; j < locals(); ++j) {
      for (int i = j + 1; i < locals(); ++i) l[i] -= b_.l_ll[i + j * local_stride()] * l[j];
    }
    for (int j = locals() - 1; j >= 0; --j) {
      double sum = l[j] * b_.d_inverse[j];
      for (int i = j + 1; i < locals(); ++i) sum -= b_.l_ll[i + j * local_stride()] * l[i];
      l[j] = sum;
    }
  }

  /// Locals, next state and multipliers, from the state in `solution`. (2.5)
  void forward(const double* next_value, const double* next_rhs, const double* d, const double* rhs, const double* value_rhs,
               double* next_state, double* solution, double* scratch) const {
    const double* s = solution + b_.at_s_vector;
    double* l = solution + b_.at_l_vector;
    for (int j = 0; j < locals(); ++j) {
      l[j] = value_rhs[b_.at_l_vector + j] - lanes::dot(b_.gain + j * state_stride(), s, 0, states());
    }
    double* lambda = solution + b_.at_dynamics;
    double* ahead = scratch;
    for (int i = 0; i < next_stride(); i += 4) {
      lanes::Map<double>(ahead + i) = -lanes::ConstMap<double>(rhs + b_.at_dynamics + i);
      lanes::Map<double>(lambda + i) = -lanes::ConstMap<double>(next_rhs + i);
    }
    stage::add_times(b_.a_s, next_stride(), s, next(), states(), ahead);
    stage::add_times(b_.a_l, next_stride(), l, next(), locals(), ahead);
    copy(ahead, next_state, next());
    stage::add_times(next_value, next_stride(), ahead, next(), next(), lambda);
    for (int r = 0; r < rows(); ++r) {
      const double c = lanes::dot(b_.c_l + r * local_stride(), l, 0, locals()) + lanes::dot(b_.c_s + r * state_stride(), s, 0, states());
      solution[b_.at_rows + r] = (c - rhs[b_.at_rows + r]) / d[r];
    }
  }

  /// residual -= K solution, in the equations of this stage and, through link, of the next state.
  void subtract(const double* solution, const double* next_state, const double* compliance, const double* link, double* residual,
                double* next_residual) const {
    const double *l = solution + b_.at_l_vector, *s = solution + b_.at_s_vector, *lambda = solution + b_.at_dynamics;
    double *of_l = residual + b_.at_l_vector, *of_s = residual + b_.at_s_vector, *of_rows = residual + b_.at_dynamics;
    stage::add_times(b_.h_ss, state_stride(), s, states(), states(), of_s, -1);
    stage::add_times(b_.h_sl, state_stride(), l, states(), locals(), of_s, -1);
    stage::add_times(b_.at_s, state_stride(), lambda, states(), next(), of_s, -1);
    stage::add_times(b_.h_ll, local_stride(), l, locals(), locals(), of_l, -1);
    stage::add_times(b_.at_l, local_stride(), lambda, locals(), next(), of_l, -1);
    for (int j = 0; j < locals(); ++j) of_l[j] -= lanes::dot(b_.h_sl + j * state_stride(), s, 0, states());
    for (int i = 0; i < next_stride(); i += 4) {
      const lanes::ConstMap<double> coupling(link + b_.at_dynamics + i);
      lanes::Map<double>(of_rows + i) += lanes::ConstMap<double>(compliance + b_.at_dynamics + i) * lanes::ConstMap<double>(lambda + i) -
                                         coupling * lanes::ConstMap<double>(next_state + i);
      lanes::Map<double>(next_residual + i) -= coupling * lanes::ConstMap<double>(lambda + i);
    }
    stage::add_times(b_.a_s, next_stride(), s, next(), states(), of_rows, -1);
    stage::add_times(b_.a_l, next_stride(), l, next(), locals(), of_rows, -1);
    for (int r = 0; r < rows(); ++r) {
      const double mu = solution[b_.at_rows + r];
      residual[b_.at_rows + r] += compliance[b_.at_rows + r] * mu - lanes::dot(b_.c_l + r * local_stride(), l, 0, locals()) -
                                  lanes::dot(b_.c_s + r * state_stride(), s, 0, states());
      stage::add_times(b_.c_l + r * local_stride(), local_stride(), &mu, locals(), 1, of_l, -1);
      stage::add_times(b_.c_s + r * state_stride(), state_stride(), &mu, states(), 1, of_s, -1);
    }
  }

 private:
  // below this many roundings of what it is made of, a pivot is none
  static constexpr double kZero = 64 * std::numeric_limits<double>::epsilon();

  int states() const { return States == Dynamic ? b_.states : States; }
  int next() const { return States == Dynamic ? b_.next_states : States; }
  int locals() const { return States == Dynamic ? b_.locals : Locals; }
  int rows() const { return b_.rows; }
  int state_stride() const { return lanes::padded<double>(states()); }
  int next_stride() const { return lanes::padded<double>(next()); }
  int local_stride() const { return lanes::padded<double>(locals()); }

  static void scale(const double* from, double factor, double* to, int size) {
    for (int i = 0; i < size; i += 4) lanes::Map<double>(to + i) = factor * lanes::ConstMap<double>(from + i);
  }
  static void copy(const double* from, double* to, int size) {
    for (int i = 0; i < size; i += 4) lanes::Map<double>(to + i) = lanes::ConstMap<double>(from + i);
  }

  // l_ll: M_ll becomes L; w: M_sl becomes G D; gain: G
  bool factor_locals(double* w) const {
    double* m = b_.l_ll;
    for (int j = 0; j < locals(); ++j) b_.d_inverse[j] = magnitude(j);
    for (int j = 0; j < locals(); ++j) {
      double* column = m + j * local_stride();
      const double pivot = column[j];
      if (!(pivot > kZero * b_.d_inverse[j])) return false;
      const double inverse = 1 / pivot;
      b_.d_inverse[j] = inverse;
      double* w_j = w + j * state_stride();
      double* gain = b_.gain + j * state_stride();
      for (int i = 0; i < state_stride(); i += 4) lanes::Map<double>(gain + i) = lanes::ConstMap<double>(w_j + i) * inverse;
      for (int i = j + 1; i < locals(); ++i) {
        const double l = column[i] * inverse;
        for (int r = i; r < locals(); ++r) m[r + i * local_stride()] -= l * column[r];
        stage::add_times(w_j, state_stride(), &l, states(), 1, w + i * state_stride(), -1);
      }
      for (int i = j + 1; i < locals(); ++i) column[i] *= inverse;
    }
    return true;
  }
  // gain: G becomes K'
  void finish_gain() const {
    for (int j = locals() - 2; j >= 0; --j) {
      stage::add_times(b_.gain + (j + 1) * state_stride(), state_stride(), b_.l_ll + (j + 1) + j * local_stride(), states(),
                       locals() - j - 1, b_.gain + j * state_stride(), -1);
    }
  }
  /// Size of the numbers whose sum is a diagonal entry of M_ll.
  double magnitude(int j) const {
    const double hessian = b_.h_ll[j + j * local_stride()];
    return std::abs(hessian) + std::abs(b_.l_ll[j + j * local_stride()] - hessian);
  }

  const StageBlocks& b_;
};

}  // namespace tenon
