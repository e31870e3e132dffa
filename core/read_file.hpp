// A whole text file in memory, or an InputError that says why not.
#pragma once

#include <string>

namespace tenon {

/// Throws InputError where the file is not there, is a folder, or cannot be read.
std::string read_file(const std::string& path);

}  // namespace tenon
