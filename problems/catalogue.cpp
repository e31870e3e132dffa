#include "tenon/problems/catalogue.hpp"

#include <algorithm>
#include <iterator>
#include <stdexcept>

#include "tenon/core/nearest_name.hpp"
#include "tenon/problems/classic/hock_schittkowski.hpp"

namespace tenon {

namespace {

std::vector<CatalogueEntry> collect() {
  std::vector<CatalogueEntry> all;
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
