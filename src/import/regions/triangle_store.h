// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/files/scratch_file.h"
#include "import/regions/region_part.h"

/// Triangles in a temporary file, by squares of the ground.
namespace throng::importer {

class TriangleStore : public RegionPart {
 public:
  /// The file lies in `folder`, which is made if it is not there. Fails with kIo.
  static Result<std::unique_ptr<TriangleStore>> create(const std::string& folder);
  /// The triangles of a scene, behind those that are here. Not of patches. Fails with kIo or
  /// kLimit. Memory: 5 MiB, and 16 bytes for every run of triangles of one square.
  Result<void> add(const Scene& scene);
  /// To be called once, before any query. Fails with kIo.
  Result<void> finish();

  [[nodiscard]] uint64_t triangles() const override { return count_; }
  [[nodiscard]] uint64_t patches() const override { return 0; }
  [[nodiscard]] Box3d bounds() const override { return bounds_; }
  [[nodiscard]] uint64_t estimate(const Box3d& box) const override;
  Result<void> append(const Box3d& box, uint32_t first_patch, SceneRegion& out,
                      Context& context) const override;

 private:
  struct Record {
    std::array<Vec3d, 3> corners;
    uint32_t number = 0;  // in the scene
    AreaKind area = 0;
  };
  struct Run {
    uint64_t first = 0;  // record of the file
    uint64_t count = 0;
  };
  struct Square {
    uint64_t count = 0;
    std::vector<Run> runs;
    std::vector<Record> waiting;
  };
  // Squares of a level are twice as long as those of the level below.
  struct Place {
    int32_t level = 0, z = 0, x = 0;
    auto operator<=>(const Place&) const = default;
  };

  explicit TriangleStore(ScratchFile file) : file_(std::move(file)) {}
  Result<void> write_waiting();
  [[nodiscard]] Error failure(const std::string& what) const;
  static Place place_of(const Box3d& triangle);
  // All squares that may have triangles in a box.
  template <class Visit>
  void for_each_square(const Box3d& box, Visit visit) const;

  ScratchFile file_;
  std::map<Place, Square> squares_;
  Box3d bounds_;
  uint64_t count_ = 0, waiting_ = 0, written_ = 0;  // records
};

}  // namespace throng::importer
