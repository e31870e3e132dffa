// A scene of bodies and contacts as a hybrid DAE of index 1.
//
//     qdot = E(q) v,    M vdot = Q(t, q, v) + sum_i H_i' lambda_i
//     joint or active contact:  h_i'' + alpha1 h_i' + alpha0 h_i + alpha3 h_i^3 + r_i lambda_i = 0    r_i = 0, or tiny where redundant
//     joint of index 2:         h_i' = 0,  h_i = 0,  and M^-1 H_i' mu_i in qdot
//     inactive contact:         lambda_i = 0,  h_i >= 0
//     work of every multiplier and of every force without potential:  Wdot = power,  so that energy - sum W stays what it was
//
// x holds q and v of each body in turn, then the works; y holds the multipliers lambda, then mu. One state machine runs for each contact
// (contact_transition.cpp), its fast phase in fast_phase.hpp. Derivation: contact.md.  Source: [S], the slides on contact and collision.
#pragma once

#include "tenon/core/dae.hpp"
#include "tenon/problems/contact/fast_phase.hpp"
#include "tenon/problems/contact/force.hpp"
#include "tenon/problems/contact/scene.hpp"
#include "tenon/problems/contact/skyline.hpp"

namespace tenon::contact {

/// State of one contact, as the record shows it.
enum ContactMode : int { kFree = 0, kCollision = 1, kContact = 2 };

/// What stands where in DaeMode::held.
inline constexpr int kHeldRedundant = 0;  // 1 where active contacts depend on one another
inline constexpr int kHeldEnergy = 1;     // J, at the start
inline constexpr int kHeldFeatures = 2;   // from here on, one for each constraint: the shape's feature that it touches (features.hpp)

inline constexpr double kGapTolerance = 1e-12;          // m: a free contact collides where its gap closes at less than minus this
inline constexpr double kTouching = 1e-9;               // m: gaps up to here touch
inline constexpr double kSpeedTolerance = 1e-10;        // m/s: a gap that closes no faster stands still
inline constexpr double kAccelerationTolerance = 1e-9;  // m/s^2
inline constexpr double kSoftness = 1e-9;               // of redundant contacts, relative to the bodies' inverse masses

/// A body's entry in a list that has the world's at its end.
template <class List>
auto& of(List& list, int body) {
  return body == kWorld ? list.back() : list[static_cast<std::size_t>(body)];
}

template <int D>
class ContactDae final : public Dae {
 public:
  /// Throws std::invalid_argument, naming the body or contact, where a mass or inertia is not positive, a gap is closed at the start or a
  /// joint is open.
  explicit ContactDae(Scene<D> scene);

  const Scene<D>& scene() const { return scene_; }

  int num_states() const override { return num_states_; }
  int num_constraints() const { return static_cast<int>(scene_.constraints.size()); }
  int num_algebraics() const override { return num_constraints() + static_cast<int>(index_2_.size()); }
  int num_guards() const override { return 2 * num_constraints(); }
  void initial_state(DaeState& state) const override;
  Workspace make_workspace() const override;
  void residual(const DaeMode& mode, const DaePoint& at, Workspace& workspace, VectorRef F) const override;
  SparsePattern jacobian_pattern() const override { return pattern_; }
  void jacobian(const DaeMode& mode, const DaePoint& at, double alpha, Workspace& workspace, std::span<double> values) const override;
  bool has_derivatives() const override { return true; }
  void derivatives(const DaeMode& mode, double t, ConstVectorRef x, ConstVectorRef u, Workspace& workspace, VectorRef xdot,
                   VectorRef y) const override;
  bool has_exact_flow(const DaeMode& mode) const override;
  void exact_flow(const DaeMode& mode, double dt, ConstVectorRef x, VectorRef next) const override;
  bool has_manifold(const DaeMode&) const override { return !index_2_.empty(); }
  bool project(const DaeMode& mode, double t, VectorRef x, Workspace& workspace) const override;
  bool guards_read_derivatives(const DaeMode& mode) const override;
  void guards(const DaeMode& mode, const DaePoint& at, Workspace& workspace, VectorRef values) const override;
  Transition transition(DaeState& state, std::span<const int> fired, Workspace& workspace, const EventLog& log) const override;
  double max_step(const DaeState& state, Workspace& workspace) const override;
  int num_outputs() const override { return 2 * static_cast<int>(contacts_.size()) + (scene_.with_audit ? 2 : 1); }
  void outputs(const DaeState& state, Workspace& workspace, VectorRef values) const override;

  std::string name() const override { return scene_.name; }
  std::string state_name(int i) const override { return state_names_[static_cast<std::size_t>(i)]; }
  std::string algebraic_name(int i) const override;
  std::string output_name(int i) const override;
  std::string guard_name(int i) const override { return scene_.constraints[static_cast<std::size_t>(i / 2)].name; }

  /// Kinetic and potential energy, J.
  double energy(double t, ConstVectorRef x, Workspace& workspace) const;
  /// Linear momentum, kg m/s.
  Point<double, D> momentum(ConstVectorRef x) const;
  /// Of one constraint.
  GapValue<double, D> gap(int constraint, double t, ConstVectorRef x, Workspace& workspace) const;

  struct Bodies;  // what the evaluations at one x share

 private:
  struct Place {
    int q, v, nq, nv;  // where a body's positions and velocities stand in x, and how many they are
  };

  Place place(int body) const { return body == kWorld ? Place{0, 0, 0, 0} : places_[static_cast<std::size_t>(body)]; }
  bool turns(Place at) const { return at.nv > D; }
  double inverse_mass(int body, int l) const { return of(inverse_masses_, body)[l]; }
  double softness(const DaeMode& mode, const Constraint<D>& c) const;
  void load(double t, ConstVectorRef x, Bodies& bodies) const;
  void load(const DaeMode& mode, double t, ConstVectorRef x, Bodies& bodies) const;
  bool pass_features(DaeState& state, std::span<const int> fired, const Bodies& bodies) const;
  void hold_features(DaeState& state, const Bodies& bodies) const;
  Transition react(DaeState& state, std::span<const int> fired, Bodies& bodies, const EventLog& log) const;
  void apply_forces(double t, Bodies& bodies, double* powers) const;
  GapValue<double, D> gap_of(int constraint, double t, const Bodies& bodies) const;
  void factorise(const DaeMode& mode, double t, Bodies& bodies) const;
  void solve(Bodies& bodies) const;
  void solve_multipliers(const DaeMode& mode, double t, Bodies& bodies) const;
  void set_accelerations(Bodies& bodies) const;
  double acceleration(int constraint, const Bodies& bodies) const;
  double acceleration(const Constraint<D>& c, const GapValue<double, D>& g, ConstVectorRef xdot) const;
  double energy_of(double t, const Bodies& bodies) const;
  double* work_of(DaeState& state, int constraint) const;

  bool release(DaeState& state, std::span<const int> fired, const Bodies& bodies, const EventLog& log) const;
  bool begin_one_law(DaeState& state, const Bodies& bodies, const EventLog& log) const;
  bool settle_one_law(DaeState& state, const Bodies& bodies, const EventLog& log) const;
  Transition collide(DaeState& state, Bodies& bodies, const EventLog& log) const;
  Transition distribute(DaeState& state, Bodies& bodies, const EventLog& log) const;
  void report(const DaeState& state, int constraint, int from, int to, const Bodies& bodies, double rate_after, double impulse,
              double energy_after, const EventLog& log) const;

  void find_pattern();
  void check() const;

  Scene<D> scene_;
  std::vector<Place> places_;
  std::vector<Velocities<double, D>> inverse_masses_;  // 0 where a body has no freedom; the world's last
  std::vector<int> contacts_;                          // the constraints that are no joints
  std::vector<double> reach_;                          // of each contact, in the order of contacts_
  std::vector<int> index_2_;                           // the joints of index 2, in the order of their mu
  std::vector<int> order_;                             // of the constraints along the bodies, for the envelope
  std::vector<int> force_work_;                        // where in x a force's work stands, -1 where it has none
  std::vector<std::string> state_names_;
  int num_states_ = 0, works_ = 0;  // works_: where in x the first work stands
  SparsePattern pattern_;
  bool has_friction_ = false, has_one_law_ = false, is_ballistic_ = true;  // is_ballistic_: between contacts nothing acts but gravity
};

/// Poses and motions of all bodies, filled up where one has not all freedoms, and what the solve for multipliers works on.
template <int D>
struct ContactDae<D>::Bodies : Dae::Scratch {
  double t = 0;
  std::vector<Positions<double, D>> q;
  std::vector<Velocities<double, D>> v, force, acceleration;
  std::vector<Velocities<double, D>> travel;  // v + M^-1 H' mu: what the positions go by
  std::vector<Pose<double, D>> poses;
  std::vector<int> features;  // of each constraint, held or kNearest

  std::vector<int> active;                            // constraints, in the order of the envelope
  std::vector<GapValue<double, D>> gaps;              // by constraint; those of active ones are there
  std::vector<Velocities<double, D>> push_a, push_b;  // generalised force of one unit of lambda
  std::vector<double> push_power;
  std::vector<int> first_seen;  // of each body among the active constraints
  Skyline skyline;
  Eigen::MatrixXd dense;  // with friction: H M^-1 H' is not symmetric then
  Eigen::PartialPivLU<Eigen::MatrixXd> lu;
  Vector rhs, answer;  // their first entries, in the order of the active constraints
  Vector lambda;
  int defect = 0;  // of the rank of H M^-1 H'

  std::vector<int> touching, resting;  // of a transition: what may collide, what may carry a force
  DaeMode trial;
};

extern template class ContactDae<2>;
extern template class ContactDae<3>;

}  // namespace tenon::contact
