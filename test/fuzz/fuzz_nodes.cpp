// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>

#include "graph/node_data.h"

// Nodes that pass the checks must answer every look-up without reading past their bytes.
extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size) {
  using namespace throng;
  (void)graph::read_node_index({bytes, size}, "fuzz");
  auto* copy = new uint8_t[size];
  std::copy_n(bytes, size, copy);
  const auto zone = graph::NodeZone::from_bytes(
      flatbuffers::DetachedBuffer(nullptr, false, copy, size, copy, size), "fuzz");
  if (!zone) return 0;
  static volatile uint64_t sum = 0;
  for (uint32_t n = 0; n < std::min<size_t>((*zone)->nodes().size(), 1000); ++n) {
    const format::NodePatch& patch = (*zone)->patch_of(n);
    if (patch.kind() == 0) sum = sum + static_cast<uint64_t>((*zone)->points(patch)[47] > 0);
    for (const format::Arc& arc : (*zone)->arcs(n)) {
      const uint32_t to = arc.to() & ~graph::kFarNode;
      const bool far = (arc.to() & graph::kFarNode) != 0;
      sum = sum + (far ? (*zone)->far()[to].node() : (*zone)->nodes()[to].level());
      const auto* hole_link =
          (*zone)->hole_link_of(static_cast<uint32_t>(&arc - (*zone)->first_arc()));
      sum = sum + (hole_link != nullptr ? hole_link->to_s() : 0u);
    }
  }
  for (const format::Door& door : (*zone)->doors()) {
    const uint32_t to = door.to() & ~graph::kFarNode;
    const bool far = (door.to() & graph::kFarNode) != 0;
    sum = sum + (far ? (*zone)->far()[to].node() : (*zone)->nodes()[to].level());
    sum = sum + (*zone)->patches()[door.patch()].depth();
  }
  return 0;
}
