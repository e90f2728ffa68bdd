// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "path/edits/corridor.h"
#include "path/edits/ground_view.h"
#include "path/edits/point_search.h"
#include "path/ground/open_list.h"

/// A search over coarse ground, before one over points: through which squares does a path of low
/// cost lead? docs/design/017-congestion.md. Source: the clusters of [BMS04].
namespace throng::path {

/// The cells of a square of a level from each of which the others can be walked to within it.
struct Cluster {
  world::GroundPoint centre;  // of one of its cells
  uint8_t square = 0;
};

/// A*, best first, over the clusters of a GroundView and between neighbours, also across corners.
/// Keeps the clusters of levels that it has seen, as long as the ground there stays as it is.
class ClusterSearch {
 public:
  explicit ClusterSearch(size_t levels) : levels_(levels), corridor_(levels) {}

  /// The squares on the route of least cost from one place to another, and those near them; null if
  /// it costs more than `max_cost`, or is not found within so many clusters. By the delays and
  /// costs of `view`; without off-mesh links. Costs are to 8 % of those of paths around no corner.
  /// Valid until the next call. [cells]
  const Corridor* find(GroundView& view, const ViewStop& from, const ViewStop& to, double max_cost,
                       uint64_t max_clusters);
  /// That it has expanded in the last call.
  [[nodiscard]] uint64_t expanded() const { return expanded_; }
  /// Was that all it may?
  [[nodiscard]] bool is_spent() const { return is_spent_; }

 private:
  static constexpr uint16_t kNone = UINT16_MAX;
  static constexpr uint32_t kNotAsked = UINT32_MAX;
  struct Beyond {
    uint32_t level = 0;
    uint16_t cluster = 0;
  };
  struct LevelClusters {
    world::CellRows open{};                            // cells that are not closed
    std::array<uint16_t, world::kTileArea> of_cell{};  // kNone where it is closed
    std::vector<Cluster> clusters;
    std::vector<std::array<uint16_t, 2>> joined;     // neighbours within the level, both orders
    std::vector<uint32_t> first_joined;              // by cluster, and the end
    std::vector<Beyond> beyond;                      // neighbours on other levels, once asked for
    std::vector<std::array<uint32_t, 2>> beyond_of;  // by cluster: first and end, or kNotAsked
    bool is_found = false;
    uint64_t version = 0;     // of the ground when it was compared with that, plus one
    uint32_t search = 0;      // that it has nodes in
    uint32_t first_node = 0;  // of that search
  };
  struct Node {
    uint32_t level = 0;
    uint16_t cluster = 0;
    bool has_edges = false, done = false;
    uint32_t first_edge = 0, edges = 0;
    uint32_t parent = UINT32_MAX;
    double cost = std::numeric_limits<double>::infinity();  // [cells]
    world::GroundPoint at;
  };
  struct Open {
    double bound = 0;
    uint32_t node = 0;
    bool operator<(const Open& other) const {
      return bound != other.bound ? bound > other.bound : node > other.node;
    }
  };

  LevelClusters& clusters_of(GroundView& view, uint32_t level);
  static void find_clusters(const GroundView& view, const ViewLevel& level, LevelClusters& of);
  static void join(const GroundView& view, const ViewLevel& level, LevelClusters& of);
  uint32_t node_at(GroundView& view, uint32_t level, world::GroundPoint at);
  void find_edges(GroundView& view, uint32_t node);
  void find_beyond(GroundView& view, uint32_t level, size_t cluster);
  double factor(GroundView& view, uint32_t node, const GroundDelays::Heading& heading) const;
  void relax(GroundView& view, uint32_t from, uint32_t by, uint32_t to);
  void expand(GroundView& view, uint32_t node);
  void trace(GroundView& view, uint32_t goal);
  void add_near(GroundView& view, uint32_t node, int rings);

  std::vector<std::unique_ptr<LevelClusters>> levels_;  // null: not seen yet
  Corridor corridor_;
  std::vector<Node> nodes_;
  std::vector<uint32_t> edges_;
  OpenList<Open> open_;
  world::GroundPoint to_;
  uint64_t version_ = 0;  // of the view, plus one
  uint32_t search_ = 0;
  uint64_t expanded_ = 0;
  bool is_spent_ = false;
};

}  // namespace throng::path
