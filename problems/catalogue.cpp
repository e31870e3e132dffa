#include "tenon/problems/catalogue.hpp"

#include <algorithm>
#include <iterator>
#include <stdexcept>

#include "tenon/core/nearest_name.hpp"
#include "tenon/problems/classic/hock_schittkowski.hpp"
#include "tenon/problems/optimal_control/linear_quadratic.hpp"
#include "tenon/problems/optimal_control/swing_up.hpp"

namespace tenon {

namespace {

std::vector<CatalogueEntry> optimal_control() {
  return {
      {"cart-pole", "swing-up of a pole on a cart in 5 s, N = 100 (n = 504, m = 400)", 11181.3177,
       [] { return std::make_unique<SwingUp>(cart_pole()); }},
      {"lq", "a chain of masses and springs, 12 states, 6 boxed inputs, N = 20 (n = 372, m = 240)", std::nullopt,
       [] { return std::make_unique<LinearQuadratic<Dynamic, Dynamic>>(mass_spring_chain(12, 6, 20)); }},
      {"pendulum", "swing-up of a pendulum in 1 s by tracking, N = 20 (n = 104, m = 80)", 2242.828131,
       [] { return std::make_unique<SwingUp>(pendulum()); }},
  };
}

std::vector<CatalogueEntry> collect() {
  std::vector<CatalogueEntry> all;
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

const CatalogueEntry& find_problem(const std::string& name, const std::vector<CatalogueEntry>& among) {
  const auto found = std::ranges::find(among, name, &CatalogueEntry::name);
  if (found != among.end()) return *found;

  std::vector<std::string> names;
  std::ranges::transform(among, std::back_inserter(names), &CatalogueEntry::name);
  throw std::invalid_argument("unknown problem \"" + name + "\", did you mean \"" + nearest_name(name, names) + "\"?");
}

}  // namespace tenon
