// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstdlib>
#include <cstring>

#include "core/access.h"
#include "world/air_data.h"

// An air file that passes the checks must answer every look-up without reading past its bytes. The
// input is tried as a file, and as the words of a tree in a file whose checksum is right.
namespace throng {
namespace {

void ask(const world::AirTree& tree) {
  static volatile uint64_t sum = 0;
  uint64_t nodes = 0;
  tree.for_each([&](const world::AirCube& cube, uint32_t word) {
    if (++nodes > tree.nodes.size()) std::abort();  // more than there are: a cycle
    if (world::air_kind(word) == world::AirKind::kLeaf)
      sum = sum + tree.leaves[world::air_number(word)];
    const bool free = tree.is_free(cube.x, cube.y, cube.z);
    if (world::air_kind(word) == world::AirKind::kFree && !free) std::abort();
    if (world::air_kind(word) == world::AirKind::kFull && free) std::abort();
  });
  for (int32_t i = -3; i < 200; i += 7) {
    sum = sum + (tree.is_free(i, tree.base + i * 3 % 100, i * 5 % 64) ? 1 : 0);
  }
}

void try_file(flatbuffers::DetachedBuffer bytes) {
  const auto zone = world::AirZone::from_bytes(std::move(bytes), "fuzz");
  if (zone) ask((*zone)->tree());
}

}  // namespace
}  // namespace throng

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size) {
  auto* copy = new uint8_t[size];
  std::copy_n(bytes, size, copy);
  throng::try_file(flatbuffers::DetachedBuffer(nullptr, false, copy, size, copy, size));
  if (size < 4) return 0;
  throng::world::AirTreeData tree;
  tree.side = 1 << (bytes[0] % 18);
  tree.base = static_cast<int8_t>(bytes[1]);
  tree.roots = bytes[2];
  tree.leaves.assign(bytes[3] % 8, 0x0123456789abcdef);
  tree.nodes.resize((size - 4) / 4);
  if (!tree.nodes.empty()) std::memcpy(tree.nodes.data(), bytes + 4, tree.nodes.size() * 4);
  throng::try_file(throng::world::air_zone_bytes(0, 0, 0, tree));
  return 0;
}
