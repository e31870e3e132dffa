#include "tenon/problems/delta/robot_file.hpp"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>

#include "tenon/core/named_file.hpp"
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
  return names_of(embedded_robots());
}

std::string describe_builtin_robot(const std::string& name) {
  return description_of(name, embedded_robots());
}

Robot load_robot(const std::string& name_or_path, const std::vector<std::string>& overrides) {
  const NamedFile file = open_named_file("robot", name_or_path, embedded_robots());
  return parse_robot(file.text, file.name, overrides);
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
