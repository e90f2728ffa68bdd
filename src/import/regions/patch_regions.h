// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "import/regions/region_part.h"

/// Patches in memory, whose triangles are made again for each region.
namespace throng::importer {

class PatchRegions : public RegionPart {
 public:
  /// Of the config, only rules and the tolerance are used. Cuts all patches once, some at a time,
  /// to count their triangles. Fails as cut_patches does.
  static Result<std::unique_ptr<PatchRegions>> create(PatchSet set, const SceneConfig& config,
                                                      Context& context);

  [[nodiscard]] uint64_t triangles() const override { return triangles_; }
  [[nodiscard]] uint64_t patches() const override { return set_.size(); }
  [[nodiscard]] Box3d bounds() const override { return bounds_; }
  [[nodiscard]] uint64_t estimate(const Box3d& box) const override;
  Result<void> append(const Box3d& box, uint32_t first_patch, SceneRegion& out,
                      Context& context) const override;

 private:
  struct Cut {
    Scene scene;                   // of the patches, with their triangles alone
    std::vector<uint32_t> number;  // of its patches
  };
  struct FlatBox {
    float x0, z0, x1, z1;  // rounded outward
  };

  PatchRegions(PatchSet set, const SceneConfig& config);
  void index();
  Result<void> count(Context& context);
  // Patches that touch a box, ascending.
  [[nodiscard]] std::vector<uint32_t> find(const Box3d& box) const;
  [[nodiscard]] std::vector<uint32_t> with_neighbours(std::span<const uint32_t> patches) const;
  [[nodiscard]] PatchSet subset(std::span<const uint32_t> patches) const;
  // The triangles of these patches, which are ascending, as of all patches.
  [[nodiscard]] Result<Cut> cut(std::span<const uint32_t> patches, Context& context) const;

  PatchSet set_;
  SceneConfig config_;
  std::vector<uint32_t> run_of_;        // by patch
  std::vector<FlatBox> boxes_;          // by patch
  std::vector<uint32_t> triangles_of_;  // by patch
  // Patches by the corners of weld_corners: those of corner c are at[first[c]] to at[first[c + 1]].
  std::vector<uint32_t> corner_of_, corner_first_, corner_patches_;
  // Patches by the squares of a grid that their boxes' middles lie in, and how far they reach
  // beyond these.
  double side_ = 1, reach_ = 0;
  double x0_ = 0, z0_ = 0;
  int32_t squares_x_ = 1, squares_z_ = 1;
  std::vector<uint32_t> square_first_, square_patches_;
  Box3d bounds_;
  uint64_t triangles_ = 0;
};

}  // namespace throng::importer
