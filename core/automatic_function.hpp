// A SmoothFunction written once, as a template: its derivatives are exact (second_order.hpp).
//
//     auto effort = tenon::automatic_function<5, 1>([](const auto& z, auto& f) { f[0] = 20 * square(z[4]); });
//
// The functions see std::array<T, N> and write std::array<T, M>; what may stand in them says core/automatic.hpp.
#pragma once

#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "tenon/core/automatic.hpp"
#include "tenon/core/smooth_function.hpp"

namespace tenon {

template <int N, int M, class Functions>
class AutomaticFunction final : public SmoothFunction {
 public:
  AutomaticFunction(Functions functions, std::vector<std::string> names) : functions_(std::move(functions)), names_(std::move(names)) {}

  int num_arguments() const override { return N; }
  int num_values() const override { return M; }

  void values(ConstVectorRef z, VectorRef f) const override {
    std::array<double, std::size_t(N)> x;
    std::array<double, std::size_t(M)> y;
    std::copy_n(z.data(), N, x.begin());
    functions_(std::as_const(x), y);
    std::copy_n(y.begin(), M, f.data());
  }

  void jacobian(ConstVectorRef z, Matrix jacobian) const override {
    const auto derivatives = differentiated(z);
    for (int i = 0; i < N; ++i) {
      for (int j = 0; j < M; ++j) jacobian(j, i) = derivatives.jacobian(j, i);
    }
  }

  void hessian(ConstVectorRef z, ConstVectorRef weights, Matrix hessian) const override {
    const auto combined = differentiated(z).combine(weights.data());
    for (int j = 0; j < N; ++j) {
      for (int i = j; i < N; ++i) hessian(i, j) = SecondOrder<double, N>::hessian(combined, i, j);
    }
  }

  std::string value_name(int k) const override {
    return static_cast<std::size_t>(k) < names_.size() ? names_[static_cast<std::size_t>(k)] : SmoothFunction::value_name(k);
  }

 private:
  Derivatives<N, M> differentiated(ConstVectorRef z) const {
    Derivatives<N, M> derivatives;
    derivatives.evaluate(functions_, z.data());
    return derivatives;
  }

  Functions functions_;
  std::vector<std::string> names_;
};

/// N arguments, M values; `names` of the values, for messages.
template <int N, int M, class Functions>
std::shared_ptr<const SmoothFunction> automatic_function(Functions functions, std::vector<std::string> names = {}) {
  return std::make_shared<AutomaticFunction<N, M, Functions>>(std::move(functions), std::move(names));
}

}  // namespace tenon
