// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>

#include "graph/leaf_link_zone.h"
#include "graph/node_data.h"

// Links to the air that pass the checks must answer every look-up without reading past their bytes.
extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size) {
  using namespace throng;
  (void)graph::read_leaf_link_index({bytes, size}, "fuzz");
  auto* copy = new uint8_t[size];
  std::copy_n(bytes, size, copy);
  const auto zone = graph::LeafLinkZone::from_bytes(
      flatbuffers::DetachedBuffer(nullptr, false, copy, size, copy, size), "fuzz");
  if (!zone) return 0;
  static volatile uint64_t sum = 0;
  const auto links = (*zone)->links();
  for (size_t i = 0; i < std::min<size_t>(links.size(), 1000); ++i) {
    const uint32_t node = links[i].node();
    sum = sum + (*zone)->of_leaf(graph::leaf_of(links[i])).size();
    for (const uint32_t link : (*zone)->of_node(node)) sum = sum + links[link].classes();
    for (const format::NodeLeaf& leaf : (*zone)->far_of_node(node)) sum = sum + leaf.link();
    if ((node & graph::kFarNode) != 0) sum = sum + (*zone)->far()[node & ~graph::kFarNode].node();
  }
  return 0;
}
