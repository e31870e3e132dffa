// Bodies, contacts and forces of a scene file; shapes are read in shape_reader.cpp, joints in joint_reader.cpp.
#include "tenon/problems/contact/scene_reader.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "tenon/core/nearest_name.hpp"
#include "tenon/problems/contact/contact_dae.hpp"

namespace tenon::contact {

void reject_name(const toml_file::Table& table, const std::string& key, const std::string& what, const std::string& name,
                 const std::vector<std::string>& known) {
  throw InputError(table.position(key), fmt::format("unknown {} '{}', the nearest is '{}'", what, name, nearest_name(name, known)),
                   fmt::format("one of {}", fmt::join(known, ", ")));
}

namespace {

constexpr double kOpenJoint = 1e-6;  // m or rad: a joint further apart cannot be closed by rounding

const std::vector<std::string> kSimulationKeys{"space", "gravity",    "duration",   "output_step", "rtol",
                                               "atol",  "integrator", "impact_law", "audit",       "stabilisation"};
const std::vector<std::string> kBodyKeys{"count",    "name",  "kind",       "mass",     "inertia",
                                         "position", "angle", "quaternion", "velocity", "omega"};
const std::vector<std::string> kShapeKeys{"count", "name",     "body", "type",  "at",    "radius", "point",   "normal", "from",
                                          "to",    "vertices", "size", "angle", "width", "depth",  "chamfer", "rim"};
const std::vector<std::string> kLawKeys{"restitution",    "contact_time", "collision",        "alpha", "one_law", "friction",
                                        "friction_speed", "rest_speed",   "rest_acceleration"};
const std::vector<std::string> kForceKeys{"count",   "name", "type",  "between", "on",        "from",  "to",        "stiffness",
                                          "damping", "rest", "force", "torque",  "frequency", "phase", "expression"};

std::vector<std::string> with(std::vector<std::string> keys, const std::vector<std::string>& more) {
  keys.insert(keys.end(), more.begin(), more.end());
  return keys;
}

ImpactLaw impact_law_of(const toml_file::Table& table, const std::string& name) {
  static const std::vector<std::string> names{"sequential", "compliant", "hertz", "coupled"};
  for (std::size_t k = 0; k < names.size(); ++k) {
    if (name == names[k]) return static_cast<ImpactLaw>(k);
  }
  reject_name(table, "impact_law", "impact law", name, names);
}

}  // namespace

template <int D>
Scene<D> SceneReader<D>::read() {
  if (const auto simulation = root_.table("simulation", kSimulationKeys)) {
    scene_.gravity = point(*simulation, "gravity", scene_.gravity);
    if (simulation->has("impact_law")) scene_.impact_law = impact_law_of(*simulation, values_.text(*simulation, "impact_law"));
    if (simulation->has("stabilisation")) stabilisation_ = stabilisation(*simulation);
    scene_.with_audit = simulation->flag("audit", true);
  }
  const auto each = [&](const std::string& key, const std::vector<std::string>& known, auto reader) {
    for (const Table& table : root_.tables(key, known)) {
      const int count = values_.count(table);
      for (int i = 1; i <= count; ++i) {
        values_.set_index(i);
        (this->*reader)(table);
      }
      values_.set_index(1);
    }
  };
  each("body", kBodyKeys, &SceneReader::read_body);
  if (scene_.bodies.empty()) throw InputError(root_.position(), "a scene without bodies", "[[body]]");
  each("shape", kShapeKeys, &SceneReader::read_shape);
  each("joint",
       with({"count", "name", "type", "between", "at", "from", "to", "length", "axis", "lock", "pole", "stabilisation", "amplitude",
             "frequency", "phase"},
            kLawKeys),
       &SceneReader::read_joint);
  each("contact", with({"count", "name", "between"}, kLawKeys), &SceneReader::read_contact);
  each("force", kForceKeys, &SceneReader::read_force);
  check_start();
  return std::move(scene_);
}

template <int D>
Point<double, D> SceneReader<D>::point(const Table& table, const std::string& key) const {
  const std::vector<double> list = values_.numbers(table, key, D);
  return Eigen::Map<const Vec>(list.data());
}

template <int D>
Point<double, D> SceneReader<D>::direction(const Table& table, const std::string& key) const {
  const Vec v = point(table, key);
  if (!(v.norm() > 0)) throw InputError(table.position(key), "'" + key + "' is no direction", "a vector that is not 0");
  return v.normalized();
}

template <int D>
double SceneReader<D>::positive(const Table& table, const std::string& key) const {
  const double value = values_.number(table, key);
  if (!(value > 0)) throw InputError(table.position(key), fmt::format("'{}' is {}", key, value), "a number above 0");
  return value;
}

template <int D>
double SceneReader<D>::in_interval(const Table& table, const std::string& key, double low, double high, double fallback) const {
  const double value = values_.number(table, key, fallback);
  if (!(value >= low && value <= high)) {
    throw InputError(table.position(key), fmt::format("'{}' is {}", key, value),
                     std::isfinite(high) ? fmt::format("a number in [{}, {}]", low, high) : fmt::format("a number from {} on", low));
  }
  return value;
}

template <int D>
int SceneReader<D>::body_of(const Table& table, const std::string& key, const std::string& name) const {
  if (name == "world") return kWorld;
  std::vector<std::string> known{"world"};
  for (std::size_t k = 0; k < scene_.bodies.size(); ++k) {
    if (scene_.bodies[k].name == name) return static_cast<int>(k);
    known.push_back(scene_.bodies[k].name);
  }
  reject_name(table, key, "body", name, known);
}

template <int D>
std::pair<int, int> SceneReader<D>::bodies_between(const Table& table) const {
  const std::vector<std::string> names = values_.texts(table, "between", 2);
  const int a = body_of(table, "between", names[0]), b = body_of(table, "between", names[1]);
  if (a == b) throw InputError(table.position("between"), "'" + names[0] + "' stands on both sides", "two bodies");
  return {a, b};
}

template <int D>
std::vector<const Shape<D>*> SceneReader<D>::shapes_of(const Table& table, const std::string& name) const {
  std::vector<const Shape<D>*> found;
  std::vector<std::string> known;
  for (const Shape<D>& shape : shapes_) {
    const std::string body = shape.body == kWorld ? "world" : scene_.bodies[static_cast<std::size_t>(shape.body)].name;
    if (shape.name == name || body == name) found.push_back(&shape);
    known.push_back(shape.name);
    known.push_back(body);
  }
  if (found.empty()) reject_name(table, "between", "shape", name, known);
  return found;
}

template <int D>
Pose<double, D> SceneReader<D>::pose_of(int body) const {
  const Body<D> nowhere;
  const Body<D>& b = body == kWorld ? nowhere : scene_.bodies[static_cast<std::size_t>(body)];
  return Pose<double, D>(b.q, b.v);
}

template <int D>
Point<double, D> SceneReader<D>::place_in(int body, const Vec& in_world) const {
  const Pose<double, D> pose = pose_of(body);
  return pose.R.transpose() * (in_world - pose.p);
}

template <int D>
void SceneReader<D>::read_body(const Table& table) {
  Body<D> body;
  body.name = values_.text(table, "name");
  for (const Body<D>& other : scene_.bodies) {
    if (other.name == body.name || body.name == "world")
      throw InputError(table.position("name"), "the name '" + body.name + "' stands twice", "another name");
  }
  const std::string kind = table.text("kind", "rigid");
  const std::vector<std::string> kinds =
      D == 2 ? std::vector<std::string>{"line", "point", "rigid"} : std::vector<std::string>{"point", "rigid"};
  if (std::find(kinds.begin(), kinds.end(), kind) == kinds.end()) reject_name(table, "kind", "kind of body", kind, kinds);
  body.freedoms = kind == "line" ? 1 : kind == "point" ? D : D == 2 ? 3 : 6;
  body.mass = positive(table, "mass");
  const bool turns = kind == "rigid";
  for (const char* key : {"inertia", "angle", "quaternion", "omega"}) {
    if (!turns && table.has(key))
      throw InputError(table.position(key), fmt::format("a {} does not turn, '{}' means nothing", kind, key), "kind = \"rigid\"");
  }
  const Vec position = point(table, "position", Vec::Zero()), velocity = point(table, "velocity", Vec::Zero());
  body.q.template head<D>() = position;
  body.v.template head<D>() = velocity;
  if constexpr (D == 2) {
    if (turns) body.inertia[0] = positive(table, "inertia");
    body.q[2] = values_.number(table, "angle", 0);
    body.v[2] = values_.number(table, "omega", 0);
  } else if (turns) {
    const std::vector<double> inertia = values_.numbers(table, "inertia", 3);
    for (int k = 0; k < 3; ++k) body.inertia[k] = inertia[static_cast<std::size_t>(k)];
    if (!(body.inertia.minCoeff() > 0)) throw InputError(table.position("inertia"), "the inertia is singular", "three numbers above 0");
    if (table.has("quaternion")) {
      const std::vector<double> q = values_.numbers(table, "quaternion", 4);
      const Eigen::Map<const Eigen::Vector4d> quaternion(q.data());
      if (!(quaternion.norm() > 0)) throw InputError(table.position("quaternion"), "'quaternion' is 0", "w, x, y, z, not all 0");
      body.q.template tail<4>() = quaternion.normalized();
    }
    const Vec omega = point(table, "omega", Vec::Zero());
    body.v.template tail<3>() = omega;
  }
  if (body.freedoms == 1 && (position[1] != 0 || velocity[1] != 0))
    throw InputError(table.position("position"), "a body on a line has x alone", "[x, 0]");
  scene_.bodies.push_back(body);
}

template <int D>
void SceneReader<D>::read_law(const Table& table, Constraint<D>& c) const {
  const double unlimited = std::numeric_limits<double>::infinity();
  c.is_two_scale = !table.flag("one_law", false);
  c.law = Law::critical(kDefaultPole);
  if (table.has("alpha")) {
    const std::vector<double> alpha = values_.numbers(table, "alpha", 3);
    c.law = {alpha[0], alpha[1], alpha[2]};
  } else if (!c.is_two_scale) {
    throw InputError(table.position(), "a one-law contact without its law", "alpha = [alpha0, alpha1, alpha3]");
  }
  c.restitution = in_interval(table, "restitution", 0, 1, 1);
  c.contact_time = table.has("contact_time") ? positive(table, "contact_time") : 1e-3;
  if (table.has("collision")) {
    if (table.has("restitution")) throw InputError(table.position("collision"), "both 'collision' and 'restitution'", "one of them");
    std::vector<double> beta = values_.numbers(table, "collision");
    const std::size_t size = beta.size();
    beta.resize(3);
    const bool pushes = beta[1] >= 0 && (beta[2] == 0 ? beta[0] > 0 : beta[0] >= 0 && beta[2] > 0);
    if (size < 2 || size > 3 || !pushes)
      throw InputError(table.position("collision"), "a collision law without stiffness",
                       "[beta0 > 0, beta1 >= 0] or [beta0, beta1, beta3 > 0]");
    const Law collision{beta[0], beta[1], beta[2]};
    if (beta[2] != 0)
      c.collision = collision;
    else
      c.restitution = restitution_of(beta[1] / (2 * std::sqrt(beta[0]))), c.contact_time = contact_time_of(collision);
  }
  c.friction = in_interval(table, "friction", 0, unlimited, 0);
  if (table.has("friction_speed")) c.friction_speed = positive(table, "friction_speed");
  c.rest_speed = in_interval(table, "rest_speed", 0, unlimited, c.rest_speed);
  c.rest_acceleration = table.has("rest_acceleration") ? positive(table, "rest_acceleration") : c.rest_acceleration;
}

template <int D>
void SceneReader<D>::read_contact(const Table& table) {
  Constraint<D> pattern;
  pattern.name = values_.text(table, "name");
  read_law(table, pattern);
  const std::vector<std::string> names = values_.texts(table, "between", 2);
  const auto found = contacts_between(shapes_of(table, names[0]), shapes_of(table, names[1]), pattern);
  if (found.empty())
    throw InputError(table.position("between"), "'" + names[0] + "' and '" + names[1] + "' cannot touch",
                     "a ball or corner on one side at least, on two bodies");
  for (const Constraint<D>& c : found) {
    if (c.shape.vertices.size() == 2 && c.radius == 0)
      throw InputError(table.position("between"),
                       fmt::format("'{}' and '{}' are a point and a line: neither has an inside", names[0], names[1]),
                       "a disc or a capsule for one of them, or a half-plane or polygon");
  }
  scene_.constraints.insert(scene_.constraints.end(), found.begin(), found.end());
  places_.resize(scene_.constraints.size(), table.position());
}

template <int D>
void SceneReader<D>::read_force(const Table& table) {
  static const std::vector<std::string> types{"spring", "torsion", "constant", "sinusoid", "expression", "drag"};
  Force<D> force;
  force.name = values_.text(table, "name");
  const std::string type = table.text("type");
  if (std::find(types.begin(), types.end(), type) == types.end()) reject_name(table, "type", "type of force", type, types);
  const double unlimited = std::numeric_limits<double>::infinity();
  if (type == "spring" || type == "torsion") {
    std::tie(force.a, force.b) = bodies_between(table);
    force.kind = type == "spring" ? ForceKind::spring : ForceKind::torsion;
    force.stiffness = in_interval(table, "stiffness", 0, unlimited, 0);
    force.rest = values_.number(table, "rest", 0);
  } else {
    force.a = body_of(table, "on", values_.text(table, "on"));
    force.kind = type == "drag" ? ForceKind::drag : type == "expression" ? ForceKind::expression : ForceKind::applied;
    if (type == "drag") force.rest = in_interval(table, "rest", 0, unlimited, 0);
    if (type == "sinusoid") force.frequency = positive(table, "frequency");
  }
  force.damping = in_interval(table, "damping", 0, unlimited, 0);
  force.phase = values_.number(table, "phase", 0);
  force.force = point(table, "force", Vec::Zero());
  force.torque = values_.number(table, "torque", 0);
  force.at_a = place_in(force.a, point(table, "from", pose_of(force.a).p));
  force.at_b = place_in(force.b, point(table, "to", pose_of(force.b).p));
  if (type == "expression") {
    try {
      force.expression = Expression(values_.with_values(table.text("expression")), force_variables<D>());
    } catch (const std::invalid_argument& error) {
      throw InputError(table.position("expression"), error.what(),
                       "an expression in t, the body's pose and motion, and the scene's parameters");
    }
  }
  scene_.forces.push_back(force);
}

/// Nothing overlaps, and every joint is closed.
template <int D>
void SceneReader<D>::check_start() const {
  const ContactDae<D> dae(scene_);
  Dae::Workspace workspace = dae.make_workspace();
  const DaeState state = initial_state_of(dae);
  for (std::size_t i = 0; i < scene_.constraints.size(); ++i) {
    const Constraint<D>& c = scene_.constraints[i];
    const GapValue<double, D> g = dae.gap(static_cast<int>(i), state.t, state.x, workspace);
    if (c.is_joint() && std::abs(g.h) > kOpenJoint) {
      throw InputError(places_[i], fmt::format("joint '{}' is open by {:.3g} at the start and cannot close", c.name, g.h),
                       "bodies where the joint holds them");
    }
    if (c.is_joint() && std::abs(g.hdot) > kOpenJoint) {
      throw InputError(places_[i], fmt::format("joint '{}' opens at {:.3g} per second at the start", c.name, g.hdot),
                       "bodies that move as the joint lets them");
    }
    if (!c.is_joint() && g.h < -kTouching) {
      throw InputError(places_[i], fmt::format("contact '{}' overlaps at the start by {:.3g} m", c.name, -g.h), "bodies apart or touching");
    }
    if (!std::isfinite(g.h)) throw InputError(places_[i], fmt::format("'{}' has no gap at the start", c.name), "bodies apart");
  }
}

template class SceneReader<2>;
template class SceneReader<3>;

}  // namespace tenon::contact
