#include "tenon/solvers/newton_kkt/stage_fronts.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "tenon/solvers/newton_kkt/equilibration.hpp"
#include "tenon/solvers/newton_kkt/subtract_product.hpp"

namespace tenon {
namespace {

constexpr int kSweeps = 2;  // of the equilibration
// u of linear_algebra.md (4.2). A prescribed end is steered by the inputs of a few stages only against high costs, which grow as 1/u: to
// wait for all of them would take a front at every stage. Refinement returns the digits.
constexpr double kThreshold = 1e-8;

int padded(int n) {
  return lanes::padded<double>(n);
}

}  // namespace

StageFronts::StageFronts(const StageSystem& system) : records_(static_cast<std::size_t>(system.size()) + 1) {
  // a stage may leave over as much as two stages have at most: more is not needed by any problem whose states can be steered in so many
  int room = 0;
  for (int k = 0; k < system.size(); ++k) {
    const StageBlocks& b = system.stage(k);
    room = std::max(room, 2 * (b.states + b.locals + b.rows));
  }
  std::size_t top = 0, ids = 0;
  int most_rows = 0;
  for (int k = -1; k < system.size(); ++k) {
    Record& r = record(k);
    const StageBlocks& b = system.stage(std::max(k, 0));
    const int own = k < 0 ? b.states : b.own_next_states + b.locals + (b.is_explicit ? b.own_next_states : 0) + b.rows;
    r.most_left_over = k < 0 ? 0 : room;
    r.most_columns = own + room;
    r.most_rows = r.most_columns + (k < 0 ? 0 : b.states);
    most_rows = std::max(most_rows, r.most_rows);
    r.panel = top, top += panel_size(r.most_rows, r.most_columns);
    r.numbers = top, top += 6 * lanes_of(r.most_rows);
    r.wide_value = top, top += panel_size(b.states + room, b.states + room);
    r.ids = ids, ids += static_cast<std::size_t>(r.most_columns);
  }
  arena_.reserve(top);
  ids_.resize(ids);
  order_.resize(static_cast<std::size_t>(most_rows));
  full_.setZero(static_cast<Eigen::Index>(panel_size(most_rows, most_rows)));
  unscaled_.setZero(full_.size());
  row_max_.setZero(padded(most_rows));
  t_.setZero(padded(most_rows));
}

StageFronts::Numbers StageFronts::numbers(const Record& record) {
  double* at = arena_.at(record.numbers);
  const auto size = static_cast<std::ptrdiff_t>(lanes_of(record.most_rows));
  return {at, at + size, at + 2 * size, at + 3 * size, at + 4 * size, at + 5 * size};
}

const double* StageFronts::value(int k, const StageSystem& system) const {
  return record(k).left_over > 0 ? const_cast<Arena&>(arena_).at(record(k).wide_value) : system.stage(k).value;
}
int StageFronts::value_stride(int k, const StageSystem& system) const {
  return padded(system.stage(k).states + record(k).left_over);
}

// Columns: the next state, what it left over, locals, dynamics, other rows; of the last front: the first state and what is left.
void StageFronts::number_unknowns(int k, const StageSystem& system, int* ids) {
  const auto take = [&](int from, int count) {
    for (int i = 0; i < count; ++i) *ids++ = from + i;
  };
  if (k + 1 < system.size()) {
    const StageBlocks& next = system.stage(k + 1);
    take(next.at_s_vector, k < 0 ? next.states : system.stage(k).own_next_states);
    const Record& left = record(k + 1);
    for (int i = 0; i < left.left_over; ++i) *ids++ = ids_[left.ids + static_cast<std::size_t>(left.eliminated + i)];
  }
  if (k < 0) return;
  const StageBlocks& b = system.stage(k);
  take(b.at_l_vector, b.locals);
  if (b.is_explicit) take(b.at_dynamics, b.own_next_states);
  take(b.at_rows, b.rows);
}

void StageFronts::factor(int k, const StageSystem& system, Inertia& inertia) {
  Record& r = record(k);
  const int from_next = k + 1 < system.size() ? record(k + 1).left_over : 0;
  if (k < 0) {
    const int states = system.stage(0).states;
    if (from_next == 0 && system.first_state_is_fixed()) {
      r.columns = r.rows = r.eliminated = r.left_over = 0;
      inertia.positive += states;
      return;
    }
    r.columns = r.rows = states + from_next;
  } else {
    const StageBlocks& b = system.stage(k);
    r.columns = b.own_next_states + from_next + b.locals + (b.is_explicit ? b.own_next_states : 0) + b.rows;
    r.rows = r.columns + b.states;
  }
  stride_ = padded(r.rows);
  std::fill_n(full_.data(), static_cast<std::ptrdiff_t>(stride_) * r.rows, 0.0);
  if (k + 1 < system.size()) add_value(k, system);
  if (k >= 0) assemble(k, system);

  const Numbers at = numbers(r);
  equilibrate(r.rows, at.scale);
  double* panel = arena_.at(r.panel);
  std::copy_n(full_.data(), static_cast<std::ptrdiff_t>(stride_) * r.columns, panel);
  for (int j = 0; j < r.columns; ++j) {
    order_[j] = j;
  }
  std::fill_n(at.magnitude, stride_, 0.0);
  for (int i = 0; i < r.rows; ++i) at.magnitude[i] = std::abs(full(i, i));
  Front front{panel, unscaled_.data(), at.magnitude, order_.data(), at.d_inverse, at.d_inverse_below, stride_, r.rows, r.columns};
  eliminate_stable(front, inertia, kThreshold);
  if (r.columns - front.eliminated > r.most_left_over) eliminate_rest(front, inertia);
  r.eliminated = front.eliminated;
  r.left_over = r.columns - r.eliminated;
  if (k >= 0) {
    const int kept = r.rows - r.columns;
    subtract_product(panel + r.columns, unscaled_.data() + r.columns, stride_, r.eliminated, &full(r.columns, r.columns), stride_, kept,
                     kept);
    keep(k, system, front, at);
  }
  // names and scales in the order of elimination
  int* ids = ids_.data() + r.ids;
  number_unknowns(k, system, ids);
  for (int j = 0; j < r.columns; ++j) row_max_[j] = ids[j];
  for (int j = 0; j < r.columns; ++j) ids[j] = static_cast<int>(row_max_[order_[j]]);
  for (int j = 0; j < r.columns; ++j) row_max_[j] = at.scale[order_[j]];
  std::copy_n(row_max_.data(), r.columns, at.scale);
}

// P of the next stage: its own state and what it left over are columns, the globals are kept.
void StageFronts::add_value(int k, const StageSystem& system) {
  const double* p = value(k + 1, system);
  const int stride = value_stride(k + 1, system), states = system.stage(k + 1).states, size = states + record(k + 1).left_over;
  const int own = k < 0 ? states : system.stage(k).own_next_states, rows = record(k).rows;
  const auto place = [&](int t) { return t < own ? t : t < states ? rows - states + t : t - states + own; };
  for (int j = 0; j < size; ++j) {
    for (int i = j; i < size; ++i) full(place(i), place(j)) += p[i + static_cast<std::ptrdiff_t>(j) * stride];
  }
}

void StageFronts::assemble(int k, const StageSystem& system) {
  const StageBlocks& b = system.stage(k);
  const int locals = b.own_next_states + (k + 1 < system.size() ? record(k + 1).left_over : 0), dynamics = locals + b.locals;
  const int others = dynamics + (b.is_explicit ? b.own_next_states : 0), state = others + b.rows;
  for (int j = 0; j < b.locals; ++j) {
    for (int i = j; i < b.locals; ++i) full(locals + i, locals + j) += b.h_ll[i + j * b.local_stride];
    for (int i = 0; i < b.states; ++i) full(state + i, locals + j) += b.h_sl[i + j * b.state_stride];
  }
  for (int j = 0; j < b.states; ++j) {
    for (int i = j; i < b.states; ++i) full(state + i, state + j) += b.h_ss[i + j * b.state_stride];
  }
  for (int i = 0; i < b.own_next_states && b.is_explicit; ++i) {
    full(dynamics + i, i) += system.link()[b.at_dynamics + i];
    full(dynamics + i, dynamics + i) -= system.compliance()[b.at_dynamics + i];
    for (int j = 0; j < b.locals; ++j) full(dynamics + i, locals + j) += b.a_l[i + j * b.next_stride];
    for (int j = 0; j < b.states; ++j) full(dynamics + i, state + j) += b.a_s[i + j * b.next_stride];
  }
  const int coupled = padded(b.own_next_states);
  for (int r = 0; r < b.rows; ++r) {
    full(others + r, others + r) -= system.compliance()[b.at_rows + r];
    for (int j = 0; j < b.locals; ++j) full(others + r, locals + j) += b.c_l[j + r * b.local_stride];
    for (int j = 0; j < b.states; ++j) full(others + r, state + j) += b.c_s[j + r * b.state_stride];
    for (int j = 0; j < b.own_next_states && !b.is_explicit; ++j) full(others + r, j) += b.c_n[j + r * coupled];
  }
  for (int i = 0; i < b.own_next_states && !b.is_explicit; ++i) {
    for (int j = 0; j < b.locals; ++j) full(locals + j, i) += b.h_nl[i + j * coupled];
    for (int j = 0; j < b.states; ++j) full(state + j, i) += b.h_ns[i + j * coupled];
  }
}

// linear_algebra.md (1.2); above the diagonal there are zeros
void StageFronts::equilibrate(int rows, double* scale) {
  using lanes::ConstMap, lanes::Lane, lanes::Map;
  std::fill_n(scale, stride_, 1.0);
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    std::fill_n(row_max_.data(), stride_, 0.0);
    for (int j = 0; j < rows; ++j) {
      const double* column = full_.data() + static_cast<std::ptrdiff_t>(j) * stride_;
      Lane<double> largest = Lane<double>::Zero();
      for (int i = lanes::lane_of<double>(j); i < rows; i += 4) {
        const Lane<double> size = (ConstMap<double>(column + i) * ConstMap<double>(scale + i)).abs() * scale[j];
        Map<double> row_max(row_max_.data() + i);
        row_max = row_max.max(size);
        largest = largest.max(size);
      }
      row_max_[j] = std::max(row_max_[j], largest.maxCoeff());
    }
    for (int i = 0; i < rows; ++i) scale[i] *= inverse_root_scale(row_max_[i]);
  }
  for (int j = 0; j < rows; ++j) {
    double* column = full_.data() + static_cast<std::ptrdiff_t>(j) * stride_;
    for (int i = lanes::lane_of<double>(j); i < rows; i += 4) Map<double>(column + i) *= ConstMap<double>(scale + i) * scale[j];
  }
}

// The value of stage k: over the state, then over what is left over, with both triangles and without the scales.
void StageFronts::keep(int k, const StageSystem& system, const Front& front, const Numbers& at) {
  const Record& r = record(k);
  const int states = system.stage(k).states, stride = value_stride(k, system);
  double* value = r.left_over > 0 ? arena_.at(r.wide_value) : system.stage(k).value;
  const auto set = [&](int i, int j, double entry) {
    value[i + static_cast<std::ptrdiff_t>(j) * stride] = value[j + static_cast<std::ptrdiff_t>(i) * stride] = entry;
  };
  const double* scale = at.scale;
  for (int j = 0; j < states; ++j) {
    for (int i = j; i < states; ++i) set(i, j, full(r.columns + i, r.columns + j) / (scale[r.columns + i] * scale[r.columns + j]));
  }
  for (int a = 0; a < r.left_over; ++a) {
    const int column = r.eliminated + a;
    const double* entries = front.panel + static_cast<std::ptrdiff_t>(column) * front.stride;
    const double scale_a = scale[front.ids[column]];
    for (int i = 0; i < states; ++i) set(states + a, i, entries[r.columns + i] / (scale_a * scale[r.columns + i]));
    for (int c = a; c < r.left_over; ++c)
      set(states + c, states + a, entries[r.eliminated + c] / (scale_a * scale[front.ids[r.eliminated + c]]));
  }
}

// L y = b: D^-1 y is kept for the columns eliminated; the rest goes to the stage before.
void StageFronts::backward(int k, const StageSystem& system, const double* rhs, double* value_rhs) {
  Record& r = record(k);
  const Numbers at = numbers(r);
  const int* ids = ids_.data() + r.ids;
  double* t = t_.data();
  const int stride = padded(r.rows);
  std::fill_n(t, stride, 0.0);

  // the right-hand side of each column: that of the stage, or what the next one left of it
  const Record* next = k + 1 < system.size() ? &record(k + 1) : nullptr;
  const StageBlocks* ahead = next ? &system.stage(k + 1) : nullptr;
  const int* left_ids = next ? ids_.data() + next->ids + next->eliminated : nullptr;
  for (int j = 0; j < r.columns; ++j) {
    const int id = ids[j];
    double b;
    if (ahead && id >= ahead->at_s_vector && id < ahead->at_s_vector + ahead->states) {
      b = value_rhs[id];
    } else if (const int* left = next ? std::find(left_ids, left_ids + next->left_over, id) : nullptr;
               next && left != left_ids + next->left_over) {
      b = numbers(*next).left_rhs[left - left_ids];
    } else {
      b = rhs[id];
    }
    t[j] = at.scale[j] * b;
  }
  if (k >= 0) {
    const StageBlocks& b = system.stage(k);
    for (int i = 0; i < b.states; ++i) {
      const int global = i - (b.states - system.globals());
      const double left = ahead && global >= 0 ? value_rhs[ahead->at_s_vector + ahead->states - system.globals() + global] : 0;
      t[r.columns + i] = at.scale[r.columns + i] * (rhs[b.at_s_vector + i] + left);
    }
  }
  const double* panel = arena_.at(r.panel);
  for (int j = 0; j < r.eliminated; ++j) lanes::subtract_scaled(t[j], panel + static_cast<std::ptrdiff_t>(j) * stride, t, j + 1, r.rows);
  for (int j = 0; j < r.eliminated; ++j) {
    if (at.d_inverse_below[j] != 0) {
      at.t[j] = at.d_inverse[j] * t[j] + at.d_inverse_below[j] * t[j + 1];
      at.t[j + 1] = at.d_inverse_below[j] * t[j] + at.d_inverse[j + 1] * t[j + 1];
      ++j;
    } else {
      at.t[j] = at.d_inverse[j] * t[j];
    }
  }
  for (int a = 0; a < r.left_over; ++a) at.left_rhs[a] = t[r.eliminated + a] / at.scale[r.eliminated + a];
  if (k >= 0) {
    const StageBlocks& b = system.stage(k);
    for (int i = 0; i < b.states; ++i) value_rhs[b.at_s_vector + i] = t[r.columns + i] / at.scale[r.columns + i];
  }
}

void StageFronts::forward(int k, const StageSystem& system, const double* value_rhs, double* solution) {
  const Record& r = record(k);
  const Numbers at = numbers(r);
  const int* ids = ids_.data() + r.ids;
  double* t = t_.data();
  const int stride = padded(r.rows);
  std::fill_n(t, stride, 0.0);
  std::copy_n(at.t, r.eliminated, t);
  for (int j = r.eliminated; j < r.columns; ++j) t[j] = solution[ids[j]] / at.scale[j];
  if (k >= 0) {
    const StageBlocks& b = system.stage(k);
    for (int i = 0; i < b.states; ++i) t[r.columns + i] = solution[b.at_s_vector + i] / at.scale[r.columns + i];
  }
  const double* panel = arena_.at(r.panel);
  for (int j = r.eliminated - 1; j >= 0; --j) t[j] -= lanes::dot(panel + static_cast<std::ptrdiff_t>(j) * stride, t, j + 1, r.rows);
  for (int j = 0; j < r.eliminated; ++j) solution[ids[j]] = at.scale[j] * t[j];
  if (k < 0 && r.columns == 0) std::fill_n(solution + system.stage(0).at_s_vector, system.stage(0).states, 0.0);
  if (k < 0 || system.globals() == 0 || k + 1 == system.size()) return;

  // the globals' copy at the next stage, and the multiplier that holds it:  P z - p of that stage
  const StageBlocks &b = system.stage(k), &next = system.stage(k + 1);
  const double* p = value(k + 1, system);
  const Record& left = record(k + 1);
  const int p_stride = value_stride(k + 1, system);
  for (int g = 0; g < system.globals(); ++g) {
    solution[next.at_s_vector + b.own_next_states + g] = solution[b.at_s_vector + b.states - system.globals() + g];
  }
  for (int g = 0; g < system.globals(); ++g) {
    const int row = b.own_next_states + g;
    double sum = -value_rhs[next.at_s_vector + row];
    for (int j = 0; j < next.states; ++j) sum += p[row + static_cast<std::ptrdiff_t>(j) * p_stride] * solution[next.at_s_vector + j];
    for (int a = 0; a < left.left_over; ++a) {
      sum += p[row + static_cast<std::ptrdiff_t>(next.states + a) * p_stride] *
             solution[ids_[left.ids + static_cast<std::size_t>(left.eliminated + a)]];
    }
    solution[b.at_dynamics + row] = sum;
  }
}

}  // namespace tenon
