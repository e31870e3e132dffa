#include "tenon/problems/delta/scene_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>

#include "tenon/core/named_file.hpp"
#include "tenon/core/nearest_name.hpp"
#include "tenon/problems/delta/robot_file.hpp"
#include "tenon/problems/delta/robot_keys.hpp"
#include "tenon/problems/toml/checked_keys.hpp"
#include "tenon/problems/toml/document.hpp"

namespace tenon {

std::vector<EmbeddedFile> embedded_delta_scenes();  // generated from scenes/*.toml

namespace delta {

namespace {

using toml_file::Table;
using Words = std::vector<std::string>;

const Words kRootKeys{"name",    "robot",  "start", "reference", "controller", "contact",
                      "gripper", "object", "tool",  "push",      "simulation", "parameters"};
const Words kReferenceKeys{"kind", "centre", "radius", "frequency", "knot"};
const Words kControllerKeys{"mode",
                            "form",
                            "pole",
                            "kp",
                            "kd",
                            "ki",
                            "feed_forward",
                            "coriolis",
                            "damping",
                            "inertia",
                            "rate",
                            "delay",
                            "encoder_bits",
                            "filter",
                            "payload",
                            "stiffness",
                            "impedance_damping",
                            "tool_pole",
                            "tool_stiffness",
                            "tool_damping",
                            "integral_limit",
                            "tactile_gain",
                            "tactile_limit",
                            "tactile_axis"};

/// A section whose keys may stand in [parameters] instead, which then count.
class Section {
 public:
  Section(const Table& root, const std::string& name, const Words& known)
      : section_(root.table(name, known)), parameters_(root.table("parameters")) {}

  const Table* find(const std::string& key) const {
    for (const std::optional<Table>* table : {&parameters_, &section_}) {
      if (*table && (*table)->has(key)) return &**table;
    }
    return nullptr;
  }
  double number(const std::string& key, double fallback) const { return find(key) ? find(key)->number(key) : fallback; }
  int integer(const std::string& key, int fallback) const { return find(key) ? find(key)->integer(key) : fallback; }
  bool flag(const std::string& key, bool fallback) const { return find(key) ? find(key)->flag(key) : fallback; }
  Vector3 vector3(const std::string& key, const Vector3& fallback) const { return find(key) ? find(key)->vector3(key) : fallback; }
  /// A number more than 0.
  double positive(const std::string& key, double fallback) const {
    const double value = number(key, fallback);
    if (!(value > 0)) throw InputError(find(key)->position(key), fmt::format("{} is {}", key, value), "more than 0");
    return value;
  }
  int not_negative(const std::string& key, int fallback) const {
    const int value = integer(key, fallback);
    if (value < 0) throw InputError(find(key)->position(key), fmt::format("{} is {}", key, value), "0 or more");
    return value;
  }
  /// The place of one of these words in their list.
  std::size_t choice(const std::string& key, const Words& words, std::size_t fallback) const {
    const Table* const table = find(key);
    if (!table) return fallback;
    const std::string word = table->text(key);
    const auto found = std::ranges::find(words, word);
    if (found == words.end()) {
      throw InputError(table->position(key), fmt::format("{} is '{}', the nearest is '{}'", key, word, nearest_name(word, words)),
                       fmt::format("one of {}", fmt::join(words, ", ")));
    }
    return static_cast<std::size_t>(found - words.begin());
  }
  const std::optional<Table>& table() const { return section_; }

 private:
  std::optional<Table> section_, parameters_;
};

Robot read_robot(const Table& root) {
  Words known{"model"};
  for (const RobotKey& key : kRobotKeys) known.emplace_back(key.name);
  for (const RobotVectorKey& key : kRobotVectorKeys) known.emplace_back(key.name);
  const auto table = root.table("robot", known);
  Robot robot = load_robot(table ? table->text("model", "delta") : "delta");
  if (!table) return robot;
  for (const RobotKey& key : kRobotKeys) robot.*key.field = table->number(key.name, robot.*key.field);
  for (const RobotVectorKey& key : kRobotVectorKeys) robot.*key.field = table->vector3(key.name, robot.*key.field);
  const RobotFault fault = find_fault(robot);
  if (!fault.key.empty()) throw InputError(table->position(fault.key), fault.found, fault.expected);
  return robot;
}

ReferencePath read_reference(const Table& root, const Robot& robot) {
  const Section section(root, "reference", kReferenceKeys);
  ReferencePath path;
  path.kind = static_cast<ReferencePath::Kind>(section.choice("kind", {"hold", "circle", "knots"}, 0));
  path.centre = section.vector3("centre", path.centre);
  path.radius = section.number("radius", 0);
  path.frequency = section.number("frequency", 0);
  const auto check = [&](const Vector3& point, const InputPosition& position) {
    if (inverse_kinematics(robot, point).ok()) return;
    throw InputError(position,
                     fmt::format("the reference ({:.6g}, {:.6g}, {:.6g}) is out of reach, {:.6g} m from the workspace", point[0], point[1],
                                 point[2], distance_to_workspace(robot, point)),
                     "a point that all arms reach");
  };
  if (section.table()) {
    for (const Table& knot : section.table()->tables("knot", {"t", "position"})) {
      path.knots.push_back({knot.number("t"), knot.vector3("position")});
      check(path.knots.back().position, knot.position("position"));
      if (path.knots.size() > 1 && !(path.knots.end()[-2].t < path.knots.back().t)) {
        throw InputError(knot.position("t"), fmt::format("t is {} s", path.knots.back().t), "more than the knot before");
      }
    }
  }
  const InputPosition position = section.table() ? section.table()->position("centre") : root.position();
  if (path.kind == ReferencePath::Kind::knots) {
    if (path.knots.size() < 2) throw InputError(position, fmt::format("there are {} knots", path.knots.size()), "2 or more");
  } else {
    constexpr int kSamples = 64;
    for (int k = 0; k < kSamples; ++k) check(path.at(path.frequency == 0 ? 0 : k / (kSamples * path.frequency)).position, position);
  }
  return path;
}

void read_controller(const Table& root, Scene& scene) {
  const Section section(root, "controller", kControllerKeys);
  ControllerOptions& options = scene.controller;
  LawOptions& law = options.law;
  scene.control = static_cast<ControlMode>(section.choice("mode", {"none", "continuous", "sampled"}, 0));
  law.form = static_cast<LawForm>(section.choice("form", {"linearising", "impedance"}, 0));
  law.inertia = static_cast<ReducedInertia>(section.choice("inertia", {"exact", "projected-left"}, 0));
  if (section.find("pole")) law.gains = place_poles(section.positive("pole", 0));
  law.gains.proportional = section.number("kp", law.gains.proportional);
  law.gains.derivative = section.number("kd", law.gains.derivative);
  law.gains.integral = section.number("ki", law.gains.integral);
  law.feed_forward = section.flag("feed_forward", law.feed_forward);
  law.coriolis = section.flag("coriolis", law.coriolis);
  law.damping = section.flag("damping", law.coriolis);
  law.stiffness = section.vector3("stiffness", law.stiffness);
  law.impedance_damping = section.vector3("impedance_damping", law.impedance_damping);
  law.tool_pole = section.positive("tool_pole", law.tool_pole);
  law.tool_stiffness = section.vector3("tool_stiffness", law.tool_stiffness);
  law.tool_damping = section.vector3("tool_damping", law.tool_damping);
  options.period = 1 / section.positive("rate", 1 / options.period);
  options.integral_limit = section.number("integral_limit", options.integral_limit);
  options.filter_frequency = section.number("filter", 0);
  options.tactile_gain = section.number("tactile_gain", 0);
  options.tactile_limit = section.number("tactile_limit", options.tactile_limit);
  options.tactile_axis = section.vector3("tactile_axis", options.tactile_axis);
  scene.delay = section.not_negative("delay", 0);
  scene.encoder_bits = section.not_negative("encoder_bits", 0);
  scene.controller_payload = section.number("payload", scene.robot.payload);
  if (scene.controller_payload < 0) {
    throw InputError(section.find("payload")->position("payload"), fmt::format("payload is {} kg", scene.controller_payload), "0 or more");
  }
  if (scene.control != ControlMode::sampled) {
    for (const char* key : {"rate", "delay", "encoder_bits", "filter", "tactile_gain", "tactile_limit", "tactile_axis"}) {
      if (section.find(key))
        throw InputError(section.find(key)->position(key), fmt::format("{} belongs to a sampled controller", key), "mode = \"sampled\"");
    }
  }
  try {
    validate(options);
  } catch (const std::invalid_argument& error) {
    throw InputError(section.table() ? section.table()->position() : root.position(), error.what());
  }
}

Contact read_contact(const Table& table) {
  Contact contact;
  contact.name = table.text("name");
  contact.normal = table.vector3("normal");
  if (contact.normal.norm() == 0) throw InputError(table.position("normal"), "normal is zero", "a direction");
  contact.normal.normalize();
  contact.offset = table.number("offset");
  contact.stiffness = table.number("stiffness", contact.stiffness);
  contact.damping = table.number("damping", contact.damping);
  if (!(contact.stiffness > 0))
    throw InputError(table.position("stiffness"), fmt::format("stiffness is {} N/m", contact.stiffness), "more than 0");
  if (!(contact.damping >= 0))
    throw InputError(table.position("damping"), fmt::format("damping is {} N s/m", contact.damping), "0 or more");
  contact.is_finger = table.flag("finger", false);
  const std::string sensor = table.text("sensor", "");
  if (!sensor.empty() && sensor != "left" && sensor != "right") {
    throw InputError(table.position("sensor"), "sensor is '" + sensor + "'", "left or right");
  }
  contact.sensor = sensor == "left" ? 1 : sensor == "right" ? -1 : 0;
  return contact;
}

void read_surroundings(const Table& root, Scene& scene) {
  for (const Table& table : root.tables("contact", {"name", "normal", "offset", "stiffness", "damping", "finger", "sensor"})) {
    scene.contacts.push_back(read_contact(table));
  }
  if (const auto table = root.table("gripper", {"from", "to", "begin", "end"})) {
    scene.gripper = {table->number("from"), table->number("to"), table->number("begin"), table->number("end")};
  }
  if (const auto table = root.table("object", {"mass", "position", "stiffness", "damping"})) {
    scene.object = {table->number("mass"), table->number("position"), table->number("stiffness", 0), table->number("damping", 0)};
    if (!(scene.object.mass > 0)) throw InputError(table->position("mass"), fmt::format("mass is {} kg", scene.object.mass), "more than 0");
  }
  if (const auto table = root.table("push", {"constant", "amplitude", "from", "to", "duration", "on"})) {
    scene.push = {table->vector3("constant", Vector3::Zero()),
                  table->vector3("amplitude", Vector3::Zero()),
                  table->number("from", 1),
                  table->number("to", table->number("from", 1)),
                  table->number("duration", 1),
                  table->text("on", "wrist") == "object"};
    if (scene.push.on_object && scene.object.mass == 0)
      throw InputError(table->position("on"), "there is no object", "an [object], or on = \"wrist\"");
    if (!(scene.push.from > 0 && scene.push.to > 0))
      throw InputError(table->position("from"), "a frequency is not positive", "more than 0 Hz");
  }
  if (const auto table = root.table("tool", {"angle", "reference"})) {
    if (!(scene.robot.gimbal_inertia.array() > 0).all())
      throw InputError(table->position(), "the robot has no gimbals", "gimbal_inertia above 0");
    scene.has_tool = true;
    scene.tool_angle = table->vector3("angle", Vector3::Zero());
    scene.tool_reference = table->vector3("reference", Vector3::Zero());
  }
}

void read_start(const Table& root, Scene& scene) {
  const Reference begin = scene.reference.at(0);
  scene.position = begin.position;
  scene.velocity = begin.velocity;
  if (const auto table = root.table("start", {"position", "velocity"})) {
    scene.position = table->vector3("position", scene.position);
    scene.velocity = table->vector3("velocity", Vector3::Zero());
    if (!inverse_kinematics(scene.robot, scene.position).ok()) {
      throw InputError(
          table->position("position"),
          fmt::format("the wrist starts out of reach, {:.6g} m from the workspace", distance_to_workspace(scene.robot, scene.position)),
          "a point that all arms reach");
    }
  }
}

}  // namespace

Scene parse_scene(const std::string& text, const std::string& file, const std::vector<std::string>& overrides) {
  const Table root = toml_file::Document(text, file, with_parameters(overrides, kRootKeys)).root(kRootKeys);
  Words variable = kControllerKeys;
  variable.insert(variable.end(), kReferenceKeys.begin(), kReferenceKeys.end());
  root.table("parameters", variable);  // refuses a key that nothing reads
  Scene scene;
  scene.name = root.text("name", std::filesystem::path(file).stem().string());
  scene.robot = read_robot(root);
  scene.reference = read_reference(root, scene.robot);
  read_controller(root, scene);
  read_surroundings(root, scene);
  read_start(root, scene);
  if (const auto table = root.table("simulation", {"duration", "rtol", "output_step"})) {
    scene.duration = table->number("duration", scene.duration);
    scene.rtol = table->number("rtol", scene.rtol);
    scene.output_step = table->number("output_step", scene.output_step);
    if (!(scene.duration > 0))
      throw InputError(table->position("duration"), fmt::format("duration is {} s", scene.duration), "more than 0");
    if (!(scene.rtol > 0)) throw InputError(table->position("rtol"), fmt::format("rtol is {}", scene.rtol), "more than 0");
    if (!(scene.output_step > 0))
      throw InputError(table->position("output_step"), fmt::format("output_step is {} s", scene.output_step), "more than 0");
  }
  return scene;
}

std::vector<std::string> builtin_scenes() {
  return names_of(embedded_delta_scenes());
}

std::string describe_builtin_scene(const std::string& name) {
  return description_of(name, embedded_delta_scenes());
}

bool has_delta_robot(const std::string& name_or_path) {
  if (std::ranges::count(builtin_scenes(), name_or_path) > 0) return true;
  if (!std::filesystem::is_regular_file(name_or_path)) return false;
  return toml_file::Document::read(name_or_path).root({}).has("robot");
}

Scene load_scene(const std::string& name_or_path, const std::vector<std::string>& overrides) {
  const NamedFile file = open_named_file("scene", name_or_path, embedded_delta_scenes());
  return parse_scene(file.text, file.name, overrides);
}

}  // namespace delta
}  // namespace tenon
