// tenon robot ROBOT: the kinematics and statics of a delta robot, asked for one pose or mapped over its workspace.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "tenon/apps/comma_list.hpp"
#include "tenon/apps/impedance.hpp"
#include "tenon/apps/json.hpp"
#include "tenon/apps/verb.hpp"
#include "tenon/core/csv.hpp"
#include "tenon/problems/delta/dynamics.hpp"
#include "tenon/problems/delta/robot_file.hpp"
#include "tenon/problems/delta/workspace_map.hpp"

namespace tenon {

namespace {

using namespace delta;

constexpr int kDivisions = 20;           // of the reach, for the workspace map
constexpr double kAtSingularity = 1e-6;  // a measure below this: the pose is at the singularity
constexpr double kNearSingularity = 1e-2;

struct Pose {
  Vector9 q;
  Configuration at;
};

Vector3 parse_vector(const std::string& flag, const std::string& text) {
  const std::vector<double> numbers = parse_numbers(flag, text, 3);
  return {numbers[0], numbers[1], numbers[2]};
}

std::string text_of(const Vector3& v) {
  return fmt::format("({:.6g}, {:.6g}, {:.6g})", v[0], v[1], v[2]);
}

Pose pose_of_wrist(const Robot& robot, const Vector3& z) {
  const Inverse inverse = inverse_kinematics(robot, z);
  if (!inverse.ok()) {
    throw std::invalid_argument(
        fmt::format("--inverse {} is out of reach of arm {}, {:.6g} m from the workspace (expected a point that all arms reach, "
                    "on the axis z up to {:.6g} m)",
                    text_of(z), inverse.unreachable_arm + 1, distance_to_workspace(robot, z), axial_reach(robot)));
  }
  return {inverse.q, Configuration(inverse.q)};
}

Pose pose_of_motors(const Robot& robot, const Vector3& y) {
  const Forward forward = forward_kinematics(robot, y);
  switch (forward.status) {
    case ForwardStatus::solved:
      return {angles(forward.at), forward.at};
    case ForwardStatus::unreachable:
      throw std::invalid_argument(
          fmt::format("--forward {}: the elbows are too far apart for the distal links to meet (expected angles of a "
                      "closed robot)",
                      text_of(y)));
    default:
      throw std::invalid_argument(
          fmt::format("--forward {} is at a singularity of type II: the wrist lies in the plane of the elbows, or "
                      "the elbows on a line (expected angles that determine the wrist)",
                      text_of(y)));
  }
}

/// Where the pose is at a singularity the Jacobians have no meaning; near one, or where nobody asks for them, a warning does.
void check_singularity(const Singularity& measure, bool jacobians, bool quiet) {
  const std::array<std::pair<double, const char*>, 3> kinds{
      {{measure.type_1, "type I: an arm is stretched or folded (|b|/l1 = {:.3g})"},
       {measure.type_2, "type II: the wrist lies in the plane of the elbows (|det A| = {:.3g})"},
       {measure.s2, "the angles: a distal link points along its arm's radial axis (sin q2 = {:.3g})"}}};
  for (const auto& [value, what] : kinds) {
    const std::string text = fmt::format(fmt::runtime(what), value);
    if (jacobians && value < kAtSingularity) {
      throw std::invalid_argument("the pose is at a singularity of " + text + " (expected a pose where the Jacobians are regular)");
    }
    if (value < kNearSingularity && !quiet) {
      fmt::print(stderr, "tenon: the pose is {} a singularity of {}\n", value < kAtSingularity ? "at" : "near", text);
    }
  }
}

template <class Matrix>
Json rows(const Matrix& m) {
  Json list = Json::array();
  for (Eigen::Index r = 0; r < m.rows(); ++r) list.push(Json(Vector(m.row(r).transpose())));
  return list;
}

template <class Matrix>
void print_rows(const char* name, const Matrix& m) {
  for (Eigen::Index r = 0; r < m.rows(); ++r) {
    std::string line;
    for (Eigen::Index c = 0; c < m.cols(); ++c) line += fmt::format("{:13.6g}", m(r, c));
    fmt::print("  {:<16}{}\n", r == 0 ? name : "", line);
  }
}

Matrix3 by_arms(const Vector9& q) {
  Matrix3 table;
  for (int i = 0; i < kArms; ++i) table.row(i) = q.segment<3>(3 * i);
  return table;
}

/// Everything at one pose: printed, or added to the JSON.
void report_pose(const Robot& robot, const Pose& pose, bool jacobians, Json* json, bool quiet) {
  const Vector3 z = wrist_position(robot, pose.at);
  const Motion motion(robot, pose.at);
  const Singularity measure = motion.singularity(robot, pose.at);
  check_singularity(measure, jacobians, quiet);
  if (json) {
    json->set("z", Vector(z)).set("q", rows(by_arms(pose.q)));
    json->set("singularity", Json::object().set("type_1", measure.type_1).set("type_2", measure.type_2).set("s2", measure.s2));
  } else {
    fmt::print("{}\n", robot.name);
    print_rows("wrist z, m", z.transpose().eval());
    print_rows("q by arm, rad", by_arms(pose.q));
    fmt::print("  singularity         type I {:.4g}, type II {:.4g}, angles {:.4g} (0 is at it)\n", measure.type_1, measure.type_2,
               measure.s2);
  }
  if (!jacobians) return;
  const ArmConstants k(robot);
  const Matrix3 exact = reduced_inertia(k, pose.at, motion);
  const Vector3 torque = gravity_torque(k, pose.at, motion);
  const Matrix39 j_v = simulation_jacobian(robot, pose.at);
  if (json) {
    json->set("Jc", rows(motion.jacobian)).set("Jv", rows(j_v)).set("My", rows(exact));
    json->set("My_projected_left", rows(reduced_inertia(k, pose.at, motion, ReducedInertia::projected_left)));
    json->set("gravity_torque", Vector(torque));
    return;
  }
  print_rows("J_c, m", motion.jacobian);
  print_rows("J_v, m", j_v);
  print_rows("M_y, kg m^2", exact);
  print_rows("gravity, N m", torque.transpose().eval());
}

void report_workspace(const Robot& robot, const std::string& file, Json* json, bool quiet) {
  CsvWriter csv(file, {"zx", "zy", "zz", "type_1", "type_2", "s2", "speed_least", "speed_greatest", "gravity_torque"});
  Singularity least{1, 1, 1};
  const double step = map_workspace(robot, kDivisions, [&](const WorkspacePoint& p) {
    csv << p.wrist[0] << p.wrist[1] << p.wrist[2] << p.singularity.type_1 << p.singularity.type_2 << p.singularity.s2 << p.speed_least
        << p.speed_greatest << p.gravity_torque;
    csv.end_row();
    least = {std::min(least.type_1, p.singularity.type_1), std::min(least.type_2, p.singularity.type_2),
             std::min(least.s2, p.singularity.s2)};
  });
  const long points = csv.rows();
  csv.finish();
  const double volume = static_cast<double>(points) * step * step * step;
  if (json) {
    json->set("workspace", Json::object().set("file", file).set("points", points).set("step", step).set("volume", volume));
  } else if (!quiet) {
    fmt::print("{}: {} points {:.4g} m apart, {:.4g} m^3 below the base, to z = {:.6g} m on the axis\n", robot.name, points, step, volume,
               axial_reach(robot));
    fmt::print("  nearest to a singularity: type I {:.3g}, type II {:.3g}, angles {:.3g} (0 is at it)\n", least.type_1, least.type_2,
               least.s2);
  }
}

std::string text_of(const LoopMargins& m) {
  const std::string gain = std::isinf(m.gain) ? "any" : fmt::format("{:.3g}", m.gain);
  return fmt::format("phase {:.3g} deg, gain {}, delay {:.3g} ms, crossover {:.3g} Hz", m.phase, gain, 1e3 * m.delay, m.crossover);
}

Json json_of(const LoopMargins& m) {
  return Json::object().set("phase_deg", m.phase).set("gain", m.gain).set("delay", m.delay).set("crossover", m.crossover);
}

void report_impedance(const std::string& robot, const std::string& file, Json* json, bool quiet) {
  CsvWriter csv(file, {"frequency", "impedance_off", "impedance_on", "linear_off", "linear_on", "wrist_off", "wrist_on"});
  const ImpedanceCurve curve = measure_impedance(robot, {});
  double least = 1, wrist_most = 1;
  double lowest = 0, highest = 0;  // of the band where the loop softens
  for (const ImpedancePoint& p : curve.points) {
    csv << p.frequency << p.off << p.on << p.linear_off << p.linear_on << p.wrist_off << p.wrist_on;
    csv.end_row();
    least = std::min(least, p.on / p.off);
    wrist_most = std::max(wrist_most, p.wrist_on / p.wrist_off);
    if (p.on >= p.off) continue;
    if (lowest == 0) lowest = p.frequency;
    highest = p.frequency;
  }
  csv.finish();
  if (json) {
    json->set("impedance", Json::object()
                               .set("file", file)
                               .set("least_ratio", least)
                               .set("softer_from", lowest)
                               .set("softer_to", highest)
                               .set("wrist_most_ratio", wrist_most)
                               .set("margins", json_of(curve.margins))
                               .set("margins_delayed_2ms", json_of(curve.margins_delayed)));
  } else if (!quiet) {
    fmt::print(
        "delta-grasp with {}: |F/v| at the part is lower with the tactile loop between {:.3g} and {:.3g} Hz, at best {:.3g} of what it is "
        "without\n",
        robot, lowest, highest, least);
    fmt::print("  pushed at the wrist itself it is up to {:.3g} times as high\n", wrist_most);
    fmt::print("  margins          {}\n  with 2 ms delay  {}\n", text_of(curve.margins), text_of(curve.margins_delayed));
  }
}

void report_robot(const Robot& robot, Json* json) {
  if (json) {
    json->set("reach", reach(robot)).set("axial_reach", axial_reach(robot));
    return;
  }
  fmt::print("{}: reaches z = {:.6g} m on the axis\n{}", robot.name, axial_reach(robot), to_toml(robot));
}

}  // namespace

int run_robot(const Arguments& arguments) {
  if (arguments.inverse && arguments.forward) throw std::invalid_argument("robot: --inverse and --forward both name a pose (expected one)");
  if (arguments.jacobians && !arguments.inverse && !arguments.forward) {
    throw std::invalid_argument("robot: --jacobians of which pose? (expected --inverse x,y,z or --forward q1,q2,q3)");
  }
  const Robot robot = load_robot(arguments.names.front(), arguments.set);
  Json json = Json::object();
  json.set("schema", 1).set("robot", robot.name);
  Json* const out = arguments.json ? &json : nullptr;
  for (const std::string& file : {arguments.workspace, arguments.impedance}) {
    if (!file.empty()) check_output_path(file);
  }
  if (arguments.inverse || arguments.forward) {
    const Pose pose = arguments.inverse ? pose_of_wrist(robot, parse_vector("--inverse", *arguments.inverse))
                                        : pose_of_motors(robot, parse_vector("--forward", *arguments.forward));
    report_pose(robot, pose, arguments.jacobians, out, arguments.quiet);
  } else if (arguments.workspace.empty() && arguments.impedance.empty()) {
    report_robot(robot, out);
  }
  if (!arguments.workspace.empty()) report_workspace(robot, arguments.workspace, out, arguments.quiet);
  if (!arguments.impedance.empty()) report_impedance(arguments.names.front(), arguments.impedance, out, arguments.quiet);
  if (out) print(json);
  return kFinished;
}

}  // namespace tenon
