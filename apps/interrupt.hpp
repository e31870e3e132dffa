// Ctrl-C and SIGTERM as a flag that loops look at: the job stops at its next row or iteration, with its record so far in order.
#pragma once

namespace tenon {

/// From now on the first of these signals sets the flag; the second ends the program as it always would.
void watch_for_interrupts();
bool interrupted();

}  // namespace tenon
