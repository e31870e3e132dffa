// The README shows code that builds and runs: its C++ is readme_snippet.cpp and readme_automatic.cpp, word for word.
#include <gtest/gtest.h>

#include "tenon/core/read_file.hpp"

namespace {

const std::string kSourceDir = TENON_SOURCE_DIR;

TEST(Readme, ShowsTheSnippetsThatTheTestsBuildAndRun) {
  const std::string readme = tenon::read_file(kSourceDir + "/README.md");
  for (const std::string file : {"readme_snippet.cpp", "readme_automatic.cpp"}) {
    const std::string snippet = tenon::read_file(kSourceDir + "/tests/" + file);
    EXPECT_NE(readme.find("```cpp\n" + snippet + "```\n"), std::string::npos) << file;
  }
}

}  // namespace
