// What a vehicle can do in each direction: hover efficiency, and the largest force and torque within its limits (envelope.md).
//
//     X1 = m g / sum of the thrusts,  X2 = m g / (N times the largest thrust):   least sum u^2 that carries the weight without a moment
//     force:         max t,  wrench (t n, 0)
//     torque:        max t,  wrench (0, t n)                 rotors push against each other, the body is not carried
//     torque_hover:  max t,  wrench (m g z, t n)             carried with body z up
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "tenon/core/solver.hpp"
#include "tenon/problems/envelope/attainable_set.hpp"
#include "tenon/problems/envelope/ray_program.hpp"

namespace tenon {

/// In one direction n of the body. For X1 and X2 n is up; NaN where the vehicle cannot hover so.
struct EnvelopePoint {
  double X1, X2;
  double force;         // N; this and the next: NaN where no start led to an answer, which only happens where the set is not convex
  double torque;        // N m
  double torque_hover;  // N m; NaN where it cannot hover with body z up
  double force_gap;     // N: no command gives more than force + force_gap
  double torque_gap;    // N m: the same of both torques
};

class Envelope {
 public:
  using SolverFactory = std::function<std::unique_ptr<Solver>(const Nlp&)>;

  /// Of a vehicle that normalise() has accepted, `failed` from 0 a rotor that gives nothing, -1 for none. The solver is asked only where the
  /// attainable set is not convex, from three starts for each boundary point; without one the answers are those of the convex set around it.
  explicit Envelope(const Vehicle& vehicle, int failed = -1, const SolverFactory& make_solver = {});

  Envelope(const Envelope&) = delete;  // the solver knows where the program is
  Envelope& operator=(const Envelope&) = delete;

  EnvelopePoint at(const Eigen::Vector3d& direction);

  /// Whether the answers are global: the rotors' sets are convex, or within 1e-4 of it, which the true maps then correct.
  bool is_convex() const { return is_convex_; }
  /// Directions of force and torque that no command gives, limits aside, in words.
  const std::vector<std::string>& unreachable() const { return unreachable_; }
  /// Answers that (4.1) did not find: they are NaN.
  long failures() const { return failures_; }

 private:
  struct Farthest {
    double length, gap;
  };

  Farthest farthest(const Wrench& from, const Wrench& direction);
  Vector thrusts(const Wrench& wrench);
  Vector start(const AttainableSet::Answer& answer) const;
  Vector neutral() const;

  int num_rotors_;
  double weight_;
  std::vector<Rotor> rotors_;  // those that work
  AttainableSet set_;
  bool is_convex_, hovers_level_;
  std::vector<std::string> unreachable_;
  RayProgram farthest_, least_effort_;
  std::unique_ptr<Solver> farthest_solver_, least_effort_solver_;  // none where the set is convex
  long failures_ = 0;
};

}  // namespace tenon
