#include "tenon/solvers/newton_kkt/multifrontal_ldlt.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <new>

#include "tenon/solvers/newton_kkt/front.hpp"
#include "tenon/solvers/newton_kkt/lanes.hpp"

namespace tenon {
namespace {

std::size_t lanes_of(int rows) { return static_cast<std::size_t>(lanes::padded<double>(rows)); }

// Entries of a panel, of a contribution, and of columns left over with the rows below them.
std::size_t panel_size(int rows, int columns) { return lanes_of(rows) * static_cast<std::size_t>(columns); }

// Room for delays: so many times the plan, and never less than kLeastRoom entries more. It costs nothing before it is touched.
constexpr std::size_t kRoom = 6;
constexpr std::size_t kLeastRoom = 1 << 16;

}  // namespace

void Arena::Release::operator()(double* memory) const { std::free(memory); }

void Arena::reserve(std::size_t capacity) {
  capacity_ = lanes_of(0) + (capacity + 3) / 4 * 4 + 4;
  memory_.reset(static_cast<double*>(std::aligned_alloc(32, capacity_ * sizeof(double))));
  if (memory_ == nullptr) throw std::bad_alloc();
}

MultifrontalLdlt::MultifrontalLdlt(const SparsePattern& lower, int n) {
  const Graph graph(lower);
  tree_ = make_front_tree(graph, order_kkt(graph, n));
  for (int position : tree_.rows) rows_.push_back(tree_.order[position]);

  // entries of K, grouped by the front that owns their earlier column
  std::vector<int> front_of(tree_.size);
  for (int s = 0; s < tree_.fronts(); ++s) std::fill(front_of.begin() + tree_.first[s], front_of.begin() + tree_.first[s + 1], s);
  auto each_entry = [&](auto visit) {
    for (int j = 0, k = 0; j < lower.cols; ++j) {
      for (; k < lower.outer[j + 1]; ++k) {
        const auto [column, row] = std::minmax(tree_.position[lower.inner[k]], tree_.position[j]);
        visit(k, int(row), int(column), front_of[column]);
      }
    }
  };
  entries_begin_.assign(tree_.fronts() + 1, 0);
  each_entry([&](int, int, int, int s) { ++entries_begin_[s + 1]; });
  for (int s = 0; s < tree_.fronts(); ++s) entries_begin_[s + 1] += entries_begin_[s];
  std::vector<int> next(entries_begin_.begin(), entries_begin_.end() - 1);
  entries_.resize(lower.nonzeros());
  diagonal_.resize(tree_.size);
  each_entry([&](int k, int row, int column, int s) {
    const auto begin = tree_.rows.begin() + tree_.rows_begin[s];
    const auto end = tree_.rows.begin() + tree_.rows_begin[s + 1];
    const int place = row < tree_.first[s + 1] ? row - tree_.first[s]
                                               : tree_.width(s) + static_cast<int>(std::lower_bound(begin, end, row) - begin);
    entries_[next[s]++] = {place, column - tree_.first[s], k};
    if (row == column) diagonal_[tree_.order[row]] = k;
  });
  plan();
}

// Memory as needed without delays, and room for them.
void MultifrontalLdlt::plan() {
  std::size_t unscaled = 0;
  std::size_t top[2] = {0, 0};
  std::vector<std::size_t> begin(tree_.fronts());
  for (int s = 0; s < tree_.fronts(); ++s) {
    const int w = tree_.width(s);
    const int r = tree_.height(s);
    planned_entries_ += w * (w + 1.0) / 2 + static_cast<double>(w) * r;
    factor_planned_ += panel_size(w + r, w);
    unscaled = std::max(unscaled, panel_size(w + r, w));
    std::size_t& mine = top[tree_.depth[s] % 2];
    begin[s] = mine;
    mine += panel_size(r, r);
    stack_planned_ = std::max(stack_planned_, mine);
    if (tree_.children_begin[s] < tree_.children_begin[s + 1]) {
      top[(tree_.depth[s] + 1) % 2] = begin[tree_.children[tree_.children_begin[s]]];
    }
  }
  auto with_room = [](std::size_t planned) { return std::max(kRoom * planned, planned + kLeastRoom); };
  factor_.reserve(with_room(factor_planned_));
  stack_[0].reserve(with_room(stack_planned_));
  stack_[1].reserve(with_room(stack_planned_));
  unscaled_.reserve(with_room(unscaled));

  records_.resize(tree_.fronts());
  delayed_into_.resize(tree_.fronts());
  ids_.resize(static_cast<std::size_t>(tree_.size) * 4);
  d_inverse_.resize(tree_.size);
  d_inverse_below_.resize(tree_.size);
  magnitude_.setZero(tree_.size);
  front_magnitude_.setZero(lanes::padded<double>(tree_.size));
  y_.setZero(lanes::padded<double>(tree_.size));
}

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

// The panel and the contribution of front s before its elimination: entries of K, and what the children hand on.
void MultifrontalLdlt::assemble(int s, Record& record, const double* values) {
  const int width = tree_.width(s);
  const int height = tree_.height(s);
  const int delayed = record.columns - width;
  record.panel = factor_top_;
  record.ids = ids_top_;
  ids_top_ += record.columns;
  ids_left_ -= record.columns;
  factor_left_ -= panel_size(record.columns + height, record.columns);

  const std::size_t stride = lanes_of(record.columns + height);
  double* panel = factor_.at(record.panel);
  std::fill_n(panel, stride * record.columns, 0.0);
  for (int k = entries_begin_[s]; k < entries_begin_[s + 1]; ++k) {
    const Entry& entry = entries_[k];
    panel[entry.column * stride + entry.row + (entry.row < width ? 0 : delayed)] = values[entry.source];
  }
  std::copy_n(tree_.order.begin() + tree_.first[s], width, ids_.begin() + static_cast<std::ptrdiff_t>(record.ids));

  const int mine = tree_.depth[s] % 2;
  record.block = stack_top_[mine];
  std::fill_n(stack_[mine].at(record.block), panel_size(height, height), 0.0);
  stack_top_[mine] += panel_size(height, height);
  int place = width;
  for (int c = tree_.children_begin[s]; c < tree_.children_begin[s + 1]; ++c) add_contribution(tree_.children[c], s, place);
  if (tree_.children_begin[s] < tree_.children_begin[s + 1]) {
    stack_top_[1 - mine] = records_[tree_.children[tree_.children_begin[s]]].block;
  }
}

// Adds the contribution of a child to front s; the columns it left over become columns `place`.. of the panel.
void MultifrontalLdlt::add_contribution(int child, int s, int& place) {
  const Record& from = records_[child];
  const Record& to = records_[s];
  const int width = tree_.width(s);
  const int delayed = to.columns - width;
  const int height = tree_.height(child);
  const int* in_parent = tree_.in_parent.data() + tree_.rows_begin[child];
  const std::size_t stride = lanes_of(to.columns + tree_.height(s));
  const std::size_t contribution_stride = lanes_of(tree_.height(s));
  const std::size_t child_stride = lanes_of(height);
  double* panel = factor_.at(to.panel);
  double* contribution = stack_[tree_.depth[s] % 2].at(to.block);
  const double* child_block = stack_[tree_.depth[child] % 2].at(from.block);

  int summed = 0;  // rows of the child that are summed up in s
  while (summed < height && in_parent[summed] < width) ++summed;
  for (int j = 0; j < summed; ++j) {
    double* column = panel + in_parent[j] * stride;
    const double* child_column = child_block + j * child_stride;
    for (int i = j; i < summed; ++i) column[in_parent[i]] += child_column[i];
    for (int i = summed; i < height; ++i) column[in_parent[i] + delayed] += child_column[i];
  }
  for (int j = summed; j < height; ++j) {
    double* column = contribution + (in_parent[j] - width) * contribution_stride - width;
    const double* child_column = child_block + j * child_stride;
    for (int i = j; i < height; ++i) column[in_parent[i]] += child_column[i];
  }

  const int left_over = from.columns - from.eliminated;
  if (left_over == 0) return;
  const double* column = child_block + panel_size(height, height);
  const std::size_t left_over_stride = lanes_of(left_over + height);
  for (int j = 0; j < left_over; ++j, column += left_over_stride) {
    double* into = panel + (place + j) * stride;
    for (int i = j; i < left_over; ++i) into[place + i] = column[i];
    for (int i = 0; i < summed; ++i) panel[in_parent[i] * stride + place + j] = column[left_over + i];
    for (int i = summed; i < height; ++i) into[in_parent[i] + delayed] = column[left_over + i];
    ids_[to.ids + place + j] = ids_[from.ids + from.eliminated + j];
  }
  place += left_over;
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
    std::copy(front.panel + static_cast<std::ptrdiff_t>(j) * front.stride + j, front.panel + static_cast<std::ptrdiff_t>(j) * front.stride + front.rows,
              column + (j - front.eliminated));
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
