// What a run leaves behind: the trajectory's columns, its rows, and the events'.
//
//     t, states, algebraic variables, inputs, then what the Dae adds (gaps, modes, energy)
//     t, contact, from, to, gap, gap_rate_before, gap_rate_after, impulse, energy_before, energy_after
#pragma once

#include <string>
#include <vector>

#include "tenon/core/csv.hpp"
#include "tenon/core/dae.hpp"

namespace tenon {

/// A record in memory, for those who look at a run as a whole.
struct Trajectory {
  std::vector<std::string> names;         // of the columns, t first
  std::vector<std::vector<double>> rows;  // in the order of time
  std::vector<DaeEvent> events;

  /// Where the column of that name stands; throws std::invalid_argument, the nearest name named, where there is none.
  std::size_t column(const std::string& name) const;
};

std::vector<std::string> trajectory_columns(const Dae& dae);
/// One row, as long as the columns; `row` is reused storage.
void trajectory_row(const Dae& dae, const DaeState& state, Dae::Workspace& workspace, std::vector<double>& row);

std::vector<std::string> event_columns();
void write_event(CsvWriter& csv, const DaeEvent& event);

}  // namespace tenon
