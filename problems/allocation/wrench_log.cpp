#include "tenon/problems/allocation/wrench_log.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>

#include "tenon/core/csv.hpp"
#include "tenon/core/read_file.hpp"

namespace tenon {

namespace {

constexpr double kQuaternionTolerance = 1e-6;
constexpr double kSingleRowStep = 1.0 / 240;  // dt of a log of one row with a time but no interval

const std::vector<std::string> kWrenchNames{"Fx", "Fy", "Fz", "Mx", "My", "Mz"};
const std::vector<std::string> kQuaternionNames{"qw", "qx", "qy", "qz"};

/// Fills t and dt of every row.
void read_times(const CsvTable& table, std::vector<WrenchRow>& rows) {
  const std::vector<double>* t = table.find("t");
  const std::vector<double>* dt = table.find("dt");
  if (t == nullptr && dt == nullptr) {
    throw InputError({table.file, 1, 1}, "neither column 't' nor 'dt' is there", "the time t or the interval dt, in s");
  }
  for (std::size_t k = 0; k < rows.size(); ++k) {
    WrenchRow& row = rows[k];
    const InputPosition position{table.file, table.lines[k], 0};
    if (t != nullptr) {
      row.t = (*t)[k];
      row.dt = k == 0 ? 0 : row.t - rows[k - 1].t;
      if (k > 0 && !(row.dt > 0))
        throw InputError(position, fmt::format("t goes from {} to {} s", rows[k - 1].t, row.t), "a time that advances");
    } else {
      row.dt = (*dt)[k];
      if (!(row.dt > 0)) throw InputError(position, fmt::format("dt is {} s", row.dt), "more than 0");
      row.t = k == 0 ? 0 : rows[k - 1].t + row.dt;
    }
  }
  if (t != nullptr) rows[0].dt = rows.size() > 1 ? rows[1].dt : kSingleRowStep;
}

/// Whether the log has orientations; an incomplete quaternion is an error.
bool has_quaternion(const CsvTable& table) {
  std::size_t count = 0;
  std::string missing;
  for (const std::string& name : kQuaternionNames) {
    if (table.has(name))
      ++count;
    else
      missing = name;
  }
  if (count != 0 && count != kQuaternionNames.size()) {
    throw InputError({table.file, 1, 1}, "the quaternion lacks column '" + missing + "'", "all of qw, qx, qy, qz or none");
  }
  return count != 0;
}

std::vector<WrenchRow> wrench_rows(const CsvTable& table) {
  std::vector<WrenchRow> rows(static_cast<std::size_t>(table.rows()));
  read_times(table, rows);
  for (int i = 0; i < 6; ++i) {
    const std::vector<double>& values = table[kWrenchNames[static_cast<std::size_t>(i)]];
    for (std::size_t k = 0; k < rows.size(); ++k) rows[k].wrench[i] = values[k];
  }
  if (!has_quaternion(table)) return rows;

  const auto &w = table["qw"], &x = table["qx"], &y = table["qy"], &z = table["qz"];
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const Eigen::Quaterniond q(w[k], x[k], y[k], z[k]);
    if (!(std::abs(q.norm() - 1) <= kQuaternionTolerance)) {
      throw InputError({table.file, table.lines[k], 0}, fmt::format("the quaternion has length {:.9g}", q.norm()), "length 1");
    }
    // W_body = [ R(q)' F ; R(q)' M ]
    const Eigen::Matrix3d R_body_world = q.normalized().toRotationMatrix().transpose();
    rows[k].wrench.head<3>() = (R_body_world * rows[k].wrench.head<3>()).eval();
    rows[k].wrench.tail<3>() = (R_body_world * rows[k].wrench.tail<3>()).eval();
  }
  return rows;
}

}  // namespace

std::vector<WrenchRow> parse_wrench_log(std::string_view text, const std::string& file) {
  return wrench_rows(parse_csv(text, file, {kWrenchNames, {"t", "dt", "qw", "qx", "qy", "qz"}}));
}

std::vector<WrenchRow> read_wrench_log(const std::string& file) {
  return parse_wrench_log(read_file(file), file);
}

}  // namespace tenon
