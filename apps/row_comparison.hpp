// Many small problems on several solvers: who solved which, who found the lowest objective, at what price.
#pragma once

#include <string>
#include <vector>

#include "tenon/apps/json.hpp"
#include "tenon/apps/measure.hpp"

namespace tenon {

class RowComparison {
 public:
  /// tolerance: of the solves; an objective counts where the rows are met to ten times that.
  RowComparison(std::vector<std::string> solvers, double tolerance) : columns_(solvers.size()), feasible_(10 * tolerance) {
    for (std::size_t s = 0; s < solvers.size(); ++s) columns_[s].solver = std::move(solvers[s]);
  }

  /// Measurements come row by row, each row in the order of the solvers.
  void add(std::size_t solver, const Measurement& measurement);

  /// One line for each solver; then which rows ended elsewhere, and why a solver took none.
  std::string text() const;
  Json json() const;

 private:
  struct Cell {
    Status status;
    double objective, residual, primal, time;
    int iterations;
  };
  struct Column {
    std::string solver, refusal;
    std::vector<Cell> cells;  // one for each row
    EvaluationCounts counts;  // of all rows
  };
  /// A row on which a solver did not end at the lowest objective that any solver found.
  struct Stray {
    std::size_t row;
    bool stationary;  // solved, but at another stationary point
  };

  std::vector<double> lowest() const;
  std::vector<Stray> strays(const Column& column, const std::vector<double>& lowest) const;

  double furthest(const Column& column, const std::vector<double>& lowest) const;

  std::vector<Column> columns_;
  double feasible_;
};

}  // namespace tenon
