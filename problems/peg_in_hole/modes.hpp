// The modes of a peg in its hole, each linear about a pose of it: in the air, one corner on the flat, the chamfer or the wall, and wedged
// between a wall and the edge across.
//
//     M q'' + D_c q' + K_c q = -K q - D q',     K_c = sum k n n',  D_c = sum d n n'        over the contacts of the mode, n = grad h
//
// In SI: q = (x, z, theta), n = (n_x, n_z, lever n_phi).
#pragma once

#include <vector>

#include "tenon/core/linear_mode.hpp"
#include "tenon/problems/peg_in_hole/impedance.hpp"
#include "tenon/problems/peg_in_hole/plant.hpp"

namespace tenon::peg {

/// Of this world under this impedance, sampled with the period and late by the delay (s).
std::vector<LinearMode> linear_modes(const World& world, const Impedance& impedance, double period, double delay);

}  // namespace tenon::peg
