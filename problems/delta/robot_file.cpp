#include "tenon/problems/delta/robot_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "tenon/core/embedded_file.hpp"
#include "tenon/core/nearest_name.hpp"
#include "tenon/core/read_file.hpp"
#include "tenon/problems/delta/robot_keys.hpp"
#include "tenon/problems/toml/document.hpp"

namespace tenon {

std::vector<EmbeddedFile> embedded_robots();  // generated from robots/*.toml

namespace delta {

using toml_file::Table;

Robot parse_robot(const std::string& text, const std::string& file, const std::vector<std::string>& overrides) {
  std::vector<std::string> known{"name"};
  for (const RobotKey& key : kRobotKeys) known.emplace_back(key.name);
  for (const RobotVectorKey& key : kRobotVectorKeys) known.emplace_back(key.name);
  const Table root = toml_file::Document(text, file, overrides).root(known);
  Robot robot;
  robot.name = root.text("name", std::filesystem::path(file).stem().string());
  for (const RobotKey& key : kRobotKeys) {
    robot.*key.field = key.required ? root.number(key.name) : root.number(key.name, robot.*key.field);
  }
  for (const RobotVectorKey& key : kRobotVectorKeys) robot.*key.field = root.vector3(key.name, robot.*key.field);
  const RobotFault fault = find_fault(robot);
  if (!fault.key.empty()) throw InputError(root.position(fault.key), fault.found, fault.expected);
  return robot;
}

std::vector<std::string> builtin_robots() {
  std::vector<std::string> names;
  for (const EmbeddedFile& file : embedded_robots()) names.emplace_back(file.name);
  std::sort(names.begin(), names.end());
  return names;
}

std::string describe_builtin_robot(const std::string& name) {
  for (const EmbeddedFile& file : embedded_robots()) {
    if (file.name == name) return std::string(file.text.substr(2, file.text.find('\n') - 2));
  }
  return "";
}

Robot load_robot(const std::string& name_or_path, const std::vector<std::string>& overrides) {
  for (const EmbeddedFile& file : embedded_robots()) {
    if (file.name == name_or_path) return parse_robot(std::string(file.text), name_or_path, overrides);
  }
  const bool is_path =
      name_or_path.find('/') != std::string::npos || name_or_path.ends_with(".toml") || std::filesystem::exists(name_or_path);
  if (!is_path) {
    throw std::invalid_argument(fmt::format("unknown robot '{}', the nearest is '{}' (expected one of {}, or a TOML file)", name_or_path,
                                            nearest_name(name_or_path, builtin_robots()), fmt::join(builtin_robots(), ", ")));
  }
  return parse_robot(read_file(name_or_path), name_or_path, overrides);
}

std::string to_toml(const Robot& robot) {
  std::string text = fmt::format("name = \"{}\"\n", robot.name);
  for (const RobotKey& key : kRobotKeys) {
    if (std::isfinite(robot.*key.field)) text += fmt::format("{} = {}\n", key.name, robot.*key.field);
  }
  for (const RobotVectorKey& key : kRobotVectorKeys) {
    const Eigen::Vector3d& v = robot.*key.field;
    text += fmt::format("{} = [{}, {}, {}]\n", key.name, v[0], v[1], v[2]);
  }
  return text;
}

}  // namespace delta
}  // namespace tenon
