// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "path/ground/mesh.h"
#include "path/ground/search.h"
#include "path/ground/sight.h"
#include "path/ground/string_puller.h"
#include "path/overlay/zone_cell.h"
#include "throng/path.h"

/// Paths over large worlds: inside zones by their tables, inside overlay cells by labels of their
/// entrances, between them by labels of their boundary nodes.
namespace throng::path {

/// Finds paths by a zone graph. Owns its memory: one per thread, no allocation once it has grown.
class ZoneSearch {
 public:
  /// As PathSearch::find. Between zones that touch, the shortest path if that is found within a
  /// budget; else the shortest of its kind (path/ground/string_puller.h), led through entrances.
  SearchResult find(const world::WorldData& world, const PathMesh& mesh, const ZoneGraph& graph,
                    const Stop& from, const Stop& to, const SearchBudget& budget,
                    std::vector<uint32_t>& corners, double& length);
  [[nodiscard]] uint64_t expanded() const { return expanded_; }

 private:
  // Distances of hubs, and from which of several nodes.
  class Reached {
   public:
    void begin(size_t hubs);
    void add(std::span<const TwoHopLabels::Label> labels, uint32_t from, float length);
    /// Infinite: it is not reached.
    [[nodiscard]] float length(uint32_t hub) const {
      return std::bit_cast<float>(static_cast<uint32_t>(hubs_[hub] >> 32));
    }
    [[nodiscard]] uint32_t from(uint32_t hub) const { return static_cast<uint32_t>(hubs_[hub]); }

   private:
    // A word of both, the bits of the length above: of floats from 0 on the smaller one has the
    // smaller bits, so the minimum word is the shortest, without a branch that cannot be predicted.
    static uint64_t word(float length, uint32_t from) {
      return uint64_t{std::bit_cast<uint32_t>(length)} << 32 | from;
    }
    std::vector<uint64_t> hubs_;
  };
  struct End {
    uint32_t zone = 0, zone_cell = 0;
    std::vector<float> length;   // to each entrance of the zone
    std::vector<uint16_t> next;  // as in the zone's tables
    Reached hubs;  // of the overlay cell's entrances, from places of the zone's entrances
    struct BoundaryNode {
      float length;
      uint32_t hub;  // of the overlay cell's entrances, over which it is reached
      float beyond;  // from it in a straight line to the other end
      float bound;   // the same, and in a straight line to it
    };
    std::vector<BoundaryNode> boundary_nodes;  // of the overlay cell
  };
  // Over a hub of one overlay cell that both ends are in, or over boundary nodes.
  struct Best {
    float length = 0;
    bool over_boundary_nodes = false;
    uint32_t hub = 0;
    uint32_t first = 0, last = 0;  // boundary nodes: their places in their overlay cells
  };

  // From an entrance of the path to the next, in a zone that both are on the border of.
  struct Segment {
    uint32_t to;  // place of that entrance in `entrances_`
    const ZonePaths* paths;
    size_t goal, at;  // its place in them, and that of the path
  };

  void find_hubs(const world::WorldData& world, const PathMesh& mesh, const ZoneGraph& graph,
                 const Stop& stop, End& end);
  bool join(const ZoneGraph& graph, const Stop& from, const Stop& to, Best& best);
  void join_boundary_nodes(const ZoneGraph& graph, const Stop& from, const Stop& to, Best& best);
  void reach_boundary_node(const ZoneGraph& graph, End& end, size_t place);
  bool lead(const PathMesh& mesh, const ZoneGraph& graph, const Stop& from, const Stop& to,
            const Best& best, std::vector<uint32_t>& corners, double& length);
  void list_entrances(const ZoneGraph& graph, const Best& best);
  void add_entrances(const OverlayCell& zone_cell, uint32_t from, uint32_t hub, uint32_t to);
  void find_segments(const ZoneGraph& graph);
  void add_segments(const PathMesh& mesh, const ZoneGraph& graph);

  PathSearch search_;
  Sight sight_;
  StringPuller pull_;
  End start_, goal_;
  Reached boundary_hubs_;
  std::vector<uint32_t> within_;      // boundary nodes that may lie on the path
  std::vector<uint32_t> prefetched_;  // nodes whose labels will be read
  std::vector<uint32_t> entrances_;   // of the path
  std::vector<Segment> segments_;
  std::vector<uint32_t> walked_;  // scratch of a walk over labels
  std::vector<uint32_t> boundary_nodes_;
  std::vector<Waypoint> path_, tail_;
  std::vector<uint32_t> near_corners_;
  uint64_t expanded_ = 0;
};

}  // namespace throng::path
