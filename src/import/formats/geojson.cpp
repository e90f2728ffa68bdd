// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <simdjson.h>

#include <cmath>

#include "import/formats/plan.h"

// Reads GeoJSON (RFC 7946) as a plan.
namespace throng::importer {
namespace {

using simdjson::dom::array;
using simdjson::dom::element;
using simdjson::dom::object;

constexpr int kDeepestGeometry = 16;

enum class Kind { kUnset, kGround, kObstacle };

class GeoJsonReader {
 public:
  GeoJsonReader(const std::string& name, double unit, double wall_height)
      : name_(name), unit_(unit), wall_height_(wall_height), height_(wall_height) {}

  Result<Plan> read(const element& root) {
    if (!read_any(root, 0)) return Error{Errc::kBadFile, message_};
    // If some polygon is named ground, a polygon without kind is an obstacle.
    for (Plan::Area& area : unset_)
      (ground_named_ ? plan_.obstacles : plan_.ground).push_back(std::move(area));
    return std::move(plan_);
  }

 private:
  bool fail(const std::string& why) {
    message_ = place_ + ": " + why;
    return false;
  }

  bool read_any(const element& node, int depth) {
    place_ = fmt::format("{}: feature {}", name_, feature_);
    if (depth > kDeepestGeometry) return fail("collections nest too deep");
    std::string_view type;
    if (node["type"].get(type) != simdjson::SUCCESS) return fail("has no \"type\"");
    array list;
    if (type == "FeatureCollection") {
      if (node["features"].get(list) != simdjson::SUCCESS) return fail("has no \"features\"");
      for (const element feature : list) {
        if (!read_any(feature, depth + 1)) return false;
      }
      return true;
    }
    if (type == "Feature") {
      ++feature_;
      place_ = fmt::format("{}: feature {}", name_, feature_);
      if (!read_properties(node)) return false;
      element geometry;
      if (node["geometry"].get(geometry) != simdjson::SUCCESS) return fail("has no \"geometry\"");
      return geometry.is_null() || read_any(geometry, depth + 1);
    }
    if (type == "GeometryCollection") {
      if (node["geometries"].get(list) != simdjson::SUCCESS) return fail("has no \"geometries\"");
      for (const element geometry : list) {
        if (!read_any(geometry, depth + 1)) return false;
      }
      return true;
    }
    if (node["coordinates"].get(list) != simdjson::SUCCESS) return fail("has no \"coordinates\"");
    if (type == "Polygon") return read_polygon(list);
    if (type == "LineString") return read_wall(list);
    if (type == "MultiPolygon" || type == "MultiLineString") {
      for (const element item : list) {
        array part;
        if (item.get(part) != simdjson::SUCCESS) return fail("coordinates must be lists");
        if (!(type == "MultiPolygon" ? read_polygon(part) : read_wall(part))) return false;
      }
      return true;
    }
    if (type == "Point" || type == "MultiPoint") return true;  // Labels: not solid.
    return fail(fmt::format("cannot use the type '{}'", type));
  }

  bool read_properties(const element& feature) {
    kind_ = Kind::kUnset;
    height_ = wall_height_;
    object properties;
    if (feature["properties"].get(properties) != simdjson::SUCCESS) return true;
    std::string_view kind;
    if (properties["kind"].get(kind) == simdjson::SUCCESS) {
      if (kind == "ground" || kind == "walkable")
        kind_ = Kind::kGround;
      else if (kind == "obstacle")
        kind_ = Kind::kObstacle;
      else
        return fail(fmt::format("kind '{}' must be ground, walkable or obstacle", kind));
    }
    double height = 0;
    if (properties["height"].get(height) == simdjson::SUCCESS) {
      if (!(height > 0 && height <= 1e4)) return fail("height must lie between 0 and 10000 m");
      height_ = height / unit_;
    }
    return true;
  }

  bool read_ring(const array& list, Ring& ring) {
    for (const element item : list) {
      array numbers;
      std::array<double, 2> p{};
      if (item.get(numbers) != simdjson::SUCCESS || numbers.at(0).get(p[0]) != simdjson::SUCCESS ||
          numbers.at(1).get(p[1]) != simdjson::SUCCESS) {
        return fail("a position needs two numbers");
      }
      ring.push_back(p);
    }
    return true;
  }

  bool read_polygon(const array& list) {
    Plan::Area area{.polygon = {}, .height = height_, .place = place_};
    bool first = true;
    for (const element item : list) {
      array corners;
      if (item.get(corners) != simdjson::SUCCESS) return fail("a ring must be a list");
      Ring& ring = first ? area.polygon.outer : area.polygon.holes.emplace_back();
      if (!read_ring(corners, ring)) return false;
      if (ring.size() > 1 && ring.front() == ring.back()) ring.pop_back();
      first = false;
    }
    if (first) return true;  // Empty.
    ground_named_ = ground_named_ || kind_ == Kind::kGround;
    (kind_ == Kind::kGround     ? plan_.ground
     : kind_ == Kind::kObstacle ? plan_.obstacles
                                : unset_)
        .push_back(std::move(area));
    return true;
  }

  bool read_wall(const array& list) {
    Plan::Wall wall{.line = {}, .height = height_};
    if (!read_ring(list, wall.line)) return false;
    plan_.walls.push_back(std::move(wall));
    return true;
  }

  std::string name_;
  double unit_;
  double wall_height_;
  Kind kind_ = Kind::kUnset;
  double height_;
  bool ground_named_ = false;
  int feature_ = 0;
  std::string place_;
  std::string message_;
  std::vector<Plan::Area> unset_;
  Plan plan_;
};

}  // namespace

Result<RawScene> read_geojson(std::string_view bytes, const ReadOptions& options, Context&) {
  simdjson::dom::parser parser;
  element root;
  if (const auto failure = parser.parse(simdjson::padded_string(bytes)).get(root);
      failure != simdjson::SUCCESS) {
    return Error{Errc::kBadFile,
                 fmt::format("{}: not JSON: {}", options.name, simdjson::error_message(failure))};
  }
  const double unit = options.metres_per_unit.value_or(1);
  auto plan = GeoJsonReader(options.name, unit, options.plan_height / unit).read(root);
  if (!plan) return plan.error();
  SceneWriter writer(options);
  constexpr double kPlate = 0.05;  // [m]
  if (auto done = write_plan(*plan, PlanAxes::kXY, 0, kPlate / unit, writer); !done) {
    return done.error();
  }
  auto scene = writer.finish();
  if (!scene) return scene.error();
  return RawScene{.scene = *std::move(scene), .up = 'z', .metres_per_unit = unit};
}

}  // namespace throng::importer
