// Lists on the command line, separated by commas: "ipopt,newton-kkt", "0.1,0,-0.2".
#pragma once

#include <string>
#include <vector>

namespace tenon {

std::vector<std::string> split_list(const std::string& text);

/// Throws std::invalid_argument, naming the flag, where an entry is no finite number or there are not `size` of them.
std::vector<double> parse_numbers(const std::string& flag, const std::string& text, std::size_t size);

}  // namespace tenon
