// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "bake/surface/body_sweep.h"
#include "throng/base.h"
#include "throng/scene.h"

/// The scene that nodes are made from: in memory as a whole, or read region by region.
namespace throng::bake {

/// Triangles and patches around some zones. A whole scene is one region.
class NodeRegion {
 public:
  explicit NodeRegion(const Scene& whole) : scene_(&whole) {}
  explicit NodeRegion(SceneRegion part) : part_(std::move(part)), scene_(&part_->scene) {}
  NodeRegion(const NodeRegion&) = delete;
  NodeRegion& operator=(const NodeRegion&) = delete;

  [[nodiscard]] const Scene& scene() const { return *scene_; }
  /// The number in the whole scene of a patch of the region.
  [[nodiscard]] uint32_t number_of(uint32_t patch) const {
    return part_ ? part_->patch_number[patch] : patch;
  }
  /// The patch of the region with a number in the whole scene; kNoPatch if it is not in it.
  [[nodiscard]] uint32_t patch_of(uint32_t number) const;
  /// By squares: made at the first call, which must not be from several threads.
  const TriangleSquares& triangles(int32_t workers);
  /// Lets the squares go, and the triangles, unless the scene is another's. Patches stay.
  void release_triangles();

 private:
  std::optional<SceneRegion> part_;  // none: of a whole scene
  const Scene* scene_;
  std::optional<TriangleSquares> triangles_;
};

/// Cheap to copy. The scene is kept by reference.
class NodeScene {
 public:
  // From either, without a word: all that makes nodes takes both.
  NodeScene(const Scene& whole);           // NOLINT(google-explicit-constructor)
  NodeScene(const SceneRegions& regions);  // NOLINT(google-explicit-constructor)

  [[nodiscard]] bool is_whole() const { return regions_ == nullptr; }
  /// Counts of the whole scene.
  [[nodiscard]] uint64_t triangles() const { return triangles_; }
  [[nodiscard]] uint64_t patch_triangles() const { return patch_triangles_; }
  [[nodiscard]] uint64_t patches() const { return patches_; }
  /// What region() takes with its squares, about; nothing if the scene is there as a whole. [bytes]
  [[nodiscard]] uint64_t region_bytes(const Box3d& box) const;
  /// All triangles and patches near a box, seen from above, and patches around these; none if the
  /// box is empty. The whole scene is the same region each time. Fails as SceneRegions::region
  /// does.
  [[nodiscard]] Result<std::shared_ptr<NodeRegion>> region(const Box3d& box,
                                                           Context& context) const;

 private:
  const SceneRegions* regions_ = nullptr;
  std::shared_ptr<NodeRegion> whole_;  // null: by regions
  uint64_t triangles_ = 0, patch_triangles_ = 0, patches_ = 0;
};

/// What is said of a scene of which a region lacks patches that are in it.
[[nodiscard]] Error region_lacks_patch(uint32_t number);

}  // namespace throng::bake
