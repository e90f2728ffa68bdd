// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "bake/surface/node_scene.h"

#include <algorithm>
#include <string>
#include <utility>

#include "core/arrays/release.h"

// A region's patches are numbered from 0 in the order of the whole scene, so what is sorted by them
// comes in the same order, and only what is stored or hashed needs their numbers there.
namespace throng::bake {
namespace {

// Of a triangle: corners of its own, indices, kinds, parts, and its share of the squares.
constexpr uint64_t kTriangleBytes = 120;
constexpr uint64_t kPatchBytes = sizeof(BezierPatch) + 4 * sizeof(PatchEdge) + 16;

}  // namespace

uint32_t NodeRegion::patch_of(uint32_t number) const {
  if (!part_) return number < scene_->patches.size() ? number : kNoPatch;
  const auto& numbers = part_->patch_number;
  const auto found = std::lower_bound(numbers.begin(), numbers.end(), number);
  return found != numbers.end() && *found == number ? static_cast<uint32_t>(found - numbers.begin())
                                                    : kNoPatch;
}

const TriangleSquares& NodeRegion::triangles(int32_t workers) {
  if (!triangles_) triangles_.emplace(*scene_, workers);
  return *triangles_;
}

void NodeRegion::release_triangles() {
  triangles_.reset();
  if (!part_) return;
  Scene& scene = part_->scene;
  release(scene.positions);
  release(scene.triangles);
  release(scene.area);
  release(scene.patch_of_triangle);
  release(scene.patch_part);
  release(scene.texture_corners);
}

NodeScene::NodeScene(const Scene& whole)
    : whole_(std::make_shared<NodeRegion>(whole)),
      triangles_(whole.triangles.size()),
      patches_(whole.patches.size()) {
  const auto& of = whole.patch_of_triangle;
  const auto others = static_cast<uint64_t>(std::count(of.begin(), of.end(), kNoPatch));
  patch_triangles_ = of.size() - others;
}

NodeScene::NodeScene(const SceneRegions& regions)
    : regions_(&regions),
      triangles_(regions.facts().triangles),
      patch_triangles_(regions.facts().patch_triangles),
      patches_(regions.facts().patches) {}

uint64_t NodeScene::region_bytes(const Box3d& box) const {
  if (is_whole() || box.empty()) return 0;
  const uint64_t triangles = regions_->estimate(box);
  return triangles * (kTriangleBytes + kPatchBytes * patches_ / std::max<uint64_t>(triangles_, 1));
}

Result<std::shared_ptr<NodeRegion>> NodeScene::region(const Box3d& box, Context& context) const {
  if (is_whole()) return whole_;
  if (box.empty()) return std::make_shared<NodeRegion>(SceneRegion{});
  auto part = regions_->region(box, context);
  if (!part) return part.error();
  return std::make_shared<NodeRegion>(*std::move(part));
}

Error region_lacks_patch(uint32_t number) {
  return {Errc::kBadInput, "nodes: a region of the scene lacks patch " + std::to_string(number) +
                               ", which is in it; read the scene again"};
}

}  // namespace throng::bake
