#include "tenon/apps/interrupt.hpp"

#include <csignal>

namespace tenon {

namespace {

volatile std::sig_atomic_t signal_seen = 0;

void note_signal(int) {
  signal_seen = 1;
}

}  // namespace

void watch_for_interrupts() {
  struct sigaction action {};
  action.sa_handler = note_signal;
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

bool interrupted() {
  return signal_seen != 0;
}

}  // namespace tenon
