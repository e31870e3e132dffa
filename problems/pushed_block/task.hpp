// A finger pushes a block that nobody measures: the experiment from its file, and what is to be estimated from its record.
#pragma once

#include "tenon/core/control_task.hpp"
#include "tenon/problems/toml/document.hpp"

namespace tenon::pushed_block {

/// Throws InputError.
ControlTask make_task(const toml_file::Document& document);

}  // namespace tenon::pushed_block
