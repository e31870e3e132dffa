// A table as the page reads it (page/table.js): numbers as base64 of little-endian floats, texts as a list and their indices.
//
//     {name, rows, kept, columns: [{name, f64 | f32} | {name, constant} | {name, texts, codes}]}
#pragma once

#include <string_view>
#include <vector>

#include "tenon/apps/json.hpp"
#include "tenon/core/csv.hpp"

namespace tenon {

/// The given rows of a table. Double precision where the table is small and for the column `precise`, else single, which keeps 7 digits.
Json table_json(const CsvTable& table, const std::vector<int>& rows, std::string_view precise = "t");

/// All rows.
Json table_json(const CsvTable& table);

}  // namespace tenon
