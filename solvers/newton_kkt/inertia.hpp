// Inertia of a symmetric matrix: how many eigenvalues are positive, negative, zero. By Sylvester's law those of D in K = L D L'.
#pragma once

namespace tenon {

struct Inertia {
  int positive = 0;
  int negative = 0;
  int zero = 0;

  bool operator==(const Inertia&) const = default;
};

}  // namespace tenon
