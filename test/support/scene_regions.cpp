// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "scene_regions.h"

#include <algorithm>
#include <vector>

#include "bake/surface/patch_cells.h"

namespace throng::test {
namespace {

bool touch(const Box3d& a, const Box3d& b) {
  return a.min.x <= b.max.x && a.max.x >= b.min.x && a.min.z <= b.max.z && a.max.z >= b.min.z;
}

Box3d box_of(const Scene& scene, size_t triangle) {
  Box3d box;
  for (const uint32_t corner : scene.triangles[triangle]) box.add(scene.positions[corner]);
  return box;
}

// Those that touch a box, and those around them, ascending.
std::vector<uint32_t> patches_near(const PatchSet& set, const Box3d& box) {
  std::vector<uint32_t> all, around;
  for (uint32_t p = 0; p < set.size(); ++p) {
    if (!touch(set.patches[p].bounds(), box)) continue;
    bake::find_patches_around(set, p, around);
    all.insert(all.end(), around.begin(), around.end());
  }
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

}  // namespace

RegionsOf::RegionsOf(const Scene& scene) : scene_(scene) {
  facts_.bounds = scene.bounds();
  facts_.triangles = scene.triangles.size();
  facts_.patches = scene.patches.size();
  for (const uint32_t patch : scene.patch_of_triangle) {
    facts_.patch_triangles += patch != kNoPatch ? 1 : 0;
  }
  facts_.report = scene.report;
}

uint64_t RegionsOf::estimate(const Box3d& box) const {
  const Box3d& all = facts_.bounds;
  const auto share = [](double low, double high, double from, double to) {
    return std::clamp((std::min(high, to) - std::max(low, from)) / (high - low), 0.0, 1.0);
  };
  return static_cast<uint64_t>(static_cast<double>(facts_.triangles) *
                               share(all.min.x, all.max.x, box.min.x, box.max.x) *
                               share(all.min.z, all.max.z, box.min.z, box.max.z));
}

Result<SceneRegion> RegionsOf::region(const Box3d& box, Context& context) const {
  if (context.cancel) return Error{Errc::kCancelled, "scene: cancelled"};
  SceneRegion region;
  Scene& out = region.scene;
  const PatchSet& set = scene_.patches;
  region.patch_number = patches_near(set, box);
  std::vector<uint32_t> place(set.size(), kNoPatch);
  for (uint32_t p = 0; p < region.patch_number.size(); ++p) place[region.patch_number[p]] = p;
  if (!region.patch_number.empty()) out.patches.begin_run("region", "", "");
  for (const uint32_t p : region.patch_number) {
    const uint32_t own = out.patches.add(set.patches[p]);
    for (size_t e = 0; e < 4; ++e) {
      PatchEdge edge = set.edges[p][e];
      for (PatchSide& next : edge.next) {
        if (next.patch == kNoPatch) continue;
        // One that faces several of which some are missing is open, and so are these.
        const PatchEdge& back = set.edges[next.patch][next.edge];
        for (const PatchSide& other : back.next) {
          if (other.patch != kNoPatch && place[other.patch] == kNoPatch) next.patch = kNoPatch;
        }
        if (next.patch == kNoPatch || place[next.patch] == kNoPatch) {
          edge = {};
          break;
        }
        next.patch = place[next.patch];
      }
      out.patches.edges[own][e] = edge;
    }
    if (!scene_.patch_off.empty()) out.patch_off.push_back(scene_.patch_off[p]);
  }
  std::vector<uint32_t> triangles;
  for (uint32_t t = 0; t < scene_.triangles.size(); ++t) {
    if (touch(box_of(scene_, t), box)) triangles.push_back(t);
  }
  out.positions.reserve(3 * triangles.size());
  out.triangles.reserve(triangles.size());
  out.area.reserve(triangles.size());
  if (!set.empty()) out.patch_of_triangle.reserve(triangles.size());
  if (!scene_.patch_part.empty()) out.patch_part.reserve(triangles.size());
  for (const uint32_t t : triangles) {
    const auto& [a, b, c] = scene_.triangles[t];
    out.add_triangle(scene_.positions[a], scene_.positions[b], scene_.positions[c], scene_.area[t]);
    if (set.empty()) continue;
    const uint32_t patch = scene_.patch_of_triangle[t];
    out.patch_of_triangle.push_back(patch == kNoPatch ? kNoPatch : place[patch]);
    if (!scene_.patch_part.empty()) out.patch_part.push_back(scene_.patch_part[t]);
  }
  uint64_t most = largest_;
  while (most < out.triangles.size() && !largest_.compare_exchange_weak(most, out.triangles.size()))
    ;
  ++count_;
  return region;
}

}  // namespace throng::test
