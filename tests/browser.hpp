// A real browser without a window, driven over a pipe in the DevTools protocol: JSON messages, each ended by a NUL.
#pragma once

#include <sys/types.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tenon/tests/scratch_folder.hpp"

namespace tenon {

/// Where chromium is; empty where there is none.
std::string browser_path();

class Browser {
 public:
  /// Starts it. Throws std::runtime_error, as all else here does, where it does not answer.
  Browser();
  ~Browser();
  Browser(const Browser&) = delete;
  Browser& operator=(const Browser&) = delete;

  /// Opens a file in a page of its own, in place of the one before, and waits until `condition`, a JavaScript expression, holds.
  void open(const std::string& file, const std::string& condition, int width = 1280, int height = 900);
  /// The value of a JavaScript expression (of a promise: what it comes to). Throws std::runtime_error with the page's message where it throws.
  nlohmann::json evaluate(const std::string& expression);
  /// Waits until an expression holds; false after 20 s.
  bool wait_for(const std::string& condition);

  /// Since the last open(): uncaught errors and what was logged as an error or a warning; and every address asked for, the file itself first.
  const std::vector<std::string>& complaints() const { return complaints_; }
  const std::vector<std::string>& requests() const { return requests_; }

 private:
  nlohmann::json call(const std::string& method, const nlohmann::json& parameters);
  nlohmann::json receive();
  void note(const nlohmann::json& event);

  ScratchFolder profile_;
  pid_t process_ = -1;
  int to_browser_ = -1, from_browser_ = -1, last_id_ = 0;
  std::string target_, session_, received_;
  std::vector<std::string> complaints_, requests_;
};

}  // namespace tenon
