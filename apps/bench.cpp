// tenon bench [NAME]: the benchmark rows whose names begin so, with the machine they ran on.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <stdexcept>

#include "tenon/apps/benchmark/benchmark.hpp"
#include "tenon/apps/benchmark/machine.hpp"
#include "tenon/apps/interrupt.hpp"
#include "tenon/apps/json.hpp"
#include "tenon/apps/progress.hpp"
#include "tenon/apps/statistics.hpp"
#include "tenon/apps/table.hpp"
#include "tenon/apps/verb.hpp"
#include "tenon/core/nearest_name.hpp"

namespace tenon {

namespace {

std::vector<Benchmark> chosen_benchmarks(const std::string& prefix) {
  std::vector<Benchmark> rows = benchmarks();
  std::vector<std::string> names;
  for (const Benchmark& row : rows) names.push_back(row.name);
  std::erase_if(rows, [&](const Benchmark& row) { return !row.name.starts_with(prefix); });
  if (rows.empty()) {
    throw std::invalid_argument(fmt::format("bench: no row begins with '{}', the nearest is '{}' (expected the beginning of one of {})",
                                            prefix, nearest_name(prefix, names), fmt::join(names, ", ")));
  }
  return rows;
}

}  // namespace

int run_bench(const Arguments& arguments) {
  const std::vector<Benchmark> rows = chosen_benchmarks(arguments.names.empty() ? "" : arguments.names.front());
  Table table({"name", "median", "p99", "runs", "notes"});
  Json list = Json::array();
  {
    Progress progress("bench", std::ssize(rows), arguments.quiet);
    for (std::size_t k = 0; k < rows.size(); ++k) {
      if (interrupted()) return kInterrupted;
      BenchmarkRun run;
      rows[k].run(run);
      const double middle = median(run.seconds), p99 = percentile(run.seconds, 0.99);
      table.add({rows[k].name, duration_text(middle), duration_text(p99), fmt::format("{}", run.seconds.size()),
                 fmt::format("{}", fmt::join(run.notes, ", "))});
      list.push(Json::object()
                    .set("name", rows[k].name)
                    .set("median_s", middle)
                    .set("p99_s", p99)
                    .set("runs", static_cast<long>(run.seconds.size()))
                    .set("notes", run.notes));
      progress.update(static_cast<long>(k) + 1);
    }
  }
  const Machine machine = this_machine();
  if (arguments.json) {
    print(Json::object()
              .set("schema", 1)
              .set("machine", Json::object()
                                  .set("cpu", machine.cpu)
                                  .set("cores", machine.cores)
                                  .set("compiler", machine.compiler)
                                  .set("flags", machine.flags)
                                  .set("libraries", machine.libraries))
              .set("benchmarks", list));
    return kFinished;
  }
  fmt::print("{}\n{}, {} cores; {}, {}\n{}\n", table.text(), machine.cpu, machine.cores, machine.compiler, machine.flags,
             machine.libraries);
  return kFinished;
}

}  // namespace tenon
