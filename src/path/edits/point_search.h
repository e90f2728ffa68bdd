// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "core/arrays/chunked_array.h"
#include "path/edits/ground_view.h"
#include "path/ground/open_list.h"

/// Paths of low cost over a GroundView: a search over points of portals, pulled taut afterwards.
namespace throng::path {

class Corridor;

/// A point of a path, standing in a rectangle.
struct ViewStop {
  uint32_t level = 0;  // of the world
  uint16_t rect = 0;   // of the level's
  world::GroundPoint at;
  double off_mesh_link =
      0;  // cost of the off-mesh link that leads there, 0 if a segment does [cells]
};

/// A point that the search has reached.
struct ReachedPoint {
  ViewStop stop;
  uint32_t parent = UINT32_MAX;
  double cost = 0;               // so far [cells]
  world::GroundPoint link_from;  // if stop.off_mesh_link > 0: in the parent's rectangle
  bool done = false;
};

/// Hash map from a stop to its node. Owns its memory.
class ReachedPoints {
 public:
  void clear();
  /// Frees what was allocated.
  void give_back();
  /// Bytes of what it holds, the same whatever was allocated before.
  [[nodiscard]] uint64_t used_bytes() const;
  [[nodiscard]] uint64_t allocated_bytes() const;
  /// The node of a stop, and whether it is new.
  std::pair<uint32_t, bool> node_of(const ViewStop& stop);
  ChunkedArray<ReachedPoint> nodes;

 private:
  void grow();
  std::vector<uint32_t> table_;  // open addressing; 0 is free, else index plus one
};

/// Calls visit(on_this_side, beyond) for points of all portals of a rectangle; beyond is a stop in
/// the next rectangle, straight across.
template <class Visit>
void for_portal_points(GroundView& mesh, const ViewStop& from, Visit visit);

/// Cost of the straight segment between two stops, in cells; infinite if it is no legal move to
/// that very level.
double segment_cost(GroundView& mesh, const ViewStop& from, const ViewStop& to);

/// As segment_cost, or the cost of the off-mesh link.
inline double cost_to(GroundView& mesh, const ViewStop& from, const ViewStop& to) {
  return to.off_mesh_link > 0 ? to.off_mesh_link : segment_cost(mesh, from, to);
}

/// A string over a GroundView whose metres differ in cost: leaves out stops where a straight
/// segment costs no more, and moves the others towards a straight line; off-mesh links stay. Owns
/// its memory: no allocation once it has grown.
class CostString {
 public:
  /// Pulls the path taut.
  void pull(GroundView& mesh, std::vector<ViewStop>& stops);

  static constexpr int kRounds = 2;
  static constexpr size_t kEnds = 2;
  void leave_out(std::vector<ViewStop>& walk);
  bool move(std::vector<ViewStop>& walk, int round);

 private:
  void move_stop(std::vector<ViewStop>& walk, size_t i);

  GroundView* mesh_ = nullptr;
  std::vector<ViewStop> whole_, walk_;
  std::vector<double> before_;  // cost up to each stop
};

/// A*, best first. Owns its memory: no allocation once it has grown; what a large query allocated
/// beyond kKeptBytes is freed when the next one begins.
class PointSearch {
 public:
  enum class State { kSearching, kFound, kNone, kFull };
  static constexpr uint64_t kKeptBytes = uint64_t{32} << 20;

  /// `max_cost`: of a path; one that costs more counts as none. `corridor`, if it is not null,
  /// holds all rectangles that the search may enter, until it ends. [cells]
  void begin(GroundView& mesh, const ViewStop& from, const ViewStop& to,
             double max_cost = std::numeric_limits<double>::infinity(),
             const Corridor* corridor = nullptr);
  /// Expands up to `max_nodes` points more; kFull if it would need more than `max_bytes`.
  State advance(GroundView& mesh, uint64_t max_nodes, uint64_t max_bytes);
  /// Frees what is allocated beyond kKeptBytes: after a search.
  void give_back();
  [[nodiscard]] uint64_t allocated_bytes() const;
  /// The path to the goal, or to the reached point that is nearest to it; not yet pulled taut.
  void trace(GroundView& mesh, std::vector<ViewStop>& stops) const;
  [[nodiscard]] uint64_t expanded() const { return expanded_; }

 private:
  struct Open {
    double bound = 0;
    uint32_t node = 0;
    // Equal bounds are ordered by number: the same on every machine.
    bool operator<(const Open& other) const {
      return bound != other.bound ? bound > other.bound : node < other.node;
    }
  };
  /// The node now reached from `parent`, or null if the known cost is no higher.
  ReachedPoint* push(GroundView& mesh, const ViewStop& stop, uint32_t parent, double cost);
  void push_links(GroundView& mesh, const ReachedPoint& node, uint32_t index, double factor);

  void note_nearest(GroundView& mesh, uint32_t index);

  ViewStop to_, nearest_stop_;
  ReachedPoints nodes_;
  OpenList<Open> open_;
  uint32_t nearest_ = 0, goal_ = UINT32_MAX;
  double nearest_distance_ = 0;
  double max_cost_ = 0;
  const Corridor* corridor_ = nullptr;
  uint64_t expanded_ = 0;
};

template <class Visit>
void for_portal_points(GroundView& mesh, const ViewStop& from, Visit visit) {
  constexpr int32_t kSpacing = 8;  // cells
  const ViewLevel& level = *mesh.level(from.level);
  const PathMesh& rects = mesh.rects();
  const uint32_t number = level.first_rect + from.rect;
  const MeshRect rect = rects.rects[number];
  const int32_t w = rect.width, d = rect.depth;
  const auto unit = [](int32_t cell) { return int64_t{cell} << world::kUnitBits; };
  // By number: what visit() does may make more of the mesh.
  const auto [begin, count] = mesh.portal_range(number);
  for (uint32_t p = begin; p < begin + count; ++p) {
    const MeshPortal portal = rects.portals[p];
    const uint32_t to_level = rects.rects[portal.rect].level;
    const auto to_rect = static_cast<uint16_t>(portal.rect - mesh.level(to_level)->first_rect);
    // The side, and cells along it.
    const bool south = portal.from < w, east = !south && portal.from < w + d;
    const bool north = !south && !east && portal.from < 2 * w + d;
    const bool along_x = south || north;
    int32_t first = rect.x + portal.from, last = rect.x + portal.to;
    if (east) {
      first = rect.z + portal.from - w, last = rect.z + portal.to - w;
    } else if (north) {
      first = rect.x + w - (portal.to - w - d), last = rect.x + w - (portal.from - w - d);
    } else if (!south) {
      first = rect.z + 2 * d - (portal.to - 2 * w), last = rect.z + 2 * d - (portal.from - 2 * w);
    }
    // A border's units belong to the cells after it.
    const int64_t border = unit(south ? rect.z : east ? rect.x + w : north ? rect.z + d : rect.x);
    const int64_t inside = east || north ? border - 1 : border;
    const int64_t outside = east || north ? border : border - 1;
    const auto point = [&](int64_t along) {
      const ViewStop beyond{
          to_level, to_rect,
          along_x ? world::GroundPoint{along, outside} : world::GroundPoint{outside, along}};
      visit(along_x ? world::GroundPoint{along, inside} : world::GroundPoint{inside, along},
            beyond);
    };
    // A unit from its ends, so that nothing beside it is grazed; the same points from both sides.
    point(unit(first) + 1);
    for (int32_t i = (first / kSpacing + 1) * kSpacing; i < last; i += kSpacing) point(unit(i));
    point(unit(last) - 2);
  }
}

}  // namespace throng::path
