#include "tenon/problems/tasks.hpp"

#include <algorithm>
#include <filesystem>

#include "tenon/core/named_file.hpp"
#include "tenon/core/nearest_name.hpp"
#include "tenon/problems/delta_payload/task.hpp"
#include "tenon/problems/peg_in_hole/task.hpp"
#include "tenon/problems/pushed_block/task.hpp"
#include "tenon/problems/soft_walls/task.hpp"
#include "tenon/problems/touch_down/task.hpp"
#include "tenon/problems/toml/checked_keys.hpp"

namespace tenon {

std::vector<EmbeddedFile> embedded_tasks();  // generated from */scenes/*.toml

namespace {

struct TaskKind {
  const char* name;
  ControlTask (*make)(const toml_file::Document& document);
};

constexpr TaskKind kKinds[] = {
    {"delta-payload", &delta_payload::make_task},
    {"peg-in-hole", &peg::make_task},
    {"pushed-block", &pushed_block::make_task},
    {"soft-walls", &soft_walls::make_task},
    {"touch-down", &touch_down::make_task},
};

const TaskKind& kind_of(const toml_file::Document& document) {
  const toml_file::Table root = document.root({});
  const std::string wanted = root.text("task");
  std::vector<std::string> names;
  std::string list;
  for (const TaskKind& kind : kKinds) {
    if (kind.name == wanted) return kind;
    names.emplace_back(kind.name);
    list += (list.empty() ? "" : ", ") + names.back();
  }
  throw InputError(root.position("task"), "unknown task '" + wanted + "', the nearest is '" + nearest_name(wanted, names) + "'", "one of " + list);
}

}  // namespace

std::vector<std::string> builtin_tasks() {
  return names_of(embedded_tasks());
}

std::string describe_builtin_task(const std::string& name) {
  return description_of(name, embedded_tasks());
}

bool is_task(const std::string& name_or_path) {
  if (std::ranges::count(builtin_tasks(), name_or_path) > 0) return true;
  if (!std::filesystem::is_regular_file(name_or_path)) return false;
  return toml_file::Document::read(name_or_path).root({}).has("task");
}

ControlTask make_task(const std::string& name_or_path, const std::vector<std::string>& overrides) {
  const NamedFile file = open_named_file("task", name_or_path, embedded_tasks());
  const toml_file::Document document(file.text, file.name, with_parameters(overrides));
  ControlTask task = kind_of(document).make(document);
  task.name = task.scenery.title = std::filesystem::path(name_or_path).stem().string();
  return task;
}

}  // namespace tenon
