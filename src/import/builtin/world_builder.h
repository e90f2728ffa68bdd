// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "throng/base.h"
#include "throng/scene.h"

/// Collects the triangles of a built-in world by node and material, with shared corners.
namespace throng::importer {

/// The materials of built-in worlds. Names and kinds: material_info.
enum class Mat : uint8_t {
  kFloor,
  kSlab,
  kWall,
  kRoof,
  kRamp,
  kStairs,
  kPillar,
  kKerb,
  kPavement,
  kRoad,
  kGrass,
  kStone,
  kWood,
  kGrating,
  kSteel,
  kRailing,
  kPipe,
  kTank,
  kCar,
  kCarDark,
  kCarLight,
  kTyre,
  kGlass,
  kTrunk,
  kCrown,
  kWater,
  kTiles,
  kCount
};

struct MaterialInfo {
  std::string_view name;
  AreaKind kind = kAreaWalkable;
};

const MaterialInfo& material_info(Mat material);

/// A place and a heading in plan: local x runs along (ux, uz), local z a quarter turn from it.
struct Frame {
  Vec3d origin;
  double ux = 1;
  double uz = 0;
  [[nodiscard]] Vec3d operator()(Vec3d p) const {
    return {origin.x + p.x * ux - p.z * uz, origin.y + p.y, origin.z + p.x * uz + p.z * ux};
  }
};

/// Corner ids are into one array for the whole world; triangles are sorted into (node, material)
/// parts and joined at the end. Corners are rounded to whole millimetres, so that the last bit of a
/// sine never matters.
class WorldBuilder {
 public:
  WorldBuilder() { node("world"); }

  /// Triangles from here on belong to `name`. Calling it again with an old name starts a new node.
  void node(std::string name);
  void place(const Frame& frame) { frame_ = frame; }
  [[nodiscard]] const Frame& frame() const { return frame_; }

  uint32_t vertex(Vec3d local);
  /// Skips triangles that rounding has made flat. Counter-clockwise seen from outside.
  void triangle(Mat material, uint32_t a, uint32_t b, uint32_t c);
  void quad(Mat material, uint32_t a, uint32_t b, uint32_t c, uint32_t d);
  /// A convex polygon as a fan.
  void polygon(Mat material, const std::vector<uint32_t>& corners);

  void reserve(size_t vertices) { positions_.reserve(vertices); }
  [[nodiscard]] uint64_t triangle_count() const { return triangle_count_; }
  /// Hands over everything; the builder is empty afterwards.
  [[nodiscard]] Scene finish();

 private:
  static constexpr size_t kMaterials = static_cast<size_t>(Mat::kCount);
  struct Node {
    std::string name;
    std::array<std::vector<std::array<uint32_t, 3>>, kMaterials> triangles;
  };

  Frame frame_;
  std::vector<Vec3d> positions_;
  std::vector<Node> nodes_;
  uint64_t triangle_count_ = 0;
};

/// Cosine and sine of an angle in turns, without libm: the same bits on every machine.
std::array<double, 2> unit_circle(double turns);

}  // namespace throng::importer
