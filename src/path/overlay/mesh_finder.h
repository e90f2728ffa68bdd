// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "path/ground/mesh.h"
#include "path/ground/slice.h"
#include "throng/path.h"

/// Paths over the ground as it was baked.
namespace throng::path {

/// Finds paths for one class. All copies share the ground; each copy has its own memory for
/// searching: give every thread one. No allocation once it is warm.
class MeshFinder {
 public:
  /// Makes a finder. Reads every zone once. Fails with kBadConfig (no such class, a slope cost, or
  /// zones with too many corners for kZones), kBadFile (a zone cannot be used) or kCancelled.
  [[nodiscard]] static Result<MeshFinder> create(const World& world, const PathConfig& config,
                                                 Context& context);
  MeshFinder(const MeshFinder& other);
  MeshFinder& operator=(const MeshFinder& other);
  MeshFinder(MeshFinder&&) noexcept;
  MeshFinder& operator=(MeshFinder&&) noexcept;
  ~MeshFinder();

  /// Finds the shortest any-angle path over all legal cells: no legal path is shorter by more than
  /// 1/1000 of a cell per corner. If the places are connected, a path is found; where legal cells
  /// side by side lie more than a step height apart, it may go from portal to portal and be a
  /// little longer. `path` is reused: its memory stays. When the budget is exhausted the search
  /// stops (Path::spent); with labels there is none. Between queries a finder keeps up to 64 MiB of
  /// search memory, and 16 bytes per corner.
  void find(const Place& from, const Place& to, Path& path, const SearchBudget& budget = {});
  /// The same in parts: call begin, then advance with the same budget until it returns true. With
  /// labels or zones the first call does all.
  void begin(const Place& from, const Place& to);
  bool advance(const SearchBudget& budget, Slice& slice, Path& path);

  [[nodiscard]] PathSummary summary() const;
  [[nodiscard]] const PathMesh& mesh() const;
  /// Where a place lies on the mesh; none if it is no place of the class.
  [[nodiscard]] std::optional<Stop> stop(const Place& place) const;
  /// The same for places that are connected, or kNoRect.
  [[nodiscard]] uint32_t component(const Place& place) const;

 private:
  struct Shared;
  struct Scratch;
  explicit MeshFinder(std::shared_ptr<const Shared> shared);
  void begin_over_points();
  bool advance_over_points(const SearchBudget& budget, Slice& slice, Path& path);

  std::shared_ptr<const Shared> state_;
  std::unique_ptr<Scratch> scratch_;
};

}  // namespace throng::path
