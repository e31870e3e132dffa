// The whole grammar of a .nl file, checked before the solver library sees it: that library trusts what it reads.
//
//     head, then segments in any order but k before J:  b r k x d  (bounds, rows, column counts, start, multipliers)
//                                                       C O V  (expressions)   J G  (linear terms)   S  (suffixes)
//
// What passes is safe to hand over: every count agrees with the head, every index is in range, every row, bound, objective
// and common expression is there, none twice, and each row's linear part has a place for every variable of its expression.
#pragma once

#include <string>
#include <string_view>

#include "tenon/problems/nl/nl_header.hpp"

namespace tenon {

/// A bound as large as this is none, as all solvers of .nl files have it.
inline constexpr double kNlNoBound = 1e19;

struct NlScan {
  NlHeader header;
  std::string bytes;  // for the library: those of the file, but for what nl_expression.hpp says of lone choices
};

/// Throws InputError at the first thing that is wrong, with its place; `file` is the name used in messages.
NlScan scan_nl(std::string_view bytes, const std::string& file);

}  // namespace tenon
