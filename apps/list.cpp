// tenon list [KIND]: what tenon knows by name.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <functional>
#include <stdexcept>

#include "tenon/apps/json.hpp"
#include "tenon/apps/table.hpp"
#include "tenon/apps/verb.hpp"
#include "tenon/core/nearest_name.hpp"
#include "tenon/problems/allocation/vehicle_file.hpp"
#include "tenon/problems/catalogue.hpp"
#include "tenon/problems/contact/scene_file.hpp"
#include "tenon/problems/delta/robot_file.hpp"
#include "tenon/problems/delta/scene_file.hpp"
#include "tenon/problems/flight/mission_file.hpp"
#include "tenon/problems/tasks.hpp"
#include "tenon/solvers/make_solver.hpp"

namespace tenon {

namespace {

struct Named {
  std::string name, description;
  bool available = true;
};

struct Kind {
  std::string name;
  std::function<std::vector<Named>()> entries;
};

std::vector<Named> problems() {
  std::vector<Named> list;
  for (const CatalogueEntry& entry : catalogue()) list.push_back({entry.name, entry.description});
  return list;
}

std::vector<Named> vehicles() {
  std::vector<Named> list;
  for (const std::string& name : builtin_vehicles()) list.push_back({name, describe_builtin_vehicle(name)});
  return list;
}

std::vector<Named> robots() {
  std::vector<Named> list;
  for (const std::string& name : delta::builtin_robots()) list.push_back({name, delta::describe_builtin_robot(name)});
  return list;
}

std::vector<Named> solvers() {
  std::vector<Named> list;
  for (const SolverDescription& s : list_solvers()) list.push_back({s.name, s.description, s.available});
  return list;
}

std::vector<Named> scenes() {
  std::vector<Named> list;
  for (const std::string& name : contact::builtin_scenes()) list.push_back({name, contact::describe_builtin_scene(name)});
  for (const std::string& name : delta::builtin_scenes()) list.push_back({name, delta::describe_builtin_scene(name)});
  for (const std::string& name : builtin_tasks()) list.push_back({name, describe_builtin_task(name)});
  return list;
}

std::vector<Named> missions() {
  std::vector<Named> list;
  for (const std::string& name : flight::builtin_missions()) list.push_back({name, flight::describe_builtin_mission(name)});
  return list;
}

const std::vector<Kind>& kinds() {
  static const std::vector<Kind> table{{"problems", &problems}, {"vehicles", &vehicles}, {"missions", &missions},
                                       {"scenes", &scenes},     {"robots", &robots},     {"solvers", &solvers}};
  return table;
}

void print_kind(const Kind& kind) {
  const std::vector<Named> entries = kind.entries();
  fmt::print("{}:\n", kind.name);
  Table table({"", "", ""});
  for (const Named& entry : entries)
    table.add({"", entry.name, entry.available ? entry.description : "(not available) " + entry.description});
  const std::string text = table.text();
  fmt::print("{}", text.substr(text.find('\n') + 1));
}

}  // namespace

int run_list(const Arguments& arguments) {
  std::vector<Kind> chosen = kinds();
  if (!arguments.names.empty()) {
    const std::string& wanted = arguments.names.front();
    std::vector<std::string> names;
    for (const Kind& kind : kinds()) names.push_back(kind.name);
    if (std::count(names.begin(), names.end(), wanted) == 0) {
      throw std::invalid_argument(fmt::format("list: unknown kind '{}', the nearest is '{}' (expected one of {})", wanted,
                                              nearest_name(wanted, names), fmt::join(names, ", ")));
    }
    std::erase_if(chosen, [&](const Kind& kind) { return kind.name != wanted; });
  }
  if (!arguments.json) {
    for (const Kind& kind : chosen) print_kind(kind);
    return kFinished;
  }
  Json json = Json::object();
  json.set("schema", 1);
  for (const Kind& kind : chosen) {
    Json list = Json::array();
    for (const Named& entry : kind.entries()) {
      list.push(Json::object().set("name", entry.name).set("description", entry.description).set("available", entry.available));
    }
    json.set(kind.name, list);
  }
  print(json);
  return kFinished;
}

}  // namespace tenon
