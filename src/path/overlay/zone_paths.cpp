// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "path/overlay/zone_paths.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <tuple>
#include <utility>

#include "core/arrays/prefetch.h"
#include "path/ground/border.h"
#include "path/ground/mesh_ray.h"
#include "path/ground/open_list.h"

// Tables of a zone: a Dijkstra search over its visible corners from each entrance. Time: a cast
// from each corner and entrance, then for each entrance n log n in what the corners see, and a ray
// to each other entrance.
namespace throng::path {
namespace {

constexpr double kNoCrossing = 1e300;

// A portal over a border of zones. Along the border: [begin, end) cells.
struct BorderCrossing {
  uint32_t zone[2];
  bool is_east;  // the other zone lies to the east, else above
  int32_t line, begin, end;
  uint32_t level[2], rect[2];
  bool ends_low, ends_high;  // in a corner: what follows there is another run

  [[nodiscard]] auto key() const {
    return std::tuple{zone[0], zone[1], is_east, line, level[0], level[1], begin};
  }
  [[nodiscard]] bool is_continued_by(const BorderCrossing& next) const {
    return zone[0] == next.zone[0] && zone[1] == next.zone[1] && is_east == next.is_east &&
           line == next.line && level[0] == next.level[0] && level[1] == next.level[1] &&
           end == next.begin && !ends_high && !next.ends_low;
  }
};

std::vector<BorderCrossing> find_crossings(const PathMesh& mesh,
                                           const std::vector<uint32_t>& zone_of_rect) {
  std::vector<BorderCrossing> crossings;
  for (uint32_t r = 0; r + 1 < mesh.rects.size(); ++r) {
    const MeshRect& rect = mesh.rects[r];
    for (uint32_t p = rect.first_portal; p < mesh.rects[r + 1].first_portal; ++p) {
      const MeshPortal& portal = mesh.portals[p];
      if (zone_of_rect[portal.rect] == zone_of_rect[r]) continue;
      const CellPoint a = point_around(rect, portal.from), b = point_around(rect, portal.to);
      const bool is_east = a.x == b.x && a.x == rect.x + rect.width;
      const bool is_up = a.z == b.z && a.z == rect.z + rect.depth;
      if (!is_east && !is_up) continue;  // It is found from the other side.
      // The path around leads up along the east side and back along the upper one.
      const bool forth = is_east;
      const bool from_corner = portal.from_corner != kNoCorner;
      const bool to_corner = portal.to_corner != kNoCorner;
      crossings.push_back({{zone_of_rect[r], zone_of_rect[portal.rect]},
                           is_east,
                           static_cast<int32_t>(is_east ? a.x : a.z),
                           static_cast<int32_t>(is_east ? a.z : b.x),
                           static_cast<int32_t>(is_east ? b.z : a.x),
                           {rect.level, mesh.rects[portal.rect].level},
                           {r, portal.rect},
                           forth ? from_corner : to_corner,
                           forth ? to_corner : from_corner});
    }
  }
  std::sort(crossings.begin(), crossings.end(),
            [](const BorderCrossing& a, const BorderCrossing& b) { return a.key() < b.key(); });
  return crossings;
}

// A unit inside the zone: where rays to the entrance end.
world::GroundPoint inside(const Entrance& entrance, const MeshRect& rect) {
  const auto units = [](double cells) {
    return static_cast<int64_t>(cells * world::kUnitsPerCell);
  };
  world::GroundPoint p{units(entrance.at.x), units(entrance.at.z)};
  if (entrance.at.x == rect.x + rect.width) --p.x;
  if (entrance.at.z == rect.z + rect.depth) --p.z;
  return p;
}

// What the corners of a zone see in it, in both directions: corner c owns edges[first[c]] to
// edges[first[c + 1]].
struct CornerGraph {
  struct Edge {
    uint16_t from = 0, to = 0;
    double length = 0;
  };
  std::vector<uint32_t> first;
  std::vector<Edge> edges;
};

// What one sees the other does, even where rounding hid it from one of them.
CornerGraph see_corners(const PathMesh& mesh, const ZonePaths& paths, Sight& sight) {
  CornerGraph graph;
  for (size_t c = 0; c < paths.corners.size(); ++c) {
    sight.cast_from_corner(mesh, paths.corners[c], false);
    for (const SeenCorner& seen : sight.corners()) {
      const auto here = static_cast<uint16_t>(c);
      const auto other = static_cast<uint16_t>(paths.place_of_corner(seen.corner));
      graph.edges.push_back({here, other, seen.distance});
      graph.edges.push_back({other, here, seen.distance});
    }
  }
  const auto key = [](const CornerGraph::Edge& e) { return std::tie(e.from, e.to, e.length); };
  std::sort(graph.edges.begin(), graph.edges.end(),
            [&](const auto& a, const auto& b) { return key(a) < key(b); });
  const auto again = [](const CornerGraph::Edge& a, const CornerGraph::Edge& b) {
    return a.from == b.from && a.to == b.to;
  };
  graph.edges.erase(std::unique(graph.edges.begin(), graph.edges.end(), again), graph.edges.end());
  graph.first.assign(paths.corners.size() + 1, 0);
  for (const CornerGraph::Edge& edge : graph.edges) ++graph.first[edge.from + size_t{1}];
  for (size_t c = 1; c < graph.first.size(); ++c) graph.first[c] += graph.first[c - 1];
  return graph;
}

// A corner that an entrance sees, by its place in the zone's corners.
struct EntranceView {
  uint16_t corner = 0;
  double distance = 0;
};

// How far corners are from an entrance, and over which corner.
class EntranceSearch {
 public:
  explicit EntranceSearch(const CornerGraph& graph)
      : length(graph.first.size() - 1), next(graph.first.size() - 1), graph_(graph) {}

  void run(const std::vector<EntranceView>& seen) {
    std::fill(length.begin(), length.end(), kNoCrossing);
    for (const EntranceView& s : seen) relax(s.corner, s.distance, kStraight);
    while (!open_.empty()) {
      const auto [reached, corner] = open_.pop();
      if (reached > length[corner]) continue;
      for (uint32_t e = graph_.first[corner]; e < graph_.first[corner + size_t{1}]; ++e)
        relax(graph_.edges[e].to, reached + graph_.edges[e].length, corner);
    }
  }

  std::vector<double> length;
  std::vector<uint16_t> next;

 private:
  void relax(uint16_t corner, double reached, uint16_t over) {
    if (reached >= length[corner]) return;
    length[corner] = reached;
    next[corner] = over;
    open_.push({reached, corner});
  }

  const CornerGraph& graph_;
  OpenList<std::pair<double, uint16_t>, std::greater<>> open_;
};

void take_shorter(double length, uint16_t next, float& best, uint16_t& best_next) {
  const auto rounded = static_cast<float>(length);
  if (!(rounded < best)) return;
  best = rounded;
  best_next = next;
}

}  // namespace

size_t ZonePaths::place_of_corner(uint32_t corner) const {
  return static_cast<size_t>(std::lower_bound(corners.begin(), corners.end(), corner) -
                             corners.begin());
}

size_t ZonePaths::place_of_entrance(uint32_t entrance) const {
  return static_cast<size_t>(std::lower_bound(entrances.begin(), entrances.end(), entrance) -
                             entrances.begin());
}

std::vector<uint32_t> zones_of_rects(const world::WorldData& world, const PathMesh& mesh) {
  std::vector<uint32_t> zones(mesh.rects.size() - 1);
  for (size_t slot = 0; slot < world.slots.size(); ++slot) {
    const uint32_t first = world.slots[slot]->first_level;
    const uint32_t last = first + world.slots[slot]->entry.levels();
    std::fill(zones.begin() + mesh.first[first], zones.begin() + mesh.first[last],
              static_cast<uint32_t>(slot));
  }
  return zones;
}

std::vector<Entrance> find_entrances(const world::WorldData& world, const PathMesh& mesh,
                                     const std::vector<uint32_t>& zone_of_rect) {
  const std::vector<BorderCrossing> crossings = find_crossings(mesh, zone_of_rect);
  const int32_t apart = std::max(1, static_cast<int32_t>(world.tiles_per_zone) * kTileCells / 10);
  std::vector<Entrance> entrances;
  for (size_t i = 0; i < crossings.size();) {
    size_t stop = i + 1;
    while (stop < crossings.size() && crossings[stop - 1].is_continued_by(crossings[stop])) ++stop;
    const int32_t begin = crossings[i].begin, cells = crossings[stop - 1].end - begin;
    const int32_t count = (cells + apart - 1) / apart;
    for (int32_t n = 0; n < count; ++n) {
      const int32_t cell = begin + static_cast<int32_t>((2 * n + 1) * int64_t{cells} / (2 * count));
      while (crossings[i].end <= cell) ++i;
      const BorderCrossing& c = crossings[i];
      const CellPoint at =
          c.is_east ? CellPoint{double(c.line), cell + 0.5} : CellPoint{cell + 0.5, double(c.line)};
      const size_t low = c.zone[0] < c.zone[1] ? 0 : 1;
      entrances.push_back({at, {c.zone[low], c.zone[1 - low]}, {c.rect[low], c.rect[1 - low]}});
    }
    i = stop;
  }
  return entrances;
}

bool find_zone_paths(const PathMesh& mesh, const std::vector<Entrance>& entrances, uint32_t zone,
                     Sight& sight, ZonePaths& paths) {
  paths.corners.clear();
  if (paths.entrances.empty()) return true;  // no path leads out, nor in
  sight.stay_within(paths.first_rect, paths.last_rect);
  for (uint32_t p = mesh.rects[paths.first_rect].first_portal;
       p < mesh.rects[paths.last_rect].first_portal; ++p) {
    for (const uint32_t corner : {mesh.portals[p].from_corner, mesh.portals[p].to_corner}) {
      if (corner != kNoCorner) paths.corners.push_back(corner);
    }
  }
  std::sort(paths.corners.begin(), paths.corners.end());
  paths.corners.erase(std::unique(paths.corners.begin(), paths.corners.end()), paths.corners.end());
  const size_t corners = paths.corners.size(), count = paths.entrances.size();
  if (corners >= kStraight) return false;
  paths.length.assign((corners + count) * count, kNeverReached);
  paths.next.assign(paths.length.size(), kStraight);
  const CornerGraph graph = see_corners(mesh, paths, sight);
  std::vector<std::vector<EntranceView>> seen(count);
  for (size_t g = 0; g < count; ++g) {
    const Entrance& entrance = entrances[paths.entrances[g]];
    sight.cast(mesh, entrance.rect_in(zone), entrance.at, kNoRect, {});
    for (const SeenCorner& s : sight.corners())
      seen[g].push_back({static_cast<uint16_t>(paths.place_of_corner(s.corner)), s.distance});
  }
  EntranceSearch search(graph);
  for (size_t g = 0; g < count; ++g) {
    search.run(seen[g]);
    for (size_t c = 0; c < corners; ++c)
      take_shorter(search.length[c], search.next[c], paths.length[paths.row(c) + g],
                   paths.next[paths.row(c) + g]);
    const Entrance& to = entrances[paths.entrances[g]];
    for (size_t other = 0; other < count; ++other) {
      const Entrance& from = entrances[paths.entrances[other]];
      const size_t at = paths.row(corners + other) + g;
      const uint32_t rect = from.rect_in(zone), goal = to.rect_in(zone);
      const world::GroundPoint begin = inside(from, mesh.rects[rect]),
                               end = inside(to, mesh.rects[goal]);
      if (mesh_ray(mesh, rect, begin, end) == goal)
        take_shorter(distance(from.at, to.at), kStraight, paths.length[at], paths.next[at]);
      for (const EntranceView& s : seen[other])
        take_shorter(s.distance + search.length[s.corner], s.corner, paths.length[at],
                     paths.next[at]);
    }
  }
  return true;
}

void find_entrances_around(const PathMesh& mesh, const std::vector<Entrance>& entrances,
                           uint32_t zone, const ZonePaths& paths, const Stop& from, Sight& sight,
                           std::vector<float>& length, std::vector<uint16_t>& next) {
  const size_t count = paths.entrances.size();
  length.assign(count, kNeverReached);
  next.assign(count, kStraight);
  if (count == 0) return;
  sight.stay_within(paths.first_rect, paths.last_rect);
  const CellPoint here = in_cells(from.at);
  sight.cast(mesh, from.rect, here, kNoRect, {});
  const auto each_corner = [&](auto visit) {
    for (const SeenCorner& s : sight.corners()) visit(s, paths.place_of_corner(s.corner));
  };
  // All rows are prefetched before the first is read.
  each_corner([&](const SeenCorner&, size_t c) {
    constexpr size_t kLine = 64 / sizeof(float);
    for (size_t g = 0; g < count; g += kLine) prefetch(&paths.length[paths.row(c) + g]);
  });
  each_corner([&](const SeenCorner& s, size_t c) {
    const float* row = &paths.length[paths.row(c)];
    const auto first = static_cast<float>(s.distance);
    for (size_t g = 0; g < count; ++g) {
      if (!(first + row[g] < length[g])) continue;
      length[g] = first + row[g];
      next[g] = static_cast<uint16_t>(c);
    }
  });
  for (size_t g = 0; g < count; ++g) {
    const Entrance& entrance = entrances[paths.entrances[g]];
    const double straight = distance(here, entrance.at);
    if (!(straight < length[g])) continue;
    const uint32_t rect = entrance.rect_in(zone);
    if (mesh_ray(mesh, from.rect, from.at, inside(entrance, mesh.rects[rect])) != rect) continue;
    length[g] = static_cast<float>(straight);
    next[g] = kStraight;
  }
}

}  // namespace throng::path
