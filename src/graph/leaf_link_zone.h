// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "graph/leaf_links_generated.h"
#include "throng/base.h"
#include "world/air_leaf.h"
#include "world/zone_file.h"

/// Files of links between leaves of the air and nodes.
namespace throng::graph {

inline constexpr uint32_t kLeafLinkVersion = 1;
inline constexpr const char* kLeafLinkIndexName = "index.thg";
inline constexpr const char* kLeafLinkRemedy = "bake the world again with --nodes";

/// A zone's bytes after the verifier and the checks of its numbers.
class LeafLinkZone : public world::ZoneFile<LeafLinkZone> {
 public:
  [[nodiscard]] int32_t x() const { return root_->x(); }
  [[nodiscard]] int32_t z() const { return root_->z(); }
  [[nodiscard]] uint64_t input() const { return root_->input(); }
  [[nodiscard]] std::span<const format::LeafLink> links() const { return links_; }
  [[nodiscard]] std::span<const format::LinkedNode> far() const { return far_; }
  [[nodiscard]] std::span<const format::NodeLeaf> far_leaves() const { return far_leaves_; }
  /// The links from a leaf of the zone.
  [[nodiscard]] std::span<const format::LeafLink> of_leaf(const world::AirLeaf& leaf) const;
  /// Which links lead to a node of the zone from leaves of the zone.
  [[nodiscard]] std::span<const uint32_t> of_node(uint32_t node) const;
  /// Leaves of other zones from which links lead to a node of the zone.
  [[nodiscard]] std::span<const format::NodeLeaf> far_of_node(uint32_t node) const;

 private:
  friend class world::ZoneFile<LeafLinkZone>;
  Result<void> attach(const std::string& name);
  [[nodiscard]] const char* fault() const;

  const format::LeafLinkZone* root_ = nullptr;
  std::span<const format::LeafLink> links_;
  std::span<const uint32_t> by_node_;
  std::span<const format::LinkedNode> far_;
  std::span<const format::NodeLeaf> far_leaves_;
};

[[nodiscard]] inline world::AirLeaf leaf_of(const format::LeafLink& link) {
  return {link.leaf(), link.piece()};
}

/// What the index says of all.
struct LeafLinkIndex {
  uint64_t air = 0, nodes = 0;  ///< XXH3 of the indexes that they belong to.
  std::vector<format::LeafLinkEntry> zones;
};
[[nodiscard]] std::vector<uint8_t> write_leaf_link_index(const LeafLinkIndex& index);
/// Fails with kBadFile and `name`.
[[nodiscard]] Result<LeafLinkIndex> read_leaf_link_index(std::span<const uint8_t> bytes,
                                                         const std::string& name);

[[nodiscard]] std::string leaf_link_file_name(int32_t x, int32_t z);

}  // namespace throng::graph
