#include "tenon/problems/nl/nl_file.hpp"

#include <filesystem>
#include <stdexcept>

#include "tenon/core/read_file.hpp"
#include "tenon/problems/nl/ampl_program.hpp"
#include "tenon/problems/nl/nl_scan.hpp"

namespace tenon {

namespace {

/// The first `count` lines of a file of names; none where it is not there or does not have as many.
std::vector<std::string> read_names(const std::filesystem::path& path, int count) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) return {};
  const std::string text = read_file(path.string());
  std::vector<std::string> names;
  for (std::size_t begin = 0; begin < text.size() && static_cast<int>(names.size()) < count;) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    std::string name = text.substr(begin, end - begin);
    if (name.ends_with('\r')) name.pop_back();
    names.push_back(std::move(name));
    begin = end + 1;
  }
  if (static_cast<int>(names.size()) < count) names.clear();
  return names;
}

}  // namespace

NlFile read_nl(const std::string& path, int objective) {
  return parse_nl(read_file(path), path, objective);
}

NlFile parse_nl(const std::string& bytes, const std::string& path, int objective) {
  const NlScan scan = scan_nl(bytes, path);
  const NlHeader& header = scan.header;
  if (objective < 0 || (objective > header.objectives && objective != 1)) {
    throw std::invalid_argument(path + ": there is no objective " + std::to_string(objective) + " (expected 0 to " +
                                std::to_string(header.objectives) + ")");
  }
  const std::filesystem::path file(path);
  NlNames names{file.stem().string(), read_names(std::filesystem::path(file).replace_extension(".col"), header.variables),
                read_names(std::filesystem::path(file).replace_extension(".row"), header.constraints)};
  NlFile made = make_ampl_program(scan.bytes, path, std::move(names), std::min(objective, header.objectives));
  made.options = header.options;
  made.boundary_tolerance = header.boundary_tolerance;
  return made;
}

}  // namespace tenon
