// A scene run to its end, with its whole record, for laws to look at.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "tenon/core/trajectory.hpp"
#include "tenon/problems/contact/contact_dae.hpp"
#include "tenon/problems/contact/scene_file.hpp"
#include "tenon/solvers/make_integrator.hpp"

namespace tenon {

inline std::unique_ptr<Dae> make_scene(contact::SceneFile& file) {
  if (auto* planar = std::get_if<contact::Scene<2>>(&file.scene)) return std::make_unique<contact::ContactDae<2>>(*planar);
  return std::make_unique<contact::ContactDae<3>>(std::get<contact::Scene<3>>(file.scene));
}

struct SceneRun : Trajectory {
  std::shared_ptr<Dae> dae;
  std::vector<DaeState> states;  // of the rows
  DaeState final;
  IntegrationResult result;

  Vector column(const std::string& name) const {
    const std::size_t at = Trajectory::column(name);
    Vector values(static_cast<int>(rows.size()));
    for (std::size_t k = 0; k < rows.size(); ++k) values[static_cast<int>(k)] = rows[k][at];
    return values;
  }
  double last(const std::string& name) const { return rows.back()[Trajectory::column(name)]; }
  double largest(const std::string& name) const { return column(name).cwiseAbs().maxCoeff(); }
  double smallest(const std::string& name) const { return column(name).minCoeff(); }
  bool is_contact(const std::string& lambda) const {
    return std::find(names.begin(), names.end(), "gap_" + lambda.substr(7)) != names.end();
  }
  std::vector<DaeEvent> events_to(int mode) const {
    std::vector<DaeEvent> found;
    std::copy_if(events.begin(), events.end(), std::back_inserter(found), [&](const DaeEvent& e) { return e.to == mode; });
    return found;
  }
  std::vector<DaeEvent> events_from(int from, int to) const {
    std::vector<DaeEvent> found;
    std::copy_if(events.begin(), events.end(), std::back_inserter(found), [&](const DaeEvent& e) { return e.from == from && e.to == to; });
    return found;
  }
};

/// rtol 0: the scene's own.
inline SceneRun run_scene(contact::SceneFile file, const std::string& integrator = "", double rtol = 0) {
  SceneRun run;
  run.dae = make_scene(file);
  run.names = trajectory_columns(*run.dae);
  IntegratorOptions options{.rtol = file.simulation.rtol, .atol = file.simulation.atol, .output_step = file.simulation.output_step};
  if (rtol > 0) options.rtol = rtol, options.atol = 1e-2 * rtol;
  Dae::Workspace workspace = run.dae->make_workspace();
  options.on_output = [&](const DaeState& state) {
    run.rows.emplace_back();
    trajectory_row(*run.dae, state, workspace, run.rows.back());
    run.states.push_back(state);
    return true;
  };
  options.on_event = [&](const DaeEvent& event) { run.events.push_back(event); };
  run.final = initial_state_of(*run.dae);
  const std::string chosen = integrator.empty() ? file.simulation.integrator : integrator;
  run.result = make_integrator(chosen, *run.dae, options)->advance(run.final, file.simulation.duration);
  EXPECT_EQ(run.result.status, IntegrationStatus::reached) << run.dae->name() << ": " << run.result.explanation;
  return run;
}

inline SceneRun run_scene(const std::string& name, const std::vector<std::string>& overrides = {}, const std::string& integrator = "",
                          double rtol = 0) {
  return run_scene(contact::load_scene(name, overrides), integrator, rtol);
}

/// The Jacobian against central differences of the residual, at the start, with all contacts off and all of them on.
inline void check_jacobian(contact::SceneFile file, double tolerance) {
  const std::unique_ptr<Dae> dae = make_scene(file);
  Dae::Workspace workspace = dae->make_workspace();
  DaeState state = initial_state_of(*dae);
  const int nx = dae->num_states(), n = nx + dae->num_algebraics();
  for (const int mode : {contact::kFree, contact::kCollision}) {
    for (int& m : state.mode.discrete) m = m == contact::kContact ? m : mode;
    for (int i = 0; i < nx; ++i) state.x[i] += 1e-2 * std::sin(1.0 + i), state.xdot[i] = std::cos(2.0 + i);
    for (int i = 0; i < n - nx; ++i) state.y[i] = 1 + std::sin(3.0 + i);
    const SparsePattern pattern = dae->jacobian_pattern();
    SparseMatrix J = pattern.zero_matrix();
    const double alpha = 0.7;
    dae->jacobian(state.mode, DaePoint(state), alpha, workspace, {J.valuePtr(), static_cast<std::size_t>(J.nonZeros())});
    const Eigen::MatrixXd dense = J;
    Vector plus(n), minus(n);
    for (int j = 0; j < n; ++j) {
      DaeState moved = state;
      const double step = 1e-6;
      const auto shift = [&](double by) { j < nx ? (moved.x[j] += by, moved.xdot[j] += alpha * by) : moved.y[j - nx] += by; };
      shift(step);
      dae->residual(state.mode, DaePoint(moved), workspace, plus);
      shift(-2 * step);
      dae->residual(state.mode, DaePoint(moved), workspace, minus);
      const Vector difference = (plus - minus) / (2 * step);
      for (int i = 0; i < n; ++i) {
        EXPECT_NEAR(dense(i, j), difference[i], tolerance * std::max(1.0, std::abs(difference[i])) * 100)
            << dae->name() << ": row " << i << ", column " << (j < nx ? dae->state_name(j) : dae->algebraic_name(j - nx)) << ", mode "
            << mode;
      }
    }
  }
}

}  // namespace tenon
