// The README shows code that builds and runs: its C++ is readme_snippet.cpp, word for word.
#include <gtest/gtest.h>

#include "tenon/core/read_file.hpp"

namespace {

const std::string kSourceDir = TENON_SOURCE_DIR;

TEST(Readme, ShowsTheSnippetThatTheTestsBuildAndRun) {
  const std::string readme = tenon::read_file(kSourceDir + "/README.md"), snippet = tenon::read_file(kSourceDir + "/tests/readme_snippet.cpp");
  EXPECT_NE(readme.find("```cpp\n" + snippet + "```\n"), std::string::npos);
}

}  // namespace
