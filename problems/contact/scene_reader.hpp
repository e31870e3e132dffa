// The reader of one scene, planar or spatial: see scene_file.hpp for what may stand in it.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "tenon/problems/contact/scene_values.hpp"
#include "tenon/problems/contact/shapes.hpp"
#include "tenon/problems/toml/document.hpp"

namespace tenon::contact {

template <int D>
class SceneReader {
 public:
  SceneReader(const toml_file::Table& root, const SceneValues& values) : root_(root), values_(values) {}

  /// Throws InputError, with the place of what is wrong.
  Scene<D> read();
  /// What the bodies are made of, after read().
  const std::vector<Shape<D>>& shapes() const { return shapes_; }

 private:
  using Table = toml_file::Table;
  using Vec = Point<double, D>;

  void read_body(const Table& table);
  void read_shape(const Table& table);
  void read_joint(const Table& table);
  void read_contact(const Table& table);
  void read_force(const Table& table);
  void read_law(const Table& table, Constraint<D>& c) const;
  void check_start() const;

  Vec point(const Table& table, const std::string& key) const;
  Vec point(const Table& table, const std::string& key, const Vec& fallback) const { return table.has(key) ? point(table, key) : fallback; }
  Vec direction(const Table& table, const std::string& key) const;
  double positive(const Table& table, const std::string& key) const;
  double in_interval(const Table& table, const std::string& key, double low, double high, double fallback) const;
  int body_of(const Table& table, const std::string& key, const std::string& name) const;
  std::pair<int, int> bodies_between(const Table& table) const;
  std::vector<const Shape<D>*> shapes_of(const Table& table, const std::string& name) const;
  Pose<double, D> pose_of(int body) const;
  Vec place_in(int body, const Vec& in_world) const;
  Constraint<D>& add_joint_row(const Table& table, const std::string& name, GapKind kind, int a, int b, const Vec& at_a, const Vec& at_b);

  const Table& root_;
  SceneValues values_;
  Scene<D> scene_;
  std::vector<Shape<D>> shapes_;
  std::vector<InputPosition> places_;  // of each constraint
  Stabilisation stabilisation_ = Stabilisation::baumgarte;  // of joints that do not say their own
};

extern template class SceneReader<2>;
extern template class SceneReader<3>;

}  // namespace tenon::contact
