// The contract of a hybrid DAE of index 1.
//
//     F(mode, t, xdot, x, y, u) = 0        x differential, y algebraic, u inputs;   [dF/dxdot, dF/dy] is regular
//
// Position constraints may stand in it in their stabilised form of index 2 instead: see `has_manifold`.
//
// The mode is what stays constant between two events: one integer for each contact, and whatever reals are held (the output of a
// sampled controller). Integrators copy it and never look inside. Sizes and patterns are the same in all modes: a contact that is off has
// the row lambda = 0. An event is a guard that falls through zero, or a clock that strikes; `transition` then decides what becomes of the
// mode, and may reset x. It also tests levels, so that an integrator calls it at every start and until nothing changes any more.
//
// Promises of a Dae: outputs arrive unset and every stored entry is written; evaluations are const, deterministic and allocate nothing; a
// non-finite value IS the report "cannot evaluate here".
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "tenon/core/eigen.hpp"
#include "tenon/core/sparse_pattern.hpp"

namespace tenon {

/// The discrete state. What the numbers mean is the Dae's own business.
struct DaeMode {
  std::vector<int> discrete;  // one state for each contact
  Vector held;                // reals that change at events only

  bool operator==(const DaeMode&) const = default;
};

/// All that a trajectory is at one instant.
struct DaeState {
  double t = 0;  // s
  DaeMode mode;
  Vector x, xdot;  // num_states
  Vector y;        // num_algebraics
  Vector u;        // num_inputs, held by whoever integrates
};

/// Where a Dae is evaluated: views of a state, or of an integrator's own storage.
struct DaePoint {
  double t;
  ConstVectorRef xdot, x, y, u;

  DaePoint(double t_, ConstVectorRef xdot_, ConstVectorRef x_, ConstVectorRef y_, ConstVectorRef u_)
      : t(t_), xdot(xdot_), x(x_), y(y_), u(u_) {}
  explicit DaePoint(const DaeState& s) : DaePoint(s.t, s.xdot, s.x, s.y, s.u) {}
};

/// One line of the events record: a contact that changes its state, or one collision of a fast phase.
struct DaeEvent {
  double t = 0;
  std::string contact;
  int from = 0, to = 0;  // 0 free, 1 collision, 2 contact
  double gap = 0, gap_rate_before = 0, gap_rate_after = 0, impulse = 0;
  double energy_before = 0, energy_after = 0;
};

/// What `transition` did.
struct Transition {
  bool changed = false;      // the mode or x: the integrator starts anew from here
  std::string failure = {};  // not empty: the run cannot go on, and why
};

class Dae {
 public:
  /// What the evaluations share between calls (storage, a factorisation's symbolic part). Null where there is nothing.
  class Scratch {
   public:
    virtual ~Scratch() = default;
  };
  using Workspace = std::unique_ptr<Scratch>;
  using EventLog = std::function<void(const DaeEvent&)>;

  virtual ~Dae() = default;

  virtual int num_states() const = 0;      // nx
  virtual int num_algebraics() const = 0;  // ny
  virtual int num_inputs() const { return 0; }
  virtual int num_guards() const { return 0; }

  /// Time, mode, x and u to start from; vectors arrive with their sizes and 0, xdot and y need not be consistent.
  virtual void initial_state(DaeState& state) const = 0;

  virtual Workspace make_workspace() const { return nullptr; }

  /// F, nx + ny rows. By convention row i < nx belongs to state i, so that a diagnosis can name it.
  virtual void residual(const DaeMode& mode, const DaePoint& at, Workspace& workspace, VectorRef F) const = 0;

  /// Non-zeros of dF/d(x, y) + alpha dF/d(xdot, 0), square of nx + ny, for every alpha and mode. Asked for once. Dense by default.
  virtual SparsePattern jacobian_pattern() const {
    const int n = num_states() + num_algebraics();
    return SparsePattern::full(n, n);
  }
  /// Its values, in the order of the pattern.
  virtual void jacobian(const DaeMode& mode, const DaePoint& at, double alpha, Workspace& workspace, std::span<double> values) const = 0;

  /// Non-zeros of dF/dxdot, (nx + ny) x nx: those of the Jacobian with alpha that the one without does not account for. Dense by default.
  virtual SparsePattern rate_jacobian_pattern() const { return SparsePattern::full(num_states() + num_algebraics(), num_states()); }

  /// dF/du, (nx + ny) x num_inputs.
  virtual SparsePattern input_jacobian_pattern() const { return SparsePattern::full(num_states() + num_algebraics(), num_inputs()); }
  virtual void input_jacobian(const DaeMode& mode, const DaePoint& at, Workspace& workspace, std::span<double> values) const {
    static_cast<void>(mode), static_cast<void>(at), static_cast<void>(workspace), static_cast<void>(values);
  }

  /// Lower triangle of the Hessian of w'F in (xdot, x, y, u), for those that optimise over it; a Dae that has it says so.
  virtual bool has_hessian() const { return false; }
  virtual SparsePattern hessian_pattern() const { return SparsePattern::full_lower(2 * num_states() + num_algebraics() + num_inputs()); }
  virtual void hessian(const DaeMode& mode, const DaePoint& at, ConstVectorRef w, Workspace& workspace, std::span<double> values) const {
    static_cast<void>(mode), static_cast<void>(at), static_cast<void>(w), static_cast<void>(workspace), static_cast<void>(values);
  }

  /// Where F can be solved for (xdot, y) directly: writes both, non-finite where it cannot. Without it integrators take Newton's method
  /// on F (core/consistent_start.hpp).
  virtual bool has_derivatives() const { return false; }
  virtual void derivatives(const DaeMode& mode, double t, ConstVectorRef x, ConstVectorRef u, Workspace& workspace, VectorRef xdot,
                           VectorRef y) const {
    static_cast<void>(mode), static_cast<void>(t), static_cast<void>(x), static_cast<void>(u), static_cast<void>(workspace);
    static_cast<void>(xdot), static_cast<void>(y);
  }

  /// Where the flow of a mode is known in closed form: the state after dt, with no error to control.
  virtual bool has_exact_flow(const DaeMode& mode) const {
    static_cast<void>(mode);
    return false;
  }
  virtual void exact_flow(const DaeMode& mode, double dt, ConstVectorRef x, VectorRef next) const {
    static_cast<void>(mode), static_cast<void>(dt), static_cast<void>(x), static_cast<void>(next);
  }

  /// Where F holds position constraints and their first derivatives themselves, each with a multiplier in y: the stabilised index 2 form.
  /// Such a Dae has `derivatives`, which count where x is on that manifold, and `project` takes x to its nearest point there (false where
  /// it cannot). Integrators do so at every start and, where they solve for derivatives instead of F, after each step. Source: C. W. Gear,
  /// B. Leimkuhler, G. K. Gupta, J. Comput. Appl. Math. 12-13 (1985) 77.
  virtual bool has_manifold(const DaeMode& mode) const {
    static_cast<void>(mode);
    return false;
  }
  virtual bool project(const DaeMode& mode, double t, VectorRef x, Workspace& workspace) const {
    static_cast<void>(mode), static_cast<void>(t), static_cast<void>(x), static_cast<void>(workspace);
    return true;
  }

  /// Values whose fall through zero ends the mode. A guard that starts at or below zero is asleep until it has been positive.
  virtual void guards(const DaeMode& mode, const DaePoint& at, Workspace& workspace, VectorRef values) const {
    static_cast<void>(mode), static_cast<void>(at), static_cast<void>(workspace), static_cast<void>(values);
  }
  /// False where the guards of this mode look at t and x alone: xdot and y are then stale there, which saves a solve for each look.
  virtual bool guards_read_derivatives(const DaeMode& mode) const {
    static_cast<void>(mode);
    return true;
  }
  /// The next time at which a clock strikes, after state.t; infinity for none.
  virtual double next_event_time(const DaeState& state) const;

  /// Called at every start, at every event and again until nothing changes, with a consistent state; `fired` are the guards that fell,
  /// empty for a level test or a clock. Afterwards x and the mode count; xdot and y are found anew.
  virtual Transition transition(DaeState& state, std::span<const int> fired, Workspace& workspace, const EventLog& log) const {
    static_cast<void>(state), static_cast<void>(fired), static_cast<void>(workspace), static_cast<void>(log);
    return {};
  }

  /// The longest step after which no event can have come and gone unseen; infinity for no limit.
  virtual double max_step(const DaeState& state, Workspace& workspace) const;

  /// Of the record: columns beyond x, y and u, such as gaps, modes and energy.
  virtual int num_outputs() const { return 0; }
  virtual void outputs(const DaeState& state, Workspace& workspace, VectorRef values) const {
    static_cast<void>(state), static_cast<void>(workspace), static_cast<void>(values);
  }

  virtual std::string name() const { return "dae"; }
  virtual std::string state_name(int i) const { return "x" + std::to_string(i + 1); }
  virtual std::string algebraic_name(int i) const { return "y" + std::to_string(i + 1); }
  virtual std::string input_name(int i) const { return "u" + std::to_string(i + 1); }
  virtual std::string output_name(int i) const { return "output" + std::to_string(i + 1); }
  virtual std::string guard_name(int i) const { return "guard" + std::to_string(i + 1); }
};

/// The Dae's own start, with vectors of the right sizes.
DaeState initial_state_of(const Dae& dae);

}  // namespace tenon
