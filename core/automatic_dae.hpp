// AutomaticDae<User>: a small semi-explicit Dae whose equations are written once, as a template; its derivatives are exact.
//
//     xdot = f(mode, x, y, u),    0 = g(mode, x, y, u)            F = (xdot - f, g)
//
//     struct Fall {
//       static constexpr int kStates = 2, kAlgebraics = 0, kInputs = 1;
//       template <class T>
//       void equations(const tenon::DaeMode&, const std::array<T, 2>& x, const std::array<T, 0>&, const std::array<T, 1>& u,
//                      std::array<T, 2>& xdot, std::array<T, 0>&) const { xdot = {x[1], u[0] - 9.81}; }
//     };
//
// The user may also have initial_state(DaeState&), name(), state_name(i), algebraic_name(i), input_name(i), and kOutputs with
// outputs(const DaeState&, VectorRef), output_name(i). Meant for up to some 20 variables in all (automatic.md).
#pragma once

#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <utility>

#include "tenon/core/automatic.hpp"
#include "tenon/core/dae.hpp"

namespace tenon {

template <class User>
class AutomaticDae final : public Dae {
 public:
  static constexpr int kStates = User::kStates, kAlgebraics = User::kAlgebraics, kInputs = User::kInputs;
  static constexpr int kRows = kStates + kAlgebraics, kVariables = kRows + kInputs;  // z = (x, y, u)

  explicit AutomaticDae(User user = {}) : user_(std::move(user)) {}
  const User& user() const { return user_; }

  int num_states() const override { return kStates; }
  int num_algebraics() const override { return kAlgebraics; }
  int num_inputs() const override { return kInputs; }

  void initial_state(DaeState& state) const override {
    if constexpr (requires { user_.initial_state(state); }) user_.initial_state(state);
  }
  Workspace make_workspace() const override {
    auto here = std::make_unique<Differentiated>();
    here->mode = initial_state_of(*this).mode;  // storage of its size
    return here;
  }

  void residual(const DaeMode& mode, const DaePoint& at, Workspace&, VectorRef F) const override {
    std::array<double, std::size_t(kVariables)> z;
    std::array<double, std::size_t(kRows)> right;
    gather(at, z);
    equations(mode, z, right);
    for (int i = 0; i < kStates; ++i) F[i] = at.xdot[i] - right[std::size_t(i)];
    for (int i = kStates; i < kRows; ++i) F[i] = right[std::size_t(i)];
  }

  // [ alpha - df/dx   -df/dy ]
  // [         dg/dx    dg/dy ]
  void jacobian(const DaeMode& mode, const DaePoint& at, double alpha, Workspace& workspace, std::span<double> values) const override {
    const auto& derivatives = differentiate(mode, at, workspace);
    double* out = values.data();
    for (int c = 0; c < kRows; ++c) {
      for (int r = 0; r < kRows; ++r) *out++ = sign(r) * derivatives.jacobian(r, c) + (r == c && c < kStates ? alpha : 0);
    }
  }
  SparsePattern rate_jacobian_pattern() const override {
    SparsePattern pattern{kRows, kStates, {0}, {}};
    for (int c = 0; c < kStates; ++c) pattern.inner.push_back(c), pattern.outer.push_back(c + 1);
    return pattern;
  }
  void input_jacobian(const DaeMode& mode, const DaePoint& at, Workspace& workspace, std::span<double> values) const override {
    const auto& derivatives = differentiate(mode, at, workspace);
    double* out = values.data();
    for (int c = kRows; c < kVariables; ++c) {
      for (int r = 0; r < kRows; ++r) *out++ = sign(r) * derivatives.jacobian(r, c);
    }
  }

  bool has_hessian() const override { return true; }
  SparsePattern hessian_pattern() const override {  // nothing of xdot
    SparsePattern pattern{kStates + kVariables, kStates + kVariables, std::vector<int>(std::size_t(kStates) + 1, 0), {}};
    for (int j = kStates; j < kStates + kVariables; ++j) {
      for (int i = j; i < kStates + kVariables; ++i) pattern.inner.push_back(i);
      pattern.outer.push_back(pattern.nonzeros());
    }
    return pattern;
  }
  void hessian(const DaeMode& mode, const DaePoint& at, ConstVectorRef w, Workspace& workspace, std::span<double> values) const override {
    std::array<double, std::size_t(kRows)> weights;
    for (int r = 0; r < kRows; ++r) weights[std::size_t(r)] = sign(r) * w[r];
    const auto combined = differentiate(mode, at, workspace).combine(weights.data());
    double* out = values.data();
    for (int j = 0; j < kVariables; ++j) {
      for (int i = j; i < kVariables; ++i) *out++ = SecondOrder<double, kVariables>::hessian(combined, i, j);
    }
  }

  bool has_derivatives() const override { return kAlgebraics == 0; }
  void derivatives(const DaeMode& mode, double, ConstVectorRef x, ConstVectorRef u, Workspace&, VectorRef xdot, VectorRef) const override {
    std::array<double, std::size_t(kVariables)> z{};
    std::array<double, std::size_t(kRows)> right;
    std::copy_n(x.data(), kStates, z.begin());
    std::copy_n(u.data(), kInputs, z.begin() + kRows);
    equations(mode, z, right);
    std::copy_n(right.begin(), kStates, xdot.data());
  }

  int num_outputs() const override {
    if constexpr (requires { User::kOutputs; })
      return User::kOutputs;
    else
      return 0;
  }
  void outputs(const DaeState& state, Workspace&, VectorRef values) const override {
    if constexpr (requires { user_.outputs(state, values); }) user_.outputs(state, values);
  }

  std::string name() const override {
    if constexpr (requires { user_.name(); })
      return user_.name();
    else
      return Dae::name();
  }
  std::string state_name(int i) const override {
    if constexpr (requires { user_.state_name(i); })
      return user_.state_name(i);
    else
      return Dae::state_name(i);
  }
  std::string algebraic_name(int i) const override {
    if constexpr (requires { user_.algebraic_name(i); })
      return user_.algebraic_name(i);
    else
      return Dae::algebraic_name(i);
  }
  std::string input_name(int i) const override {
    if constexpr (requires { user_.input_name(i); })
      return user_.input_name(i);
    else
      return Dae::input_name(i);
  }
  std::string output_name(int i) const override {
    if constexpr (requires { user_.output_name(i); })
      return user_.output_name(i);
    else
      return Dae::output_name(i);
  }

 private:
  /// All derivatives at one point, for Jacobians and Hessian to share.
  struct Differentiated final : Scratch {
    Derivatives<kVariables, kRows> derivatives;
    std::array<double, std::size_t(kVariables)> z;
    DaeMode mode;
    bool is_filled = false;
  };

  static double sign(int row) { return row < kStates ? -1 : 1; }

  static void gather(const DaePoint& at, std::array<double, std::size_t(kVariables)>& z) {
    std::copy_n(at.x.data(), kStates, z.begin());
    std::copy_n(at.y.data(), kAlgebraics, z.begin() + kStates);
    std::copy_n(at.u.data(), kInputs, z.begin() + kRows);
  }

  template <class T>
  void equations(const DaeMode& mode, const std::array<T, std::size_t(kVariables)>& z, std::array<T, std::size_t(kRows)>& right) const {
    std::array<T, std::size_t(kStates)> x, xdot;
    std::array<T, std::size_t(kAlgebraics)> y, g;
    std::array<T, std::size_t(kInputs)> u;
    std::copy_n(z.begin(), kStates, x.begin());
    std::copy_n(z.begin() + kStates, kAlgebraics, y.begin());
    std::copy_n(z.begin() + kRows, kInputs, u.begin());
    user_.equations(mode, std::as_const(x), std::as_const(y), std::as_const(u), xdot, g);
    std::copy_n(xdot.begin(), kStates, right.begin());
    std::copy_n(g.begin(), kAlgebraics, right.begin() + kStates);
  }

  const Derivatives<kVariables, kRows>& differentiate(const DaeMode& mode, const DaePoint& at, Workspace& workspace) const {
    auto& here = static_cast<Differentiated&>(*workspace);
    std::array<double, std::size_t(kVariables)> z;
    gather(at, z);
    if (here.is_filled && z == here.z && mode == here.mode) return here.derivatives;
    here.derivatives.evaluate([&](const auto& variables, auto& right) { equations(mode, variables, right); }, z.data());
    here.z = z, here.mode = mode, here.is_filled = true;
    return here.derivatives;
  }

  User user_;
};

}  // namespace tenon
