// A selection from the collection of W. Hock and K. Schittkowski, Test Examples for Nonlinear Programming Codes (Springer, 1981): small
// dense problems with published starting points and optima. See hock_schittkowski.md.
#pragma once

#include <vector>

#include "tenon/problems/catalogue.hpp"

namespace tenon {

/// The problems by their number in the collection, `hs035` for number 35, ascending.
std::vector<CatalogueEntry> hock_schittkowski();

}  // namespace tenon
