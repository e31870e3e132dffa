// Why a solve did not end at a solution, in words that name rows and variables. Every back end's end can be asked about; a cold path.
#pragma once

#include <string>
#include <vector>

#include "tenon/core/conflict.hpp"
#include "tenon/core/point.hpp"
#include "tenon/core/result.hpp"

namespace tenon {

struct Explanation {
  std::vector<std::string> sentences;  // most telling first; none for a solved problem
  std::vector<Limit> conflict;         // of an infeasible end: what cannot be met together; where that is not found, what is violated

  /// The sentences, one a line.
  std::string text() const;
};

/// What can be seen at the point where a solve of `problem` ended with `result`, in this order: what is not finite there; which derivatives
/// disagree with differences (problems of up to 200 variables); what runs away; which row, variable and complementarity are worst, and
/// what is active there; which rows and bounds contradict one another; which rows depend on others.
/// Throws std::invalid_argument where the point has the wrong sizes. Allocates; costs about a factorisation, and 2 n evaluations.
Explanation explain(const Nlp& problem, const Point& point, const Result& result);

}  // namespace tenon
