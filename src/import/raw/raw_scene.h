// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "import/raw/polygon.h"
#include "throng/base.h"
#include "throng/scene.h"

/// What the readers of all formats share. A reader turns bytes into triangles as they are in the
/// file: its units, its axes, nothing cleaned. load_scene does the rest.
namespace throng::importer {

/// A corner of a landscape zone that a corner of another zone meets.
struct ZoneCorner {
  uint16_t corner = 0;
  uint16_t other_zone = 0;
  uint16_t other_corner = 0;
};

/// An edge whose neighbours lie in another zone, as the file numbers them.
struct ZoneBind {
  PatchSide side;  ///< Counted within this zone.
  EdgeBind bind = EdgeBind::kOpen;
  uint16_t other_zone = 0;
  std::array<PatchSide, 4> next{};  ///< Counted within the other zone.
};

/// One zone of a landscape, until it is joined with its neighbours.
struct PatchZone {
  uint16_t id = 0;
  std::string file;
  uint32_t first_patch = 0;
  std::vector<std::array<uint16_t, 4>> corners;  ///< Of each patch, as the file numbers them.
  std::vector<ZoneCorner> border;                ///< Sorted.
  std::vector<ZoneBind> far;
};

/// A corner of a triangle that names no vertex; clean_scene drops and counts the triangle.
inline constexpr uint32_t kNoVertex = UINT32_MAX;

/// A picture that a file names or contains.
struct TextureSource {
  std::string name;   ///< As the file has it: a path, if it holds no bytes.
  std::string bytes;  ///< Of a PNG, JPEG ...; or, where it has a size, RGBA texels.
  int32_t width = 0, height = 0;
};

struct RawScene {
  /// In the file's units and axes; patches without their triangles. The textures of its materials
  /// are still in `textures`.
  Scene scene;
  char up = 'y';  ///< Which axis of these numbers points up.
  double metres_per_unit = 1;
  std::optional<PatchZone> zone = std::nullopt;  ///< Where the file is one zone of many.
  std::vector<TextureSource> textures = {};
};

struct ReadOptions {
  std::string name;                       ///< The file, for messages and parts.
  double curve_tolerance = 0.02;          ///< [m]
  double plan_height = 3;                 ///< [m]
  std::optional<double> metres_per_unit;  ///< The user's own, where given.
  SceneMaterials materials = SceneMaterials::kLeaveOut;
};

/// Adds meshes and polygons to a scene, and counts what cannot be solid.
class SceneWriter {
 public:
  explicit SceneWriter(const ReadOptions& options) : file_(options.name) {}

  /// Triangles added from here on belong to this node and material. `material1` as of a ScenePart.
  void begin_part(std::string_view node, std::string_view material, uint32_t material1 = 0);
  uint32_t add_vertex(Vec3d p);
  void add_triangle(uint32_t a, uint32_t b, uint32_t c);
  /// A polygon by its corners; rings as in PolygonCutter::cut. Too short rings are counted.
  void add_polygon(std::span<const Vec3d> points, std::span<const uint32_t> ring_first);

  /// One face over vertices that were added before: a triangle as it is, anything longer as a
  /// polygon. Fewer than three corners, or kNoVertex among them, are counted as bad. Linear, but
  /// for polygons as PolygonCutter::cut.
  void add_face(std::span<const uint32_t> corners);
  /// The same with a place in the texture for each corner; none: there is no texture.
  void add_face(std::span<const uint32_t> corners, std::span<const std::array<float, 2>> places);
  /// Of the triangle that was added last.
  void set_texture_corners(const TextureCorners& corners);

  void count_bad(uint64_t triangles) { bad_ += triangles; }
  void count_points_and_lines(uint64_t count) { thin_ += count; }
  void warn(std::string sentence) { scene_.report.warnings.push_back(std::move(sentence)); }
  [[nodiscard]] Scene& scene() { return scene_; }
  [[nodiscard]] bool full() const;  ///< More vertices than indices can name.

  /// Closes the last part and turns the counts into the report. Fails with kLimit.
  Result<Scene> finish();

 private:
  std::string file_;
  Scene scene_;
  PolygonCutter cutter_;
  std::vector<std::array<uint32_t, 3>> cut_;
  std::vector<Vec3d> points_;  // of a face
  uint64_t bad_ = 0;
  uint64_t thin_ = 0;
  uint64_t inexact_ = 0;
};

}  // namespace throng::importer
