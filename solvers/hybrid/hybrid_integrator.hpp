// Integration across events, over any flow.
//
// settle: xdot and y from F = 0, then the level test (Dae::transition until nothing changes any more); step; look for guards that fell at
// the step's end and at points inside it; locate the first of them; settle again. A record has one row for each output step, after what the
// clock did there, and a row on either side of an event that resets x or changes a contact.
//
// Root finding is here and not in the flow's library: a guard that starts at zero must sleep until it has been positive, which a test for a
// change of sign does not know, and both flows must see the same events.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "tenon/solvers/hybrid/flow.hpp"

namespace tenon {

/// Two instants that nobody can tell apart.
inline bool is_same_time(double a, double b) {
  constexpr double kSameTime = 4e-16;  // relative
  return std::abs(a - b) <= kSameTime * std::max(std::abs(a), std::abs(b));
}

class HybridIntegrator final : public Integrator {
 public:
  HybridIntegrator(const Dae& dae, const IntegratorOptions& options, std::unique_ptr<Flow> flow);

  IntegrationResult advance(DaeState& state, double t_end) override;

 private:
  struct Crossing {
    double t = 0;
    std::vector<int> fired;
  };

  bool is_where_we_left(const DaeState& state) const;
  bool settle(DaeState& state, std::span<const int> fired, bool is_consistent);
  bool restart(DaeState& state, std::span<const int> fired, bool is_consistent);
  bool strike(DaeState& state, std::span<const int> fired);
  bool write_outputs(double t_last, bool is_event = false);
  double next_output() const { return t_start_ + static_cast<double>(outputs_) * options_.output_step; }
  bool emit(const DaeState& state);
  std::string why_inconsistent(const DaeState& state);
  std::string suspects(const DaeState& state) const;
  bool fail(IntegrationStatus status, const DaeState& state, const std::string& why);

  // crossing.cpp
  void evaluate_guards(const DaeState& state, Vector& values);
  bool look(double t);
  double guard_at(double t, int guard);
  bool find_crossing(Crossing& crossing);
  double locate(int guard, double a, double b);
  bool land(Crossing& crossing, DaeState& state);

  const Dae& dae_;
  IntegratorOptions options_;
  std::unique_ptr<Flow> flow_, exact_;  // exact_: for the modes that have one
  Flow* current_;
  ConsistentStart newton_;
  Dae::Workspace workspace_;
  IntegrationResult result_;

  DaeState left_;    // where the last call ended
  DaeState struck_;  // just before an event
  DaeState sample_;  // inside a step
  Vector before_, after_, values_;
  std::vector<char> is_armed_;
  bool is_started_ = false, reads_derivatives_ = true;
  double t_start_ = 0;
  long outputs_ = 0;  // written so far
};

}  // namespace tenon
