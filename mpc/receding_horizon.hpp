// Model-predictive control: at every tick the plan of the tick before is moved on, solved again from there, and its beginning commanded.
//
//     estimate, observe, shift, solve, accept, command
//
// A plan whose rows hold well enough is used, however its solve ended; else the plan before, shifted, is used further, and the next solve
// starts afresh. So an infeasible horizon, a deadline or a solve gone wrong never leaves the plant without commands.
//
// Where commands act late by a known delay, commanded is what the plan has for the time at which they will act. The plan takes it that its
// beginning is commanded, and that is so as far as the plan before was right.
//
// A controller plans before it is switched on: the first tick goes on from a plan made for what the program knows when it is built, where
// the plant is expected to start and what is believed of it. Where the plant is elsewhere, so that no use can be made of that plan, the
// first tick starts afresh.
#pragma once

#include <memory>

#include "tenon/core/controller.hpp"
#include "tenon/core/estimator.hpp"
#include "tenon/core/horizon_options.hpp"
#include "tenon/core/horizon_program.hpp"
#include "tenon/core/solver_factory.hpp"

namespace tenon {

class RecedingHorizon final : public Controller {
 public:
  /// `estimator` may be null. `period` (s) is that of the ticks: at most a stage of the program, which is shifted once a stage has passed.
  /// Plans ahead for the program as it is given.
  /// Throws std::invalid_argument where the parts do not fit together, and what the factory throws.
  RecedingHorizon(std::unique_ptr<HorizonProgram> program, std::unique_ptr<Estimator> estimator, const SolverFactory& make_solver,
                  const HorizonOptions& options, double period);
  ~RecedingHorizon() override;

  int num_measurements() const override { return program_->num_measurements(); }
  int num_commands() const override { return program_->num_commands(); }
  double period() const override { return period_; }
  void reset() override;
  void update(double t, ConstVectorRef measurements, VectorRef commands) override;
  StepLog last_step() const override { return log_; }

  /// Estimates and the lower triangle of their covariance, how the step went, what the plan foresees.
  int num_outputs() const override;
  std::string output_name(int i) const override;
  void outputs(VectorRef values) const override;

  /// What is commanded now, and the time (s) at which its first stage begins.
  const Point& plan() const { return plan_; }
  double plan_start() const { return start_; }

 private:
  /// What the plan in use was made for.
  enum class Basis { nothing, expectation, measurement };

  void plan_ahead(const SolverFactory& make_solver, const Options& options);
  void estimate(double t, ConstVectorRef measurements);
  void shift_to(double t);
  void start_afresh(Point& plan) const;
  Result solve_from_guess();
  Result solve(Solver& solver);
  bool is_usable(const Result& result) const;
  void accept(double t, const Result& result);

  std::unique_ptr<HorizonProgram> program_;
  std::unique_ptr<Estimator> estimator_;
  Stages stages_;
  std::unique_ptr<Solver> cold_, warm_;
  double largest_violation_, delay_, period_;

  Point ahead_, plan_, trial_;
  double start_ = 0;
  bool has_ahead_ = false, failed_ = false;
  Basis basis_ = Basis::nothing;
  Vector estimates_, commands_;
  Eigen::MatrixXd covariance_;
  StepLog log_;
};

}  // namespace tenon
