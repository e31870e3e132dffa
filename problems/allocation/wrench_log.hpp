// A log of wrenches to allocate: t or dt, Fx, Fy, Fz, Mx, My, Mz and, where present, qw, qx, qy, qz (body to world).
//
// With a quaternion the wrench is in world axes and is turned into the body:  W_body = [ R(q)' F ; R(q)' M ].
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tenon/problems/allocation/allocator.hpp"

namespace tenon {

struct WrenchRow {
  double t = 0;   // s
  double dt = 0;  // s since the row before, > 0; the first row has that of the second
  Wrench wrench;  // body axes
};

/// Reads a log. Throws InputError, with the line, where a column is missing or incomplete (some of the quaternion's, say), a number is not
/// finite, time does not advance, or a quaternion's length is not 1 to 1e-6 (within that it is brought to 1).
std::vector<WrenchRow> read_wrench_log(const std::string& file);

/// The same from text; `file` is the name used in messages.
std::vector<WrenchRow> parse_wrench_log(std::string_view text, const std::string& file);

}  // namespace tenon
