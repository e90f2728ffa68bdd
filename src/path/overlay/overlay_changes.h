// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "path/overlay/overlay.h"
#include "path/overlay/overlay_graph.h"

/// The overlay of a mesh on which obstacles stand: where the obstacles are, costs differ from those
/// of the overlay.
namespace throng::path {

/// An overlay cell is *stale* if a block of it is cut or has other portals, and so is each that
/// holds it. On the lowest overlay level the rows of costs of stale cells are computed again when
/// they are first used; higher ones are not used. An entrance whose portal is closed moves to what
/// is left of it, or to the nearest other crossing between the same two overlay cells; without one
/// it is closed.
class OverlayChanges {
 public:
  OverlayChanges(const NodeView& view, const PieceCost& cost, const Overlay& overlay)
      : view_(&view), overlay_(&overlay), graph_(view, cost) {}

  /// After the view has changed. Time: linear in the active obstacles and the overlay cells below
  /// them.
  void update();

  [[nodiscard]] bool is_stale(size_t overlay_level, uint32_t overlay_cell) const {
    return !stale_.empty() && stale_[overlay_level][overlay_cell] != 0;
  }
  [[nodiscard]] bool is_closed(uint32_t entry) const {
    const Entrance* moved = moved_entrance(entry);
    return moved != nullptr && moved->portal == graph::kNoNode;
  }
  /// [not closed]
  [[nodiscard]] Crossing crossing(uint32_t entry) const {
    const Entrance* moved = moved_entrance(entry);
    if (moved == nullptr) return overlay_->crossing(entry);
    return {moved->portal, (entry % 2 != 0) != moved->turned};
  }
  [[nodiscard]] Vec3d at(uint32_t entry) const {
    const Entrance* moved = moved_entrance(entry);
    if (moved == nullptr || moved->portal == graph::kNoNode) return overlay_->at(entry);
    return moved->at[entry % 2];
  }
  /// Of the lowest overlay level, as they are now: rising.
  [[nodiscard]] std::span<const uint32_t> blocks_of(uint32_t overlay_cell) const {
    if (is_stale(0, overlay_cell)) return blocks_.at(overlay_cell);
    return overlay_->blocks_of(overlay_cell);
  }
  /// Of an entry into a stale overlay cell of the lowest level, as
  /// Overlay::OverlayLevel::costs_from.
  std::span<const float> costs_from(uint32_t entry);

 private:
  struct Entrance {
    uint32_t portal = graph::kNoNode;
    bool turned = false;  // Its portal's a and b are swapped.
    Vec3d at[2];
  };
  [[nodiscard]] const Entrance* moved_entrance(uint32_t entry) const {
    if (moved_.empty()) return nullptr;
    const auto found = moved_.find(entry / 2);
    return found == moved_.end() ? nullptr : &found->second;
  }
  void move_entrance(uint32_t entrance, uint32_t first, uint32_t last);

  const NodeView* view_;
  const Overlay* overlay_;
  OverlayGraph graph_;
  uint32_t in_graph_ = graph::kNoNode;  // the stale overlay cell that is in graph_
  std::vector<std::vector<uint8_t>>
      stale_;  // by overlay level and cell; empty: nothing has changed yet
  std::vector<std::vector<uint32_t>> stale_of_level_;
  std::unordered_map<uint32_t, std::vector<uint32_t>>
      blocks_;                                             // by stale overlay cell; looked up only
  std::unordered_map<uint32_t, Entrance> moved_;           // looked up only
  std::unordered_map<uint32_t, std::vector<float>> rows_;  // by entry; looked up only
};

}  // namespace throng::path
