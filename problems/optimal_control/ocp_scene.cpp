#include "tenon/problems/optimal_control/ocp_scene.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <stdexcept>

#include "tenon/core/named_file.hpp"
#include "tenon/core/nearest_name.hpp"
#include "tenon/problems/optimal_control/ocp_models.hpp"
#include "tenon/problems/toml/checked_keys.hpp"
#include "tenon/problems/toml/document.hpp"

namespace tenon {

std::vector<EmbeddedFile> embedded_ocp_scenes();  // generated from scenes/*.toml

namespace {

using toml_file::Table;

constexpr const char* kKind = "scene to plan";
const std::vector<std::string> kRootKeys{"name", "model", "contact", "parameters", "horizon"};
const std::vector<std::string> kHorizonKeys{"duration", "intervals", "points", "tolerance", "refinements"};

std::string one_of(const Table& table, const std::string& key, const std::string& fallback, const std::vector<std::string>& words) {
  const std::string word = table.text(key, fallback);
  if (std::ranges::count(words, word) > 0) return word;
  throw InputError(table.position(key), fmt::format("unknown {} '{}', the nearest is '{}'", key, word, nearest_name(word, words)),
                   fmt::format("one of {}", fmt::join(words, ", ")));
}

const OcpModel& read_model(const Table& root) {
  std::vector<std::string> names;
  for (const OcpModel& model : ocp_models()) names.push_back(model.name);
  const std::string name = one_of(root, "model", "", names);
  return ocp_models()[static_cast<std::size_t>(std::ranges::find(names, name) - names.begin())];
}

OcpModelInput read_input(const Table& root, const OcpModel& model) {
  OcpModelInput input;
  std::vector<std::string> names;
  for (const auto& [name, value] : model.parameters) names.push_back(name), input.parameters[name] = value;
  if (const auto parameters = root.table("parameters", names)) {
    for (const std::string& key : parameters->keys()) input.parameters[key] = parameters->number(key);
  }
  if (!model.contacts.empty())
    input.contact = one_of(root, "contact", model.contacts.front(), model.contacts);
  else if (root.has("contact"))
    throw InputError(root.position("contact"), "the model '" + model.name + "' leaves no choice of contact", "no such key");
  return input;
}

template <class Value>
Value within(const Table& table, const std::string& key, Value value, Value least, Value most) {
  if (value >= least && value <= most) return value;
  throw InputError(table.position(key), fmt::format("{} is {}", key, value), fmt::format("{} to {}", least, most));
}

OcpScene parse_ocp_scene(const NamedFile& file, const std::vector<std::string>& overrides) {
  const Table root = toml_file::Document(file.text, file.name, with_parameters(overrides, kRootKeys)).root(kRootKeys);
  const OcpModel& model = read_model(root);
  OcpModelInput input = read_input(root, model);
  input.duration = model.duration, input.intervals = model.intervals;
  const auto horizon = root.table("horizon", kHorizonKeys);
  if (horizon) {
    input.duration = within(*horizon, "duration", horizon->number("duration", input.duration), 1e-6, 1e6);
    input.intervals = within(*horizon, "intervals", horizon->integer("intervals", input.intervals), 1, 100'000);
  }
  OcpScene scene;
  try {
    scene = model.make(input);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(file.name + ": " + error.what());
  }
  scene.ocp.name = root.text("name", std::filesystem::path(file.name).stem().string());
  if (horizon) {
    scene.points = within(*horizon, "points", horizon->integer("points", scene.points), 1, 3);
    scene.tolerance = within(*horizon, "tolerance", horizon->number("tolerance", scene.tolerance), 1e-12, 1.0);
    scene.refinements = within(*horizon, "refinements", horizon->integer("refinements", scene.refinements), 0, 20);
  }
  return scene;
}

}  // namespace

std::vector<std::string> builtin_ocp_scenes() {
  return names_of(embedded_ocp_scenes());
}

std::string describe_builtin_ocp_scene(const std::string& name) {
  return description_of(name, embedded_ocp_scenes());
}

OcpScene load_ocp_scene(const std::string& name_or_path, const std::vector<std::string>& overrides) {
  return parse_ocp_scene(open_named_file(kKind, name_or_path, embedded_ocp_scenes()), overrides);
}

}  // namespace tenon
