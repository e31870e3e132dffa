#include "tenon/apps/command_line.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <stdexcept>

#include "tenon/core/nearest_name.hpp"

namespace tenon {

namespace {

/// Every flag, by name: how it is added to a verb.
const std::map<std::string, std::function<CLI::Option*(CLI::App&, Arguments&)>>& flags() {
  using App = CLI::App;
  using Args = Arguments;
  static const CLI::Validator finite(
      [](std::string& text) { return std::isfinite(std::strtod(text.c_str(), nullptr)) ? "" : text + " is not finite"; }, "");
  static const CLI::Validator count = CLI::Range(0, 1 << 30).description("");
  static const std::map<std::string, std::function<CLI::Option*(App&, Args&)>> table{
      {"wrenches", [](App& a, Args& v) { return a.add_option("--wrenches", v.wrenches, "the wrench log")->type_name("FILE.csv"); }},
      {"measurements",
       [](App& a, Args& v) { return a.add_option("--measurements", v.measurements, "the record to estimate from")->type_name("FILE.csv"); }},
      {"output", [](App& a, Args& v) { return a.add_option("--output", v.output, "where the record goes")->type_name("FILE.csv"); }},
      {"events", [](App& a, Args& v) { return a.add_option("--events", v.events, "where the events go")->type_name("FILE.csv"); }},
      {"fast-phase",
       [](App& a, Args& v) { return a.add_option("--fast-phase", v.fast_phase, "collisions in their own time scale")->type_name("FILE.csv"); }},
      {"real-time", [](App& a, Args& v) { return a.add_flag("--real-time", v.real_time, "paced as the clock on the wall"); }},
      {"report", [](App& a, Args& v) { return a.add_option("--report", v.report, "the report page of what came out")->type_name("FILE.html"); }},
      {"trace", [](App& a, Args& v) { return a.add_option("--trace", v.trace, "one line per solver iteration")->type_name("FILE.jsonl"); }},
      {"dump",
       [](App& a, Args& v) { return a.add_option("--dump", v.dump, "where a solve that fails goes, for replay")->type_name("FILE.json"); }},
      {"profile",
       [](App& a, Args& v) { return a.add_option("--profile", v.profile, "compare over a folder of .nl files")->type_name("DIR"); }},
      {"solver", [](App& a, Args& v) { return a.add_option("--solver", v.solver, "the back end")->type_name("NAME"); }},
      {"solvers", [](App& a, Args& v) { return a.add_option("--solvers", v.solvers, "the back ends to compare")->type_name("A,B,C"); }},
      {"set",
       [](App& a, Args& v) {
         return a.add_option("--set", v.set, "override a value of the TOML; may stand several times")
             ->type_name("KEY.PATH=VALUE")
             ->allow_extra_args(false);
       }},
      {"initial",
       [](App& a, Args& v) {
         return a.add_option("--initial", v.initial, "arm angles before the first row, rad")->type_name("A1,...,AN");
       }},
      {"inverse", [](App& a, Args& v) { return a.add_option("--inverse", v.inverse, "the wrist's position, m")->type_name("X,Y,Z"); }},
      {"forward", [](App& a, Args& v) { return a.add_option("--forward", v.forward, "the motors' angles, rad")->type_name("Q1,Q2,Q3"); }},
      {"jacobians", [](App& a, Args& v) { return a.add_flag("--jacobians", v.jacobians, "Jacobians, inertia, gravity torque of that pose"); }},
      {"impedance",
       [](App& a, Args& v) {
         return a.add_option("--impedance", v.impedance, "what a grasped part feels over frequency, tactile loop off and on")->type_name("FILE.csv");
       }},
      {"workspace",
       [](App& a, Args& v) { return a.add_option("--workspace", v.workspace, "a map of what is reached")->type_name("FILE.csv"); }},
      {"cold", [](App& a, Args& v) { return a.add_flag("--cold", v.cold, "every row on its own: no previous angles, no rate"); }},
      {"tolerance",
       [](App& a, Args& v) { return a.add_option("--tolerance", v.tolerance, "where a solve ends")->type_name("X")->check(finite); }},
      {"max-iterations",
       [](App& a, Args& v) {
         return a.add_option("--max-iterations", v.max_iterations, "where a solve gives up")->type_name("N")->check(count);
       }},
      {"time-limit",
       [](App& a, Args& v) {
         return a.add_option("--time-limit", v.time_limit, "where a solve gives up, s")->type_name("S")->check(finite);
       }},
      {"seed", [](App& a, Args& v) { return a.add_option("--seed", v.seed, "of random numbers")->type_name("N"); }},
      {"samples", [](App& a, Args& v) { return a.add_option("--samples", v.samples, "worlds to draw")->type_name("N")->check(count); }},
      {"baselines", [](App& a, Args& v) { return a.add_flag("--baselines", v.baselines, "the scene's baselines in the same worlds, too"); }},
      {"margins", [](App& a, Args& v) { return a.add_flag("--margins", v.margins, "of stability in each mode, and of capture"); }},
      {"resume", [](App& a, Args& v) { return a.add_flag("--resume", v.resume, "go on where an earlier sweep into --output ended"); }},
      {"threads",
       [](App& a, Args& v) {
         return a.add_option("--threads", v.threads, "workers of this process; every core without it")
             ->type_name("N")
             ->check(CLI::Range(1, 1 << 12).description(""));
       }},
      {"rows", [](App& a, Args& v) { return a.add_option("--rows", v.rows, "random rows of a vehicle, directions of an envelope")->type_name("N")->check(count); }},
      {"starts",
       [](App& a, Args& v) {
         return a.add_option("--starts", v.starts, "solve from so many points; the best answer counts")
             ->type_name("N")
             ->check(CLI::Range(1, 1 << 20).description(""));
       }},
      {"degree",
       [](App& a, Args& v) { return a.add_option("--degree", v.degree, "of the polynomials")->type_name("N")->capture_default_str(); }},
      {"constant", [](App& a, Args& v) { return a.add_flag("--constant", v.constant, "fit a constant term as well"); }},
      {"json", [](App& a, Args& v) { return a.add_flag("--json", v.json, "the result as one JSON object on stdout"); }},
      {"quiet", [](App& a, Args& v) { return a.add_flag("--quiet", v.quiet, "no log, no progress bar, no summary"); }},
      {"verbose", [](App& a, Args& v) { return a.add_flag("--verbose", v.verbose, "the iteration table, on stderr"); }},
  };
  return table;
}

/// Help without the machinery's words: `tenon allocate VEHICLE [flags]`.
class HelpText : public CLI::Formatter {
 public:
  explicit HelpText(std::string usage) : usage_(std::move(usage)) {}
  std::string make_usage(const CLI::App*, std::string) const override { return "usage: " + usage_ + "\n"; }
  std::string make_positionals(const CLI::App*) const override { return ""; }

 private:
  std::string usage_;
};

void add_verb(CLI::App& app, const Verb& verb, Arguments& arguments) {
  CLI::App* command = app.add_subcommand(verb.name, verb.description);
  command->formatter(std::make_shared<HelpText>(fmt::format("tenon {} {} [flags]", verb.name, verb.operands)));
  command->add_option("operands", arguments.names);  // counted afterwards, so that a mistyped flag is what shows first
  for (const std::string& flag : verb.flags) flags().at(flag)(*command, arguments);
}

const Verb* find_verb(const std::string& name) {
  for (const Verb& verb : verbs()) {
    if (verb.name == name) return &verb;
  }
  return nullptr;
}

[[noreturn]] void reject_verb(const std::string& name) {
  std::vector<std::string> names;
  for (const Verb& verb : verbs()) names.push_back(verb.name);
  throw std::invalid_argument(
      fmt::format("unknown verb '{}', the nearest is '{}' (expected one of {})", name, nearest_name(name, names), fmt::join(names, ", ")));
}

void check_operands(const Verb& verb, const std::vector<std::string>& names) {
  const int count = static_cast<int>(names.size());
  if (count < verb.min_operands) throw std::invalid_argument(fmt::format("{}: nothing named (expected {})", verb.name, verb.operands));
  if (verb.max_operands >= 0 && count > verb.max_operands) {
    throw std::invalid_argument(fmt::format("{}: '{}' is one word too many (expected {})", verb.name,
                                            names[static_cast<std::size_t>(verb.max_operands)], verb.operands));
  }
}

[[noreturn]] void reject_flag(const Verb& verb, const std::string& word) {
  std::vector<std::string> names;
  for (const std::string& flag : verb.flags) names.push_back("--" + flag);
  names.emplace_back("--help");
  const std::string name = word.substr(0, word.find('='));
  throw std::invalid_argument(fmt::format("{}: unknown flag '{}', the nearest is '{}' (expected one of {})", verb.name, name,
                                          nearest_name(name, names), fmt::join(names, ", ")));
}

}  // namespace

std::optional<Invocation> read_command_line(int argc, char** argv) {
  CLI::App app("Nonlinear optimisation and model-predictive control for wrench allocation and contact-aware assembly.", "tenon");
  app.set_version_flag("--version", "tenon " TENON_VERSION);
  app.formatter(std::make_shared<HelpText>("tenon VERB ... ; tenon VERB --help tells more of one"));
  app.require_subcommand(0, 1);  // so that the operand of `tenon bench envelope` is no second verb
  Invocation invocation;
  for (const Verb& verb : verbs()) add_verb(app, verb, invocation.arguments);

  const std::string first = argc > 1 ? argv[1] : "";
  if (first.empty()) throw std::invalid_argument("no verb (expected tenon VERB ..., see tenon --help)");
  invocation.verb = find_verb(first);
  if (invocation.verb == nullptr && !first.starts_with("-")) reject_verb(first);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& asked) {  // --help, --version
    app.exit(asked);
    return std::nullopt;
  } catch (const CLI::ExtrasError&) {
    const std::vector<std::string> extras = app.remaining(true);
    if (invocation.verb == nullptr) throw std::invalid_argument("unknown flag '" + first + "' (expected tenon VERB ..., see tenon --help)");
    reject_flag(*invocation.verb, extras.empty() ? "" : extras.front());
  } catch (const CLI::ConversionError& error) {
    const std::string what = error.what();
    throw std::invalid_argument(fmt::format("{}: {} makes no sense (expected a number)", first, what.substr(what.find("--"))));
  } catch (const CLI::ParseError& error) {
    throw std::invalid_argument(first + ": " + error.what());
  }
  if (invocation.verb == nullptr) reject_verb(first);
  check_operands(*invocation.verb, invocation.arguments.names);
  return invocation;
}

}  // namespace tenon
