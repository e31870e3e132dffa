// L D L' of a sparse symmetric indefinite matrix: multifrontal, with 1x1 and 2x2 threshold pivots and delayed columns.
//
// Fronts are factored children first. A front sums up its entries of K, its children's contributions and the columns they left over,
// eliminates what is stable, keeps L, and hands on the rest:
//
//         d + w columns     R rows
//       +---------------+----------+        d columns left over by the children, w its own: the panel, in the arena of L
//       |  panel        |          |        what the panel leaves over and the contribution: on a stack
//       |               | contrib. |
//       +---------------+----------+
//
// All memory is provided at construction, with room for delays; once that is used up, pivots are taken as they are (front.hpp,
// eliminate_rest). Equations: linear_algebra.md sections 3 and 4.
#pragma once

#include <memory>
#include <vector>

#include "tenon/solvers/newton_kkt/elimination.hpp"
#include "tenon/solvers/newton_kkt/inertia.hpp"
#include "tenon/solvers/newton_kkt/lanes.hpp"

namespace tenon {

struct Front;

/// Rows in whole lanes, and the numbers that a block of so many rows and columns takes: a panel, a contribution, columns left over.
inline std::size_t lanes_of(int rows) { return static_cast<std::size_t>(lanes::padded<double>(rows)); }
inline std::size_t panel_size(int rows, int columns) { return lanes_of(rows) * static_cast<std::size_t>(columns); }

/// Memory that is not touched before it is used, in 32-byte lanes.
class Arena {
 public:
  void reserve(std::size_t capacity);
  double* at(std::size_t offset) { return memory_.get() + offset; }
  std::size_t capacity() const { return capacity_; }

 private:
  struct Release {
    void operator()(double* memory) const;
  };
  std::unique_ptr<double[], Release> memory_;
  std::size_t capacity_ = 0;
};

class MultifrontalLdlt {
 public:
  /// Memory for delays, in numbers beyond the plan: so many times the plan, within bounds. It costs nothing before it is touched.
  struct Room {
    std::size_t times = 5;
    std::size_t least = 1 << 16;
    std::size_t most = 1 << 26;
  };

  /// lower: the lower triangle of K with its whole diagonal; its first n rows are variables, the others constraints.
  MultifrontalLdlt(const SparsePattern& lower, int n) : MultifrontalLdlt(lower, n, Room{}) {}
  MultifrontalLdlt(const SparsePattern& lower, int n, Room room);

  int size() const { return tree_.size; }

  /// values: one for each entry of `lower`, finite.
  Inertia factor(const double* values);

  /// x <- K^-1 x (size).
  void solve_in_place(double* x);

  /// Of the last factorisation.
  long delayed_columns() const { return delayed_; }
  /// Entries of L if no column is delayed.
  double planned_entries() const { return planned_entries_; }

 private:
  struct Record {             // of a front, as factored
    std::size_t panel = 0;    // where its L begins in the arena
    std::size_t ids = 0;      // where its columns are named
    std::size_t block = 0;    // where its contribution begins on its stack
    int columns = 0;          // summed up
    int eliminated = 0;       // of them
    int pivots = 0;           // eliminated before this front
  };
  struct Entry {
    int row, column;          // in the front, without delays
    int source;               // among the values
  };

  void plan(Room room);
  void assemble(int s, Record& record, const double* values);
  void add_contribution(int child, int s, int& place);
  std::size_t panel_growth(int s, int delayed) const;
  bool can_delay(int s, const Front& front) const;
  void keep_left_over(int s, const Front& front);

  FrontTree tree_;
  std::vector<int> rows_;                       // tree_.rows as rows of K
  std::vector<int> entries_begin_;
  std::vector<Entry> entries_;                  // of K, by the front that owns their earlier column
  std::vector<int> diagonal_;                   // where each diagonal entry is among the values

  std::vector<Record> records_;
  std::vector<int> ids_;
  std::vector<int> delayed_into_;               // columns that its children leave over to each front
  Arena factor_, stack_[2], unscaled_;          // fronts of even and odd depth use different stacks: a front reads one and writes the other
  std::size_t factor_top_ = 0, ids_top_ = 0, stack_top_[2] = {0, 0};
  std::size_t factor_left_ = 0;                 // what the fronts still to come need, with the columns already delayed into them
  std::size_t ids_left_ = 0;
  std::size_t factor_planned_ = 0, stack_planned_ = 0;
  std::vector<double> d_inverse_, d_inverse_below_;
  Vector magnitude_;                            // size: by row of K
  Vector front_magnitude_, y_;                  // of one front, in whole lanes
  long delayed_ = 0;
  double planned_entries_ = 0;
};

}  // namespace tenon
