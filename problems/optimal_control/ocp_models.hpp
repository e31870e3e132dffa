// The models that scenes to be planned can have, by name.
//
// To add one: write its equations (core/automatic_dae.hpp) and its Ocp in one .cpp, and give it a line in ocp_models.cpp.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "tenon/problems/optimal_control/ocp_scene.hpp"

namespace tenon {

/// What a scene file says of its model.
struct OcpModelInput {
  std::map<std::string, double> parameters;  // all that the model knows: from the file, else its default
  std::string contact;                       // one of its contacts, else empty
  double duration = 0;                       // s
  int intervals = 0;

  double operator[](const std::string& name) const { return parameters.at(name); }
};

struct OcpModel {
  std::string name;
  std::vector<std::pair<std::string, double>> parameters;  // with their defaults
  std::vector<std::string> contacts;                       // the first is the default; empty where there is no choice
  double duration;                                         // s, default
  int intervals;                                           // default
  OcpScene (*make)(const OcpModelInput& input);            // throws std::invalid_argument where numbers make no sense
};

const std::vector<OcpModel>& ocp_models();

OcpModel cart_pole_model();  // pole_swing_up.cpp
OcpModel pendulum_model();
OcpModel cartesian_pendulum_model();  // cartesian_pendulum.cpp
OcpModel ball_catch_model();          // ball_catch.cpp
OcpModel push_and_slide_model();      // push_and_slide.cpp

/// Throws std::invalid_argument unless the parameter is more than 0.
void require_positive(const OcpModelInput& input, const std::vector<std::string>& names);

}  // namespace tenon
