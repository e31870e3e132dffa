// The task `peg-in-hole` from its file: keys as in scenes/peg-in-hole.toml.
#pragma once

#include "tenon/core/control_task.hpp"
#include "tenon/problems/toml/document.hpp"

namespace tenon::peg {

/// Program, estimator and baselines are built from what is believed; only the plant knows the true hole, once it has drawn it.
/// Throws InputError.
ControlTask make_task(const toml_file::Document& document);

}  // namespace tenon::peg
