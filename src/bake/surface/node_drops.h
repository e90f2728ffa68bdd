// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <compare>
#include <cstdint>
#include <span>
#include <vector>

#include "bake/surface/object_ground.h"
#include "bake/surface/patch_links.h"

/// One-way drops: where a class with a `max_drop` goes out over an edge of its ground and straight
/// down to lower ground.
namespace throng::bake {

/// A cell of a Bezier patch of the scene, or of a level of the world.
struct DropEnd {
  PatchKind kind = PatchKind::kBezier;
  uint32_t source = 0;
  uint32_t cell = 0;

  friend auto operator<=>(const DropEnd&, const DropEnd&) = default;
};

struct NodeDrop {
  DropEnd from, to;
  uint16_t classes = 0;
};

/// How far a drop leads sideways beyond the body's width. On level tiles it stands on ground all
/// around, a radius from the edge, and comes down a radius beside it; and either is known to a cell
/// and a half. [cells]
inline constexpr double kDropCells = 3;

/// How far a drop of a class leads sideways at most, from cells of a size; 0 if it does not drop.
/// [m]
[[nodiscard]] inline double drop_reach(const AvatarClass& avatar, double cell) {
  return avatar.max_drop > 0 ? 2 * avatar.radius + kDropCells * cell : 0;
}

struct DropInput {
  PatchLinkInput links;
  std::span<const graph::CellPair>
      edges;                         ///< Over the edges of Bezier patches, by patch of the scene.
  bool tiles = false;                ///< Whether level tiles carry a class.
  std::span<const uint32_t> levels;  ///< Of the world: those from which drops are looked for.
  bool has_objects = false;          ///< Do level tiles carry the cells of objects alone?
  std::span<const ObjectLevel> objects = {};
  uint16_t wanted = 0xffff;  ///< Classes.
};

/// For each class with a `max_drop` and each cell of its ground from which it cannot go on to one
/// side: the place sideways at hand that is nearest in the plane, lower by more than a step and at
/// most by `max_drop`, not to be walked to straight, to which its body can drop: level out from the
/// middle of the cell to above the middle of the other, upright there, and straight down. Proved
/// against the triangles. By where they begin and end, each pair of places once.
[[nodiscard]] std::vector<NodeDrop> find_drops(const DropInput& input, int32_t workers);

}  // namespace throng::bake
