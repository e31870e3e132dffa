#include "tenon/solvers/newton_kkt/multifrontal_ldlt.hpp"

#include <algorithm>
#include <cmath>

#include "tenon/solvers/newton_kkt/front.hpp"
#include "tenon/solvers/newton_kkt/lanes.hpp"
#include "tenon/solvers/newton_kkt/subtract_product.hpp"

namespace tenon {

Inertia MultifrontalLdlt::factor(const double* values) {
  Inertia inertia;
  factor_top_ = ids_top_ = stack_top_[0] = stack_top_[1] = 0;
  factor_left_ = factor_planned_;
  ids_left_ = tree_.size;
  delayed_ = 0;
  std::fill(delayed_into_.begin(), delayed_into_.end(), 0);
  for (int i = 0; i < tree_.size; ++i) magnitude_[i] = std::abs(values[diagonal_[i]]);

  int pivots = 0;
  for (int s = 0; s < tree_.fronts(); ++s) {
    Record& record = records_[s];
    const int height = tree_.height(s);
    record.columns = delayed_into_[s] + tree_.width(s);
    record.pivots = pivots;
    assemble(s, record, values);

    Front front;
    front.rows = record.columns + height;
    front.columns = record.columns;
    front.stride = lanes::padded<double>(front.rows);
    front.panel = factor_.at(record.panel);
    front.unscaled = unscaled_.at(0);
    front.ids = ids_.data() + record.ids;
    front.magnitude = front_magnitude_.data();
    front.d_inverse = d_inverse_.data() + pivots;
    front.d_inverse_below = d_inverse_below_.data() + pivots;
    const int* below = rows_.data() + tree_.rows_begin[s];
    for (int i = 0; i < front.columns; ++i) front.magnitude[i] = magnitude_[front.ids[i]];
    for (int i = 0; i < height; ++i) front.magnitude[front.columns + i] = magnitude_[below[i]];

    eliminate_stable(front, inertia);
    if (front.eliminated < front.columns && !can_delay(s, front)) eliminate_rest(front, inertia);

    for (int i = front.eliminated; i < front.columns; ++i) magnitude_[front.ids[i]] = front.magnitude[i];
    for (int i = 0; i < height; ++i) magnitude_[below[i]] = front.magnitude[front.columns + i];
    // (4.6) contribution <- contribution - L21 W21'
    subtract_product(front.panel + front.columns, front.unscaled + front.columns, front.stride, front.eliminated,
                     stack_[tree_.depth[s] % 2].at(record.block), lanes::padded<double>(height), height, height);
    record.eliminated = front.eliminated;
    pivots += front.eliminated;
    keep_left_over(s, front);
    factor_top_ = record.panel + panel_size(front.rows, front.eliminated);
  }
  return inertia;
}

// What the panel of front s grows by where so many columns more are delayed into it.
std::size_t MultifrontalLdlt::panel_growth(int s, int delayed) const {
  const int columns = tree_.width(s) + delayed_into_[s];
  return panel_size(columns + delayed + tree_.height(s), columns + delayed) - panel_size(columns + tree_.height(s), columns);
}

// Whether the columns left over by s fit: on the stack, and in the panel of its parent, beside all that is still to come.
bool MultifrontalLdlt::can_delay(int s, const Front& front) const {
  const int p = tree_.parent[s];
  if (p == -1) return false;
  const int left_over = front.columns - front.eliminated;
  const int columns = tree_.width(p) + delayed_into_[p] + left_over;
  const int mine = tree_.depth[s] % 2;
  return stack_top_[mine] + panel_size(left_over + tree_.height(s), left_over) + stack_planned_ <= stack_[mine].capacity() &&
         panel_size(columns + tree_.height(p), columns) <= unscaled_.capacity() &&
         factor_top_ + panel_size(front.rows, front.columns) + factor_left_ + panel_growth(p, left_over) <= factor_.capacity() &&
         ids_top_ + ids_left_ + left_over <= ids_.size();
}

// The columns that s leaves over, from the diagonal down, on the stack behind its contribution.
void MultifrontalLdlt::keep_left_over(int s, const Front& front) {
  const int left_over = front.columns - front.eliminated;
  if (left_over == 0) return;
  delayed_ += left_over;
  factor_left_ += panel_growth(tree_.parent[s], left_over);
  ids_left_ += left_over;
  delayed_into_[tree_.parent[s]] += left_over;
  std::size_t& top = stack_top_[tree_.depth[s] % 2];
  const std::size_t stride = lanes_of(front.rows - front.eliminated);
  double* column = stack_[tree_.depth[s] % 2].at(top);
  for (int j = front.eliminated; j < front.columns; ++j, column += stride) {
    const double* from = front.panel + static_cast<std::ptrdiff_t>(j) * front.stride;
    std::copy(from + j, from + front.rows, column + (j - front.eliminated));
  }
  top += stride * left_over;
}

void MultifrontalLdlt::solve_in_place(double* x) {
  double* y = y_.data();
  auto gather = [&](const Record& record, const int* ids, const int* below, int rows) {
    for (int i = 0; i < record.columns; ++i) y[i] = x[ids[i]];
    for (int i = record.columns; i < rows; ++i) y[i] = x[below[i - record.columns]];
    for (int i = rows; i % lanes::kLanes<double> != 0; ++i) y[i] = 0;
  };
  for (int s = 0; s < tree_.fronts(); ++s) {  // L u = b, D v = u
    const Record& record = records_[s];
    const int* ids = ids_.data() + record.ids;
    const int* below = rows_.data() + tree_.rows_begin[s];
    const int rows = record.columns + tree_.height(s);
    const int stride = lanes::padded<double>(rows);
    const double* l = factor_.at(record.panel);
    const double* d = d_inverse_.data() + record.pivots;
    const double* d_below = d_inverse_below_.data() + record.pivots;
    gather(record, ids, below, rows);
    for (int k = 0; k < record.eliminated; ++k, l += stride) lanes::subtract_scaled(y[k], l, y, k + 1, rows);
    for (int k = 0; k < record.eliminated; ++k) {
      if (d_below[k] != 0) {
        x[ids[k]] = d[k] * y[k] + d_below[k] * y[k + 1];
        x[ids[k + 1]] = d_below[k] * y[k] + d[k + 1] * y[k + 1];
        ++k;
      } else {
        x[ids[k]] = d[k] * y[k];
      }
    }
    for (int i = record.eliminated; i < record.columns; ++i) x[ids[i]] = y[i];
    for (int i = record.columns; i < rows; ++i) x[below[i - record.columns]] = y[i];
  }
  for (int s = tree_.fronts() - 1; s >= 0; --s) {  // L' w = v
    const Record& record = records_[s];
    const int* ids = ids_.data() + record.ids;
    const int rows = record.columns + tree_.height(s);
    const int stride = lanes::padded<double>(rows);
    gather(record, ids, rows_.data() + tree_.rows_begin[s], rows);
    const double* l = factor_.at(record.panel) + static_cast<std::ptrdiff_t>(record.eliminated) * stride;
    for (int k = record.eliminated - 1; k >= 0; --k) {
      l -= stride;
      y[k] -= lanes::dot(l, y, k + 1, rows);
      x[ids[k]] = y[k];
    }
  }
}

}  // namespace tenon
