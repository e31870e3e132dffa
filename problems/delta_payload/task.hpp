// The delta carries something of unknown mass: the experiment from its file, and what is to be estimated from its record.
#pragma once

#include "tenon/core/control_task.hpp"
#include "tenon/problems/toml/document.hpp"

namespace tenon::delta_payload {

/// Throws InputError.
ControlTask make_task(const toml_file::Document& document);

}  // namespace tenon::delta_payload
