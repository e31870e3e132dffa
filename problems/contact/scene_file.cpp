#include "tenon/problems/contact/scene_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>

#include "tenon/core/embedded_file.hpp"
#include "tenon/core/nearest_name.hpp"
#include "tenon/core/read_file.hpp"
#include "tenon/problems/contact/scene_reader.hpp"
#include "tenon/problems/contact/scene_scenery.hpp"
#include "tenon/problems/toml/checked_keys.hpp"

namespace tenon {

std::vector<EmbeddedFile> embedded_scenes();  // generated from scenes/*.toml

namespace contact {

namespace {

using toml_file::Table;

const std::vector<std::string> kRootKeys{"name", "parameters", "simulation", "body", "shape", "joint", "contact", "force"};

/// A parameter that the file does not have is a mistake, not a new one.
void check_parameters(const std::string& text, const std::string& file, const std::vector<std::string>& overrides) {
  const auto known = toml_file::Document(text, file).root(kRootKeys).table("parameters");
  const std::vector<std::string> names = known ? known->keys() : std::vector<std::string>{};
  for (const std::string& entry : overrides) {
    const std::string key = entry.substr(0, entry.find('='));
    if (key.empty() || key.find('.') != std::string::npos || std::count(names.begin(), names.end(), key) > 0) continue;
    throw InputError({"--set " + entry, 0, 0},
                     names.empty() ? "the scene has no parameters"
                                   : fmt::format("unknown parameter '{}', the nearest is '{}'", key, nearest_name(key, names)),
                     names.empty() ? "key.path=value" : fmt::format("one of {}, or key.path=value", fmt::join(names, ", ")));
  }
}

double positive(const SceneValues& values, const Table& table, const std::string& key, double fallback) {
  const double value = values.number(table, key, fallback);
  if (!(value > 0)) throw InputError(table.position(key), fmt::format("'{}' is {}", key, value), "a number above 0");
  return value;
}

}  // namespace

SceneFile parse_scene(const std::string& text, const std::string& file, const std::vector<std::string>& overrides) {
  check_parameters(text, file, overrides);
  const Table root = toml_file::Document(text, file, with_parameters(overrides)).root(kRootKeys);
  const SceneValues values(root);
  SceneFile out;
  std::string space = "planar";
  if (const auto simulation = root.table("simulation")) {
    space = simulation->text("space", space);
    if (space != "planar" && space != "spatial")
      throw InputError(simulation->position("space"), "unknown space '" + space + "'", "planar or spatial");
    SimulationSettings& s = out.simulation;
    s.duration = positive(values, *simulation, "duration", s.duration);
    s.output_step = positive(values, *simulation, "output_step", s.output_step);
    s.rtol = positive(values, *simulation, "rtol", s.rtol);
    s.atol = positive(values, *simulation, "atol", 1e-2 * s.rtol);
    s.integrator = simulation->text("integrator", s.integrator);
  }
  const auto read = [&](auto reader) {
    auto scene = reader.read();
    scene.name = root.text("name", std::filesystem::path(file).stem().string());
    out.scenery = scenery_of(scene, reader.shapes(), out.simulation.duration);
    out.scene = std::move(scene);
  };
  if (space == "planar")
    read(SceneReader<2>(root, values));
  else
    read(SceneReader<3>(root, values));
  return out;
}

std::vector<std::string> builtin_scenes() {
  std::vector<std::string> names;
  for (const EmbeddedFile& file : embedded_scenes()) names.emplace_back(file.name);
  std::sort(names.begin(), names.end());
  return names;
}

std::string describe_builtin_scene(const std::string& name) {
  for (const EmbeddedFile& file : embedded_scenes()) {
    if (file.name == name) return std::string(file.text.substr(2, file.text.find('\n') - 2));
  }
  return "";
}

SceneFile load_scene(const std::string& name_or_path, const std::vector<std::string>& overrides) {
  for (const EmbeddedFile& file : embedded_scenes()) {
    if (file.name == name_or_path) return parse_scene(std::string(file.text), name_or_path, overrides);
  }
  const bool is_path =
      name_or_path.find('/') != std::string::npos || name_or_path.ends_with(".toml") || std::filesystem::exists(name_or_path);
  if (!is_path) {
    throw std::invalid_argument(fmt::format("unknown scene '{}', the nearest is '{}' (expected one of {}, or a TOML file)", name_or_path,
                                            nearest_name(name_or_path, builtin_scenes()), fmt::join(builtin_scenes(), ", ")));
  }
  return parse_scene(read_file(name_or_path), name_or_path, overrides);
}

}  // namespace contact
}  // namespace tenon
