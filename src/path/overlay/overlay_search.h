// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
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

  void begin();
  void reach(uint32_t entry, uint32_t parent, double cost, uint8_t overlay_level, Vec3d goal);
  bool next(Open& top);
  PathEnd over_entrances(const BlockPoint& from, const BlockPoint& to, const SearchBudget& budget);
  bool refine(const Stretch& stretch);
  void straighten(const BlockPoint& from, const BlockPoint& to, const SearchBudget& budget,
                  NodeSearch& blocks, std::vector<Crossing>& crossings);
  [[nodiscard]] double cost_of(const BlockPoint& from, const BlockPoint& to, const Crossing* first,
                               const Crossing* last) const;
  PathEnd within(uint32_t overlay_cell, const BlockPoint& from, const BlockPoint& to,
                 const SearchBudget& budget, NodeSearch& blocks, std::vector<Crossing>& crossings);

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
};

}  // namespace throng::path
