// What --report FILE.html asks of a verb: check_report() before the work, make_report() once the records are on the disk.
#pragma once

#include <string>
#include <vector>

#include "tenon/apps/arguments.hpp"

namespace tenon {

/// Throws InputError where the page could not be written, so that a long job does not find out at its end.
void check_report(const Arguments& arguments);

/// Where a record goes for which nobody named a file: hover.html has hover.csv beside it; `otherwise` where no report is asked for.
std::string record_beside_report(const Arguments& arguments, const std::string& extension, const std::string& otherwise);

/// Writes the page, if one is asked for, and says so in the log. `files` as for write_report.
void make_report(const Arguments& arguments, const std::vector<std::string>& files);

}  // namespace tenon
