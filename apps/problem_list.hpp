// Every built-in problem: those of the catalogue, and every scene to plan as the nonlinear program that collocation makes of it.
//
// A scene whose name the catalogue has in another transcription is NAME/collocation.
#pragma once

#include <vector>

#include "tenon/problems/catalogue.hpp"

namespace tenon {

/// Sorted by name.
const std::vector<CatalogueEntry>& problem_list();

}  // namespace tenon
