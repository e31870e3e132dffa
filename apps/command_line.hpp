// The command line, read: which verb, with which arguments.
#pragma once

#include <optional>

#include "tenon/apps/verb.hpp"

namespace tenon {

struct Invocation {
  const Verb* verb = nullptr;
  Arguments arguments;
};

/// Nothing where help or the version was asked for, which is then printed. Throws std::invalid_argument where a verb or flag is not known
/// (the nearest is named) or a value makes no sense.
std::optional<Invocation> read_command_line(int argc, char** argv);

}  // namespace tenon
