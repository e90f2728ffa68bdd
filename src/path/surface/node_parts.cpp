// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "path/surface/node_parts.h"

#include <algorithm>

#include "core/arrays/strong_parts.h"
#include "core/parallel.h"

// Strongly connected components of the blocks, and the graph between them. Linear in the portals.
namespace throng::path {
NodeParts::NodeParts(const graph::NodeMesh& mesh, int32_t workers) : boxes_(mesh.patches().size()) {
  StrongParts parts = strong_parts(
      static_cast<uint32_t>(mesh.blocks().size()),
      [&](uint32_t block) { return static_cast<uint32_t>(mesh.portals_of(block).size()); },
      [&](uint32_t block, uint32_t k) {
        const graph::PortalSides portal = mesh.portals().sides(mesh.portals_of(block)[k]);
        if (portal.a == block) return portal.b;
        return portal.one_way ? UINT32_MAX : portal.a;
      });
  part_of_ = std::move(parts.of);
  count_ = parts.count;
  std::vector<std::pair<uint32_t, uint32_t>> arcs;
  for (size_t p = 0; p < mesh.portals().size(); ++p) {
    const graph::PortalSides portal = mesh.portals().sides(p);
    const uint32_t from = part_of_[portal.a], to = part_of_[portal.b];
    if (from != to) arcs.emplace_back(from, to);
  }
  std::sort(arcs.begin(), arcs.end());
  arcs.erase(std::unique(arcs.begin(), arcs.end()), arcs.end());
  first_.assign(count_ + 1, 0);
  for (const auto& [from, to] : arcs) ++first_[from + 1];
  for (uint32_t p = 0; p < count_; ++p) first_[p + 1] += first_[p];
  for (const auto& [from, to] : arcs) leads_to_.push_back(to);
  const NodeView view(mesh);
  parallel_for(boxes_.size(), workers, [&](size_t p) {
    const auto patch = static_cast<uint32_t>(p);
    const auto blocks = static_cast<uint32_t>(mesh.blocks_of(patch).size());
    for (uint32_t b = mesh.first_block(patch); b < mesh.first_block(patch) + blocks; ++b) {
      for_each_arc_in(view, b, [&](const Crossing& crossing) {
        boxes_[p].add(position(view, ends_of(view, crossing).in));
      });
    }
  });
}

void NodeParts::reach(uint32_t block, Reached& reached) const {
  reached.marks_.resize(count_, 0);
  if (++reached.query_ == 0) {  // After 2^32 queries the marks start over.
    std::fill(reached.marks_.begin(), reached.marks_.end(), 0);
    reached.query_ = 1;
  }
  reached.open_.assign(1, part_of_[block]);
  reached.marks_[part_of_[block]] = reached.query_;
  while (!reached.open_.empty()) {
    const uint32_t part = reached.open_.back();
    reached.open_.pop_back();
    for (uint32_t k = first_[part]; k < first_[part + 1]; ++k) {
      uint32_t& mark = reached.marks_[leads_to_[k]];
      if (mark == reached.query_) continue;
      mark = reached.query_;
      reached.open_.push_back(leads_to_[k]);
    }
  }
}

double NodeParts::distance_to(uint32_t patch, Vec3d at) const {
  const Box3d& box = boxes_[patch];
  const auto along = [](double low, double high, double x) {
    return std::max({low - x, x - high, 0.0});
  };
  return length(Vec3d{along(box.min.x, box.max.x, at.x), along(box.min.y, box.max.y, at.y),
                      along(box.min.z, box.max.z, at.z)});
}

uint64_t NodeParts::bytes() const {
  return (part_of_.size() + first_.size() + leads_to_.size()) * sizeof(uint32_t) +
         boxes_.size() * sizeof(Box3d);
}

}  // namespace throng::path
