// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "world/node_data.h"

/// Nodes that lie in a world's folder from an earlier bake.
namespace throng {

class OldNodes {
 public:
  /// Of the world itself, and those that its bake has carried over from the world before it. What
  /// cannot be read is left out. [world_path may be empty: none]
  explicit OldNodes(const std::string& world_path);

  /// The zone's nodes if they were made from this input and their file is whole: null if it has
  /// none, else mapped.
  [[nodiscard]] std::optional<std::unique_ptr<NodeData::Slot>> keep(int32_t x, int32_t z,
                                                                    uint64_t input) const;

 private:
  std::vector<std::shared_ptr<const NodeData>> folders_;  // their indexes
};

/// Carries the nodes of the world in `from` over to `to`, which takes its place, as far as that can
/// be done: as its own if it is the same world.
void carry_nodes(const std::string& from, const std::string& to, bool is_same_world);

}  // namespace throng
