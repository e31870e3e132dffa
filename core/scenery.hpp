// What a record's picture is made of: bodies with shapes, links and arrows, placed by the columns of the record.
//
// It lies beside the record (run.csv has run.scene.json), so that a new robot or task is drawn without touching what draws it. Wherever a
// number stands a column of the record may stand instead, or a polynomial in one. apps/report/scenery.md describes the file.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tenon/core/eigen.hpp"

namespace tenon {

/// A number, the name of a column, or a polynomial in a column.
class SceneryValue {
 public:
  SceneryValue(double number = 0) : number_(number) {}
  SceneryValue(int number) : number_(number) {}  // so that a plain 0 is a number
  SceneryValue(const char* column) : column_(column) {}
  SceneryValue(std::string column) : column_(std::move(column)) {}
  /// c_0 + c_1 v + c_2 v^2 + ... of the column's value v.
  SceneryValue(std::string column, std::vector<double> coefficients) : column_(std::move(column)), coefficients_(std::move(coefficients)) {}

  std::string json() const;

 private:
  double number_ = 0;
  std::string column_;
  std::vector<double> coefficients_;
};

using SceneryVector = std::array<SceneryValue, 3>;  // m; a planar scene leaves the third at 0
inline SceneryVector scenery_vector(const Eigen::Vector3d& v) { return {v[0], v[1], v[2]}; }

/// A shape in the axes of its body; lengths in m. Planar scenes have no cylinder.
class SceneryShape {
 public:
  static SceneryShape disc(double radius);    // in the plane z = 0, with a radius drawn to show how it turns
  static SceneryShape sphere(double radius);
  static SceneryShape box(const Eigen::Vector3d& size);
  static SceneryShape polygon(const std::vector<Eigen::Vector2d>& corners);
  static SceneryShape capsule(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double radius);
  static SceneryShape cylinder(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double radius);
  static SceneryShape line(const std::vector<Eigen::Vector3d>& points);
  /// All that lies against the normal (outward, any length) from the point on.
  static SceneryShape half_space(const Eigen::Vector3d& normal, const Eigen::Vector3d& point = Eigen::Vector3d::Zero());

  /// Where the shape stands in its body, turned by the angle (rad) about the axis.
  SceneryShape at(const Eigen::Vector3d& position, double angle = 0, const Eigen::Vector3d& axis = Eigen::Vector3d::UnitZ()) const;
  /// "ground", "link", "frame", "arm", "rotor", "force", or "#rrggbb"; else every body has a colour of its own.
  SceneryShape colored(const std::string& color) const;

  const std::string& json() const { return json_; }

 private:
  explicit SceneryShape(std::string json) : json_(std::move(json)) {}
  SceneryShape with(const std::string& member) const;

  std::string json_;
};

struct SceneryBody {
  std::string name = {};
  std::string parent = {};  // the body, named earlier, in whose axes this one is placed; empty for the world
  SceneryVector position = {};
  std::optional<SceneryValue> angle = {};                     // rad, about the axis
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();
  std::optional<std::array<SceneryValue, 4>> quaternion = {};  // w, x, y, z, to the parent's axes; in place of the angle
  std::vector<SceneryShape> shapes = {};
  bool trail = false;    // its path is drawn
  bool outline = false;  // it is not there but believed to be: outlines alone, planar scenes
};

/// A point of a body, or of the world where no body is named.
struct SceneryPoint {
  std::string body = {};
  SceneryVector at = {};
};

struct SceneryLink {
  enum class Kind { rod, rope, spring };
  Kind kind = Kind::rod;
  SceneryPoint from = {}, to = {};
};

struct SceneryArrow {
  enum class Kind { force, torque, velocity };
  std::string name = {};
  Kind kind = Kind::force;
  SceneryPoint at = {};
  SceneryVector vector = {};          // N, N m or m/s, in the axes of the frame
  std::string frame = {};             // a body, or "world"; where it is not said, the body of the point
  std::vector<std::string> sum = {};  // names of earlier arrows: this one is their sum, `vector` is not read
};

/// Where a plan has a body at the ends of its intervals: its outlines, the fainter the farther ahead. A # in a column's name stands for
/// 1 .. count. Planar scenes.
struct SceneryGhosts {
  std::string body = {};
  int count = 0;
  SceneryVector position = {};
  std::optional<SceneryValue> angle = {};  // rad
};

/// How surely a point of a body is known, as ellipses of one and two standard deviations. Planar scenes.
struct SceneryEllipse {
  std::string body = {};
  Eigen::Vector2d at = Eigen::Vector2d::Zero();    // m
  std::array<SceneryValue, 6> covariance = {};     // of the body's x, y (m) and angle (rad): the lower triangle, column by column
};

/// A square about a point of a body, seen enlarged. Planar scenes.
struct SceneryLens {
  std::string name = {};
  std::string body = {};
  Eigen::Vector2d at = Eigen::Vector2d::Zero();  // m
  double extent = 0;                             // m
};

/// Two quantities that are estimated together, drawn across one another: mean, ellipses of one and two standard deviations, truth.
struct SceneryEstimate {
  struct Axis {
    std::string title = {}, unit = {};
    std::string mean = {}, truth = {};  // columns; no truth where the record does not have it
  };
  std::string title = {};
  Axis across = {}, upward = {};
  std::array<std::string, 3> covariance = {};  // columns: across^2, across upward, upward^2
};

/// Columns that share a plot; what is not asked for is grouped by the columns' names.
struct SceneryPlot {
  /// Two standard deviations to either side of a mean.
  struct Band {
    std::string mean = {}, variance = {};  // columns
  };
  /// What a plan has ahead of the plot's time: columns with a # for 1 .. count, `step` (s) apart.
  struct Foresight {
    std::string columns = {};
    int count = 0;
    double step = 0;
  };
  std::string title = {};
  std::string unit = {};
  std::vector<std::string> columns = {};
  std::optional<double> lower = {}, upper = {};  // limits, drawn as lines
  std::vector<Band> bands = {};
  std::vector<Foresight> foresights = {};
};

struct Scenery {
  enum class Space { planar, spatial };
  std::string title = {};
  Space space = Space::planar;
  std::optional<Eigen::Vector3d> up = {};                // else y in the plane, z in space
  std::optional<Eigen::Vector3d> camera_direction = {};  // from what is seen to the eye, spatial scenes
  std::optional<Eigen::Vector3d> camera_target = {};     // what stands in the middle, else the middle of the whole run
  std::string camera_follows = {};                       // a body that stays in the middle
  std::optional<double> extent = {};                     // m: the size of what is seen, else that of the whole run
  std::vector<SceneryBody> bodies = {};
  std::vector<SceneryLink> links = {};
  std::vector<SceneryArrow> arrows = {};
  std::vector<SceneryGhosts> ghosts = {};
  std::vector<SceneryEllipse> ellipses = {};
  std::vector<SceneryLens> lenses = {};
  std::vector<SceneryEstimate> estimates = {};
  std::vector<SceneryPlot> plots = {};

  std::string json() const;
};

/// Where the scenery of a record lies: run.csv has run.scene.json.
std::string scenery_path(const std::string& record);

/// Writes it there, where the record is a .csv file; a pipe or a device has nothing beside it. Throws OutputError.
void write_scenery(const Scenery& scenery, const std::string& record);

}  // namespace tenon
