// A task as a scene makes it: the world, what looks ahead in it, what estimates, and what to compare with.
//
// The parts know nothing of one another: the program and the estimator are built from what is believed, before any world is drawn.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tenon/core/controller.hpp"
#include "tenon/core/estimation_problem.hpp"
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

  /// A surprise of which a task bears some: worlds with so much of it, all else drawn as ever.
  struct Capture {
    std::string quantity;  // with its unit
    double largest = 0;    // to look for
    std::function<std::unique_ptr<Plant>(double amount)> plant;
  };

  std::string name;
  double period = 0;    // s, of the controller
  double duration = 0;  // s, after which a run ends whatever came of it
  std::unique_ptr<Plant> plant;
  std::unique_ptr<HorizonProgram> program;        // null where the commands are a script: then the first baseline
  std::function<std::unique_ptr<HorizonProgram>()> whole_program;  // from the start to the end, the scene's own world known: one plan
  std::unique_ptr<Estimator> estimator;           // null where the measurements say it all, or `estimation` stands for it
  std::unique_ptr<EstimationProblem> estimation;  // to be looked back over by a moving horizon
  HorizonOptions options;                         // how the program is solved, unless the caller says otherwise
  std::vector<Baseline> baselines;
  std::vector<LinearMode> modes;                  // of the inner loop, for its margins of stability
  std::optional<Capture> capture;
  Scenery scenery;  // its picture, for the record
};

}  // namespace tenon
