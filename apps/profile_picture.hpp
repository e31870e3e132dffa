// Performance profiles as a picture: one panel each, side by side, as SVG.
#pragma once

#include <string>
#include <vector>

#include "tenon/apps/performance_profile.hpp"

namespace tenon {

struct ProfilePanel {
  std::string title;  // what the cost is
  PerformanceProfile profile;
};

/// The text of an SVG file. The panels share their solvers, so one legend does for all.
std::string profile_picture(const std::string& title, const std::vector<ProfilePanel>& panels);

}  // namespace tenon
