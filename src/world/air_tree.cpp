// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "world/air_tree.h"

#include <bit>

// Checks an octree of a file, so that look-ups need no checks. Linear in its words.
namespace throng::world {

// Each group is named once and stands before the group that names it, so a walk over the tree ends
// after as many steps as there are words. The side of a group's cubes is noted when it is named.
std::string AirTree::fault() const {
  if (side < 8 || side > kMaxSide || !std::has_single_bit(static_cast<uint32_t>(side))) {
    return "its cubes have an odd side";
  }
  if (roots == 0 || nodes.size() < roots || (nodes.size() - roots) % 8 != 0 ||
      nodes.size() > UINT32_MAX / 4 || leaves.size() > UINT32_MAX / 4) {
    return "its arrays do not fit together";
  }
  std::vector<int32_t> side_of((nodes.size() - roots) / 8, 0);
  const auto check = [&](uint32_t word, int32_t cube, uint64_t before) {
    if (air_kind(word) == AirKind::kLeaf) {
      return cube == kLeafSide && air_number(word) < leaves.size();
    }
    if (air_kind(word) != AirKind::kInner) return true;
    const uint32_t group = air_number(word);
    if (cube <= kLeafSide || group < roots || (group - roots) % 8 != 0 || group + 8 > before) {
      return false;
    }
    int32_t& child = side_of[(group - roots) / 8];
    if (child != 0) return false;
    child = cube / 2;
    return true;
  };
  for (uint32_t r = 0; r < roots; ++r) {
    if (!check(nodes[r], side, nodes.size())) return "a root points outside the file";
  }
  for (size_t g = side_of.size(); g-- > 0;) {  // parents stand behind their children
    const size_t first = roots + 8 * g;
    if (side_of[g] == 0) return "it has a group of cubes that nothing names";
    for (size_t c = 0; c < 8; ++c) {
      if (!check(nodes[first + c], side_of[g], first)) return "a cube points outside the file";
    }
  }
  return {};
}

}  // namespace throng::world
