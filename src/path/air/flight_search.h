// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/arrays/chunked_array.h"
#include "path/air/air_view.h"
#include "path/ground/open_list.h"
#include "path/ground/search.h"
#include "path/ground/search_states.h"
#include "path/ground/slice.h"
#include "throng/path.h"

/// A short path through the air, over boxes.
namespace throng::path {

/// Lazy Theta* [NKH10] over boxes of any size: where the path enters a box is computed for each,
/// where the straight line from the last waypoint to the goal would, and a waypoint is assumed to
/// be seen until its box is expanded. Owns its memory: one per thread, no allocation once it has
/// grown.
class FlightSearch {
 public:
  /// Waypoints of a path from `from` to `to`, ends included. Stops when the budget of boxes is
  /// exhausted. Far ends are searched through large boxes first.
  SearchResult find(const AirView& air, AirPoint from, AirPoint to, const SearchBudget& budget,
                    std::vector<AirPoint>& path);
  /// The same in parts: call begin, then advance with the same budget until it returns a result.
  /// The air must not change in between.
  void begin(const AirView& air, AirPoint from, AirPoint to);
  std::optional<SearchResult> advance(const SearchBudget& budget, Slice& slice,
                                      std::vector<AirPoint>& path);
  [[nodiscard]] uint64_t expanded() const { return expanded_; }
  /// Frees what is allocated beyond kKeptBytes: after a query, when its results are no longer
  /// needed.
  void give_back();
  [[nodiscard]] uint64_t allocated_bytes() const;
  static constexpr uint64_t kKeptBytes = uint64_t{64} << 20;
  /// After a search that found none: the point nearest to another in all boxes that it reached.
  [[nodiscard]] AirPoint nearest_reached(AirPoint goal) const;

 private:
  // What a search in parts does next.
  enum class Step : uint8_t {
    kNone,      // an end is not in the air
    kStraight,  // the ends see each other
    kLarge,     // through large boxes
    kAll,       // through all boxes
  };

  void begin_boxes(Step step);
  std::optional<SearchResult> search(const SearchBudget& budget, Slice& slice,
                                     std::vector<AirPoint>& path);
  [[nodiscard]] uint64_t used_bytes() const;
  [[nodiscard]] int32_t min_around(const world::AirCube& box) const;
  struct Node {
    AirPoint point;       // where the path enters the box
    double length = 0;    // to there
    double estimate = 0;  // of the whole
    uint32_t box = kNoBox;
    uint32_t parent = 0;  // node of the waypoint before it
    uint32_t via = 0;     // node of the box before it
    bool opened = false;
  };
  struct Entry {
    double estimate;
    uint32_t node;
    bool operator<(const Entry& other) const {
      return estimate != other.estimate ? estimate > other.estimate : node < other.node;
    }
  };
  struct Mark {
    uint32_t search = 0;
    uint32_t node = 0;
  };

  void open(uint32_t node);
  void trace(uint32_t node, std::vector<AirPoint>& path) const;
  void reach(uint32_t from, uint32_t box);
  void push(uint32_t node);

  std::optional<AirView> air_;
  AirPoint start_, goal_;
  Step step_ = Step::kNone;
  bool large_ =
      false;  // only through boxes of a minimum size that grows with the distance from both ends
  uint32_t start_box_ = kNoBox, goal_box_ = kNoBox;
  bool found_large_ = false;  // and a shorter path is searched for
  uint64_t all_nodes_ = 0;    // in how many boxes
  uint64_t expanded_ = 0;
  ChunkedArray<Node> nodes_;
  OpenList<Entry> open_;
  SearchStates<Mark> marks_;          // per box or part of a split one
  std::vector<AirPoint> large_path_;  // through large boxes
};

}  // namespace throng::path
