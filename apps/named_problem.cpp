#include "tenon/apps/named_problem.hpp"

#include "tenon/apps/dump.hpp"
#include "tenon/apps/problem_list.hpp"
#include "tenon/core/read_file.hpp"
#include "tenon/problems/nl/nl_file.hpp"

namespace tenon {

NamedProblem built_in_problem(const std::string& name) {
  const CatalogueEntry& entry = find_problem(name, problem_list());
  NamedProblem named;
  named.name = named.built_in = name;
  named.problem = entry.make();
  named.start = suggested_start(*named.problem);
  named.published_objective = entry.published_objective;
  return named;
}

NamedProblem nl_problem(const std::string& bytes, const std::string& path) {
  NlFile file = parse_nl(bytes, path);
  NamedProblem named;
  named.name = path;
  named.problem = std::move(file.problem);
  named.start = file.start;
  named.maximises = file.maximises;
  named.nl_bytes = bytes;
  return named;
}

NamedProblem load_problem(const std::string& name) {
  if (name.ends_with(".nl")) return nl_problem(read_file(name), name);
  if (name.ends_with(".json")) return read_dump(name);
  return built_in_problem(name);
}

Measurement measure(const NamedProblem& named, const std::string& solver, const Options& options, int timed_runs) {
  Measurement m = measure(*named.problem, solver, options, named.start, timed_runs);
  if (named.maximises) m.result.objective = 0 - m.result.objective;  // 0, not -0
  return m;
}

}  // namespace tenon
