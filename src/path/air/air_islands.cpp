// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "path/air/air_islands.h"

#include <algorithm>

#include "path/air/air_changes.h"
#include "path/air/air_view.h"

// Whatever is cut off has a box beside cells that became blocked. So floods start from those boxes,
// each as a piece of its own; pieces that meet are merged. They take turns, box by box, and stop
// when only one piece is left of what was connected: a piece that runs out of boxes before that is
// an island. Around a crate all pieces have met after a few turns. Time: linear in the boxes
// visited, about kMaxBoxes for one change; pieces that have not met by then keep the label that
// they had.
namespace throng::path {
namespace {

constexpr size_t kMaxBoxes = 1 << 16;  // that are visited for one change

}  // namespace

AirIslands::AirIslands(const FlightSpace& space)
    : space_(&space), first_(static_cast<uint32_t>(space.boxes.size())) {}

void AirIslands::set_label(uint32_t box, uint32_t label) {
  if (box >= first_) {
    if (of_part_.size() <= box - first_) of_part_.resize(box - first_ + 1, kNoBox);
    of_part_[box - first_] = label;
  } else if (label == space_->component[box]) {
    of_box_.erase(box);
  } else {
    of_box_[box] = label;
  }
}

uint32_t AirIslands::new_island(uint32_t component) {
  component_.push_back(component);
  return first_ + static_cast<uint32_t>(component_.size()) - 1;
}

uint32_t AirIslands::root(uint32_t piece) {
  while (pieces_[piece].parent != piece) {
    piece = pieces_[piece].parent = pieces_[pieces_[piece].parent].parent;
  }
  return piece;
}

uint32_t& AirIslands::left(uint32_t label) {
  for (auto& [of, count] : left_) {
    if (of == label) return count;
  }
  return left_.emplace_back(label, 0).second;
}

void AirIslands::see(uint32_t box, uint32_t piece) {
  const auto index = static_cast<uint32_t>(seen_.size());
  seen_of_.emplace(box, index);
  seen_.push_back({box, piece, kNoBox});
  Piece& p = pieces_[piece];
  (p.head == kNoBox ? p.head : seen_[p.tail].next) = index;
  p.tail = index;
}

void AirIslands::unite(uint32_t a, uint32_t b) {
  Piece &into = pieces_[a], &from = pieces_[b];
  from.parent = a;
  if (from.head != kNoBox) {
    (into.head == kNoBox ? into.head : seen_[into.tail].next) = from.head;
    into.tail = from.tail;
  }
  --left(into.label);
}

// Visits one box of a piece. False if there is none.
bool AirIslands::expand(const AirView& air, uint32_t piece) {
  const uint32_t index = pieces_[piece].head;
  if (index == kNoBox) return false;
  pieces_[piece].head = seen_[index].next;
  air.for_neighbours(air.cube(seen_[index].box), [&](uint32_t next) {
    const auto found = seen_of_.find(next);
    if (found == seen_of_.end()) {
      see(next, piece);
      return;
    }
    const uint32_t other = root(seen_[found->second].piece);
    if (other != piece) unite(piece, other);
  });
  return true;
}

void AirIslands::divide(const AirView& air, std::span<const uint32_t> boxes) {
  pieces_.clear();
  seen_.clear();
  seen_of_.clear();
  left_.clear();
  const auto begin = [&](uint32_t box) {
    if (seen_of_.contains(box)) return;
    const auto piece = static_cast<uint32_t>(pieces_.size());
    pieces_.push_back({piece, label(box), kNoBox, kNoBox, kNoBox});
    see(box, piece);
    ++left(pieces_[piece].label);
  };
  for (const uint32_t box : boxes) {
    air.for_pieces(box, begin);
    air.for_neighbours(space_->boxes[box], begin);
  }
  std::vector<uint32_t> going;
  for (uint32_t p = 0; p < pieces_.size(); ++p) going.push_back(p);
  size_t expanded = 0, islands = 0;
  while (!going.empty() && expanded < kMaxBoxes) {
    size_t kept = 0;
    for (const uint32_t p : going) {
      Piece& piece = pieces_[p];
      if (piece.parent != p || left(piece.label) <= 1) continue;
      ++expanded;
      if (expand(air, p)) {
        going[kept++] = p;
        continue;
      }
      pieces_[p].island = new_island(component(pieces_[p].label));
      --left(pieces_[p].label);
      ++islands;
    }
    going.resize(kept);
  }
  if (islands == 0) return;
  for (const Seen& seen : seen_) {
    const uint32_t island = pieces_[root(seen.piece)].island;
    if (island != kNoBox) set_label(seen.box, island);
  }
}

void AirIslands::join(const AirView& air, std::span<const uint32_t> boxes) {
  std::unordered_map<uint32_t, uint32_t> into;  // label: one that it is the same as
  const auto last = [&](uint32_t label) {
    for (auto found = into.find(label); found != into.end(); found = into.find(label)) {
      label = found->second;
    }
    return label;
  };
  const size_t known = component_.size();
  for (const uint32_t box : boxes) {
    air.for_pieces(box, [&](uint32_t piece) {
      if (label(piece) == kNoBox) set_label(piece, new_island(space_->component[box]));
    });
  }
  for (const uint32_t box : boxes) {
    air.for_pieces(box, [&](uint32_t piece) {
      air.for_neighbours(air.cube(piece), [&](uint32_t next) {
        const uint32_t a = last(label(piece)), b = last(label(next));
        // The lowest stays: a component is lower than its islands.
        if (a != b) into.emplace(std::max(a, b), std::min(a, b));
      });
    });
  }
  // Usually only pieces that were freed join what is around them.
  bool any_new = false, any_old = false;
  for (const uint32_t box : boxes) {
    air.for_pieces(box, [&](uint32_t piece) {
      const uint32_t own = last(label(piece));
      set_label(piece, own);
      any_new |= own >= first_ + known;
    });
  }
  if (!any_new) component_.resize(known);
  for (const auto& [label, other] : into) any_old |= label < first_ + known;
  if (!any_old) return;
  for (uint32_t& label : of_part_) label = last(label);
  for (auto entry = of_box_.begin(); entry != of_box_.end();) {
    entry->second = last(entry->second);
    entry =
        entry->second == space_->component[entry->first] ? of_box_.erase(entry) : std::next(entry);
  }
}

}  // namespace throng::path
