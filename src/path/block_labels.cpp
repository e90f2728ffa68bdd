// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "path/block_labels.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <utility>

#include "core/parallel.h"
#include "path/hub_labels.h"
#include "path/mesh_ray.h"

namespace throng {
namespace {

struct Entry {
  uint32_t hub;
  uint16_t candidate;
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

  // `r` is the n-th block of rectangle `rect`.
  std::vector<Entry> list(uint32_t rect, uint32_t n) {
    ++now_;
    const MeshRect r = mesh_.block(rect, n);
    const uint32_t block = r.first_block + n;
    const uint32_t begin = labels_.first_candidate[block], end = labels_.first_candidate[block + 1];
    const GroundPoint middle{
        ((int64_t{r.x} << kUnitBits) * 2 + (int64_t{r.width} << kUnitBits)) / 2,
        ((int64_t{r.z} << kUnitBits) * 2 + (int64_t{r.depth} << kUnitBits)) / 2};
    const auto from_middle = [&](const MeshCorner& c) {
      return static_cast<float>(
          std::hypot(c.x - (r.x + r.width * 0.5), c.z - (r.z + r.depth * 0.5)));
    };
    // How far each hub is from the middle, over the corners that it sees.
    for (uint32_t i = begin; i < end; ++i) {
      const uint32_t corner = labels_.candidates[i].corner;
      const MeshCorner& c = mesh_.corners[corner];
      if (ray_to_corner(mesh_, {middle, rect}, corner) != RayEnd::kArrived) continue;
      const float here = from_middle(c);
      for (const HubLabels::Label& label : labels_.of(corner)) {
        const float length = here + label.length;
        if (set_[label.hub] == now_ && best_[label.hub] <= length) continue;
        set_[label.hub] = now_;
        best_[label.hub] = length;
      }
    }
    // A hub may be nearer by another one than by all corners that have it in their lists: then no
    // way from here needs it.
    const auto true_length = [&](uint32_t hub) {
      if (known_[hub].rect == now_) return known_[hub].length;
      float length = set_[hub] == now_ ? best_[hub] : std::numeric_limits<float>::max();
      for (const HubLabels::Label& label : labels_.of(labels_.hubs[hub])) {
        if (set_[label.hub] == now_) length = std::min(length, best_[label.hub] + label.length);
      }
      known_[hub] = {now_, length};
      return length;
    };
    // From any other point p the way by the middle m is at most |p m| longer than from m, and a way
    // by corner c at most |p m| shorter.
    const auto half = static_cast<float>(std::hypot(r.width * 0.5, r.depth * 0.5));
    std::vector<Entry> entries;
    for (uint32_t i = begin; i < end; ++i) {
      const uint32_t corner = labels_.candidates[i].corner;
      const float near =
          std::max(from_middle(mesh_.corners[corner]) - half, nearest(r, mesh_.corners[corner]));
      for (const HubLabels::Label& label : labels_.of(corner)) {
        // What is as long within a float's error stays.
        constexpr float kSlack = 1e-2f;  // cells
        if (near + label.length > true_length(label.hub) + half + kSlack) continue;
        entries.push_back({label.hub, static_cast<uint16_t>(i - begin), label.length});
      }
    }
    std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
      return a.hub != b.hub ? a.hub < b.hub : a.candidate < b.candidate;
    });
    return entries;
  }

 private:
  // Distance of a corner from the rectangle.
  [[nodiscard]] static float nearest(const MeshRect& r, const MeshCorner& c) {
    const double dx = std::max({r.x - c.x, c.x - (r.x + r.width), 0});
    const double dz = std::max({r.z - c.z, c.z - (r.z + r.depth), 0});
    return static_cast<float>(std::sqrt(dx * dx + dz * dz));
  }

  const PathMesh& mesh_;
  const HubLabels& labels_;
  std::vector<float> best_;    // per hub
  std::vector<uint32_t> set_;  // per hub: for which rectangle
  struct Known {
    uint32_t rect = 0;
    float length = 0;
  };
  std::vector<Known> known_;  // per hub
  uint32_t now_ = 0;
};

}  // namespace

BlockLabels build_block_labels(const PathMesh& mesh, const HubLabels& labels, int32_t workers,
                               uint64_t most) {
  BlockLabels out;
  std::vector<std::pair<uint32_t, uint32_t>> blocks;  // rectangle, which of its blocks
  for (uint32_t r = 0; r + 1 < mesh.rects.size(); ++r) {
    const uint32_t count = mesh.rects[r + 1].first_block - mesh.rects[r].first_block;
    for (uint32_t n = 0; n < count; ++n) blocks.push_back({r, n});
  }
  for (size_t b = 0; b < blocks.size(); ++b) {
    // Longer lists than a candidate's number can tell: none.
    constexpr uint32_t kMost = std::numeric_limits<uint16_t>::max();
    if (labels.first_candidate[b + 1] - labels.first_candidate[b] > kMost) return {};
  }
  std::vector<std::vector<Entry>> entries(blocks.size());
  std::atomic<uint64_t> total{0};
  constexpr size_t kGrain = 64;
  parallel_ranges(blocks.size(), kGrain, workers, [&](size_t begin, size_t end) {
    if (total > most) return;
    Lister lister(mesh, labels);
    for (size_t b = begin; b < end && total <= most; ++b) {
      entries[b] = lister.list(blocks[b].first, blocks[b].second);
      total += entries[b].size();
    }
  });
  if (total > most) return {};
  out.first.push_back(0);
  out.hub.reserve(total);
  out.length.reserve(total);
  out.candidate.reserve(total);
  for (const auto& of_block : entries) {
    for (const Entry& entry : of_block) {
      out.hub.push_back(entry.hub);
      out.length.push_back(entry.length);
      out.candidate.push_back(entry.candidate);
    }
    out.first.push_back(static_cast<uint32_t>(out.hub.size()));
  }
  return out;
}

}  // namespace throng
