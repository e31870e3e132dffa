// The programs of AttainableSet by the true maps, in throttles and angles: smooth, not convex, for any vehicle.
//
//     min -t  or  sum u_i^2     s.t.   sum_i w_i(mu_i(u_i), tau_i(u_i); n_i(a_i)) - t d = W,    limits of u and a                 (4.1)
//
// Variables u_1..u_N, a_1..a_N, t; derivatives as in problems/allocation/allocation.md, section 2.
#pragma once

#include "tenon/core/nlp.hpp"
#include "tenon/problems/allocation/allocator.hpp"
#include "tenon/problems/allocation/vehicle.hpp"

namespace tenon {

class RayProgram final : public Nlp {
 public:
  enum class Aim { farthest, least_effort };

  RayProgram(std::vector<Rotor> rotors, Aim aim) : rotors_(std::move(rotors)), is_effort_(aim == Aim::least_effort) {}

  /// W and d; for the least effort d has no meaning.
  void set_ray(const Wrench& from, const Wrench& direction = Wrench::Zero());

  int num_variables() const override { return 2 * num_rotors() + 1; }
  int num_constraints() const override { return 6; }
  SparsePattern jacobian_pattern() const override { return SparsePattern::full(6, num_variables()); }
  SparsePattern hessian_pattern() const override;
  void bounds(Bounds& bounds) const override;
  double objective(ConstVectorRef x, Workspace& workspace) const override;
  void gradient(ConstVectorRef x, Workspace& workspace, VectorRef gradient) const override;
  void constraints(ConstVectorRef x, Workspace& workspace, VectorRef values) const override;
  void jacobian(ConstVectorRef x, Workspace& workspace, std::span<double> values) const override;
  void hessian(ConstVectorRef x, double sigma, ConstVectorRef lambda, Workspace& workspace, std::span<double> values) const override;
  std::string name() const override { return is_effort_ ? "least effort" : "farthest wrench"; }

 private:
  int num_rotors() const { return static_cast<int>(rotors_.size()); }

  std::vector<Rotor> rotors_;
  Wrench from_ = Wrench::Zero(), direction_ = Wrench::Zero();
  bool is_effort_;
};

}  // namespace tenon
