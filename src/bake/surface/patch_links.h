// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "bake/surface/body_motion.h"
#include "bake/surface/patch_cells.h"
#include "graph/node_links.h"

/// Which classes go from a Bezier patch's cells to those of others: over shared edges, over the
/// holes that patches make in each other, and onto level tiles.
namespace throng::bake {

struct PatchLinkInput {
  const TriangleSquares* triangles = nullptr;
  const World* world = nullptr;
  std::span<const AvatarClass> classes;
  std::span<const BezierCells> cells;  ///< By patch of the scene; none of those not judged.
  double size = 1;                     ///< Of cells. [m]
  /// By patch of the scene: are its links of interest? Empty: those of all.
  std::span<const uint8_t> is_linked = {};

  [[nodiscard]] bool is_judged(uint32_t patch) const { return !cells[patch].promise.cells.empty(); }
  [[nodiscard]] bool links(uint32_t patch) const {
    return is_linked.empty() || is_linked[patch] != 0;
  }
};

/// A part of an edge over which the same classes go to the patch beyond and back, in 256ths of the
/// edges: `first` meets `to_first`, and the edge beyond runs in the opposite direction.
struct PatchDoor {
  uint32_t patch = 0, to_patch = 0;
  uint8_t edge = 0, to_edge = 0;
  uint16_t classes = 0;
  uint16_t first = 0, last = 0, to_first = 0, to_last = 0;
};

struct EdgeLinks {
  std::vector<graph::CellPair> pairs;
  std::vector<PatchDoor> doors;  ///< By patch.
};

/// The farthest that a class goes over a hole between patches, from cell to cell. [m]
[[nodiscard]] inline double hole_link_reach(double radius, double size) {
  return 3 * size + 2 * radius;
}

/// The middle of a cell of a patch, as a body stands there.
[[nodiscard]] BodyPose pose_on(const PatchLinkInput& input, const PatchBody& body, uint32_t patch,
                               uint32_t cell);

/// Can a body go straight from one pose to another? A walker also needs ground within a step under
/// all of its move. [m]
[[nodiscard]] bool goes_straight(MotionJudge& judge, const PatchBody& body, const BodyPose& from,
                                 const BodyPose& to, double step);

/// Pairs of cells over all edges that patches share, and where exactly they touch. Where the
/// surface has a crease, a climber must be able to turn over it.
[[nodiscard]] EdgeLinks link_edges(const PatchLinkInput& input, int32_t workers);

/// For each class, each cell of a patch with holes that lacks a neighbour, and each patch that made
/// the holes: the nearest of its cells to which the body can go straight. Source: [PACS00] 1.2.3.6.
[[nodiscard]] std::vector<graph::CellPair> link_holes(const PatchLinkInput& input, int32_t workers);

/// Cells on which a climber also finds a place on a level tile, and can straighten up there.
/// `patch_b` counts levels of the world; `carries`: do nodes of level tiles hold a place?
[[nodiscard]] std::vector<graph::CellPair> link_tiles(
    const PatchLinkInput& input, const std::function<bool(const Place&)>& carries, int32_t workers);

}  // namespace throng::bake
