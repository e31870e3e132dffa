// Tasks by name or file: what `tenon mpc SCENE` runs, a receding horizon or a scripted experiment.
//
//     task = "soft-walls" | "pushed-block" | ...     which reader takes the file; its keys stand at the scenes that come with tenon
//
// To add a kind: write its `make_task(document)` beside its problem and give it a line in tasks.cpp.
#pragma once

#include <string>
#include <vector>

#include "tenon/core/control_task.hpp"

namespace tenon {

/// The names of the tasks that come with tenon, sorted.
std::vector<std::string> builtin_tasks();
/// What a built-in task is, from the comment that opens its file.
std::string describe_builtin_task(const std::string& name);

/// Whether the name is that of a built-in task, or of a file with a key `task`.
bool is_task(const std::string& name_or_path);

/// A built-in task, or one from a file, with overrides `key.path=value`, or NAME=VALUE for one of its [parameters]. Throws InputError, with
/// the place of what is wrong; std::invalid_argument for a name that is neither, the nearest named.
ControlTask make_task(const std::string& name_or_path, const std::vector<std::string>& overrides = {});

}  // namespace tenon
