// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "bake/surface/node_batch.h"
#include "bake/surface/node_folder.h"
#include "bake/surface/node_plan.h"
#include "bake/surface/node_scene.h"

/// Which zones' nodes have to be made, in which batches, and where they go; by one process or by
/// several of which each makes batches of its own.
namespace throng::bake {

class NodeBaker {
 public:
  /// What is said of a zone that was made: nothing, if it has no nodes.
  struct Made {
    uint32_t zone = 0;  ///< Of the plan.
    uint32_t has_nodes = 0;
    format::NodeZoneEntry entry;
  };

  /// Without a folder nodes stay in memory. All is kept by reference.
  NodeBaker(const World& world, NodeScene scene, const NodeConfig& config,
            const NodeFolder* folder);

  /// Can nodes be made of this at all?
  [[nodiscard]] static Result<void> check(const World& world, const NodeScene& scene,
                                          const NodeConfig& config);
  /// Do all off-mesh links begin and end at places of the world? Reads the zones around them only.
  /// Fails with kBadInput, kBadFile or kCancelled.
  [[nodiscard]] static Result<void> check_off_mesh_links(const World& world, const NodeScene& scene,
                                                         const NodeConfig& config,
                                                         Context& context);
  /// Finds the zones and what each depends on. Fails as NodeScene::region does.
  Result<void> plan(Context& context);
  /// Of all that zones depend on: processes that make nodes together have the same.
  [[nodiscard]] uint64_t input() const;
  /// Takes over zones of earlier bakes.
  Result<void> reuse_zones();
  /// Those that are left, in batches of at most about so much memory each. [bytes] At least one.
  [[nodiscard]] std::vector<std::vector<uint32_t>> batches(uint64_t max_bytes) const;
  /// What all of them would take at once, about, and a batch with what lies near it. [bytes]
  [[nodiscard]] uint64_t working_bytes() const { return all_working_bytes(plan_); }
  [[nodiscard]] uint64_t working_bytes(std::span<const uint32_t> batch) const {
    return batch_working_bytes(plan_, batch);
  }
  [[nodiscard]] uint64_t zones() const { return plan_.zones.size(); }
  [[nodiscard]] uint64_t zones_done() const;

  /// Before batches are made in this order: keeps what several of them judge, in a file of the
  /// folder, if there is one. Changes no node.
  void keep_cells(std::span<const std::vector<uint32_t>> batches);
  /// `is_last`: triangles are let go as soon as may be.
  Result<NodeSlots> make_nodes(std::span<const uint32_t> zones, bool is_last, Context& context);
  /// Writes what was made into the folder, if there is one, and lets it go.
  Result<std::vector<Made>> write(std::span<const uint32_t> zones, NodeSlots& made) const;
  /// Enters what was made by this process, with `slots`, or by another.
  void enter(std::span<const Made> made, NodeSlots* slots = nullptr);
  /// Writes for the next bake what is in the folder so far.
  Result<void> list();
  /// All of them, once they are made. Fails with kLimit: too many.
  Result<std::shared_ptr<graph::NodeData>> finish();

 private:
  void drop_cells(std::span<const uint32_t> zones);
  [[nodiscard]] Result<std::shared_ptr<NodeRegion>> region_of(std::span<const uint32_t> zones,
                                                              Context& context) const;
  [[nodiscard]] NodeBatchInput batch_input(NodeRegion& region, bool is_last,
                                           Context& context) const;
  [[nodiscard]] std::shared_ptr<graph::NodeData> gather();

  const World& world_;
  const world::WorldData& data_;
  const NodeScene scene_;
  const NodeConfig& config_;
  const NodeFolder* folder_;  // may be null
  NodeBins bins_;
  NodePlan plan_;
  std::vector<uint8_t> is_done_;        // by zone of the plan
  NodeSlots slots_;                     // likewise
  std::vector<uint32_t> batches_near_;  // by zone: batches left that judge its patches
  std::unique_ptr<CellStore> cells_;    // null: nothing is kept
  uint64_t reused_ = 0;
};

}  // namespace throng::bake
