// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "core/paged.h"
#include "path/ground/mesh.h"
#include "path/ground/open_list.h"
#include "path/ground/search.h"

/// Paths over a mesh from portal to portal: none is the shortest, but every segment is legal.
namespace throng::path {

/// Where neighbouring cells that can both be stood on lie a step apart, two sides of one line touch
/// and a shortest path over corners may be drawn across it: nothing is missing there from which it
/// could keep a distance. Then this search finds the path. A* over the ends and the middles of
/// portals; stops that a straight segment makes needless are left out. Owns its memory: one per
/// thread, no allocation once it has grown; what a large query allocated is freed.
class PortalSearch {
 public:
  /// The stops from `from` to `to`, and their length in cells. Finds a path wherever both are of
  /// one component. Stops when the budget of portals' ends and middles to expand is exhausted.
  SearchResult find(const PathMesh& mesh, const Stop& from, const Stop& to,
                    const SearchBudget& budget, std::vector<Stop>& stops, double& length);
  [[nodiscard]] uint64_t expanded() const { return expanded_; }
  [[nodiscard]] uint64_t allocated_bytes() const;
  /// Of these, the maximum that stays allocated from one query to the next. [bytes]
  static constexpr uint64_t kKeptBytes = uint64_t{32} << 20;

 private:
  static constexpr uint32_t kPoints = 3;  // of a portal
  static constexpr uint32_t kStart = UINT32_MAX;

  // A point beyond a portal, by 3 portal + point.
  struct Reached {
    uint32_t search = 0;  // that set it
    uint32_t before = kStart;
    uint32_t rect = kNoRect;  // on this side
    double cost = 0;
  };
  struct Open {
    double estimate;
    uint32_t point;
    bool operator<(const Open& other) const {
      return estimate != other.estimate ? estimate > other.estimate : point > other.point;
    }
  };
  struct Crossing {
    world::GroundPoint inside, beyond;
  };

  [[nodiscard]] Crossing crossing(uint32_t rect, uint32_t point) const;
  SearchResult search(const Stop& from, const Stop& to, const SearchBudget& budget,
                      std::vector<Stop>& stops, double& length);
  [[nodiscard]] uint64_t used_bytes() const;
  void give_back();
  void expand(const Stop& at, double cost, uint32_t before);
  void draw(uint32_t last, const Stop& from, const Stop& to, std::vector<Stop>& stops);

  const PathMesh* mesh_ = nullptr;
  world::GroundPoint goal_;
  uint32_t search_ = 0;
  uint64_t expanded_ = 0;
  uint64_t met_ = 0;  // points that this search has reached
  Paged<Reached> reached_;
  OpenList<Open> open_;
  std::vector<Stop> all_;
};

}  // namespace throng::path
