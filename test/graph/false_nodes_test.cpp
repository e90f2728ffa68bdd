// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "baked.h"
#include "core/access.h"
#include "core/random.h"
#include "graph/node_data.h"

// Files of nodes with bytes changed at random: refused by name, or used without reading beyond
// them.
namespace throng {
namespace {

Nodes make_small(Scene& scene) {
  scene = test::builtin({.name = "landscape", .size = 100});
  std::vector<AvatarClass> classes = {AvatarClass{}, AvatarClass{.name = "climber"}};
  classes[1].climb_slope = 150;
  Context context;
  const auto nodes = Nodes::create(test::bake(scene, 0.5, classes), scene, {.size = 4}, context);
  EXPECT_TRUE(nodes);
  return nodes ? *nodes : Nodes{};
}

std::unique_ptr<graph::NodeZone> changed(std::span<const uint8_t> bytes, uint64_t seed,
                                         std::string& why) {
  auto* copy = new uint8_t[bytes.size()];
  std::copy(bytes.begin(), bytes.end(), copy);
  const uint64_t changes = 1 + random_below(seed, 0, 0, 3);
  for (uint64_t k = 0; k < changes; ++k) {
    copy[random_below(seed, k, 1, bytes.size())] = static_cast<uint8_t>(random_u64(seed, k, 2));
  }
  auto zone = graph::NodeZone::from_bytes(
      flatbuffers::DetachedBuffer(nullptr, false, copy, bytes.size(), copy, bytes.size()), "it");
  if (!zone) why = zone.error().message;
  return zone ? std::move(*zone) : nullptr;
}

TEST(FalseNodes, AreRefusedByNameOrUsedWithoutACrash) {
  Scene scene;
  const Nodes nodes = make_small(scene);
  size_t refused = 0, used = 0;
  for (uint64_t seed = 0; seed < 1500; ++seed) {
    const graph::NodeZone& zone = *data_of(nodes)->zone(seed % data_of(nodes)->slots.size());
    std::string why;
    const auto found = changed(zone.bytes(), seed, why);
    if (found == nullptr) {
      EXPECT_EQ(why.substr(0, 4), "it: ");
      ++refused;
      continue;
    }
    uint64_t sum = 0;
    for (uint32_t n = 0; n < found->nodes().size(); ++n) {
      const format::NodePatch& patch = found->patch_of(n);
      EXPECT_GE(n, patch.first_node());
      EXPECT_LT(n, patch.first_node() + patch.nodes());
      EXPECT_EQ(found->cells_of(n) != 0, (found->nodes()[n].flags() & graph::kPartialFlag) != 0);
      if (patch.kind() == 0) sum += static_cast<uint64_t>(found->points(patch)[47] != 0);
      for (const format::Arc& arc : found->arcs(n)) {
        const uint32_t to = arc.to() & ~graph::kFarNode;
        sum += (arc.to() & graph::kFarNode) != 0 ? found->far()[to].node()
                                                 : found->nodes()[to].level();
        const auto* hole_link =
            found->hole_link_of(static_cast<uint32_t>(&arc - found->first_arc()));
        sum += hole_link != nullptr ? hole_link->to_s() : 0;
      }
    }
    for (const format::Door& door : found->doors()) {
      const uint32_t to = door.to() & ~graph::kFarNode;
      sum +=
          (door.to() & graph::kFarNode) != 0 ? found->far()[to].node() : found->nodes()[to].level();
      sum += found->patches()[door.patch()].depth();
    }
    used += sum > 0 ? 1 : 0;
  }
  EXPECT_GT(refused, 100u);
  EXPECT_GT(used, 300u);
}

// The arc is changed in the bytes of the file: `kind` is its last byte but one.
TEST(FalseNodes, AnArcOfAKindThatDoesNotExistIsRefusedByName) {
  Scene scene;
  const Nodes nodes = make_small(scene);
  const graph::NodeZone& zone = *data_of(nodes)->zone(0);
  uint32_t node = 0;
  while (node + 1 < zone.nodes().size() && zone.arcs(node).empty()) ++node;
  ASSERT_FALSE(zone.arcs(node).empty());
  const format::Arc& arc = zone.arcs(node).front();
  const auto at =
      static_cast<size_t>(reinterpret_cast<const uint8_t*>(&arc) - zone.bytes().data()) + 6;
  for (const int32_t kind : {0, kLinkKinds - 1, int32_t{kLinkKinds}, 6, 255}) {
    const size_t size = zone.bytes().size();
    auto* copy = new uint8_t[size];
    std::copy_n(zone.bytes().data(), size, copy);
    ASSERT_EQ(copy[at], arc.kind());
    copy[at] = static_cast<uint8_t>(kind);
    const auto found = graph::NodeZone::from_bytes(
        flatbuffers::DetachedBuffer(nullptr, false, copy, size, copy, size), "it");
    EXPECT_EQ(static_cast<bool>(found), kind < kLinkKinds) << kind;
    if (found) continue;
    EXPECT_EQ(found.error().message.substr(0, 30), "it: an arc is of no known kind");
  }
}

TEST(FalseNodes, ATruncatedFileOrOneOfAnotherKindIsRefused) {
  Scene scene;
  const Nodes nodes = make_small(scene);
  const auto bytes = data_of(nodes)->zone(0)->bytes();
  for (size_t size = 0; size < bytes.size(); size += 1 + size / 3) {
    auto* copy = new uint8_t[size + 1];
    std::copy_n(bytes.data(), size, copy);
    EXPECT_FALSE(graph::NodeZone::from_bytes(
        flatbuffers::DetachedBuffer(nullptr, false, copy, size + 1, copy, size), "it"));
  }
  const std::vector<uint8_t> index = graph::write_node_index(*data_of(nodes));
  EXPECT_TRUE(graph::read_node_index(index, "it"));
  EXPECT_FALSE(graph::read_node_index(std::span(index).first(index.size() / 2), "it"));
  EXPECT_FALSE(graph::read_node_index(bytes, "it"));  // A zone is no index.
  size_t refused = 0;
  for (uint64_t seed = 0; seed < 500; ++seed) {
    std::vector<uint8_t> copy = index;
    copy[random_below(seed, 0, 5, copy.size())] = static_cast<uint8_t>(random_u64(seed, 0, 6));
    refused += graph::read_node_index(copy, "it") ? 0 : 1;
  }
  EXPECT_GT(refused, 20u);
}

}  // namespace
}  // namespace throng
