// Broken .nl files: cut at every byte, every line garbled, every byte of a binary file changed. Each gives one line of explanation, or a
// problem that can be evaluated and solved for; nothing ends the program (it would end this one) and nothing hangs.
#include <gtest/gtest.h>

#include <random>

#include "tenon/core/check_derivatives.hpp"
#include "tenon/core/input_error.hpp"
#include "tenon/problems/nl/nl_file.hpp"
#include "tenon/solvers/make_solver.hpp"
#include "tenon/tests/nl_folder.hpp"

namespace tenon {
namespace {

constexpr const char* kText[] = {"garden", "valley", "crossing", "conflict", "bottomless", "undefined", "operators"};
constexpr int kFewIterations = 8;

/// Either InputError with one line that names the file, or a problem.
class Fuzz : public testing::Test {
 protected:
  void SetUp() override {
    if (!nl_files_are_available()) GTEST_SKIP() << "built without the AMPL solver library";
  }

  void read(const std::string& bytes, const std::string& what) {
    try {
      use(parse_nl(bytes, "broken.nl"));
      ++taken_;
    } catch (const InputError& error) {
      const std::string message = error.what();
      EXPECT_TRUE(message.starts_with("broken.nl:")) << what << ": " << message;
      EXPECT_EQ(message.find('\n'), std::string::npos) << what << ": " << message;
      EXPECT_EQ(message.find("the AMPL solver library cannot read"), std::string::npos) << what << ": the scan let this pass: " << message;
      ++refused_;
    }
  }

  int taken_ = 0, refused_ = 0;

 private:
  /// What the file validly says must hold together: derivatives where they are, and a solve that ends.
  static void use(const NlFile& file) {
    Point point = file.start;
    Options options;
    options.max_iterations = kFewIterations;
    make_solver("newton-kkt", *file.problem, options)->solve(point);
    check_derivatives(*file.problem, file.start.x, 1, Vector::Ones(file.problem->num_constraints()));
  }
};

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = text.find('\n', begin) + 1;
    lines.push_back(text.substr(begin, end - begin));
    begin = end;
  }
  return lines;
}

std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line;
  return text;
}

TEST_F(Fuzz, AFileCutAtAnyByte) {
  for (const char* name : kText) {
    const std::string whole = nl_text(name);
    for (std::size_t length = 0; length < whole.size(); ++length) {
      read(whole.substr(0, length), std::string(name) + " cut at " + std::to_string(length));
    }
  }
  EXPECT_EQ(taken_, 0);  // every file ends in a segment that the head counts
}

TEST_F(Fuzz, ABinaryFileCutAtAnyByte) {
  const std::string whole = nl_text("garden_binary");
  for (std::size_t length = 0; length < whole.size(); ++length) read(whole.substr(0, length), "cut at " + std::to_string(length));
  EXPECT_EQ(taken_, 0);
}

TEST_F(Fuzz, AnyLineGarbled) {
  const std::vector<std::string> garbage = {"",        "\n",       "???\n",   "-1\n",    "o54\n",         "n\n",  "v-1\n", "0 1 2 3 4 5 6 7\n", "C0\n",
                                            "1e400\n", "b\n",      "k99\n",   "nan\n",   "2147483648\n",  "J0 9\n", "x1\n",  std::string("\0\0\n", 3),
                                            "S0 1 sosno\n",        "V4 0 0\n", "o16\n",  "n0\n",          "v0\n", "3\n",   "4 0\n"};
  for (const char* name : kText) {
    const std::vector<std::string> lines = lines_of(nl_text(name));
    for (std::size_t k = 0; k < lines.size(); ++k) {
      for (const std::string& garbled : garbage) {
        std::vector<std::string> broken = lines;
        broken[k] = garbled;
        read(joined(broken), std::string(name) + " line " + std::to_string(k + 1));
      }
      std::vector<std::string> doubled = lines;
      doubled.insert(doubled.begin() + static_cast<std::ptrdiff_t>(k), lines[k]);
      read(joined(doubled), std::string(name) + " with line " + std::to_string(k + 1) + " twice");
    }
  }
  EXPECT_GT(refused_, 10 * taken_);
}

TEST_F(Fuzz, AnyNumberChanged) {
  std::mt19937 random(1);
  const std::string characters = "0123456789.-e onvCJkbrx\n#\t\r";
  for (const char* name : kText) {
    const std::string whole = nl_text(name);
    for (int repetition = 0; repetition < 4; ++repetition) {
      for (std::size_t k = 0; k < whole.size(); ++k) {
        std::string broken = whole;
        broken[k] = characters[random() % characters.size()];
        read(broken, std::string(name) + " byte " + std::to_string(k));
      }
    }
  }
  EXPECT_GT(refused_, 1000);
  EXPECT_GT(taken_, 100);
}

TEST_F(Fuzz, AnyByteOfABinaryFileChanged) {
  std::mt19937 random(2);
  const std::string whole = nl_text("garden_binary");
  for (int repetition = 0; repetition < 6; ++repetition) {
    for (std::size_t k = 0; k < whole.size(); ++k) {
      std::string broken = whole;
      broken[k] = static_cast<char>(repetition == 0 ? whole[k] ^ 1 : repetition == 1 ? '\xff' : static_cast<int>(random() % 256));
      read(broken, "byte " + std::to_string(k));
    }
  }
  EXPECT_GT(refused_, 1000);
}

TEST_F(Fuzz, SeveralLinesMoved) {
  std::mt19937 random(3);
  for (const char* name : kText) {
    for (int repetition = 0; repetition < 3000; ++repetition) {
      std::vector<std::string> lines = lines_of(nl_text(name));
      for (std::uint32_t swaps = 1 + random() % 3; swaps > 0; --swaps) std::swap(lines[random() % lines.size()], lines[random() % lines.size()]);
      read(joined(lines), std::string(name) + " repetition " + std::to_string(repetition));
    }
  }
  EXPECT_GT(refused_, 500);
}

}  // namespace
}  // namespace tenon
