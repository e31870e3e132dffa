#include "tenon/core/trajectory.hpp"

#include <algorithm>
#include <stdexcept>

#include "tenon/core/nearest_name.hpp"

namespace tenon {

std::size_t Trajectory::column(const std::string& name) const {
  const auto at = std::find(names.begin(), names.end(), name);
  if (at == names.end())
    throw std::invalid_argument("trajectory: unknown column '" + name + "', the nearest is '" + nearest_name(name, names) + "'");
  return static_cast<std::size_t>(at - names.begin());
}

std::vector<std::string> trajectory_columns(const Dae& dae) {
  std::vector<std::string> names{"t"};
  for (int i = 0; i < dae.num_states(); ++i) names.push_back(dae.state_name(i));
  for (int i = 0; i < dae.num_algebraics(); ++i) names.push_back(dae.algebraic_name(i));
  for (int i = 0; i < dae.num_inputs(); ++i) names.push_back(dae.input_name(i));
  for (int i = 0; i < dae.num_outputs(); ++i) names.push_back(dae.output_name(i));
  return names;
}

void trajectory_row(const Dae& dae, const DaeState& state, Dae::Workspace& workspace, std::vector<double>& row) {
  row.assign(1, state.t);
  row.insert(row.end(), state.x.begin(), state.x.end());
  row.insert(row.end(), state.y.begin(), state.y.end());
  row.insert(row.end(), state.u.begin(), state.u.end());
  const std::size_t begin = row.size();
  row.resize(begin + static_cast<std::size_t>(dae.num_outputs()));
  dae.outputs(state, workspace, Eigen::Map<Vector>(row.data() + begin, dae.num_outputs()));
}

std::vector<std::string> event_columns() {
  return {"t", "contact", "from", "to", "gap", "gap_rate_before", "gap_rate_after", "impulse", "energy_before", "energy_after"};
}

void write_event(CsvWriter& csv, const DaeEvent& event) {
  csv << event.t << event.contact << event.from << event.to << event.gap << event.gap_rate_before << event.gap_rate_after << event.impulse
      << event.energy_before << event.energy_after;
  csv.end_row();
}

}  // namespace tenon
