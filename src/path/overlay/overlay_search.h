// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "path/ground/open_list.h"
#include "path/ground/search_states.h"
#include "path/overlay/overlay.h"
#include "path/overlay/overlay_changes.h"
#include "path/overlay/overlay_graph.h"
#include "path/surface/node_search.h"

/// Long paths over a mesh: first over the entrances of overlay cells, on high overlay levels
/// between far places, then within one overlay cell after the other.
namespace throng::path {

class OverlaySearch {
 public:
  OverlaySearch(const NodeView& view, const PieceCost& cost, const Overlay& overlay)
      : view_(&view),
        piece_cost_(&cost),
        overlay_(&overlay),
        now_(view, cost, overlay),
        graph_(view, cost) {}

  /// After the view has changed.
  void update() { now_.update(); }

  /// Fills `crossings` with the crossings from one place to another: of paths over entrances the
  /// cheapest, which seldom costs much more than the best. kUnreachable if none leads there, and
  /// then `crossings` is empty. `blocks` searches within overlay cells.
  PathEnd find(const BlockPoint& from, const BlockPoint& to, const SearchBudget& budget,
               NodeSearch& blocks, std::vector<Crossing>& crossings);
  /// The same in parts: call advance with the same budget, searcher and crossings until it returns
  /// how the search ended. The view must not change in between. Rows of costs that obstacles have
  /// made stale are computed in one go and are not counted, as they serve later queries, too.
  void begin(const BlockPoint& from, const BlockPoint& to);
  std::optional<PathEnd> advance(const SearchBudget& budget, Slice& slice, NodeSearch& blocks,
                                 std::vector<Crossing>& crossings);
  [[nodiscard]] double cost() const { return cost_; }
  /// Entries and crossings.
  [[nodiscard]] uint64_t expanded() const { return expanded_; }

 private:
  static constexpr uint32_t kNoEntry = UINT32_MAX;
  // An entry that was reached.
  struct State {
    uint32_t search = 0;
    uint32_t parent = kNoEntry;
    double cost = 0;
    uint8_t overlay_level = 0;  // of the overlay cell through which it was reached
    bool closed = false;
  };
  struct Open {
    double estimate;
    uint32_t entry;
    bool operator<(const Open& other) const {
      return estimate != other.estimate ? estimate > other.estimate : entry > other.entry;
    }
  };
  // From entry to entry through an overlay cell of some level.
  struct Stretch {
    uint32_t from, to;
    uint8_t overlay_level;
  };

  // What a search in parts does next.
  enum class Step : uint8_t {
    kBack,        // costs from the entries of the goal's overlay cell
    kOut,         // costs to the entrances of the start's
    kEntrances,   // A* over entries
    kRefine,      // stretches through overlay cells of the level below
    kJoin,        // crossings within each overlay cell
    kStraighten,  // again from middle to middle
  };

  void begin_states();
  void reach(uint32_t entry, uint32_t parent, double cost, uint8_t overlay_level, Vec3d goal);
  bool next(Open& top);
  std::optional<PathEnd> over_entrances(const SearchBudget& budget, Slice& slice);
  void note_rest();
  void begin_entrances();
  void expand(uint32_t entry);
  std::optional<PathEnd> refine_all(Slice& slice);
  std::optional<bool> refine(const Stretch& stretch, Slice& slice);
  std::optional<PathEnd> join(const SearchBudget& budget, Slice& slice, NodeSearch& blocks,
                              std::vector<Crossing>& crossings);
  bool straighten(const SearchBudget& budget, Slice& slice, NodeSearch& blocks,
                  std::vector<Crossing>& crossings);
  [[nodiscard]] double cost_of(const BlockPoint& from, const BlockPoint& to, const Crossing* first,
                               const Crossing* last) const;
  std::optional<PathEnd> within(const BlockPoint& to, const SearchBudget& budget, Slice& slice,
                                NodeSearch& blocks, std::vector<Crossing>& crossings);
  std::optional<PathEnd> find_piece(const BlockPoint& from, const BlockPoint& to,
                                    const SearchBounds& within, double less_than,
                                    const SearchBudget& budget, Slice& slice, NodeSearch& blocks);

  const NodeView* view_;
  const PieceCost* piece_cost_;
  const Overlay* overlay_;
  OverlayChanges now_;
  OverlayGraph graph_;
  SearchStates<State, std::vector<State>> states_;  // by entry
  OpenList<Open> open_;
  std::vector<double> rest_;  // from the entries of the goal's overlay cell
  std::vector<Stretch> stretches_, finer_;
  std::vector<Crossing> piece_, straightened_;
  std::vector<size_t> joints_;                   // where entrances come in the path
  uint32_t first_ = kNoEntry, last_ = kNoEntry;  // none: the path does not leave the overlay cell
  double cost_ = 0;
  uint64_t expanded_ = 0;

  // Of a search in parts.
  Step step_ = Step::kBack;
  BlockPoint from_, to_;
  Vec3d goal_;
  uint32_t start_cell_ = 0, goal_cell_ = 0;
  std::array<uint32_t, 32> holds_goal_{};  // by overlay level: the cell of the goal
  double found_ = 0;                       // cost of the best path over entrances so far
  size_t overlay_level_ = 0;               // whose stretches are refined
  size_t index_ = 0;                       // of the stretch or joint that is next
  bool is_begun_ = false;                  // the search of a stretch, or of a piece
  BlockPoint at_;                          // where the crossings lead to so far
  size_t first_crossing_ = 0;              // that is straightened next
};

}  // namespace throng::path
