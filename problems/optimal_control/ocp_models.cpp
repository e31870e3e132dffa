#include "tenon/problems/optimal_control/ocp_models.hpp"

#include <fmt/format.h>

#include <stdexcept>

namespace tenon {

const std::vector<OcpModel>& ocp_models() {
  static const std::vector<OcpModel> models{ball_catch_model(), cart_pole_model(), pendulum_model(), cartesian_pendulum_model(),
                                            push_and_slide_model()};
  return models;
}

void require_positive(const OcpModelInput& input, const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    if (!(input[name] > 0)) throw std::invalid_argument(fmt::format("{} is {} (expected more than 0)", name, input[name]));
  }
}

}  // namespace tenon
