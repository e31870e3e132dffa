// tenon envelope VEHICLE: what a vehicle can do in each direction, whole and with each rotor failed, as a map over the sphere and a summary.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "tenon/apps/envelope_map.hpp"
#include "tenon/apps/interrupt.hpp"
#include "tenon/apps/json.hpp"
#include "tenon/apps/make_report.hpp"
#include "tenon/apps/progress.hpp"
#include "tenon/apps/table.hpp"
#include "tenon/apps/verb.hpp"
#include "tenon/core/csv.hpp"
#include "tenon/problems/allocation/vehicle_file.hpp"
#include "tenon/solvers/make_solver.hpp"

namespace tenon {

namespace {

constexpr int kDirections = 10'000;
constexpr const char* kLocalSolver = "newton-kkt";

void write_maps(const std::string& file, const std::vector<Eigen::Vector3d>& grid, const std::vector<EnvelopeMap>& maps) {
  std::vector<std::string> names{"nx", "ny", "nz"};
  for (const EnvelopeMap& map : maps) {
    for (const EnvelopeQuantity& quantity : kEnvelopeQuantities) names.push_back(quantity.name + map.suffix());
  }
  CsvWriter csv(file, names);
  for (std::size_t k = 0; k < grid.size(); ++k) {
    for (const double n : grid[k]) csv << n;
    for (const EnvelopeMap& map : maps) {
      for (const EnvelopeQuantity& quantity : kEnvelopeQuantities) {
        const double value = map.points[k].*quantity.value;
        if (std::isnan(value))
          csv << "";
        else
          csv << value;
      }
    }
    csv.end_row();
  }
  csv.finish();
}

std::string range_text(const EnvelopeRange& range) {
  return range.exists ? fmt::format("{:.4f} to {:.4f}", range.least.value, range.most.value) : "none";
}

/// 100 % only where it is all.
std::string share_text(double share) {
  return share > 0 && share < 1 ? fmt::format("{:.2f} %", std::clamp(100 * share, 0.01, 99.99)) : fmt::format("{:.0f} %", 100 * share);
}

/// Lines that are the same for several maps stand once.
void print_unreachable(const std::vector<EnvelopeMap>& maps) {
  for (const EnvelopeMap& map : maps) {
    if (map.unreachable.empty() || (map.failed >= 0 && map.unreachable == maps.front().unreachable)) continue;
    fmt::print("{}: no command gives {}\n", map.failed < 0 ? "limits aside" : map.title(), fmt::join(map.unreachable, ", "));
  }
}

void print_summary(const std::string& vehicle, std::size_t directions, const std::vector<EnvelopeMap>& maps) {
  fmt::print("{}: {} directions\n", vehicle, directions);
  Table table({"", "can hover", "X1", "X2", "force, N", "torque, N m", "torque at hover, N m"});
  double force_gap = 0, torque_gap = 0;
  long failures = 0;
  bool is_convex = true;
  for (const EnvelopeMap& map : maps) {
    std::vector<std::string> row{map.title(), share_text(map.hover_share)};
    for (const EnvelopeRange& range : map.ranges) row.push_back(range_text(range));
    table.add(row);
    force_gap = std::max(force_gap, map.force_gap());
    torque_gap = std::max(torque_gap, map.torque_gap());
    failures += map.failures;
    is_convex = is_convex && map.is_convex;
  }
  fmt::print("{}", table.text());
  print_unreachable(maps);
  fmt::print("no command gives more than {:.1e} N or {:.1e} N m beyond these\n", force_gap, torque_gap);
  if (!is_convex) {
    fmt::print("the rotors' sets are not convex: each value is the best of three local optima{}\n",
               failures > 0 ? fmt::format(", {} were not found", failures) : "");
  }
}

Json json_of(const EnvelopeMap& map) {
  Json json = Json::object();
  for (std::size_t q = 0; q < kEnvelopeQuantities.size(); ++q) {
    const EnvelopeRange& range = map.ranges[q];
    Json entry = Json::object();
    const auto end = [&](const char* name, const SphereExtreme& extreme) {
      entry.set(name, range.exists ? extreme.value : std::nan(""));
      entry.set(std::string(name) + "_at", range.exists ? Json(Vector(extreme.direction)) : Json(std::nan("")));
    };
    end("min", range.least);
    end("max", range.most);
    json.set(kEnvelopeQuantities[q].name, entry);
  }
  json.set("hover_share", map.hover_share).set("unreachable", map.unreachable).set("convex", map.is_convex);
  json.set("gap", Json::object().set("force", map.force_gap()).set("torque", map.torque_gap())).set("failures", map.failures);
  return json;
}

Json json_of(const std::string& vehicle, std::size_t directions, const std::vector<EnvelopeMap>& maps) {
  Json json = Json::object().set("schema", 1).set("vehicle", vehicle).set("directions", static_cast<long>(directions));
  const Json healthy = json_of(maps.front());
  for (const std::string& key : healthy.keys()) json.set(key, healthy.at(key));
  Json failed = Json::array();
  for (std::size_t k = 1; k < maps.size(); ++k) {
    Json entry = Json::object().set("rotor", maps[k].failed + 1);
    const Json map = json_of(maps[k]);
    for (const std::string& key : map.keys()) entry.set(key, map.at(key));
    failed.push(entry);
  }
  return json.set("failed", failed);
}

}  // namespace

int run_envelope(const Arguments& arguments) {
  const int directions = arguments.rows > 0 ? arguments.rows : kDirections;
  if (directions < kLeastDirections) {
    throw std::invalid_argument(fmt::format("--rows is {} (expected at least {} directions)", directions, kLeastDirections));
  }
  const VehicleFile file = load_vehicle(arguments.names.front(), arguments.set);
  const std::string record = !arguments.output.empty() ? arguments.output : record_beside_report(arguments, ".csv", "");
  if (!record.empty()) check_output_path(record);
  check_report(arguments);
  const std::string solver = arguments.solver.value_or(kLocalSolver);
  const auto make_local_solver = [&](const Nlp& program) { return make_solver(solver, program, arguments.options()); };
  if (!arguments.quiet) {
    for (const std::string& note : file.notes) fmt::print(stderr, "tenon: {}\n", note);
  }

  const std::vector<Eigen::Vector3d> grid = sphere_grid(directions);
  std::vector<EnvelopeMap> maps;
  {
    Progress progress("envelope", (file.vehicle.num_rotors() + 1) * std::ssize(grid), arguments.quiet);
    long done = 0;
    for (int failed = -1; failed < file.vehicle.num_rotors() && !interrupted(); ++failed) {
      maps.push_back(map_envelope(file.vehicle, failed, make_local_solver, grid, [&] {
        progress.update(done++);
        return !interrupted();
      }));
    }
  }
  if (interrupted()) return kInterrupted;
  if (!record.empty()) {
    write_maps(record, grid, maps);
    if (!arguments.report.empty()) make_report(arguments, {record});
  }
  if (arguments.json)
    print(json_of(file.vehicle.name, grid.size(), maps));
  else if (!arguments.quiet)
    print_summary(file.vehicle.name, grid.size(), maps);
  return kFinished;
}

}  // namespace tenon
