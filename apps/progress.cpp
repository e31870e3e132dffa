#include "tenon/apps/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>

namespace tenon {

namespace {

constexpr double kFirstShown = 1.0;  // s after the start
constexpr double kInterval = 0.1;    // s between two pictures
constexpr int kWidth = 30;

/// "42 s", "3:20 min", "1:05 h".
std::string time_left(double seconds) {
  const long whole = std::lround(seconds);
  if (whole < 100) return fmt::format("{} s", whole);
  if (whole < 6000) return fmt::format("{}:{:02} min", whole / 60, whole % 60);
  return fmt::format("{}:{:02} h", whole / 3600, whole / 60 % 60);
}

}  // namespace

Progress::Progress(std::string what, long total, bool quiet)
    : what_(std::move(what)), total_(std::max(1L, total)), visible_(!quiet && isatty(STDERR_FILENO) != 0) {
  start_ = last_ = std::chrono::steady_clock::now();
}

Progress::~Progress() {
  if (drawn_) fmt::print(stderr, "\r\x1b[K");
}

void Progress::show(long done) {
  const auto now = std::chrono::steady_clock::now();
  const double elapsed = std::chrono::duration<double>(now - start_).count();
  if (elapsed < kFirstShown || std::chrono::duration<double>(now - last_).count() < kInterval) return;
  last_ = now;
  drawn_ = true;
  const double share = std::min(1.0, static_cast<double>(done) / static_cast<double>(total_));
  const int filled = static_cast<int>(share * kWidth);
  const double left = done > 0 ? elapsed * (1 - share) / share : 0;
  fmt::print(stderr, "\r{} [{:=<{}}{:<{}}] {:3.0f} %, {} left\x1b[K", what_, "", filled, "", kWidth - filled, 100 * share, time_left(left));
}

}  // namespace tenon
