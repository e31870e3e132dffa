#include "tenon/problems/catalogue.hpp"

#include <algorithm>
#include <iterator>
#include <stdexcept>

#include "tenon/core/nearest_name.hpp"
#include "tenon/problems/classic/hock_schittkowski.hpp"
#include "tenon/problems/optimal_control/linear_quadratic.hpp"
#include "tenon/problems/optimal_control/swing_up.hpp"
#include "tenon/problems/peg_in_hole/assembly_program.hpp"
#include "tenon/problems/tasks.hpp"

namespace tenon {

namespace {

std::vector<CatalogueEntry> optimal_control() {
  return {
      {"cart-pole", "swing-up of a pole on a cart in 5 s, N = 100 (n = 504, m = 400)", 11181.3177,
       [] { return std::make_unique<SwingUp>(cart_pole()); }},
      {"lq", "a chain of masses and springs, 12 states, 6 boxed inputs, N = 20 (n = 372, m = 240)", std::nullopt,
       [] { return std::make_unique<LinearQuadratic<Dynamic, Dynamic>>(mass_spring_chain(12, 6, 20)); }},
      {"peg-in-hole", "a peg finds its way into a hole 0.9 mm and 1 degree aside, contact by complementarity, N = 40 (n = 852, m = 960)",
       std::nullopt, [] { return std::make_unique<peg::AssemblyProgram>(peg::single_plan()); }},
      {"pendulum", "swing-up of a pendulum in 1 s by tracking, N = 20 (n = 104, m = 80)", 2242.828131,
       [] { return std::make_unique<SwingUp>(pendulum()); }},
  };
}

/// The first horizon of a task, from its nominal start.
CatalogueEntry first_horizon(const std::string& name, const std::string& description, const std::string& task,
                             const std::vector<std::string>& overrides = {}) {
  return {name, description, std::nullopt, [=] { return make_task(task, overrides).program; }};
}

std::vector<CatalogueEntry> horizons() {
  const std::string kRounder = "rounding=5e-3";  // than in closed loop: differences, which `tenon check` takes, then follow the corner
  return {
      first_horizon("cart-pole-soft-walls", "a pole between soft walls, N = 10 (n = 54, m = 40)", "cart-pole-soft-walls", {kRounder}),
      first_horizon("cart-pole-soft-walls-5", "the same, N = 5 (n = 29, m = 20)", "cart-pole-soft-walls", {kRounder, "intervals=5"}),
      first_horizon("delta-touch-down", "a wrist onto a plane, N = 25 (n = 128, m = 175)", "delta-touch-down"),
      first_horizon("delta-touch-down-10", "the same, N = 10 (n = 53, m = 70)", "delta-touch-down", {"intervals=10"}),
  };
}

std::vector<CatalogueEntry> collect() {
  std::vector<CatalogueEntry> all;
  std::ranges::move(horizons(), std::back_inserter(all));
  std::ranges::move(optimal_control(), std::back_inserter(all));
  std::ranges::move(hock_schittkowski(), std::back_inserter(all));
  std::ranges::sort(all, {}, &CatalogueEntry::name);
  return all;
}

}  // namespace

const std::vector<CatalogueEntry>& catalogue() {
  static const std::vector<CatalogueEntry> all = collect();
  return all;
}

const CatalogueEntry& find_problem(const std::string& name) {
  const auto& all = catalogue();
  const auto found = std::ranges::find(all, name, &CatalogueEntry::name);
  if (found != all.end()) return *found;

  std::vector<std::string> names;
  std::ranges::transform(all, std::back_inserter(names), &CatalogueEntry::name);
  throw std::invalid_argument("unknown problem \"" + name + "\", did you mean \"" + nearest_name(name, names) + "\"?");
}

}  // namespace tenon
