// A progress bar on stderr, with the time left: only where stderr is a terminal and the job lasts over a second.
#pragma once

#include <chrono>
#include <string>

namespace tenon {

class Progress {
 public:
  /// `total` > 0 steps; a quiet one shows nothing.
  Progress(std::string what, long total, bool quiet);
  /// Wipes the bar.
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void update(long done) {
    if (visible_) show(done);
  }

 private:
  void show(long done);

  std::string what_;
  long total_;
  bool visible_, drawn_ = false;
  std::chrono::steady_clock::time_point start_, last_;
};

}  // namespace tenon
