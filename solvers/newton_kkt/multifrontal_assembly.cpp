// The multifrontal factorisation before its arithmetic: where everything goes, and how a front is put together.
#include <algorithm>
#include <cstdlib>
#include <new>

#include "tenon/solvers/newton_kkt/multifrontal_ldlt.hpp"

namespace tenon {

void Arena::Release::operator()(double* memory) const { std::free(memory); }

void Arena::reserve(std::size_t capacity) {
  capacity_ = (capacity + 3) / 4 * 4 + 4;
  memory_.reset(static_cast<double*>(std::aligned_alloc(32, capacity_ * sizeof(double))));
  if (memory_ == nullptr) throw std::bad_alloc();
}

MultifrontalLdlt::MultifrontalLdlt(const SparsePattern& lower, int n, Room room) {
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
  plan(room);
}

// Memory as needed without delays, and room for them.
void MultifrontalLdlt::plan(Room room) {
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
  auto with_room = [&](std::size_t planned) { return planned + std::clamp(room.times * planned, room.least, room.most); };
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

}  // namespace tenon
