// The report page: one HTML file, made from records alone, that opens in any browser without a network.
//
//     run.csv         a trajectory, or a comparison, a profile, a sweep, a map over directions: told by its columns (record_table.hpp)
//     run.scene.json  beside it, its scenery (scenery.md)
//     run.jsonl       the iterations of a solve
//
// Events and fast phases belong to the trajectory that was named before them.
#pragma once

#include <string>
#include <vector>

namespace tenon {

/// The whole page as text, with the parts in the order of the files. Throws InputError.
std::string report_page(const std::vector<std::string>& files);

/// Writes it. Throws InputError, OutputError.
void write_report(const std::vector<std::string>& files, const std::string& output);

}  // namespace tenon
