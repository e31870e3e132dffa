// The known name nearest to one that nobody knows, for error messages: "unknown solver \"ipop\", did you mean \"ipopt\"?"
//
// Nearest in the edit distance: the fewest insertions, deletions and replacements of one character [Levenshtein 1966].
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace tenon {

/// Insertions, deletions and replacements that turn one string into the other.
int edit_distance(std::string_view a, std::string_view b);

/// The first of the known names with the smallest edit distance; empty where none is known.
std::string nearest_name(const std::string& name, const std::vector<std::string>& known);

}  // namespace tenon
