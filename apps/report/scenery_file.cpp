#include "tenon/apps/report/scenery_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>

#include "tenon/core/nearest_name.hpp"
#include "tenon/core/read_file.hpp"
#include "tenon/core/scenery.hpp"

namespace tenon {

namespace {

const std::vector<std::string> kShapes{"disc", "sphere", "box", "polygon", "capsule", "cylinder", "line", "half-space"};

constexpr int kMostNumbered = 1000;  // columns that one name with a # may stand for

/// What stands under a key, null where nothing does.
Json member(const Json& object, const std::string& key) {
  return object.has(key) ? object.at(key) : Json::parse("null", "");
}

/// Walks through a scenery and stops at the first thing that is wrong.
class Check {
 public:
  Check(std::string file, const CsvTable& record) : file_(std::move(file)), record_(record) {}

  void scenery(const Json& root) {
    if (!root.is_object()) fail("the scenery is no object", "{\"schema\": 1, ...}");
    if (const Json schema = member(root, "schema"); !schema.is_number() || schema.number() != 1) fail("schema is not 1", "\"schema\": 1");
    one_of("space", member(root, "space"), {"planar", "spatial"});
    each(root, "bodies", [this](const std::string& at, const Json& json) { body(at, json); });
    each(root, "links", [this](const std::string& at, const Json& json) {
      point(at + ".from", member(json, "from"));
      point(at + ".to", member(json, "to"));
    });
    each(root, "arrows", [this](const std::string& at, const Json& json) { arrow(at, json); });
    each(root, "ghosts", [this](const std::string& at, const Json& json) { ghosts(at, json); });
    each(root, "ellipses", [this](const std::string& at, const Json& json) {
      one_of(at + ".body", member(json, "body"), bodies_);
      values(at + ".covariance", member(json, "covariance"), 6);
    });
    each(root, "lenses", [this](const std::string& at, const Json& json) {
      one_of(at + ".body", member(json, "body"), bodies_);
      const Json extent = member(json, "extent");
      if (!extent.is_number() || !(extent.number() > 0)) fail(at + ".extent is no length", "a number of metres");
    });
    each(root, "estimates", [this](const std::string& at, const Json& json) {
      for (const char* axis : {"across", "upward"}) {
        const Json quantity = member(json, axis);
        if (!quantity.is_object()) fail(at + "." + axis + " is no object", "{\"mean\": column, ...}");
        value(at + "." + axis + ".mean", member(quantity, "mean"));
        if (quantity.has("truth")) value(at + "." + axis + ".truth", quantity.at("truth"));
      }
      values(at + ".covariance", member(json, "covariance"), 3);
    });
    each(root, "plots", [this](const std::string& at, const Json& json) { plot(at, json); });
    if (const Json camera = member(root, "camera"); camera.has("follow")) one_of("camera.follow", camera.at("follow"), bodies_);
  }

 private:
  template <class What>
  void each(const Json& root, const std::string& key, What what) {
    const std::vector<Json> list = member(root, key).elements();
    for (std::size_t i = 0; i < list.size(); ++i) what(fmt::format("{}[{}]", key, i), list[i]);
  }

  void body(const std::string& at, const Json& json) {
    if (json.has("parent")) one_of(at + ".parent", member(json, "parent"), bodies_);
    vector(at + ".position", member(json, "position"));
    if (json.has("angle")) value(at + ".angle", member(json, "angle"));
    vector(at + ".quaternion", member(json, "quaternion"));
    for (const Json& shape : member(json, "shapes").elements()) {
      if (std::none_of(kShapes.begin(), kShapes.end(), [&](const std::string& kind) { return member(shape, kind).is_object(); }))
        fail(at + ".shapes: a shape of no known kind", fmt::format("one of {}", fmt::join(kShapes, ", ")));
    }
    bodies_.push_back(name(at, json));
  }

  void arrow(const std::string& at, const Json& json) {
    point(at, json);
    vector(at + ".vector", member(json, "vector"));
    if (json.has("frame") && !(json.at("frame").is_text() && json.at("frame").as_text() == "world")) one_of(at + ".frame", json.at("frame"), bodies_);
    for (const Json& part : member(json, "sum").elements()) one_of(at + ".sum", part, arrows_);
    arrows_.push_back(name(at, json));
  }

  void ghosts(const std::string& at, const Json& json) {
    one_of(at + ".body", member(json, "body"), bodies_);
    const int number = count(at + ".count", member(json, "count"));
    for (const Json& element : member(json, "position").elements()) numbered(at + ".position", element, number);
    if (json.has("angle")) numbered(at + ".angle", json.at("angle"), number);
  }

  void plot(const std::string& at, const Json& json) {
    for (const Json& column : member(json, "columns").elements()) value(at + ".columns", column);
    for (const Json& band : member(json, "bands").elements()) {
      for (const char* part : {"mean", "variance"}) value(at + ".bands." + part, member(band, part));
    }
    for (const Json& foresight : member(json, "foresights").elements())
      numbered(at + ".foresights", member(foresight, "columns"), count(at + ".foresights.count", member(foresight, "count")));
  }

  int count(const std::string& at, const Json& json) {
    if (!json.is_number() || !(json.number() >= 1 && json.number() <= kMostNumbered))
      fail(at + " is no count", fmt::format("1 to {}", kMostNumbered));
    return static_cast<int>(json.number());
  }

  /// A value in whose column's name a # stands for 1 .. count.
  void numbered(const std::string& at, const Json& json, int count) {
    if (!json.is_text()) return value(at, json);
    const std::string name = json.as_text();
    const std::size_t place = name.find('#');
    for (int i = 1; i <= count; ++i)
      value(at, Json(place == std::string::npos ? name : std::string(name).replace(place, 1, std::to_string(i))));
  }

  void values(const std::string& at, const Json& json, std::size_t expected) {
    const std::vector<Json> list = json.elements();
    if (list.size() != expected) fail(fmt::format("{} has {} values", at, list.size()), fmt::format("{}: a lower triangle, column by column", expected));
    for (const Json& element : list) value(at, element);
  }

  void point(const std::string& at, const Json& json) {
    if (json.has("body")) one_of(at + ".body", member(json, "body"), bodies_);
    vector(at + ".at", member(json, "at"));
  }

  void vector(const std::string& at, const Json& json) {
    for (const Json& element : json.elements()) value(at, element);
  }

  /// A number, the name of a column, or a polynomial in one.
  void value(const std::string& at, const Json& json) {
    if (json.is_number()) return;
    const Json name = json.is_object() ? member(json, "column") : json;
    if (!name.is_text()) fail(at + " is no value", "a number, the name of a column, or {\"column\": ..., \"polynomial\": [...]}");
    const std::string column = name.as_text();
    const std::vector<double>* values = record_.find(column);
    if (values == nullptr || values->empty()) {
      fail(fmt::format("{} names column '{}'", at, column),
           fmt::format("a column of numbers of {}, such as '{}'", record_.file, nearest_name(column, record_.names)));
    }
  }

  std::string name(const std::string& at, const Json& json) {
    const Json name = member(json, "name");
    if (!name.is_text()) fail(at + " has no name", "a name for each body and arrow");
    return name.as_text();
  }

  void one_of(const std::string& at, const Json& json, const std::vector<std::string>& known) {
    if (json.is_text() && std::count(known.begin(), known.end(), json.as_text()) > 0) return;
    fail(at + (json.is_text() ? " is '" + json.as_text() + "'" : " is no text"), fmt::format("one of {}", fmt::join(known, ", ")));
  }

  [[noreturn]] void fail(const std::string& what, const std::string& expected) { throw InputError({file_, 0, 0}, what, expected); }

  std::string file_;
  const CsvTable& record_;
  std::vector<std::string> bodies_, arrows_;
};

}  // namespace

std::optional<Json> read_scenery(const CsvTable& record) {
  const std::string path = scenery_path(record.file);
  if (!std::filesystem::exists(path)) return std::nullopt;
  const Json scenery = Json::parse(read_file(path), path, "a scenery as scenery.md describes it");
  Check(path, record).scenery(scenery);
  return scenery;
}

}  // namespace tenon
