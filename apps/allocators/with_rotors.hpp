// From a number of rotors known at run time to one known at compile time.
#pragma once

#include <type_traits>
#include <utility>

#include "tenon/problems/allocation/vehicle.hpp"

namespace tenon {

/// f(std::integral_constant<int, N>) for the N that is asked for.
template <int N = kMinRotors, class Function>
auto with_rotors(int rotors, Function&& f) {
  if constexpr (N < kMaxRotors) {
    if (rotors != N) return with_rotors<N + 1>(rotors, std::forward<Function>(f));
  }
  return f(std::integral_constant<int, N>());
}

}  // namespace tenon
