// What is wrong with a vehicle, and at which rotor and key, so that a reader of files can say where that stands.
#pragma once

#include <stdexcept>
#include <string>

namespace tenon {

class VehicleError : public std::invalid_argument {
 public:
  /// `rotor` from 0, -1 for the vehicle itself; `key` as in its TOML.
  VehicleError(int rotor, std::string key, const std::string& found, const std::string& expected)
      : std::invalid_argument(prefix(rotor) + found + " (expected " + expected + ")"),
        rotor_(rotor),
        key_(std::move(key)),
        found_(prefix(rotor) + found),
        expected_(expected) {}

  int rotor() const { return rotor_; }
  const std::string& key() const { return key_; }
  const std::string& found() const { return found_; }
  const std::string& expected() const { return expected_; }

 private:
  static std::string prefix(int rotor) { return rotor < 0 ? "" : "rotor " + std::to_string(rotor + 1) + ": "; }

  int rotor_;
  std::string key_, found_, expected_;
};

}  // namespace tenon
