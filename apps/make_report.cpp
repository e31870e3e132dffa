#include "tenon/apps/make_report.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "tenon/apps/report/report.hpp"
#include "tenon/core/output_file.hpp"

namespace tenon {

void check_report(const Arguments& arguments) {
  if (!arguments.report.empty()) check_output_path(arguments.report);
}

std::string record_beside_report(const Arguments& arguments, const std::string& extension, const std::string& otherwise) {
  return arguments.report.empty() ? otherwise : std::filesystem::path(arguments.report).replace_extension(extension).string();
}

void make_report(const Arguments& arguments, const std::vector<std::string>& files) {
  if (arguments.report.empty()) return;
  write_report(files, arguments.report);
  if (!arguments.quiet) fmt::print(stderr, "tenon: the report is {}\n", arguments.report);
}

}  // namespace tenon
