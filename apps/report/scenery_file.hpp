// The scenery of a record, read and checked: scenery.md describes the file.
#pragma once

#include <optional>

#include "tenon/apps/json.hpp"
#include "tenon/core/csv.hpp"

namespace tenon {

/// The scenery that lies beside the record; nothing where none does. Throws InputError where it is no JSON, names a column that the record
/// does not have, a body or an arrow that is not there, or a shape that is not known.
std::optional<Json> read_scenery(const CsvTable& record);

}  // namespace tenon
