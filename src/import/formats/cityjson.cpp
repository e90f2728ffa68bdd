// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <simdjson.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <unordered_map>
#include <unordered_set>

#include "import/formats/city.h"

// Source: CityJSON specifications 1.0.3, 1.1.3 and 2.0.1 (cityjson.org/specs).
namespace throng::importer {
namespace {

using simdjson::dom::array;
using simdjson::dom::element;
using simdjson::dom::object;

constexpr double kNoDetail = -1;

bool is_part_type(std::string_view type) { return type.ends_with("Part"); }

double detail_of(const element& geometry) {
  double number = 0;
  if (geometry["lod"].get(number) == simdjson::SUCCESS) return number;  // Version 1.0: a number.
  std::string_view text;
  if (geometry["lod"].get(text) == simdjson::SUCCESS) {
    const auto parsed = std::from_chars(text.data(), text.data() + text.size(), number);
    if (parsed.ec == std::errc()) return number;
  }
  return 0;
}

// How many lists lie around a surface: 0 for a list of surfaces, 1 for shells, 2 for solids.
int lists_above_surfaces(std::string_view type) {
  if (type == "MultiSurface" || type == "CompositeSurface") return 0;
  if (type == "Solid") return 1;
  if (type == "MultiSolid" || type == "CompositeSolid") return 2;
  return -1;
}

class CityJsonReader {
 public:
  CityJsonReader(const ReadOptions& options, Context& context)
      : name_(options.name), context_(context), writer_(options) {}

  Result<RawScene> read(const element& root) {
    if (!read_all(root)) {
      if (context_.cancel) return Error{Errc::kCancelled, "cancelled while reading"};
      return Error{Errc::kBadFile, name_ + ": " + message_};
    }
    auto scene = writer_.finish();
    if (!scene) return scene.error();
    return RawScene{.scene = *std::move(scene), .up = 'z', .metres_per_unit = 1};
  }

 private:
  bool fail(std::string why) {
    message_ = std::move(why);
    return false;
  }

  bool read_all(const element& root) {
    std::string_view type;
    if (root["type"].get(type) != simdjson::SUCCESS || type != "CityJSON") {
      return fail("not CityJSON: \"type\" must be \"CityJSON\"");
    }
    std::string_view system;
    if (root["metadata"]["referenceSystem"].get(system) == simdjson::SUCCESS &&
        names_degrees(system)) {
      return fail(
          fmt::format("coordinates are degrees ({}); convert it to a metric system", system));
    }
    Vec3d scale{1, 1, 1};
    Vec3d shift;
    element transform;
    if (root["transform"].get(transform) == simdjson::SUCCESS &&
        !(read_point(transform["scale"], scale) && read_point(transform["translate"], shift))) {
      return fail("\"transform\" needs \"scale\" and \"translate\" of three numbers");
    }
    array vertices;
    if (root["vertices"].get(vertices) != simdjson::SUCCESS) return fail("has no \"vertices\"");
    for (const element vertex : vertices) {
      Vec3d p;
      if (!read_point(vertex, p)) return fail("a vertex needs three numbers");
      vertices_.push_back(
          {p.x * scale.x + shift.x, p.y * scale.y + shift.y, p.z * scale.z + shift.z});
    }
    if (!read_templates(root)) return false;

    object objects;
    if (root["CityObjects"].get(objects) != simdjson::SUCCESS) {
      return fail("has no \"CityObjects\"");
    }
    for (const auto& [id, city_object] : objects) {
      if (const double detail = highest_detail(city_object); detail > kNoDetail) {
        detail_of_object_[id] = detail;
      }
      std::string_view part_type;
      if (city_object["type"].get(part_type) == simdjson::SUCCESS && is_part_type(part_type)) {
        parts_.insert(id);
      }
    }
    for (const auto& [id, city_object] : objects) {
      if (context_.cancel) return false;
      read_object(id, city_object);
    }
    return true;
  }

  template <class Node>  // An element, or the lookup of one.
  static bool read_point(const Node& node, Vec3d& p) {
    array numbers;
    if (node.get(numbers) != simdjson::SUCCESS) return false;
    return numbers.at(0).get(p.x) == simdjson::SUCCESS &&
           numbers.at(1).get(p.y) == simdjson::SUCCESS &&
           numbers.at(2).get(p.z) == simdjson::SUCCESS;
  }

  bool read_templates(const element& root) {
    element block;
    if (root["geometry-templates"].get(block) != simdjson::SUCCESS) return true;
    array list, vertices;
    if (block["templates"].get(list) != simdjson::SUCCESS ||
        block["vertices-templates"].get(vertices) != simdjson::SUCCESS) {
      return fail("\"geometry-templates\" needs \"templates\" and \"vertices-templates\"");
    }
    for (const element one : list) templates_.push_back(one);
    for (const element vertex : vertices) {
      Vec3d p;
      if (!read_point(vertex, p)) return fail("a template's vertex needs three numbers");
      template_vertices_.push_back(p);
    }
    return true;
  }

  // Of the geometries that have surfaces.
  double highest_detail(const element& city_object) const {
    array list;
    double highest = kNoDetail;
    if (city_object["geometry"].get(list) != simdjson::SUCCESS) return highest;
    for (const element geometry : list) {
      if (has_surfaces(geometry)) highest = std::max(highest, effective_detail(geometry));
    }
    return highest;
  }

  double effective_detail(const element& geometry) const {
    const element* from = instance_template(geometry);
    return detail_of(from != nullptr ? *from : geometry);
  }

  const element* instance_template(const element& geometry) const {
    std::string_view type;
    int64_t index = -1;
    if (geometry["type"].get(type) != simdjson::SUCCESS || type != "GeometryInstance" ||
        geometry["template"].get(index) != simdjson::SUCCESS || index < 0 ||
        static_cast<size_t>(index) >= templates_.size()) {
      return nullptr;
    }
    return &templates_[static_cast<size_t>(index)];
  }

  bool has_surfaces(const element& geometry) const {
    const element* from = instance_template(geometry);
    std::string_view type;
    return (from != nullptr ? *from : geometry)["type"].get(type) == simdjson::SUCCESS &&
           lists_above_surfaces(type) >= 0;
  }

  // Bad surfaces are counted, not fatal.
  void read_object(std::string_view id, const element& city_object) {
    array list;
    if (city_object["geometry"].get(list) != simdjson::SUCCESS) return;
    std::string_view type;
    if (city_object["type"].get(type) != simdjson::SUCCESS) type = "CityObject";
    node_ = fmt::format("{}/{}", type, id);
    const auto own = detail_of_object_.find(id);
    const double wanted = own == detail_of_object_.end() ? kNoDetail : own->second;
    const bool left_to_parts = parts_detail(city_object) > wanted;
    for (const element geometry : list) {
      if (!has_surfaces(geometry)) {
        writer_.count_points_and_lines(1);
      } else if (!left_to_parts && effective_detail(geometry) == wanted) {
        read_geometry(geometry);
      }
    }
  }

  // The lowest detail among the parts of an object; a part without surfaces has none.
  double parts_detail(const element& city_object) const {
    array children;
    double lowest = kNoDetail;
    bool first = true;
    if (city_object["children"].get(children) != simdjson::SUCCESS) return kNoDetail;
    for (const element child : children) {
      std::string_view id;
      if (child.get(id) != simdjson::SUCCESS) continue;
      if (!parts_.contains(id)) continue;
      const auto found = detail_of_object_.find(id);
      const double detail = found == detail_of_object_.end() ? kNoDetail : found->second;
      lowest = first ? detail : std::min(lowest, detail);
      first = false;
    }
    return lowest;
  }

  void read_geometry(const element& geometry) {
    const element* from = instance_template(geometry);
    if (from == nullptr) {
      read_boundaries(geometry, vertices_);
      return;
    }
    // An instance: its template's points through a matrix, then to the anchor.
    array anchor, matrix;
    int64_t index = -1;
    std::array<double, 16> m{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    bool good = geometry["boundaries"].get(anchor) == simdjson::SUCCESS &&
                anchor.at(0).get(index) == simdjson::SUCCESS && index >= 0 &&
                static_cast<size_t>(index) < vertices_.size();
    if (geometry["transformationMatrix"].get(matrix) == simdjson::SUCCESS) {
      for (size_t i = 0; i < 16; ++i) good = good && matrix.at(i).get(m[i]) == simdjson::SUCCESS;
    }
    if (!good) {
      writer_.count_bad(1);
      return;
    }
    const Transform place{
        {{{m[0], m[1], m[2], m[3]}, {m[4], m[5], m[6], m[7]}, {m[8], m[9], m[10], m[11]}}}};
    std::vector<Vec3d> placed;
    placed.reserve(template_vertices_.size());
    for (const Vec3d& p : template_vertices_) {
      placed.push_back(place(p) + vertices_[static_cast<size_t>(index)]);
    }
    read_boundaries(*from, placed);
  }

  void read_boundaries(const element& geometry, std::span<const Vec3d> vertices) {
    std::string_view type;
    element boundaries, values;
    if (geometry["type"].get(type) != simdjson::SUCCESS ||
        geometry["boundaries"].get(boundaries) != simdjson::SUCCESS) {
      writer_.count_bad(1);
      return;
    }
    surface_types_.clear();
    array surfaces;
    if (geometry["semantics"]["surfaces"].get(surfaces) == simdjson::SUCCESS) {
      for (const element surface : surfaces) {
        std::string_view name;
        if (surface["type"].get(name) != simdjson::SUCCESS) name = {};
        surface_types_.push_back(name);
      }
    }
    const bool has_values = geometry["semantics"]["values"].get(values) == simdjson::SUCCESS;
    read_level(boundaries, has_values ? &values : nullptr, lists_above_surfaces(type), vertices);
  }

  // `values` has the shape of `boundaries` down to the surfaces; null anywhere means "no meaning".
  void read_level(const element& boundaries, const element* values, int lists,
                  std::span<const Vec3d> vertices) {
    array items, item_values;
    if (boundaries.get(items) != simdjson::SUCCESS) {
      writer_.count_bad(1);
      return;
    }
    const bool paired = values != nullptr && values->get(item_values) == simdjson::SUCCESS;
    auto value_at = paired ? item_values.begin() : array::iterator();
    for (const element item : items) {
      element value;
      const bool has_value = paired && value_at != item_values.end();
      if (has_value) {
        value = *value_at;
        ++value_at;
      }
      if (lists > 0) {
        read_level(item, has_value ? &value : nullptr, lists - 1, vertices);
        continue;
      }
      int64_t meaning = -1;
      if (!has_value || value.get(meaning) != simdjson::SUCCESS) meaning = -1;
      const bool named = meaning >= 0 && static_cast<size_t>(meaning) < surface_types_.size();
      writer_.begin_part(node_,
                         named ? surface_types_[static_cast<size_t>(meaning)] : std::string_view());
      read_surface(item, vertices);
    }
  }

  void read_surface(const element& surface, std::span<const Vec3d> vertices) {
    array rings;
    points_.clear();
    rings_ = {0};
    bool good = surface.get(rings) == simdjson::SUCCESS;
    if (good) {
      for (const element ring : rings) {
        array corners;
        good = good && ring.get(corners) == simdjson::SUCCESS;
        if (!good) break;
        for (const element corner : corners) {
          int64_t index = -1;
          good = good && corner.get(index) == simdjson::SUCCESS && index >= 0 &&
                 static_cast<size_t>(index) < vertices.size();
          if (good) points_.push_back(vertices[static_cast<size_t>(index)]);
        }
        rings_.push_back(static_cast<uint32_t>(points_.size()));
      }
    }
    if (!good || rings_.size() < 2) {
      writer_.count_bad(1);
      return;
    }
    writer_.add_polygon(points_, rings_);
  }

  std::string name_;
  Context& context_;
  SceneWriter writer_;
  std::string message_;
  std::vector<Vec3d> vertices_;
  std::vector<element> templates_;
  std::vector<Vec3d> template_vertices_;
  std::unordered_map<std::string_view, double> detail_of_object_;
  std::unordered_set<std::string_view> parts_;  // Ids of BuildingPart, BridgePart, TunnelPart.
  std::string node_;
  std::vector<std::string_view> surface_types_;
  std::vector<Vec3d> points_;
  std::vector<uint32_t> rings_;
};

}  // namespace

bool names_degrees(std::string_view reference_system) {
  // The codes of latitude and longitude in everyday use: WGS 84 (2D, 3D), ETRS89 (2D, 3D),
  // JGD2011 (2D, 3D), NAD83, GDA2020.
  constexpr std::array<std::string_view, 10> kCodes{"4326", "4979", "4258", "4937",  "6668",
                                                    "6697", "4269", "7844", "CRS84", "CRS84h"};
  size_t begin = reference_system.find_last_of("/:#");
  begin = begin == std::string_view::npos ? 0 : begin + 1;
  const std::string_view code = reference_system.substr(begin);
  return std::find(kCodes.begin(), kCodes.end(), code) != kCodes.end();
}

Result<RawScene> read_cityjson(std::string_view bytes, const ReadOptions& options,
                               Context& context) {
  simdjson::dom::parser parser;
  element root;
  if (const auto failure = parser.parse(simdjson::padded_string(bytes)).get(root);
      failure != simdjson::SUCCESS) {
    return Error{Errc::kBadFile,
                 fmt::format("{}: not JSON: {}", options.name, simdjson::error_message(failure))};
  }
  return CityJsonReader(options, context).read(root);
}

}  // namespace throng::importer
