// A task for a receding horizon, as a scene makes it: the world, what looks ahead in it, what estimates, and what to compare with.
//
// The parts know nothing of one another: the program and the estimator are built from what is believed, before any world is drawn.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tenon/core/controller.hpp"
#include "tenon/core/estimator.hpp"
#include "tenon/core/horizon_options.hpp"
#include "tenon/core/horizon_program.hpp"
#include "tenon/core/linear_mode.hpp"
#include "tenon/core/plant.hpp"
#include "tenon/core/scenery.hpp"

namespace tenon {

struct ControlTask {
  /// A law that takes the plant's measurements and gives its commands; or another program, to be held as the task's own is.
  struct Baseline {
    std::string name = {};
    std::unique_ptr<Controller> controller = {};
    std::unique_ptr<HorizonProgram> program = {};
    std::unique_ptr<Estimator> estimator = {};
  };

  /// What a task is to bear, of which one asks how much of it: an entry of the file's [parameters].
  struct Capture {
    std::string parameter;
    double largest = 0;  // to look for, in the parameter's unit
  };

  std::string name;
  double period = 0;    // s, of the controller
  double duration = 0;  // s, after which a run ends whatever came of it
  std::unique_ptr<Plant> plant;
  std::unique_ptr<HorizonProgram> program;
  std::unique_ptr<Estimator> estimator;  // null where the measurements say it all
  HorizonOptions options;                // how the program is solved, unless the caller says otherwise
  std::vector<Baseline> baselines;
  std::vector<LinearMode> modes;   // of the inner loop, for its margins of stability
  std::optional<Capture> capture;
  Scenery scenery;  // its picture, for the record
};

}  // namespace tenon
