// Elimination of a stage that is not regular: hard rows beside the dynamics, compliant dynamics, a fixed next state, locals without
// positive curvature. The stage becomes a dense front with threshold pivots (front.hpp); what has no stable pivot, such as a multiplier
// whose row the inputs of this stage cannot meet, is left over to the stage before.
//
//               eliminated or left over                    kept
//     [ next state | left over by it | l | rows of the stage ][ s ]                                            stage_kkt.md (3.1)
#pragma once

#include <vector>

#include "tenon/solvers/newton_kkt/front.hpp"
#include "tenon/solvers/newton_kkt/stage_system.hpp"

namespace tenon {

class StageFronts {
 public:
  explicit StageFronts(const StageSystem& system);

  /// Unknowns that stage k leaves over to the stage before.
  int left_over(int k) const { return record(k).left_over; }
  void nothing_left_over(int k) { record(k).left_over = 0; }

  /// Eliminates stage k; the value of stage k and what is left over then hold the rest. k = -1: the first state and all that is left.
  void factor(int k, const StageSystem& system, Inertia& inertia);

  void backward(int k, const StageSystem& system, const double* rhs, double* value_rhs);
  void forward(int k, const StageSystem& system, const double* value_rhs, double* solution);

  /// P of stage k as the stage before sees it: over its state, then over what is left over.
  const double* value(int k, const StageSystem& system) const;

 private:
  struct Record {
    std::size_t panel = 0, numbers = 0, wide_value = 0, ids = 0;  // where they begin
    int most_columns = 0, most_rows = 0, most_left_over = 0;      // memory
    int columns = 0, rows = 0, eliminated = 0, left_over = 0;     // as factored
  };
  // numbers of a front, columns or rows each
  struct Numbers {
    double *d_inverse, *d_inverse_below, *scale, *t, *left_rhs, *magnitude;
  };
  Record& record(int k) { return records_[k + 1]; }
  const Record& record(int k) const { return records_[k + 1]; }
  Numbers numbers(const Record& record);
  void number_unknowns(int k, const StageSystem& system, int* ids);
  void assemble(int k, const StageSystem& system);
  void add_value(int k, const StageSystem& system);
  void equilibrate(int rows, double* scale);
  void keep(int k, const StageSystem& system, const Front& front, const Numbers& at);
  int value_stride(int k, const StageSystem& system) const;
  double& full(int i, int j) { return full_[std::max(i, j) + static_cast<std::ptrdiff_t>(std::min(i, j)) * stride_]; }

  std::vector<Record> records_;  // the first one is the last front, of the first state
  std::vector<int> ids_;         // of each column: where its unknown is in a vector
  std::vector<int> order_;       // of one front, while it is factored
  Arena arena_;
  Vector full_, unscaled_, row_max_, t_;
  int stride_ = 0;
};

}  // namespace tenon
