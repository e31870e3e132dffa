// The joints of a scene file, each as one row or more.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tenon/problems/contact/scene_reader.hpp"

namespace tenon::contact {

template <int D>
Stabilisation SceneReader<D>::stabilisation(const Table& table) const {
  static const std::vector<std::string> names{"baumgarte", "gear-gupta-leimkuhler"};
  const std::string name = values_.text(table, "stabilisation");
  for (std::size_t k = 0; k < names.size(); ++k) {
    if (name == names[k]) return static_cast<Stabilisation>(k);
  }
  reject_name(table, "stabilisation", "stabilisation", name, names);
}

template <int D>
Constraint<D>& SceneReader<D>::add_joint_row(const Table& table, const std::string& name, GapKind kind, int a, int b, const Vec& at_a,
                                             const Vec& at_b) {
  Constraint<D> c;
  c.name = name;
  c.kind = ConstraintKind::joint;
  c.a = a, c.b = b;
  c.gap.kind = kind;
  c.gap.a = place_in(a, at_a);
  c.gap.b = place_in(b, at_b);
  c.stabilisation = table.has("stabilisation") ? stabilisation(table) : table.has("pole") ? Stabilisation::baumgarte : stabilisation_;
  if (c.is_index_2() && table.has("pole"))
    throw InputError(table.position("pole"), "a joint of index 2 has no pole", "stabilisation = \"baumgarte\"");
  if (!c.is_index_2()) c.law = Law::critical(table.has("pole") ? positive(table, "pole") : kDefaultPole);
  scene_.constraints.push_back(c);
  places_.push_back(table.position());
  return scene_.constraints.back();
}

template <int D>
void SceneReader<D>::read_joint(const Table& table) {
  static const std::vector<std::string> types =
      D == 2 ? std::vector<std::string>{"revolute", "distance", "rope", "slide", "angle", "weld", "guide"}
             : std::vector<std::string>{"ball", "distance", "rope", "guide"};
  const std::string name = values_.text(table, "name"), type = table.text("type");
  if (std::find(types.begin(), types.end(), type) == types.end()) reject_name(table, "type", "type of joint", type, types);
  const auto [a, b] = bodies_between(table);
  const auto drive = [&](Gap<D>& gap) {
    gap.amplitude = values_.number(table, "amplitude", 0);
    gap.frequency = values_.number(table, "frequency", 0);
    gap.phase = values_.number(table, "phase", 0);
  };
  if (type == "distance" || type == "rope") {
    const Vec from = point(table, "from", pose_of(a).p), to = point(table, "to", pose_of(b).p);
    Constraint<D>& c = add_joint_row(table, name, GapKind::point_point, a, b, from, to);
    c.gap.offset = table.has("length") ? positive(table, "length") : (from - to).norm();
    if (!(c.gap.offset > 0) || !((from - to).norm() > 0))
      throw InputError(table.position(), "both ends are at one place", "ends that are apart");
    if (type == "rope") {
      if (table.has("stabilisation"))
        throw InputError(table.position("stabilisation"), "a rope is a contact, its law keeps it", "alpha = [alpha0, alpha1, alpha3]");
      c.kind = ConstraintKind::contact;
      c.stabilisation = Stabilisation::baumgarte;
      c.gap.sign = -1;
      read_law(table, c);
    }
    return;
  }
  if constexpr (D == 2) {
    if (type == "angle" || type == "weld") {
      Constraint<D>& c = add_joint_row(table, type == "weld" ? name + "_angle" : name, GapKind::angle, a, b, Vec::Zero(), Vec::Zero());
      const auto angle = [&](int body) { return body == kWorld ? 0 : scene_.bodies[static_cast<std::size_t>(body)].q[2]; };
      c.gap.offset = angle(a) - angle(b);
      drive(c.gap);
    }
    if (type == "angle") return;
    if (type == "slide") {
      const Vec at = point(table, "at", pose_of(a).p), axis = direction(table, "axis");
      Constraint<D>& c = add_joint_row(table, name, GapKind::point_face, a, b, at, at);
      c.gap.n = pose_of(b).R.transpose() * Vec(-axis[1], axis[0]);
      if (table.flag("lock", false)) {
        Constraint<D>& angle = add_joint_row(table, name + "_angle", GapKind::angle, a, b, Vec::Zero(), Vec::Zero());
        angle.gap.offset = (a == kWorld ? 0 : scene_.bodies[static_cast<std::size_t>(a)].q[2]) -
                           (b == kWorld ? 0 : scene_.bodies[static_cast<std::size_t>(b)].q[2]);
      }
      return;
    }
  }
  const Vec at = point(table, "at", pose_of(a).p);
  if (type == "guide") {  // one coordinate, in the world's axes, as time has it
    Constraint<D>& c = add_joint_row(table, name, GapKind::coordinate, a, b, at, at);
    c.gap.n = direction(table, "axis");
    drive(c.gap);
    c.gap.offset -= c.gap.amplitude * std::sin(c.gap.phase);
    return;
  }
  const Vec to = point(table, "to", at);
  static constexpr const char* kAxes[] = {"_x", "_y", "_z"};
  for (int k = 0; k < D; ++k) add_joint_row(table, name + kAxes[k], GapKind::coordinate, a, b, at, to).gap.n = Vec::Unit(k);
}

template class SceneReader<2>;
template class SceneReader<3>;

}  // namespace tenon::contact
