// The task `soft-walls` from its file: keys as in scenes/cart-pole-soft-walls.toml.
#pragma once

#include "tenon/core/control_task.hpp"
#include "tenon/problems/toml/document.hpp"

namespace tenon::soft_walls {

/// Throws InputError.
ControlTask make_task(const toml_file::Document& document);

}  // namespace tenon::soft_walls
