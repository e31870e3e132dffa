// tenon report FILE.csv ...: the report page again, from record files alone.
#include "tenon/apps/report/report.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "tenon/apps/verb.hpp"

namespace tenon {

int run_report(const Arguments& arguments) {
  const std::string output = !arguments.report.empty()   ? arguments.report
                             : !arguments.output.empty() ? arguments.output
                                                         : std::filesystem::path(arguments.names.front()).replace_extension(".html").string();
  write_report(arguments.names, output);
  if (!arguments.quiet) fmt::print("{}\n", output);
  return kFinished;
}

}  // namespace tenon
