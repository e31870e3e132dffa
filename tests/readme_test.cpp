// The README shows code that builds and runs: its C++ is readme_automatic.cpp, readme_ocp.cpp and readme_snippet.cpp, word for word.
#include <gtest/gtest.h>

#include "tenon/core/read_file.hpp"

namespace {

const std::string kSourceDir = TENON_SOURCE_DIR;

TEST(Readme, ShowsTheSnippetsThatTheTestsBuildAndRun) {
  const std::string readme = tenon::read_file(kSourceDir + "/README.md");
  for (const std::string file : {"readme_automatic.cpp", "readme_ocp.cpp", "readme_snippet.cpp"}) {
    const std::string snippet = tenon::read_file(kSourceDir + "/tests/" + file);
    EXPECT_NE(readme.find("```cpp\n" + snippet + "```\n"), std::string::npos) << file;
  }
}

}  // namespace
