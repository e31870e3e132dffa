// The only catch: whatever goes wrong becomes one line on stderr and an exit code.
#pragma once

#include <functional>

namespace tenon {

/// Watches for interrupts, runs, and sees that all of standard output got out. Returns the exit code.
int guarded_main(const std::function<int()>& run);

}  // namespace tenon
