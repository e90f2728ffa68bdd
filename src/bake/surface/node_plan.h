// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <compare>
#include <cstdint>
#include <span>
#include <vector>

#include "bake/surface/node_scene.h"
#include "throng/base.h"
#include "throng/surface.h"
#include "world/zone_data.h"

/// Which patches nodes are made of, zone by zone, and what each zone's nodes depend on.
namespace throng::bake {

/// A patch of the forest: where it comes from and which zone keeps it.
struct PatchSource {
  int32_t zone_z = 0, zone_x = 0;
  PatchKind kind = PatchKind::kBezier;
  uint32_t source = 0;  ///< Patch of the whole scene, or level of the world.

  friend auto operator<=>(const PatchSource&, const PatchSource&) = default;
};

/// A zone that patches belong to.
struct NodePlanZone {
  int32_t x = 0, z = 0;
  uint32_t first = 0, last = 0;  ///< of the plan's sources
  bool has_tiles = false;        ///< Are some of these level tiles?
  Box3d box = {};                ///< That holds its patches, heights left out.
  double reach = 0;              ///< How far around it triangles bear on its nodes. [m]
  uint64_t bytes = 0;            ///< What its nodes take while they are made, about.
  std::vector<uint32_t> near =
      {};  ///< Zones that its nodes depend on, itself among them; ascending.
  std::vector<uint32_t> off_mesh_links = {};  ///< That begin or end in or near it, ascending.
  uint64_t own = 0;                           ///< XXH3 of what its trees depend on.
  uint64_t input = 0;                         ///< XXH3 of all that its nodes depend on.
};

struct NodePlan {
  bool has_patches = false;  ///< Do Bezier patches carry a class,
  bool has_tiles = false;    ///< do level tiles?
  bool drops = false;        ///< Does a class drop?
  uint16_t on_patches = 0;   ///< Classes that patches carry.
  bool knows_parts = false;  ///< Does the scene state which part of its patch a triangle covers?
  /// Do patches carry all classes? Then level tiles carry what lies on other ground alone.
  bool has_objects = false;
  double near_reach = 0;  ///< How far from each other nodes are linked, or bear on widths. [m]
  std::vector<uint8_t> object_tiles = {};  ///< If so: ObjectSurvey::tiles.
  std::vector<PatchSource> sources;
  std::vector<NodePlanZone> zones;  ///< By z, then x.

  /// May a level tile carry nodes? By its place in the plan.
  [[nodiscard]] bool is_carrier(const world::WorldData& world, int32_t x, int32_t z) const {
    return !has_objects ||
           object_tiles[static_cast<size_t>(z) * static_cast<size_t>(world.summary.tiles_x) +
                        static_cast<size_t>(x)] != 0;
  }

  /// Do nodes need triangles at all?
  [[nodiscard]] bool needs_triangles() const { return has_patches || drops; }
};

/// Lists patches and zones, by zones, then kinds, then sources, and finds which zones depend on
/// which: a zone that has to be made reads its `near` zones. Fails as NodeScene::region does.
[[nodiscard]] Result<NodePlan> plan_nodes(const world::WorldData& world, const NodeScene& scene,
                                          const NodeConfig& config, Context& context);

/// Finds `input` of each zone: equal inputs give equal bytes. Fails as NodeScene::region does.
[[nodiscard]] Result<void> find_node_inputs(const world::WorldData& world, const NodeScene& scene,
                                            const NodeConfig& config, Context& context,
                                            NodePlan& plan);

/// The box of all on which the nodes of some zones depend, without the zones near them.
[[nodiscard]] Box3d box_around(const NodePlan& plan, std::span<const uint32_t> zones);

/// Zones and those near them, ascending.
[[nodiscard]] std::vector<uint32_t> with_near_zones(const NodePlan& plan,
                                                    std::span<const uint32_t> zones);

/// Splits zones, given in ascending order, into batches whose nodes are made together: nearly
/// square, of about `max_bytes` each, because zones near a batch are made for it too. At least one;
/// only a single batch may be empty.
[[nodiscard]] std::vector<std::vector<uint32_t>> node_batches(const NodePlan& plan,
                                                              const NodeScene& scene,
                                                              std::vector<uint32_t> zones,
                                                              uint64_t max_bytes);
/// What the nodes of all zones would take while they are made, about. [bytes]
[[nodiscard]] uint64_t all_working_bytes(const NodePlan& plan);
/// The same of a batch, with what lies near its zones and is made for it too.
[[nodiscard]] uint64_t batch_working_bytes(const NodePlan& plan, std::span<const uint32_t> batch);

}  // namespace throng::bake
