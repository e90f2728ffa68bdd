// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "core/arrays/chunked_array.h"
#include "path/ground/mesh.h"
#include "path/ground/open_list.h"
#include "path/ground/search_states.h"
#include "throng/path.h"

/// The shortest path over a mesh, by search over intervals.
namespace throng::path {

enum class SearchResult { kFound, kNone, kBudget };

/// Polyanya over rectangles (source: [CHG17]): a node is an interval of a portal that is seen from
/// a root; the path turns at corners only, and the first one to arrive is the shortest over the
/// mesh. Owns its memory: one per thread, no allocation once it has grown; what a large query
/// allocated beyond kKeptBytes is freed after it.
class PathSearch {
 public:
  /// Corners of the shortest path from `from` to `to`, in order, ends left out; `length` in cells.
  /// Stops when the budget is exhausted, and does not search for paths that are not shorter than
  /// `longest`.
  SearchResult find(const PathMesh& mesh, const Stop& from, const Stop& to,
                    const SearchBudget& budget, std::vector<uint32_t>& corners, double& length,
                    double longest = kAnyLength);
  static constexpr double kAnyLength = 1e300;  // cells
  /// The same in parts: after kBudget for its nodes, calls with a larger budget continue. A mesh
  /// that is made on demand may grow in between; it must not change.
  void begin(const PathMesh& mesh, const Stop& from, const Stop& to, double longest = kAnyLength);
  SearchResult advance(const SearchBudget& budget, std::vector<uint32_t>& corners, double& length);
  [[nodiscard]] uint64_t expanded() const { return expanded_; }
  /// After a search that no call will continue: frees what is allocated beyond kKeptBytes.
  void give_back();
  /// What it has allocated for queries by now, without references to the mesh. [bytes]
  [[nodiscard]] uint64_t allocated_bytes() const;
  /// Of these, the maximum that stays allocated from one query to the next. [bytes]
  static constexpr uint64_t kKeptBytes = uint64_t{32} << 20;

 private:
  // Where a path turns, and its length up to there.
  struct Root {
    CellPoint point;
    double length = 0;
    uint32_t corner = kNoCorner;  // none: the start
    uint32_t before = 0;          // index of the root before it
  };
  // An interval of a portal, seen from the root; the path continues into `rect`. Seen in that
  // direction, left is on the left.
  struct Node {
    CellPoint left, right;
    uint32_t left_corner = kNoCorner, right_corner = kNoCorner;
    uint32_t rect = kNoRect;
    uint32_t root = 0;
  };
  // Of equal estimates, the one that was pushed first comes first.
  struct Entry {
    double estimate;
    uint32_t pushed;  // number of the push
    uint32_t node;    // its place in nodes_
    bool operator<(const Entry& other) const {
      return estimate != other.estimate ? estimate > other.estimate : pushed > other.pushed;
    }
  };
  struct Best {
    uint32_t search = 0;  // that set it
    double length = 0;
  };

  SearchResult run(const SearchBudget& budget);
  void start(uint32_t rect, CellPoint from);
  void expand(const Node& node);
  void look_at_goal(const Node& node, bool on_line, uint32_t seen_root, uint32_t& right_root,
                    uint32_t& left_root);
  void add_piece(const MeshRect& rect, const MeshPortal& portal, double from, double to,
                 uint32_t root);
  uint32_t turn(uint32_t root, CellPoint at, uint32_t corner);
  void push(const Node& node);
  [[nodiscard]] double estimate(const Node& node) const;
  [[nodiscard]] bool is_stale(uint32_t root) const;
  [[nodiscard]] uint64_t used_bytes() const;
  void drop_useless();

  const PathMesh* mesh_ = nullptr;
  uint32_t goal_rect_ = kNoRect;
  CellPoint goal_;
  uint64_t expanded_ = 0;
  uint32_t found_root_ = 0;
  double found_length_ = 0;
  bool was_spent_ = false;  // the nodes of the last advance()
  size_t drop_at_ = 0;      // open intervals, at which useless ones are dropped
  ChunkedArray<Root> roots_;
  ChunkedArray<Node> nodes_;    // of entries of open_, and free places
  std::vector<uint32_t> free_;  // places of nodes_
  OpenList<Entry> open_;
  uint32_t pushed_ = 0;
  SearchStates<Best, std::vector<Best>> best_;  // per corner
  std::vector<uint32_t> around_;                // rectangles around the start
};

}  // namespace throng::path
