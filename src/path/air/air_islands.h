// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "path/air/flight_space.h"

/// What obstacles have cut off from the air that it was connected to.
namespace throng::path {

class AirView;

/// Labels boxes and parts of boxes: two with different labels are not connected. The largest piece
/// of a component keeps the component as its label, the others are islands. Pieces too large to
/// flood in time keep the same label; then only a search can decide.
class AirIslands {
 public:
  explicit AirIslands(const FlightSpace& space);

  [[nodiscard]] uint32_t label(uint32_t box) const {
    if (box >= first_) return of_part_[box - first_];
    if (of_box_.empty()) return space_->component[box];
    const auto found = of_box_.find(box);
    return found == of_box_.end() ? space_->component[box] : found->second;
  }
  /// The component of the space that a label is a piece of.
  [[nodiscard]] uint32_t component(uint32_t label) const {
    return label < first_ ? label : component_[label - first_];
  }
  void set_label(uint32_t box, uint32_t label);
  /// After cells of some boxes of the space were blocked: finds what is still connected. Pieces are
  /// flooded in turns, so this takes as long as all but the largest have boxes.
  void divide(const AirView& air, std::span<const uint32_t> boxes);
  /// After cells of some boxes were freed; new parts are labelled kNoBox.
  void join(const AirView& air, std::span<const uint32_t> boxes);

 private:
  // A piece that is flooded: a list of what it has yet to visit.
  struct Piece {
    uint32_t parent = 0, label = 0;
    uint32_t head = kNoBox, tail = kNoBox;  // in seen_
    uint32_t island = kNoBox;               // its label, once it is known to be one
  };
  struct Seen {
    uint32_t box = 0, piece = 0, next = kNoBox;
  };

  uint32_t root(uint32_t piece);
  void see(uint32_t box, uint32_t piece);
  void unite(uint32_t a, uint32_t b);
  uint32_t& left(uint32_t label);
  uint32_t new_island(uint32_t component);
  bool expand(const AirView& air, uint32_t piece);

  const FlightSpace* space_;
  uint32_t first_;                                 // labels of islands and parts begin there
  std::unordered_map<uint32_t, uint32_t> of_box_;  // of whole boxes that are in islands
  std::vector<uint32_t> of_part_;
  std::vector<uint32_t> component_;  // by island
  // While islands are searched for:
  std::vector<Piece> pieces_;
  std::vector<Seen> seen_;
  std::unordered_map<uint32_t, uint32_t> seen_of_;   // box: in seen_; looked up only
  std::vector<std::pair<uint32_t, uint32_t>> left_;  // label: pieces not known to be islands
};

}  // namespace throng::path
