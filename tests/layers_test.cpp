// The order of dependence, read off every #include:
//
//     core  <-  problems        problems, mpc and solvers never see one another; apps and tests may use everything; core sees core alone.
//     core  <-  mpc
//     core  <-  solvers
//
// and three smaller laws of the house: a header has `#pragma once`, a missing back end is a choice of file and not an #ifdef, and a file
// of a library has at most 400 lines.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace fs = std::filesystem;

namespace {

const fs::path kSourceDir = TENON_SOURCE_DIR;
const std::string kOurs = "tenon/";
constexpr std::size_t kMaxLines = 400;

/// What a folder may include, itself aside.
const std::map<std::string, std::set<std::string>> kMayInclude = {
    {"core", {}},
    {"problems", {"core"}},
    {"mpc", {"core"}},
    {"solvers", {"core"}},
    {"apps", {"core", "problems", "mpc", "solvers"}},
    {"tests", {"core", "problems", "mpc", "solvers", "apps"}},
};

bool is_library(const std::string& folder) { return folder != "apps" && folder != "tests"; }

struct SourceFile {
  std::string folder;  // the first part of its path
  fs::path path;       // from the project's folder
  std::vector<std::string> lines;

  bool is_header() const { return path.extension() == ".hpp" || path.extension() == ".h"; }
};

std::vector<SourceFile> read_sources() {
  static const std::set<std::string> extensions = {".hpp", ".cpp", ".h", ".c"};
  std::vector<SourceFile> files;
  for (const auto& [folder, allowed] : kMayInclude) {
    if (!fs::exists(kSourceDir / folder)) continue;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(kSourceDir / folder)) {
      if (!entry.is_regular_file() || !extensions.contains(entry.path().extension().string())) continue;
      SourceFile file{folder, fs::relative(entry.path(), kSourceDir), {}};
      std::ifstream stream(entry.path());
      for (std::string line; std::getline(stream, line);) file.lines.push_back(line);
      files.push_back(std::move(file));
    }
  }
  return files;
}

const std::vector<SourceFile>& sources() {
  static const std::vector<SourceFile> files = read_sources();
  return files;
}

struct Directive {
  std::string name;  // "include", "ifdef", ...
  std::string rest;
};

/// The preprocessor directive on a line, if it holds one.
std::optional<Directive> directive(const std::string& line) {
  static const std::string blank = " \t";
  const std::size_t hash = line.find_first_not_of(blank);
  if (hash == std::string::npos || line[hash] != '#') return std::nullopt;
  const std::size_t name = std::min(line.find_first_not_of(blank, hash + 1), line.size());
  const std::size_t name_end = std::min(line.find_first_of(blank + "<\"", name), line.size());
  const std::size_t rest = std::min(line.find_first_not_of(blank, name_end), line.size());
  return Directive{line.substr(name, name_end - name), line.substr(rest)};
}

/// The name between the quotes or brackets of an #include, with the opening one before it.
std::optional<std::string> included(const std::string& line) {
  const std::optional<Directive> found = directive(line);
  if (!found || found->name != "include" || found->rest.empty()) return std::nullopt;
  return found->rest.substr(0, found->rest.find_first_of("\">", 1));
}

/// What is wrong with a line of a file in `folder`, if it is an #include and there is something.
std::optional<std::string> wrong_include(const std::string& folder, const std::string& line) {
  const std::optional<std::string> name = included(line);
  if (!name) return std::nullopt;
  const bool quoted = name->front() == '"';
  const std::string target = name->substr(1);

  if (target.find("..") != std::string::npos) return "climbs out of its folder: " + target;
  if (!target.starts_with(kOurs)) {
    return quoted && is_library(folder) ? std::optional("is not named from the top (\"tenon/...\"): " + target) : std::nullopt;
  }
  const std::string other = fs::path(target.substr(kOurs.size())).begin()->string();
  if (other != folder && !kMayInclude.at(folder).contains(other)) return folder + " must not see " + other + ": " + target;
  return std::nullopt;
}

bool is_back_end_switch(const std::string& line) {
  const std::optional<Directive> found = directive(line);
  return found && (found->name.starts_with("if") || found->name.starts_with("elif")) && found->rest.find("HAVE_") != std::string::npos;
}

TEST(Layers, EveryIncludeFollowsTheOrderOfDependence) {
  ASSERT_FALSE(sources().empty());
  for (const SourceFile& file : sources()) {
    for (std::size_t i = 0; i < file.lines.size(); ++i) {
      const std::optional<std::string> wrong = wrong_include(file.folder, file.lines[i]);
      if (wrong) ADD_FAILURE() << file.path.string() << ":" << i + 1 << ": " << *wrong;
    }
  }
}

TEST(Layers, EveryIncludedFileOfOursIsThere) {
  for (const SourceFile& file : sources()) {
    for (const std::string& line : file.lines) {
      const std::optional<std::string> name = included(line);
      if (!name || !name->substr(1).starts_with(kOurs)) continue;
      EXPECT_TRUE(fs::exists(kSourceDir / name->substr(1 + kOurs.size()))) << file.path.string() << " includes " << name->substr(1);
    }
  }
}

TEST(Layers, TheLawRefusesEachForbiddenArrow) {
  EXPECT_TRUE(wrong_include("core", "#include \"tenon/solvers/make_solver.hpp\""));
  EXPECT_TRUE(wrong_include("core", "#include <tenon/problems/catalogue.hpp>"));
  EXPECT_TRUE(wrong_include("core", "#include \"tenon/tests/allocation_counter.hpp\""));
  EXPECT_TRUE(wrong_include("problems", "  #  include <tenon/solvers/make_solver.hpp>  // no"));
  EXPECT_TRUE(wrong_include("solvers", "#include \"tenon/problems/catalogue.hpp\""));
  EXPECT_TRUE(wrong_include("mpc", "#include \"tenon/solvers/make_solver.hpp\""));
  EXPECT_TRUE(wrong_include("solvers", "#include \"tenon/mpc/loop.hpp\""));
  EXPECT_TRUE(wrong_include("apps", "#include \"tenon/tests/allocation_counter.hpp\""));
  EXPECT_TRUE(wrong_include("solvers", "#include \"../problems/catalogue.hpp\""));
  EXPECT_TRUE(wrong_include("solvers", "#include \"make_solver.hpp\""));
}

TEST(Layers, TheLawLetsEachAllowedArrowPass) {
  EXPECT_FALSE(wrong_include("core", "#include \"tenon/core/nlp.hpp\""));
  EXPECT_FALSE(wrong_include("solvers", "#include <tenon/core/nlp.hpp>"));
  EXPECT_FALSE(wrong_include("apps", "#include \"tenon/solvers/make_solver.hpp\""));
  EXPECT_FALSE(wrong_include("tests", "#include \"tenon/apps/csv.hpp\""));
  EXPECT_FALSE(wrong_include("core", "#include <Eigen/Core>"));
  EXPECT_FALSE(wrong_include("core", "// no #include \"tenon/solvers/make_solver.hpp\" here"));
}

TEST(Layers, EveryHeaderIsReadOnce) {
  for (const SourceFile& file : sources()) {
    if (!file.is_header()) continue;
    EXPECT_NE(std::find(file.lines.begin(), file.lines.end(), "#pragma once"), file.lines.end()) << file.path.string();
  }
}

TEST(Layers, AMissingBackEndIsAChoiceOfFileNotOfThePreprocessor) {
  EXPECT_TRUE(is_back_end_switch("#ifdef HAVE_IPOPT"));
  EXPECT_TRUE(is_back_end_switch("  # if defined(TENON_HAVE_NLOPT)"));
  for (const SourceFile& file : sources()) {
    for (const std::string& line : file.lines) EXPECT_FALSE(is_back_end_switch(line)) << file.path.string() << ": " << line;
  }
}

TEST(Layers, NoFileOfALibraryIsLong) {
  for (const SourceFile& file : sources()) {
    if (!is_library(file.folder)) continue;
    EXPECT_LE(file.lines.size(), kMaxLines) << file.path.string();
  }
}

}  // namespace
