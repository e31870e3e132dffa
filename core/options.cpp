#include "tenon/core/options.hpp"

#include <stdexcept>
#include <string>

namespace tenon {

void validate(const Options& options) {
  if (!(options.tolerance > 0) || !(options.tolerance < 1)) {
    throw std::invalid_argument("option tolerance is " + std::to_string(options.tolerance) + " (expected a number in (0, 1))");
  }
  if (options.max_iterations < 0) {
    throw std::invalid_argument("option max_iterations is " + std::to_string(options.max_iterations) + " (expected 0 or more)");
  }
  if (!(options.initial_mu >= 0)) {
    throw std::invalid_argument("option initial_mu is " + std::to_string(options.initial_mu) + " (expected 0 or more)");
  }
  if (!(options.time_limit >= 0)) {
    throw std::invalid_argument("option time_limit is " + std::to_string(options.time_limit) + " s (expected 0 or more)");
  }
}

}  // namespace tenon
