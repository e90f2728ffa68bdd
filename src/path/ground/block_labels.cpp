// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "path/ground/block_labels.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <utility>

#include "core/parallel.h"
#include "path/ground/hub_labels.h"
#include "path/ground/mesh_ray.h"

// Hub labels merged per block, after [DSC23]: entries that no point of the block can need are left
// out. Linear in the labels of the corners that the blocks see.
namespace throng::path {
namespace {

struct Entry {
  uint32_t hub;
  uint16_t candidate;
  float length;
};

struct MiddleEntry {
  uint32_t hub, tree_place;
  float length;
};

// One worker's memory.
class Lister {
 public:
  Lister(const PathMesh& mesh, const HubLabels& labels)
      : mesh_(mesh),
        labels_(labels),
        best_(mesh.corner_count()),
        set_(mesh.corner_count(), 0),
        known_(mesh.corner_count()) {}

  // Of the n-th block of rectangle `rect`.
  std::vector<Entry> list(uint32_t rect, uint32_t n) {
    const MeshRect r = cast_into(rect, n);
    const uint32_t begin = labels_.first_candidate[r.first_block + n];
    const uint32_t end = labels_.first_candidate[r.first_block + n + 1];
    // From any other point p the path over the middle m is at most |p m| longer than from m, and a
    // path over corner c at most |p m| shorter.
    const auto half = static_cast<float>(std::hypot(r.width * 0.5, r.depth * 0.5));
    std::vector<Entry> entries;
    for (uint32_t i = begin; i < end; ++i) {
      const uint32_t corner = labels_.candidates[i].corner;
      const float near =
          std::max(from_middle(r, mesh_.corners[corner]) - half, nearest(r, mesh_.corners[corner]));
      for (const HubLabels::Label& label : labels_.of(corner)) {
        // What is as long within a float's error stays.
        constexpr float kLengthTolerance = 1e-2f;  // cells
        if (near + label.length > true_length(label.hub) + half + kLengthTolerance) continue;
        entries.push_back({label.hub, static_cast<uint16_t>(i - begin), label.length});
      }
    }
    std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
      return a.hub != b.hub ? a.hub < b.hub : a.candidate < b.candidate;
    });
    return entries;
  }

  // Of the middle alone.
  std::vector<MiddleEntry> list_middle(uint32_t rect, uint32_t n) {
    cast_into(rect, n);
    std::vector<MiddleEntry> entries;
    for (const uint32_t hub : hubs_) {
      // cells: the hub itself is one of those that it is reached by
      constexpr float kLengthTolerance = 1e-3f;
      if (best_[hub].length > true_length(hub) + kLengthTolerance) continue;
      entries.push_back({hub, labels_.tree_place[best_[hub].label], best_[hub].length});
    }
    std::sort(entries.begin(), entries.end(),
              [](const MiddleEntry& a, const MiddleEntry& b) { return a.hub < b.hub; });
    return entries;
  }

 private:
  // Finds how far each hub is from the middle of the block, over the corners that it sees.
  MeshRect cast_into(uint32_t rect, uint32_t n) {
    ++now_;
    hubs_.clear();
    const MeshRect r = mesh_.block(rect, n);
    const uint32_t block = r.first_block + n;
    const uint32_t begin = labels_.first_candidate[block], end = labels_.first_candidate[block + 1];
    const Stop middle{middle_of(r), rect};
    for (uint32_t i = begin; i < end; ++i) {
      const uint32_t corner = labels_.candidates[i].corner;
      if (!sees_corner(mesh_, middle, corner)) continue;
      const float here = from_middle(r, mesh_.corners[corner]);
      for (uint32_t l = labels_.first[corner]; l < labels_.first[corner + 1]; ++l) {
        const HubLabels::Label& label = labels_.labels[l];
        const float length = here + label.length;
        if (set_[label.hub] == now_ && best_[label.hub].length <= length) continue;
        if (set_[label.hub] != now_) hubs_.push_back(label.hub);
        set_[label.hub] = now_;
        best_[label.hub] = {length, l};
      }
    }
    return r;
  }

  // A hub may be nearer over another hub than over all corners that have it in their lists: then no
  // path from here needs it.
  float true_length(uint32_t hub) {
    if (known_[hub].block == now_) return known_[hub].length;
    float length = set_[hub] == now_ ? best_[hub].length : std::numeric_limits<float>::max();
    for (const HubLabels::Label& label : labels_.of(labels_.hubs[hub])) {
      if (set_[label.hub] == now_)
        length = std::min(length, best_[label.hub].length + label.length);
    }
    known_[hub] = {now_, length};
    return length;
  }

  static float from_middle(const MeshRect& r, const MeshCorner& c) {
    return static_cast<float>(std::hypot(c.x - (r.x + r.width * 0.5), c.z - (r.z + r.depth * 0.5)));
  }

  // Distance of a corner from the rectangle.
  [[nodiscard]] static float nearest(const MeshRect& r, const MeshCorner& c) {
    const double dx = std::max({r.x - c.x, c.x - (r.x + r.width), 0});
    const double dz = std::max({r.z - c.z, c.z - (r.z + r.depth), 0});
    return static_cast<float>(std::sqrt(dx * dx + dz * dz));
  }

  const PathMesh& mesh_;
  const HubLabels& labels_;
  struct Best {
    float length = 0;
    uint32_t label = 0;
  };
  std::vector<Best> best_;      // per hub
  std::vector<uint32_t> set_;   // per hub: for which block
  std::vector<uint32_t> hubs_;  // that are set
  struct Known {
    uint32_t block = 0;
    float length = 0;
  };
  std::vector<Known> known_;  // per hub
  uint32_t now_ = 0;
};

struct Block {
  uint32_t rect, n;  // which of its blocks
};

std::vector<Block> all_blocks(const PathMesh& mesh) {
  std::vector<Block> blocks;
  for (uint32_t r = 0; r + 1 < mesh.rects.size(); ++r) {
    const uint32_t count = mesh.rects[r + 1].first_block - mesh.rects[r].first_block;
    for (uint32_t n = 0; n < count; ++n) blocks.push_back({r, n});
  }
  return blocks;
}

// Does a block have more candidates than the number of an entry can hold?
bool are_too_many(const HubLabels& labels) {
  for (size_t b = 0; b + 1 < labels.first_candidate.size(); ++b) {
    constexpr uint32_t kMax = std::numeric_limits<uint16_t>::max();
    if (labels.first_candidate[b + 1] - labels.first_candidate[b] > kMax) return true;
  }
  return false;
}

}  // namespace

world::GroundPoint middle_of(const MeshRect& block) {
  return {
      ((int64_t{block.x} << world::kUnitBits) * 2 + (int64_t{block.width} << world::kUnitBits)) / 2,
      ((int64_t{block.z} << world::kUnitBits) * 2 + (int64_t{block.depth} << world::kUnitBits)) /
          2};
}

BlockLabels build_block_labels(const PathMesh& mesh, const HubLabels& labels, int32_t workers,
                               uint64_t max_entries) {
  BlockLabels out;
  const std::vector<Block> blocks = all_blocks(mesh);
  if (are_too_many(labels)) return {};
  std::vector<std::vector<Entry>> entries(blocks.size());
  std::atomic<uint64_t> total{0};
  constexpr size_t kGrain = 64;
  parallel_ranges(blocks.size(), kGrain, workers, [&](size_t begin, size_t end) {
    if (total > max_entries) return;
    Lister lister(mesh, labels);
    for (size_t b = begin; b < end && total <= max_entries; ++b) {
      entries[b] = lister.list(blocks[b].rect, blocks[b].n);
      total += entries[b].size();
    }
  });
  if (total > max_entries) return {};
  out.first.push_back(0);
  out.length.reserve(total);
  out.candidate.reserve(total);
  for (const auto& of_block : entries) {
    for (const Entry& entry : of_block) {
      if (out.first.back() == out.hub.size() || out.hub.back() != entry.hub) {
        out.hub.push_back(entry.hub);
        out.entries.push_back(static_cast<uint32_t>(out.length.size()));
      }
      out.length.push_back(entry.length);
      out.candidate.push_back(entry.candidate);
    }
    out.first.push_back(static_cast<uint32_t>(out.hub.size()));
  }
  out.entries.push_back(static_cast<uint32_t>(out.length.size()));
  return out;
}

MiddleLabels build_middle_labels(const PathMesh& mesh, const HubLabels& labels, int32_t workers) {
  MiddleLabels out;
  const std::vector<Block> blocks = all_blocks(mesh);
  std::vector<std::vector<MiddleEntry>> entries(blocks.size());
  constexpr size_t kGrain = 64;
  parallel_ranges(blocks.size(), kGrain, workers, [&](size_t begin, size_t end) {
    Lister lister(mesh, labels);
    for (size_t b = begin; b < end; ++b)
      entries[b] = lister.list_middle(blocks[b].rect, blocks[b].n);
  });
  out.first.push_back(0);
  for (auto& of_block : entries) {
    for (const MiddleEntry& entry : of_block) {
      out.labels.push_back({entry.hub, entry.length});
      out.tree_place.push_back(entry.tree_place);
    }
    out.first.push_back(static_cast<uint32_t>(out.labels.size()));
    of_block = {};
  }
  return out;
}

}  // namespace throng::path
