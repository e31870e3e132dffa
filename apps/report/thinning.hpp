// Which rows of a long record a page carries: whole rows, bit for bit, so that what is drawn was there.
//
// The rows are cut into intervals of equal length; of each interval the first row is kept and, for every column of numbers, the row of its
// least and that of its greatest value. Kept as well: the rows on both sides of every change of a mode or text, those around every event,
// and the last. A spike one row wide is drawn at its full height, whatever the length of the record.
#pragma once

#include <vector>

#include "tenon/core/csv.hpp"

namespace tenon {

/// The kept rows in order; all of them where rows times columns is at most `max_values`, else about max_values / columns.
/// `event_times`: in the unit of the column t, ascending.
std::vector<int> thinned_rows(const CsvTable& record, const std::vector<double>& event_times, std::size_t max_values);

}  // namespace tenon
