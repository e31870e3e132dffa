// tenon compare VEHICLE --rows N --seed S: random rows of an allocation on every back end.
#include <stdexcept>

#include "tenon/apps/compare.hpp"

namespace tenon {

int compare_vehicle(const std::string& vehicle, const Arguments&) {
  throw std::invalid_argument("compare: '" + vehicle +
                              "' is a vehicle, whose rows cannot be compared yet (expected a problem of `tenon list problems`)");
}

}  // namespace tenon
