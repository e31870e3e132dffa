#include "tenon/apps/ampl.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "tenon/apps/default_solver.hpp"
#include "tenon/apps/exit_code.hpp"
#include "tenon/apps/interrupt.hpp"
#include "tenon/core/output_file.hpp"
#include "tenon/problems/nl/nl_file.hpp"
#include "tenon/problems/nl/sol_file.hpp"

namespace tenon {

namespace {

constexpr const char* kFlag = "-AMPL";
constexpr const char* kEnvironment = "tenon_options";

/// What the words of a call say.
struct Call {
  std::string stem;
  std::string solver;
  int objective = 1;
  Options options;
};

double number(const std::string& key, const std::string& value) {
  double number = 0;
  const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), number);
  if (error != std::errc() || end != value.data() + value.size() || !std::isfinite(number)) {
    throw std::invalid_argument(fmt::format("{} {}={} makes no sense (expected a number)", kFlag, key, value));
  }
  return number;
}

int count(const std::string& key, const std::string& value) {
  const double wanted = number(key, value);
  if (wanted < 0 || wanted > 1e9 || wanted != std::floor(wanted)) {
    throw std::invalid_argument(fmt::format("{} {}={} makes no sense (expected a whole number from 0)", kFlag, key, value));
  }
  return static_cast<int>(wanted);
}

/// The names by which solvers of .nl files know the same thing.
struct Key {
  std::vector<std::string> names;
  void (*set)(Call&, const std::string& key, const std::string& value);
};

const std::vector<Key>& keys() {
  using Word = const std::string&;
  static const std::vector<Key> table{
      {{"tol", "tolerance"}, [](Call& c, Word key, Word value) { c.options.tolerance = number(key, value); }},
      {{"max_iter", "max_iterations", "maxit"}, [](Call& c, Word key, Word value) { c.options.max_iterations = count(key, value); }},
      {{"timelimit", "time_limit", "max_wall_time", "max_cpu_time"},
       [](Call& c, Word key, Word value) { c.options.time_limit = number(key, value); }},
      {{"objno"}, [](Call& c, Word key, Word value) { c.objective = count(key, value); }},
      {{"solver"}, [](Call& c, Word, Word value) { c.solver = value; }},
      {{"outlev", "print_level", "wantsol", "timing", "version"}, [](Call&, Word, Word) {}},  // understood, of no effect
  };
  return table;
}

/// `key=value`; one that is not known is named on stderr and passed over, as solvers of .nl files do.
void set_option(Call& call, const std::string& word) {
  const std::size_t equals = word.find('=');
  const std::string name = word.substr(0, equals), value = equals == std::string::npos ? "" : word.substr(equals + 1);
  for (const Key& key : keys()) {
    for (const std::string& known : key.names) {
      if (known == name) return key.set(call, name, value);
    }
  }
  fmt::print(stderr, "tenon: option '{}' is not known and has no effect\n", name);
}

Call read_call(int argc, char** argv) {
  Call call;
  call.solver = default_solver();
  if (const char* environment = std::getenv(kEnvironment)) {
    std::istringstream words(environment);
    for (std::string word; words >> word;) set_option(call, word);
  }
  for (int k = 1; k < argc; ++k) {
    const std::string word = argv[k];
    if (word == kFlag) continue;
    if (call.stem.empty() && word.find('=') == std::string::npos)
      call.stem = word.ends_with(".nl") ? word.substr(0, word.size() - 3) : word;
    else
      set_option(call, word);
  }
  if (call.stem.empty()) throw std::invalid_argument(fmt::format("{}: nothing named (expected tenon PATH {} [key=value ...])", kFlag, kFlag));
  validate(call.options);
  return call;
}

}  // namespace

bool is_ampl_call(int argc, char** argv) {
  for (int k = 1; k < argc; ++k) {
    if (std::strcmp(argv[k], kFlag) == 0) return true;
  }
  return false;
}

int run_ampl(int argc, char** argv) {
  Call call = read_call(argc, argv);
  const std::string answer = call.stem + ".sol";
  const NlFile file = read_nl(call.stem + ".nl", call.objective);
  check_output_path(answer);
  call.options.on_iteration = [](const Iteration&) { return !interrupted(); };
  Point point = file.start;
  const Result result = make_solver(call.solver, *file.problem, call.options)->solve(point);

  const double objective = file.maximises ? 0 - result.objective : result.objective;
  const std::string message = fmt::format("tenon {}: {} by {}; objective {:.10g}, {} iterations", TENON_VERSION, to_string(result.status),
                                          call.solver, objective, result.iterations);
  OutputFile output(answer);
  output.append(sol_text(file, point, result.status, message));
  output.finish();
  fmt::print("{}\n", message);
  return kFinished;
}

}  // namespace tenon
