#include "tenon/solvers/hybrid/exact_flow.hpp"

#include <algorithm>

namespace tenon {

namespace {

class ExactFlow final : public Flow {
 public:
  explicit ExactFlow(const Dae& dae) : dae_(dae), newton_(dae), workspace_(dae.make_workspace()) {}

  bool restart(const DaeState& state) override {
    start_ = state;
    begin_ = end_ = state.t;
    return true;
  }

  Step step(double t_limit, double h_max) override {
    begin_ = end_;
    end_ = std::min(t_limit, begin_ + h_max);
    ++steps_;
    return end_ > begin_ ? Step::taken : Step::collapsed;
  }

  bool interpolate_state(double t, DaeState& state) override {
    state.t = t;
    dae_.exact_flow(start_.mode, t - start_.t, start_.x, state.x);
    return state.x.allFinite();
  }

  bool interpolate(double t, DaeState& state) override {
    return interpolate_state(t, state) && make_consistent(dae_, newton_, state, workspace_);
  }

 private:
  const Dae& dae_;
  ConsistentStart newton_;
  Dae::Workspace workspace_;
  DaeState start_;
};

}  // namespace

std::unique_ptr<Flow> make_exact_flow(const Dae& dae) {
  return std::make_unique<ExactFlow>(dae);
}

}  // namespace tenon
