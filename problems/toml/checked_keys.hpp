// What the readers of scene files share: keys with the range that makes sense, and short ways to override them.
#pragma once

#include <string>
#include <vector>

#include "tenon/problems/toml/document.hpp"

namespace tenon {

/// All throw InputError with the place of what is wrong.
toml_file::Table required_table(const toml_file::Table& root, const std::string& key, const std::vector<std::string>& known_keys);
double positive(const toml_file::Table& table, const std::string& key, double fallback);
double not_negative(const toml_file::Table& table, const std::string& key, double fallback);
int positive_integer(const toml_file::Table& table, const std::string& key, int fallback);
/// [centre, deviation] of what is believed, both more than 0; `centre` says in messages what the first is: "mean", "median".
Eigen::Vector2d centre_and_deviation(const toml_file::Table& table, const std::string& key, const std::string& centre);

/// Overrides in which NAME=VALUE has become parameters.NAME=VALUE; with a dot, or named as one of the root keys, it is a path in the file.
std::vector<std::string> with_parameters(std::vector<std::string> overrides, const std::vector<std::string>& root_keys = {});

}  // namespace tenon
