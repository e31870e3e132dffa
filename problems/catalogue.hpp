// The built-in nonlinear programs by name: what `tenon list problems` shows, `tenon solve NAME` solves and every law is tested on.
//
// To add one: write it as an Nlp (or a fixed-size problem lifted by AsNlp) and give it a line in catalogue.cpp.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tenon/core/nlp.hpp"

namespace tenon {

struct CatalogueEntry {
  std::string name;                           // as on the command line
  std::string description;                    // one line
  std::optional<double> published_objective;  // at the known solution, where one was published
  std::function<std::unique_ptr<Nlp>()> make;
};

/// Every built-in problem, sorted by name.
const std::vector<CatalogueEntry>& catalogue();

/// The entry of that name; throws std::invalid_argument with the nearest known name where there is none.
const CatalogueEntry& find_problem(const std::string& name, const std::vector<CatalogueEntry>& among = catalogue());

}  // namespace tenon
