// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <pugixml.hpp>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "import/formats/city.h"
#include "import/formats/text_cursor.h"

// CityGML nests features, thematic surfaces and geometries. Versions 2 and 3 (and many profiles)
// name the properties between them differently, but in all of them names that begin with a capital
// are features or geometries, properties are `lodN...`, and faces are gml:Polygon or similar. So
// the reader walks the tree and notes for each face its object, theme and detail.
namespace throng::importer {
namespace {

constexpr int kDeepestElement = 200;

std::string_view local_name(const pugi::xml_node& node) {
  const std::string_view name = node.name();
  const size_t colon = name.rfind(':');
  return colon == std::string_view::npos ? name : name.substr(colon + 1);
}

std::string_view local_attribute(const pugi::xml_node& node, std::string_view wanted) {
  for (const pugi::xml_attribute& attribute : node.attributes()) {
    std::string_view name = attribute.name();
    const size_t colon = name.rfind(':');
    if (colon != std::string_view::npos) name.remove_prefix(colon + 1);
    if (name == wanted) return attribute.value();
  }
  return {};
}

pugi::xml_node child_named(const pugi::xml_node& node, std::string_view wanted) {
  for (const pugi::xml_node& child : node.children()) {
    if (local_name(child) == wanted) return child;
  }
  return {};
}

bool is_face(std::string_view name) {
  return name == "Polygon" || name == "PolygonPatch" || name == "Triangle" || name == "Rectangle";
}

// GML's own containers of faces: not features.
bool is_geometry(std::string_view name) {
  constexpr std::array<std::string_view, 18> kNames{
      "Surface",           "MultiSurface", "CompositeSurface", "OrientableSurface",   "Solid",
      "CompositeSolid",    "MultiSolid",   "MultiGeometry",    "TriangulatedSurface", "Tin",
      "PolyhedralSurface", "Shell",        "CityModel",        "FeatureCollection",   "Envelope",
      "MultiCurve",        "Point",        "MultiPoint"};
  return std::find(kNames.begin(), kNames.end(), name) != kNames.end();
}

bool is_theme(std::string_view name) {
  return name.ends_with("Surface") || name == "Door" || name == "Window";
}

struct CityObject {
  std::string node;  // "Type/id"
  bool is_part = false;
  size_t parent = 0;
  int detail = -1;        // Highest of its faces.
  int parts_detail = -1;  // The lowest detail of its parts; -1 without parts.
  bool has_parts = false;
};

// A face, a reference to faces elsewhere, or an implicit geometry.
struct Use {
  enum class Kind { kFace, kReference, kImplicit } kind = Kind::kFace;
  size_t object = 0;
  int detail = 0;
  std::string_view theme;
  pugi::xml_node node;
};

class CityGmlReader {
 public:
  CityGmlReader(const ReadOptions& options, Context& context)
      : name_(options.name), context_(context), writer_(options) {}

  Result<RawScene> read(const pugi::xml_document& document) {
    objects_.push_back({.node = "CityModel",
                        .is_part = false,
                        .parent = 0,
                        .detail = -1,
                        .parts_detail = -1,
                        .has_parts = false});
    walk(document.document_element(), {}, 0);
    if (!message_.empty()) return Error{Errc::kBadFile, name_ + ": " + message_};
    choose_details();
    for (const auto kind : {Use::Kind::kFace, Use::Kind::kReference, Use::Kind::kImplicit}) {
      for (const Use& use : uses_) {
        if (context_.cancel) return Error{Errc::kCancelled, "cancelled while reading"};
        if (use.kind == kind && is_chosen(use)) write(use);
      }
    }
    if (lost_references_ > 0) {
      writer_.warn(fmt::format("{}: {} references lead to geometry that is not in the file", name_,
                               lost_references_));
    }
    auto scene = writer_.finish();
    if (!scene) return scene.error();
    return RawScene{.scene = *std::move(scene), .up = 'z', .metres_per_unit = 1};
  }

 private:
  struct Where {
    size_t object = 0;
    int detail = -1;  // -1 outside of all lodN properties.
    std::string_view theme;
  };

  void walk(const pugi::xml_node& node, Where where, int depth) {
    if (depth > kDeepestElement) {
      message_ = fmt::format("elements nest more than {} deep", kDeepestElement);
      return;
    }
    const std::string_view name = local_name(node);
    if (name.empty() || name.starts_with("appearance") || name == "Appearance") return;
    if (const auto id = local_attribute(node, "id"); !id.empty()) by_id_.emplace(id, node);
    check_system(local_attribute(node, "srsName"));
    if (name.size() > 4 && name.starts_with("lod") && name[3] >= '0' && name[3] <= '9') {
      where.detail = name[3] - '0';
    } else if (is_face(name)) {
      use(Use::Kind::kFace, where, node);
      return;
    } else if (name == "ImplicitGeometry") {
      use(Use::Kind::kImplicit, where, node);
      index_ids(node, depth);  // Its faces are written only through the matrix.
      return;
    } else if (name[0] >= 'A' && name[0] <= 'Z' && !is_geometry(name)) {
      if (is_theme(name))
        where.theme = name;
      else
        where = add_object(name, node, where);
    }
    const bool in_geometry = where.detail >= 0;
    if (in_geometry && !local_attribute(node, "href").empty()) {
      use(Use::Kind::kReference, where, node);
    }
    for (const pugi::xml_node& child : node.children()) walk(child, where, depth + 1);
  }

  void index_ids(const pugi::xml_node& node, int depth) {
    if (depth > kDeepestElement) return;
    if (const auto id = local_attribute(node, "id"); !id.empty()) by_id_.emplace(id, node);
    for (const pugi::xml_node& child : node.children()) index_ids(child, depth + 1);
  }

  void check_system(std::string_view system) {
    while (!system.empty() && message_.empty()) {  // "urn:...,crs:EPSG::28992,crs:EPSG::5709"
      const size_t comma = system.find(',');
      if (names_degrees(system.substr(0, comma))) {
        message_ =
            fmt::format("coordinates are degrees ({}); convert it to a metric system", system);
      }
      if (comma == std::string_view::npos) break;
      system.remove_prefix(comma + 1);
    }
  }

  Where add_object(std::string_view type, const pugi::xml_node& node, Where where) {
    CityObject object;
    object.node = fmt::format("{}/{}", type, local_attribute(node, "id"));
    if (object.node.back() == '/') object.node.pop_back();
    object.is_part = type.ends_with("Part");
    object.parent = where.object;
    objects_.push_back(std::move(object));
    return {.object = objects_.size() - 1, .detail = -1, .theme = {}};
  }

  void use(Use::Kind kind, const Where& where, const pugi::xml_node& node) {
    const int detail = std::max(where.detail, 0);  // A terrain has its level elsewhere.
    objects_[where.object].detail = std::max(objects_[where.object].detail, detail);
    uses_.push_back({kind, where.object, detail, where.theme, node});
  }

  void choose_details() {
    for (const CityObject& object : objects_) {
      if (!object.is_part) continue;
      CityObject& parent = objects_[object.parent];
      parent.parts_detail =
          parent.has_parts ? std::min(parent.parts_detail, object.detail) : object.detail;
      parent.has_parts = true;
    }
  }

  bool is_chosen(const Use& use) const {
    const CityObject& object = objects_[use.object];
    return use.detail == object.detail && object.parts_detail <= object.detail;
  }

  void write(const Use& use) {
    writer_.begin_part(objects_[use.object].node, use.theme);
    if (use.kind == Use::Kind::kFace) {
      if (written_.insert(use.node.internal_object()).second) write_face(use.node, {});
    } else if (use.kind == Use::Kind::kReference) {
      write_faces_below(target_of(use.node), {}, true, 0);
    } else {
      write_implicit(use.node);
    }
  }

  pugi::xml_node target_of(const pugi::xml_node& node) {
    std::string_view href = local_attribute(node, "href");
    const size_t hash = href.find('#');
    href = hash == std::string_view::npos ? std::string_view() : href.substr(hash + 1);
    const auto found = by_id_.find(href);
    if (found != by_id_.end()) return found->second;
    ++lost_references_;
    return {};
  }

  void write_faces_below(const pugi::xml_node& node, const Transform& place, bool once, int depth) {
    if (!node || depth > kDeepestElement) return;
    if (is_face(local_name(node))) {
      if (!once || written_.insert(node.internal_object()).second) write_face(node, place);
      return;
    }
    for (const pugi::xml_node& child : node.children()) {
      write_faces_below(child, place, once, depth + 1);
    }
  }

  void write_implicit(const pugi::xml_node& node) {
    std::vector<double> matrix, anchor;
    take_numbers(child_named(node, "transformationMatrix").text().get(), matrix);
    const pugi::xml_node point = child_named(child_named(node, "referencePoint"), "Point");
    take_numbers(child_named(point, "pos").text().get(), anchor);
    if (matrix.empty()) matrix = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    anchor.resize(3, 0.0);
    if (matrix.size() != 16) {
      writer_.count_bad(1);
      return;
    }
    Transform place;
    for (size_t row = 0; row < 3; ++row) {
      for (size_t column = 0; column < 4; ++column) place.m[row][column] = matrix[row * 4 + column];
      place.m[row][3] += anchor[row];
    }
    pugi::xml_node geometry = child_named(node, "relativeGMLGeometry");
    if (!geometry) geometry = child_named(node, "relativeGeometry");  // CityGML 3.
    if (!geometry) {
      ++lost_references_;  // A model in a file of its own.
      return;
    }
    if (!local_attribute(geometry, "href").empty()) geometry = target_of(geometry);
    write_faces_below(geometry, place, false, 0);
  }

  static void take_numbers(std::string_view text, std::vector<double>& out) {
    TextCursor cursor(text);
    double value = 0;
    while (cursor.take(value)) {
      out.push_back(value);
      if (cursor.peek() == ',') cursor.skip();  // gml:coordinates
    }
  }

  static size_t dimension_of(pugi::xml_node node) {
    for (; node; node = node.parent()) {
      const std::string_view text = local_attribute(node, "srsDimension");
      if (text == "2") return 2;
      if (!text.empty()) return 3;
    }
    return 3;
  }

  void write_face(const pugi::xml_node& face, const Transform& place) {
    points_.clear();
    rings_ = {0};
    for (const std::string_view wanted : {"exterior", "outerBoundaryIs"}) {
      add_ring(child_named(face, wanted), place);
    }
    if (rings_.size() != 2) {
      writer_.count_bad(1);
      return;
    }
    for (const pugi::xml_node& child : face.children()) {
      const std::string_view name = local_name(child);
      if (name == "interior" || name == "innerBoundaryIs") add_ring(child, place);
    }
    writer_.add_polygon(points_, rings_);
  }

  void add_ring(const pugi::xml_node& boundary, const Transform& place) {
    if (!boundary) return;
    const size_t first = points_.size();
    add_points(boundary, place, 0);
    if (points_.size() > first + 1 && points_[first] == points_.back()) points_.pop_back();
    if (points_.size() > first) rings_.push_back(static_cast<uint32_t>(points_.size()));
  }

  void add_points(const pugi::xml_node& node, const Transform& place, int depth) {
    if (depth > kDeepestElement) return;
    for (const pugi::xml_node& child : node.children()) {
      const std::string_view name = local_name(child);
      if (name != "posList" && name != "pos" && name != "coordinates") {
        add_points(child, place, depth + 1);
        continue;
      }
      numbers_.clear();
      take_numbers(child.text().get(), numbers_);
      const size_t step = dimension_of(child);
      for (size_t i = 0; i + step <= numbers_.size(); i += step) {
        points_.push_back(place({numbers_[i], numbers_[i + 1], step == 3 ? numbers_[i + 2] : 0}));
      }
    }
  }

  std::string name_;
  Context& context_;
  SceneWriter writer_;
  std::string message_;
  std::vector<CityObject> objects_;
  std::vector<Use> uses_;
  std::unordered_map<std::string_view, pugi::xml_node> by_id_;
  std::unordered_set<const void*> written_;
  uint64_t lost_references_ = 0;
  std::vector<double> numbers_;
  std::vector<Vec3d> points_;
  std::vector<uint32_t> rings_;
};

}  // namespace

Result<RawScene> read_citygml(std::string_view bytes, const ReadOptions& options,
                              Context& context) {
  pugi::xml_document document;
  const auto parsed = document.load_buffer(bytes.data(), bytes.size(), pugi::parse_default);
  if (!parsed) {
    const auto at = static_cast<ptrdiff_t>(std::min<size_t>(parsed.offset, bytes.size()));
    return Error{
        Errc::kBadFile,
        fmt::format("{}:{}: not XML: {}", options.name,
                    1 + std::count(bytes.begin(), bytes.begin() + at, '\n'), parsed.description())};
  }
  return CityGmlReader(options, context).read(document);
}

}  // namespace throng::importer
