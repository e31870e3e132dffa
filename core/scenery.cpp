#include "tenon/core/scenery.hpp"

#include <charconv>

#include "tenon/core/output_file.hpp"

namespace tenon {

namespace {

std::string quoted(const std::string& text) {
  static constexpr char kHex[] = "0123456789abcdef";
  std::string out = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') out += '\\';
    if (byte < 0x20)
      out.append("\\u00").append(1, kHex[byte >> 4]).append(1, kHex[byte & 15]);
    else
      out += c;
  }
  return out + "\"";
}

/// The shortest text that reads back as the same number.
std::string json_of(double value) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}
std::string json_of(const SceneryValue& value) { return value.json(); }
std::string json_of(const std::string& text) { return quoted(text); }
std::string json_of(const SceneryShape& shape) { return shape.json(); }

template <class List>
std::string json_list(const List& list);
std::string json_of(const Eigen::Vector3d& v) { return json_list(v); }
std::string json_of(const Eigen::Vector2d& v) { return json_list(v); }
std::string json_of(const SceneryPlot::Band& band);
std::string json_of(const SceneryPlot::Foresight& foresight);

template <class List>
std::string json_list(const List& list) {
  std::string text = "[";
  for (const auto& item : list) text += (text.size() > 1 ? ", " : "") + json_of(item);
  return text + "]";
}

/// An object, member by member.
class Object {
 public:
  Object& set(const char* key, const std::string& json) {
    text_ += (text_.empty() ? "" : ", ") + quoted(key) + ": " + json;
    return *this;
  }
  std::string json() const { return "{" + text_ + "}"; }

 private:
  std::string text_;
};

Object& set_point(Object& object, const SceneryPoint& point) {
  if (!point.body.empty()) object.set("body", quoted(point.body));
  return object.set("at", json_list(point.at));
}

std::string json_of(const SceneryBody& body) {
  Object object;
  object.set("name", quoted(body.name));
  if (!body.parent.empty()) object.set("parent", quoted(body.parent));
  object.set("position", json_list(body.position));
  if (body.quaternion) object.set("quaternion", json_list(*body.quaternion));
  if (body.angle) object.set("axis", json_of(body.axis)).set("angle", body.angle->json());
  object.set("shapes", json_list(body.shapes));
  if (body.trail) object.set("trail", "true");
  if (body.outline) object.set("outline", "true");
  return object.json();
}

std::string json_of(const SceneryLink& link) {
  static constexpr const char* kKinds[] = {"rod", "rope", "spring"};
  Object from, to;
  return Object()
      .set("kind", quoted(kKinds[static_cast<int>(link.kind)]))
      .set("from", set_point(from, link.from).json())
      .set("to", set_point(to, link.to).json())
      .json();
}

std::string json_of(const SceneryArrow& arrow) {
  static constexpr const char* kKinds[] = {"force", "torque", "velocity"};
  Object object;
  object.set("name", quoted(arrow.name)).set("kind", quoted(kKinds[static_cast<int>(arrow.kind)]));
  set_point(object, arrow.at);
  if (arrow.sum.empty())
    object.set("vector", json_list(arrow.vector));
  else
    object.set("sum", json_list(arrow.sum));
  if (!arrow.frame.empty()) object.set("frame", quoted(arrow.frame));
  return object.json();
}

std::string json_of(const SceneryGhosts& ghosts) {
  Object object;
  object.set("body", quoted(ghosts.body)).set("count", std::to_string(ghosts.count)).set("position", json_list(ghosts.position));
  if (ghosts.angle) object.set("angle", ghosts.angle->json());
  return object.json();
}

std::string json_of(const SceneryEllipse& ellipse) {
  return Object().set("body", quoted(ellipse.body)).set("at", json_of(ellipse.at)).set("covariance", json_list(ellipse.covariance)).json();
}

std::string json_of(const SceneryLens& lens) {
  return Object()
      .set("name", quoted(lens.name))
      .set("body", quoted(lens.body))
      .set("at", json_of(lens.at))
      .set("extent", json_of(lens.extent))
      .json();
}

std::string json_of(const SceneryEstimate::Axis& axis) {
  Object object;
  object.set("title", quoted(axis.title)).set("unit", quoted(axis.unit)).set("mean", quoted(axis.mean));
  if (!axis.truth.empty()) object.set("truth", quoted(axis.truth));
  return object.json();
}

std::string json_of(const SceneryEstimate& estimate) {
  return Object()
      .set("title", quoted(estimate.title))
      .set("across", json_of(estimate.across))
      .set("upward", json_of(estimate.upward))
      .set("covariance", json_list(estimate.covariance))
      .json();
}

std::string json_of(const SceneryPlot::Band& band) {
  return Object().set("mean", quoted(band.mean)).set("variance", quoted(band.variance)).json();
}

std::string json_of(const SceneryPlot::Foresight& foresight) {
  return Object()
      .set("columns", quoted(foresight.columns))
      .set("count", std::to_string(foresight.count))
      .set("step", json_of(foresight.step))
      .json();
}

std::string json_of(const SceneryPlot& plot) {
  Object object;
  object.set("title", quoted(plot.title)).set("unit", quoted(plot.unit)).set("columns", json_list(plot.columns));
  const auto limit = [](const std::optional<double>& value) { return value ? json_of(*value) : std::string("null"); };
  if (plot.lower || plot.upper) object.set("limits", "[" + limit(plot.lower) + ", " + limit(plot.upper) + "]");
  if (!plot.bands.empty()) object.set("bands", json_list(plot.bands));
  if (!plot.foresights.empty()) object.set("foresights", json_list(plot.foresights));
  return object.json();
}

/// One item on each line, for those who read the file.
template <class List>
std::string json_lines(const List& list) {
  std::string text;
  for (const auto& item : list) text += (text.empty() ? "\n    " : ",\n    ") + json_of(item);
  return "[" + text + "]";
}

}  // namespace

std::string SceneryValue::json() const {
  if (column_.empty()) return json_of(number_);
  if (coefficients_.empty()) return quoted(column_);
  return Object().set("column", quoted(column_)).set("polynomial", json_list(coefficients_)).json();
}

SceneryShape SceneryShape::disc(double radius) {
  return SceneryShape(Object().set("disc", Object().set("radius", json_of(radius)).json()).json());
}
SceneryShape SceneryShape::sphere(double radius) {
  return SceneryShape(Object().set("sphere", Object().set("radius", json_of(radius)).json()).json());
}
SceneryShape SceneryShape::box(const Eigen::Vector3d& size) {
  return SceneryShape(Object().set("box", Object().set("size", json_of(size)).json()).json());
}
SceneryShape SceneryShape::polygon(const std::vector<Eigen::Vector2d>& corners) {
  return SceneryShape(Object().set("polygon", Object().set("points", json_list(corners)).json()).json());
}
SceneryShape SceneryShape::capsule(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double radius) {
  return SceneryShape(
      Object().set("capsule", Object().set("from", json_of(from)).set("to", json_of(to)).set("radius", json_of(radius)).json()).json());
}
SceneryShape SceneryShape::cylinder(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double radius) {
  return SceneryShape(
      Object().set("cylinder", Object().set("from", json_of(from)).set("to", json_of(to)).set("radius", json_of(radius)).json()).json());
}
SceneryShape SceneryShape::line(const std::vector<Eigen::Vector3d>& points) {
  return SceneryShape(Object().set("line", Object().set("points", json_list(points)).json()).json());
}
SceneryShape SceneryShape::half_space(const Eigen::Vector3d& normal, const Eigen::Vector3d& point) {
  return SceneryShape(Object().set("half-space", Object().set("normal", json_of(normal)).set("point", json_of(point)).json()).json());
}

SceneryShape SceneryShape::with(const std::string& member) const {
  return SceneryShape(json_.substr(0, json_.size() - 1) + ", " + member + "}");
}
SceneryShape SceneryShape::at(const Eigen::Vector3d& position, double angle, const Eigen::Vector3d& axis) const {
  const SceneryShape placed = with("\"at\": " + json_of(position));
  return angle == 0 ? placed : placed.with("\"axis\": " + json_of(axis) + ", \"angle\": " + json_of(angle));
}
SceneryShape SceneryShape::colored(const std::string& color) const {
  return with("\"color\": " + quoted(color));
}

std::string Scenery::json() const {
  std::string text = "{\n  \"schema\": 1,\n  \"title\": " + quoted(title) + ",\n  \"space\": " +
                     (space == Space::planar ? "\"planar\"" : "\"spatial\"");
  if (up) text += ",\n  \"up\": " + json_of(*up);
  Object camera;
  if (camera_direction) camera.set("direction", json_of(*camera_direction));
  if (camera_target) camera.set("target", json_of(*camera_target));
  if (!camera_follows.empty()) camera.set("follow", quoted(camera_follows));
  if (extent) camera.set("extent", json_of(*extent));
  if (camera_direction || camera_target || !camera_follows.empty() || extent) text += ",\n  \"camera\": " + camera.json();
  text += ",\n  \"bodies\": " + json_lines(bodies) + ",\n  \"links\": " + json_lines(links) + ",\n  \"arrows\": " + json_lines(arrows);
  if (!ghosts.empty()) text += ",\n  \"ghosts\": " + json_lines(ghosts);
  if (!ellipses.empty()) text += ",\n  \"ellipses\": " + json_lines(ellipses);
  if (!lenses.empty()) text += ",\n  \"lenses\": " + json_lines(lenses);
  if (!estimates.empty()) text += ",\n  \"estimates\": " + json_lines(estimates);
  text += ",\n  \"plots\": " + json_lines(plots);
  return text + "\n}\n";
}

std::string scenery_path(const std::string& record) {
  return (record.ends_with(".csv") ? record.substr(0, record.size() - 4) : record) + ".scene.json";
}

void write_scenery(const Scenery& scenery, const std::string& record) {
  if (!record.ends_with(".csv")) return;
  OutputFile file(scenery_path(record));
  file.append(scenery.json());
  file.finish();
}

}  // namespace tenon
