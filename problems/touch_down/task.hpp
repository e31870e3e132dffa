// The task `touch-down` from its file: keys as in scenes/delta-touch-down.toml.
#pragma once

#include "tenon/core/control_task.hpp"
#include "tenon/problems/toml/document.hpp"

namespace tenon::touch_down {

/// Throws InputError.
ControlTask make_task(const toml_file::Document& document);

}  // namespace tenon::touch_down
