// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <flatbuffers/flatbuffers.h>

#include <array>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "graph/nodes_generated.h"
#include "throng/base.h"
#include "throng/surface.h"
#include "world/zone_file.h"

/// Nodes in memory: zones mapped from files, or owned after they were made.
namespace throng::graph {

inline constexpr uint32_t kNodeVersion = 4;
inline constexpr const char* kNodeIndexName = "index.thn";
inline constexpr const char* kNodeFolder = "nodes";
inline constexpr const char* kPartNodeFolder = "nodes.part";  // in the making
inline constexpr const char* kOldNodeFolder = "nodes.old";    // of the world before this one
inline constexpr uint32_t kFarNode = uint32_t{1} << 31;
inline constexpr uint8_t kDeepestPatch = 6;
inline constexpr uint16_t kEdgeUnits = 256;  // of an edge, as doors count along it
inline constexpr uint8_t kTerminalFlag = 1, kPartialFlag = 2;  // of nodes
inline constexpr uint8_t kPartialLevel = 3;  // of partial nodes: blocks of 8 x 8 of a tile's cells

/// A zone's bytes after the verifier and the checks of its numbers.
class NodeZone : public world::ZoneFile<NodeZone> {
 public:
  [[nodiscard]] int32_t x() const { return root_->x(); }
  [[nodiscard]] int32_t z() const { return root_->z(); }
  [[nodiscard]] std::span<const format::NodePatch> patches() const { return patches_; }
  [[nodiscard]] std::span<const format::Node> nodes() const { return nodes_; }
  [[nodiscard]] std::span<const format::FarNode> far() const { return far_; }
  [[nodiscard]] std::span<const format::Door> doors() const { return doors_; }
  [[nodiscard]] std::span<const format::Arc> arcs(uint32_t node) const;
  [[nodiscard]] const format::Arc* first_arc() const { return arcs_.data(); }
  /// Which of its block's 8 x 8 cells a partial node is, bit 8 t + s; 0 if it is a whole block.
  [[nodiscard]] uint64_t cells_of(uint32_t node) const;
  /// The hole link of an arc, or null.
  [[nodiscard]] const format::HoleLink* hole_link_of(uint32_t arc) const;
  /// Patch of the zone that a node belongs to.
  [[nodiscard]] const format::NodePatch& patch_of(uint32_t node) const;
  /// The 48 numbers of a Bezier patch.
  [[nodiscard]] const double* points(const format::NodePatch& patch) const {
    return points_.data() + patch.points();
  }

 private:
  friend class world::ZoneFile<NodeZone>;
  Result<void> attach(const std::string& name);
  [[nodiscard]] const char* fault() const;

  const format::NodeZone* root_ = nullptr;
  std::span<const format::NodePatch> patches_;
  std::span<const format::Node> nodes_;
  std::span<const format::Arc> arcs_;
  std::span<const format::PartialCells> partial_;
  std::span<const format::HoleLink> hole_links_;
  std::span<const format::FarNode> far_;
  std::span<const format::Door> doors_;
  std::span<const double> points_;
};

/// What Nodes points to.
struct NodeData {
  using AreaList = std::vector<std::pair<uint32_t, double>>;
  struct Slot : world::ZoneSlot<NodeZone> {
    format::NodeZoneEntry entry;
    uint32_t first_node = 0;  // of all
  };

  NodeSummary summary;
  World world;  // that they belong to
  uint64_t world_hash = 0;
  double size = 0;
  std::string path;  // of their folder; empty: in memory
  std::vector<std::unique_ptr<Slot>> slots;
  std::vector<format::NodeInput> inputs;  // by z, then x
  uint32_t node_count = 0;
  struct ClassAreas {
    std::once_flag once;
    AreaList list;
  };
  mutable std::array<ClassAreas, kMaxAvatarClasses> class_areas;

  /// The zone of a slot, opened and checked at its first touch; null if it cannot be used.
  [[nodiscard]] const NodeZone* zone(size_t slot) const;
  /// Slot that holds a node of all. [node < node_count]
  [[nodiscard]] size_t slot_of(uint32_t node) const;
  /// Slot of a zone, or slots.size().
  [[nodiscard]] size_t slot_at(int32_t x, int32_t z) const;
  /// Patch of the scene, or level tile of the world.
  [[nodiscard]] uint32_t source_of(const NodeZone& zone, const format::NodePatch& patch) const;
  /// Those cells of a partial node of a zone on which a class may stand, by the ground; 0 of
  /// others.
  [[nodiscard]] uint64_t cells_of(const NodeZone& zone, uint32_t node, int32_t avatar_class) const;
  /// The part of a node on which a class may stand, if it is one of its classes. [m^2]
  [[nodiscard]] double area_of(const NodeZone& zone, uint32_t node, int32_t avatar_class) const;
  /// A node's zone and its number there; null if the zone cannot be used.
  [[nodiscard]] std::pair<const NodeZone*, uint32_t> find(uint32_t node) const;
  /// For a class, the nodes that share out its area (those whose parents it cannot stand on), and
  /// the area up to and with each. Made at the first use.
  [[nodiscard]] const AreaList& areas_before(int32_t avatar_class) const;
  /// Where an arc of a slot's zone leads to, as a node of all.
  [[nodiscard]] uint32_t target(size_t slot, const NodeZone& zone, const format::Arc& arc) const {
    return target(slot, zone, arc.to());
  }
  [[nodiscard]] uint32_t target(size_t slot, const NodeZone& zone, uint32_t to) const;
};

std::string node_file_name(int32_t x, int32_t z);

std::vector<uint8_t> write_node_index(const NodeData& nodes);
/// Fills everything but the world and the zones. Fails with kBadFile and `name`.
Result<std::shared_ptr<NodeData>> read_node_index(std::span<const uint8_t> bytes,
                                                  const std::string& name);

}  // namespace throng::graph
