// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "path/surface/node_changes.h"

#include <algorithm>
#include <cmath>

#include "core/access.h"
#include "graph/surface_piece.h"
#include "path/edits/blocked_cells.h"
#include "path/surface/floors_near.h"
#include "world/place.h"

// Which blocks and portals of a mesh of nodes obstacles block, found by halving blocks and motions.
// Time by the blocks near an obstacle; an update copies what is cut elsewhere.
namespace throng::path {
namespace {

constexpr double kMinSquare = 0.35;  // [m] across a square of curved ground that is cut no further
constexpr uint8_t kMaxDepth = 8;     // the maximum that a block's numbers hold
constexpr int32_t kPieces = 16;      // of a portal's line
constexpr int kTurns = 7;            // halvings of a motion
constexpr double kRounded = 1e-9;
constexpr double kMinPiece = 1e-7;  // A shorter piece of a line counts as empty.

struct Pose {
  Vec3d feet, axis;
};

BodyRoom body_of(const AvatarClass& avatar, bool climbs) {
  BodyRoom body;
  body.bottom = climbs ? avatar.step_height : body_bottom(avatar);
  body.top = avatar.height;
  body.radius = avatar.radius;
  return body;
}

// Straight from one to the other, the axis turning evenly, feet up to `spread` beside that.
bool motion_may_touch(const Solid& solid, BodyRoom body, const Pose& from, const Pose& to,
                      double spread, int halvings) {
  const Vec3d sum = from.axis + to.axis;
  const double size = length(sum);
  const Vec3d feet = (from.feet + to.feet) * 0.5;
  body.feet = feet;
  body.spread = spread + length(to.feet - from.feet) / 2;
  body.turns_far = !(size > 1e-6);
  if (!body.turns_far) {
    body.axis = sum * (1 / size);
    body.cosine = std::clamp(dot(body.axis, from.axis) - kRounded, 0.0, 1.0);
    body.sine = std::sqrt(1 - body.cosine * body.cosine);
  }
  if (!may_touch(body, solid)) return false;
  if (halvings == 0 || body.turns_far) return true;
  const Pose middle{feet, body.axis};
  return motion_may_touch(solid, body, from, middle, spread, halvings - 1) ||
         motion_may_touch(solid, body, middle, to, spread, halvings - 1);
}

struct Line {
  double s = 0, t = 0, ds = 0, dt = 0;
};

Line line_of(const std::array<double, 4>& on) {
  return {on[0], on[1], on[2] - on[0], on[3] - on[1]};
}

struct Stretch {
  double from = 0, to = 1;
  uint32_t block = 0;
};

void sort_unique(std::vector<uint32_t>& numbers) {
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
}

std::array<double, 4> cut_line(const std::array<double, 4>& on, double from, double to) {
  const auto at = [&](double u, size_t k) { return on[k] + u * (on[k + 2] - on[k]); };
  return {at(from, 0), at(from, 1), at(to, 0), at(to, 1)};
}

}  // namespace

void NodeChanges::StalePlaces::add(uint32_t place) {
  places_.push_back(place);
  if (places_.size() < max_places_) return;
  sort_unique(places_);
  max_places_ = std::max(kMinPlaces, 2 * places_.size());
}

void NodeChanges::StalePlaces::clear() {
  places_.clear();
  max_places_ = kMinPlaces;
}

const std::vector<uint32_t>& NodeChanges::StalePlaces::sorted() {
  sort_unique(places_);
  return places_;
}

ChangeId NodeChanges::add(Solid solid) {
  const auto& classes = data_of(data_of(mesh_->nodes())->world)->summary.classes;
  const double around = reach_of(classes[static_cast<size_t>(mesh_->avatar_class())]);
  Change change;
  std::vector<uint32_t> near;
  block_tiles(solid, around + longest_hole_link_, change, near);
  const Prism& prism = solid.prism;
  Box3d box;
  for (const auto& [x, z] : prism.corners) {
    box.add({x, prism.low, z});
    box.add({x, prism.high, z});
  }
  const double reach = length(box.max - box.min) / 2 + around + longest_hole_link_;
  const size_t first_curved = near.size();
  squares_->for_each_near((box.min + box.max) * 0.5, reach,
                          [&](uint32_t block) { near.push_back(block); });
  std::sort(near.begin() + static_cast<ptrdiff_t>(first_curved), near.end());
  for (size_t i = first_curved; i < near.size(); ++i) block_squares(solid, near[i], change);
  std::sort(near.begin(), near.end());
  block_pieces(solid, near, change);
  return keep(std::move(change));
}

ChangeId NodeChanges::keep(Change change) {
  std::sort(change.tiles.begin(), change.tiles.end(),
            [](const BlockedTile& a, const BlockedTile& b) { return a.patch < b.patch; });
  std::sort(change.pieces.begin(), change.pieces.end(),
            [](const BlockedPieces& a, const BlockedPieces& b) { return a.portal < b.portal; });
  note(change);
  changes_.push_back(std::move(change));
  active_.push_back(static_cast<ChangeId>(changes_.size()));
  list(active_.back(), true);
  return active_.back();
}

void NodeChanges::list(ChangeId id, bool active) {
  const Change& change = changes_[id - 1];
  const auto list_at = [&](uint32_t place, ChangesByPlace& changes, StalePlaces& stale) {
    stale.add(place);
    std::vector<ChangeId>& here = changes[place];
    const auto at = std::lower_bound(here.begin(), here.end(), id);
    const bool is_listed = at != here.end() && *at == id;
    if (active && !is_listed) here.insert(at, id);
    if (!active && is_listed) here.erase(at);
    if (here.empty()) changes.erase(place);
  };
  for (const BlockedTile& tile : change.tiles) list_at(tile.patch, tile_changes_, stale_tiles_);
  uint32_t last = graph::kNoNode;  // A block has many squares.
  for (const BlockedSquare& square : change.squares) {
    if (square.block != last) list_at(square.block, block_changes_, stale_blocks_);
    last = square.block;
  }
  for (const BlockedPieces& p : change.pieces) list_at(p.portal, portal_changes_, stale_portals_);
}

void NodeChanges::note(const Change& change) {
  const bool holds_any = !change.tiles.empty() || !change.squares.empty() || !change.pieces.empty();
  // An area over another one counts even if its own cost is 1.
  const bool differs =
      change.kind != Kind::kArea ||
      std::any_of(area_cost_.begin(), area_cost_.end(), [](double cost) { return cost != 1; });
  if (change.kind == Kind::kLink || (holds_any && differs)) ++version_;
}

bool NodeChanges::set_active(ChangeId id, bool active, bool remove) {
  if (id == 0 || id > changes_.size() || changes_[id - 1].removed) return false;
  Change& change = changes_[id - 1];
  if (change.active != active) {
    note(change);
    const auto at = std::lower_bound(active_.begin(), active_.end(), id);
    if (active) {
      active_.insert(at, id);
    } else {
      active_.erase(at);
    }
    list(id, active);
  }
  change.active = active;
  if (remove) {
    change = {};  // Its id is never used again, its memory is freed.
    change.active = false;
    change.removed = true;
  }
  return true;
}

// Blocked cells, and blocks within `around`.
void NodeChanges::block_tiles(const Solid& solid, double around, Change& change,
                              std::vector<uint32_t>& near) const {
  const world::WorldData& world = *data_of(data_of(mesh_->nodes())->world);
  const AvatarClass& avatar = world.summary.classes[static_cast<size_t>(mesh_->avatar_class())];
  for_floors_near(*mesh_, solid.prism.corners, around, [&](uint32_t patch, const TileFloor& floor) {
    // Legal cells alone need their heights.
    world::CellRows legal{};
    const auto blocks = mesh_->blocks_of(patch);
    for (const graph::NodeBlock& block : blocks) {
      const int32_t side = 64 >> block.level;
      const uint64_t row = (~uint64_t{0} >> (64 - side)) << (block.s * side);
      for (int32_t k = block.t * side; k < (block.t + 1) * side; ++k)
        legal[static_cast<size_t>(k)] |= row;
    }
    const world::CellRows rows =
        blocked_cells(floor, avatar, solid.prism, solid.triangles, legal.data());
    if (std::any_of(rows.begin(), rows.end(), [](uint64_t row) { return row != 0; })) {
      change.tiles.push_back({patch, rows});
    }
    const auto [first_x, last_x, first_z, last_z] = cells_near(floor, solid.prism.corners, around);
    for (uint32_t b = 0; b < blocks.size(); ++b) {
      const int32_t side = 64 >> blocks[b].level;
      const int32_t s = blocks[b].s * side, t = blocks[b].t * side;
      if (s <= last_x && s + side > first_x && t <= last_z && t + side > first_z) {
        near.push_back(mesh_->first_block(patch) + b);
      }
    }
  });
}

uint8_t NodeChanges::finest_level(const graph::NodeBlock& block) const {
  const graph::NodeSurface& surface = mesh_->patches()[block.patch];
  const double side = block.side(), s = block.s * side, t = block.t * side;
  double across = 2 * surface_piece(surface, s, t, s + side, t + side).spread;
  uint8_t level = block.level;
  for (; level < kMaxDepth && across > kMinSquare; across /= 2) ++level;
  return level;
}

void NodeChanges::block_squares(const Solid& solid, uint32_t block, Change& change) const {
  const graph::NodeBlock& whole = mesh_->blocks()[block];
  const graph::NodeSurface& surface = mesh_->surface(block);
  const auto& classes = data_of(data_of(mesh_->nodes())->world)->summary.classes;
  const AvatarClass& avatar = classes[static_cast<size_t>(mesh_->avatar_class())];
  const bool climbs = avatar.climb_slope > 0;
  const uint8_t finest = finest_level(whole);
  const auto descend = [&](auto&& self, uint8_t level, uint32_t s, uint32_t t) -> void {
    const double side = 1.0 / (1 << level);
    const graph::SurfacePiece piece =
        graph::surface_piece(surface, s * side, t * side, (s + 1) * side, (t + 1) * side);
    BodyRoom body = body_of(avatar, climbs);
    body.feet = piece.middle;
    body.spread = piece.spread;
    body.axis = {0, 1, 0};
    if (climbs) {
      body.axis = piece.normal;
      body.turns_far = !piece.leans;
      body.cosine = piece.cosine;
      body.sine = piece.sine;
    }
    if (!may_touch(body, solid)) return;
    if (level == finest) {
      change.squares.push_back({block, graph::quad_order(s, t, level)});
      return;
    }
    for (uint32_t q = 0; q < 4; ++q)
      self(self, static_cast<uint8_t>(level + 1), 2 * s + q % 2, 2 * t + q / 2);
  };
  descend(descend, whole.level, whole.s, whole.t);
}

// A step over the border of two tiles crosses no distance: the bodies on either side are checked.
void NodeChanges::block_pieces(const Solid& solid, std::span<const uint32_t> near,
                               Change& change) const {
  for (const uint32_t block : near) {
    for (const uint32_t p : mesh_->portals_of(block)) {
      const graph::NodePortal portal = mesh_->portals()[p];
      if (portal.a != block) continue;
      const bool curved = mesh_->surface(portal.a).points != nullptr;
      const bool doors =
          mesh_->blocks()[portal.a].patch != mesh_->blocks()[portal.b].patch && curved;
      if (!portal.over_hole && !doors) continue;
      uint16_t pieces = 0;
      if (portal.over_hole) {
        pieces = blocks_portal(solid, portal, 0, 0) ? 1 : 0;
      } else if (blocks_portal(solid, portal, 0, 1)) {
        for (int32_t k = 0; k < kPieces; ++k) {
          const double from = k * (1.0 / kPieces), to = (k + 1) * (1.0 / kPieces);
          if (blocks_portal(solid, portal, from, to)) pieces |= static_cast<uint16_t>(1u << k);
        }
      }
      if (pieces != 0) change.pieces.push_back({p, pieces});
    }
  }
}

bool NodeChanges::blocks_portal(const Solid& solid, const graph::NodePortal& portal, double from,
                                double to) const {
  const auto& classes = data_of(data_of(mesh_->nodes())->world)->summary.classes;
  const AvatarClass& avatar = classes[static_cast<size_t>(mesh_->avatar_class())];
  const bool climbs = avatar.climb_slope > 0;
  const double middle = (from + to) / 2;
  double spread = 0;
  double sine = 0;  // of how far bodies along the line lean from the one of a strip's middle
  bool leans_far = false;
  const auto pose = [&](const graph::NodeSurface& surface, const std::array<double, 4>& on) {
    const double s = on[0] + middle * (on[2] - on[0]), t = on[1] + middle * (on[3] - on[1]);
    Pose found{surface.at(s, t), {0, 1, 0}};
    if (surface.points == nullptr) return found;
    if (climbs) found.axis = surface.normal(s, t);
    if (to <= from) return found;
    // A strip along the line: a line alone does not show how bodies lean.
    constexpr double kStrip = 1.0 / 256;
    const auto cut = cut_line(on, from, to);
    const auto range = [&](size_t k) {
      double low = std::min(cut[k], cut[k + 2]), high = std::max(cut[k], cut[k + 2]);
      if (high - low < kStrip) {
        low = std::clamp(low - kStrip / 2, 0.0, 1 - kStrip);
        high = low + kStrip;
      }
      return std::pair{low, high};
    };
    const auto [s0, s1] = range(0);
    const auto [t0, t1] = range(1);
    const graph::SurfacePiece piece = graph::surface_piece(surface, s0, t0, s1, t1);
    spread = std::max(spread, piece.spread + length(piece.middle - found.feet));
    if (climbs) {
      leans_far |= !piece.leans || piece.cosine < 0.71;
      sine = std::max(sine, piece.sine);
    }
    return found;
  };
  const Pose a = pose(mesh_->surface(portal.a), portal.on_a);
  const Pose b = pose(mesh_->surface(portal.b), portal.on_b);
  if (leans_far) return true;
  const bool upright = !climbs || (a.axis.y == 1 && b.axis.y == 1);
  BodyRoom body = body_of(avatar, climbs && !upright);
  // Their axes differ by twice that at most, and the chord of a doubled angle is twice its sine: so
  // far apart are their points.
  spread += 2 * sine * reach_of(avatar);
  if (portal.kind != LinkKind::kDrop) return motion_may_touch(solid, body, a, b, spread, kTurns);
  const Pose over{{b.feet.x, a.feet.y, b.feet.z}, {0, 1, 0}};
  return motion_may_touch(solid, body, a, over, spread, kTurns) ||
         motion_may_touch(solid, body, over, b, spread, kTurns);
}

void NodeChanges::update() {
  if (updated_ == version_) return;
  updated_ = version_;
  std::vector<uint32_t> recut;  // blocks that were cut before, or are now
  for (const uint32_t patch : stale_tiles_.sorted()) cut_tile(patch, recut);
  for (const uint32_t block : stale_blocks_.sorted()) cut_squares(block, recut);
  sort_unique(recut);
  cut_portals(recut);
  stale_tiles_.clear();
  stale_blocks_.clear();
  stale_portals_.clear();
  number_parts();
  number_portals();
  add_links();
  find_min_factor();
  list_portals();
}

// The largest squares of a block that are free and cost the same. label_of(level, s, t): what
// becomes of a square.
template <class LabelOf>
NodeChanges::CutBlock NodeChanges::cut(uint32_t block, const LabelOf& label_of) {
  const graph::NodeBlock& whole = mesh_->blocks()[block];
  CutBlock made;
  made.block = block;
  const auto descend = [&](auto&& self, uint8_t level, uint32_t s, uint32_t t) -> void {
    const int label = label_of(level, s, t);
    if (label == kBlocked) return;
    if (label != kMixed) {
      graph::NodeBlock part = whole;
      part.level = level;
      part.s = static_cast<uint8_t>(s);
      part.t = static_cast<uint8_t>(t);
      made.parts.push_back(part);
      made.areas.push_back(static_cast<uint8_t>(label));
      return;
    }
    for (uint32_t q = 0; q < 4; ++q)
      self(self, static_cast<uint8_t>(level + 1), 2 * s + q % 2, 2 * t + q / 2);
  };
  descend(descend, whole.level, whole.s, whole.t);
  join_parts(made);
  ++cut_count_;
  return made;
}

void NodeChanges::cut_tile(uint32_t patch, std::vector<uint32_t>& recut) {
  if (const auto old = cut_tiles_.find(patch); old != cut_tiles_.end()) {
    for (const CutBlock& one : old->second) recut.push_back(one.block);
    cut_tiles_.erase(old);
  }
  const TileLabels tile = tile_labels(patch);
  const auto blocks = mesh_->blocks_of(patch);
  const auto label_of = [&](uint8_t level, uint32_t s, uint32_t t) {
    const uint32_t side = 64u >> level;
    const uint64_t row = (~uint64_t{0} >> (64 - side)) << (s * side);
    bool is_mixed = false;
    // Does it hold all cells of the square? Notes if it holds some.
    const auto holds_all = [&](const world::CellRows& cells) {
      bool any = false, all = true;
      for (uint32_t k = t * side; k < (t + 1) * side; ++k) {
        any |= (cells[k] & row) != 0;
        all &= (cells[k] & row) == row;
      }
      is_mixed |= any && !all;
      return all;
    };
    if (holds_all(tile.blocked)) return kBlocked;
    if (is_mixed) return kMixed;
    for (const auto& [area, cells] : tile.areas) {
      if (holds_all(cells)) return int{area};
    }
    return is_mixed ? kMixed : 0;
  };
  std::vector<CutBlock> made;
  for (uint32_t b = 0; b < blocks.size(); ++b) {
    if (label_of(blocks[b].level, blocks[b].s, blocks[b].t) == 0) continue;
    made.push_back(cut(mesh_->first_block(patch) + b, label_of));
    recut.push_back(made.back().block);
  }
  if (!made.empty()) cut_tiles_.emplace(patch, std::move(made));
}

void NodeChanges::cut_squares(uint32_t block, std::vector<uint32_t>& recut) {
  if (cut_curved_.erase(block) > 0) recut.push_back(block);
  const std::vector<SquareLabel> squares = square_labels(block);
  if (squares.empty()) return;
  const uint8_t finest = finest_level(mesh_->blocks()[block]);
  CutBlock made = cut(block, [&](uint8_t level, uint32_t s, uint32_t t) {
    const uint32_t up = 2u * (finest - level);
    const uint32_t first = graph::quad_order(s, t, level) << up, count = 1u << up;
    const auto before = [](const SquareLabel& one, uint32_t order) {
      return one.square.order < order;
    };
    const auto from = std::lower_bound(squares.begin(), squares.end(), first, before);
    const auto to = std::lower_bound(from, squares.end(), first + count, before);
    if (from == to) return 0;
    const bool is_same =
        std::all_of(from, to, [&](const SquareLabel& one) { return one.label == from->label; });
    return is_same && to - from == static_cast<ptrdiff_t>(count) ? from->label : kMixed;
  });
  cut_curved_.emplace(block, std::move(made));
  recut.push_back(block);
}

const NodeChanges::CutBlock* NodeChanges::find_cut(uint32_t block) const {
  const auto curved = cut_curved_.find(block);
  if (curved != cut_curved_.end()) return &curved->second;
  const auto tile = cut_tiles_.find(mesh_->blocks()[block].patch);
  if (tile == cut_tiles_.end()) return nullptr;
  const auto at = std::lower_bound(tile->second.begin(), tile->second.end(), block,
                                   [](const CutBlock& one, uint32_t b) { return one.block < b; });
  return at != tile->second.end() && at->block == block ? &*at : nullptr;
}

// All parts, tiles before curved blocks.
void NodeChanges::number_parts() {
  cuts_.clear();
  cut_blocks_.clear();
  cut_patches_.clear();
  parts_.clear();
  base_of_part_.clear();
  area_of_part_.clear();
  const auto add = [&](const CutBlock& one) {
    const auto first = static_cast<uint32_t>(parts_.size());
    parts_.insert(parts_.end(), one.parts.begin(), one.parts.end());
    base_of_part_.resize(parts_.size(), one.block);
    area_of_part_.insert(area_of_part_.end(), one.areas.begin(), one.areas.end());
    cuts_.emplace(one.block, Cut{first, static_cast<uint32_t>(parts_.size())});
    cut_blocks_.push_back(one.block);
    cut_patches_.push_back(mesh_->blocks()[one.block].patch);
  };
  for (const auto& [patch, blocks] : cut_tiles_) std::for_each(blocks.begin(), blocks.end(), add);
  for (const auto& [block, one] : cut_curved_) add(one);
  std::sort(cut_blocks_.begin(), cut_blocks_.end());
  sort_unique(cut_patches_);
}

// Those between parts by block, then what is left of the mesh's.
void NodeChanges::number_portals() {
  portals_.clear();
  replaced_.clear();
  const auto base = static_cast<uint32_t>(mesh_->blocks().size());
  const auto count = static_cast<uint32_t>(mesh_->portals().size());
  for (const uint32_t block : cut_blocks_) {
    const uint32_t first = base + cuts_.at(block).first;
    for (graph::NodePortal portal : find_cut(block)->portals) {
      portal.a += first;
      portal.b += first;
      portals_.push_back(portal);
    }
  }
  for (const auto& [p, left] : left_) {
    const graph::PortalSides sides = mesh_->portals().sides(p);
    Replaced made{p, static_cast<uint32_t>(count + portals_.size()), 0};
    for (const LeftPortal& one : left) {
      graph::NodePortal portal = one.portal;
      if (one.in_part_a) portal.a += base + cuts_.at(sides.a).first;
      if (one.in_part_b) portal.b += base + cuts_.at(sides.b).first;
      portals_.push_back(portal);
    }
    made.last = static_cast<uint32_t>(count + portals_.size());
    replaced_.push_back(made);
  }
}

// Portals between the parts of a block: where two squares share a part of a side.
void NodeChanges::join_parts(CutBlock& cut) const {
  const std::vector<graph::NodeBlock>& parts = cut.parts;
  const bool tile = mesh_->surface(cut.block).points == nullptr;
  const double inset = tile ? graph::kTileInset : 0;
  struct Side {
    double at, from, to;
    uint32_t part;
  };
  for (const bool by_s : {true, false}) {
    std::vector<Side> lows, highs;
    for (uint32_t p = 0; p < parts.size(); ++p) {
      const graph::NodeBlock& part = parts[p];
      const double side = part.side();
      const double along = (by_s ? part.s : part.t) * side,
                   across = (by_s ? part.t : part.s) * side;
      lows.push_back({along, across, across + side, p});
      highs.push_back({along + side, across, across + side, p});
    }
    const auto before = [](const Side& a, const Side& b) {
      return a.at != b.at ? a.at < b.at : a.from < b.from;
    };
    std::sort(lows.begin(), lows.end(), before);
    std::sort(highs.begin(), highs.end(), before);
    size_t from = 0;
    for (const Side& high : highs) {
      const auto is_before = [&](const Side& low) {
        return low.at < high.at || (low.at == high.at && low.to <= high.from);
      };
      while (from < lows.size() && is_before(lows[from])) ++from;
      for (size_t k = from; k < lows.size() && lows[k].at == high.at && lows[k].from < high.to;
           ++k) {
        const double begin = std::max(high.from, lows[k].from) + inset;
        const double end = std::min(high.to, lows[k].to) - inset;
        if (!(end > begin)) continue;
        graph::NodePortal portal{.a = high.part, .b = lows[k].part, .on_a = {}, .on_b = {}};
        portal.kind =
            parts[high.part].inclination > mesh_->walking() ? LinkKind::kClimb : LinkKind::kWalk;
        portal.inside = true;
        portal.on_a = by_s ? std::array{high.at, begin, high.at, end}
                           : std::array{begin, high.at, end, high.at};
        portal.on_b = portal.on_a;
        cut.portals.push_back(portal);
      }
    }
  }
}

// What is left of a portal whose blocks are cut, or of which pieces are blocked.
std::vector<NodeChanges::LeftPortal> NodeChanges::left_of(uint32_t p, uint16_t blocked) const {
  std::vector<Stretch> free, on_a, on_b;
  const graph::NodePortal portal = mesh_->portals()[p];
  const CutBlock *cut_a = find_cut(portal.a), *cut_b = find_cut(portal.b);
  // The pieces of a line that lie in what is left of a block.
  const auto stretches = [&](const CutBlock* cut, uint32_t block, const std::array<double, 4>& on,
                             std::vector<Stretch>& out) {
    if (cut == nullptr) {
      out.push_back({0, 1, block});
      return;
    }
    const double inset = mesh_->surface(block).points == nullptr ? graph::kTileInset : 0;
    const Line line = line_of(on);
    for (uint32_t k = 0; k < cut->parts.size(); ++k) {
      const graph::NodeBlock& part = cut->parts[k];
      const double side = part.side();
      double from = 0, to = 1;
      const auto clip = [&](double at, double delta, double low, double high) {
        // A line along a side lies on it, or an inset beside it.
        if (std::fabs(delta) < kMinPiece) {
          if (at < low - inset - kRounded || at > high + inset + kRounded) to = -1;
          return;
        }
        const double one = (low + inset - at) / delta, two = (high - inset - at) / delta;
        from = std::max(from, std::min(one, two));
        to = std::min(to, std::max(one, two));
      };
      clip(line.s, line.ds, part.s * side, (part.s + 1) * side);
      clip(line.t, line.dt, part.t * side, (part.t + 1) * side);
      const bool is_point = std::fabs(line.ds) < kMinPiece && std::fabs(line.dt) < kMinPiece;
      if (is_point ? to >= 0 : to - from > kMinPiece) out.push_back({from, to, k});
      if (is_point && !out.empty()) break;
    }
    std::sort(out.begin(), out.end(),
              [](const Stretch& a, const Stretch& b) { return a.from < b.from; });
  };
  if (blocked == 0) {
    free.push_back({});
  } else if (!portal.over_hole) {
    for (int32_t k = 0; k < kPieces; ++k) {
      if ((blocked >> k & 1) != 0) continue;
      const double from = k * (1.0 / kPieces), to = (k + 1) * (1.0 / kPieces);
      if (!free.empty() && free.back().to == from) {
        free.back().to = to;
      } else {
        free.push_back({from, to, 0});
      }
    }
  }
  stretches(cut_a, portal.a, portal.on_a, on_a);
  stretches(cut_b, portal.b, portal.on_b, on_b);
  std::vector<LeftPortal> made;
  for (const Stretch& piece : free) {
    for (const Stretch& a : on_a) {
      for (const Stretch& b : on_b) {
        const double from = std::max({piece.from, a.from, b.from});
        const double to = std::min({piece.to, a.to, b.to});
        if (!portal.over_hole && !(to - from > kMinPiece)) continue;
        LeftPortal& left = made.emplace_back();
        left.portal = portal;
        left.portal.a = a.block;
        left.portal.b = b.block;
        left.in_part_a = cut_a != nullptr;
        left.in_part_b = cut_b != nullptr;
        if (portal.over_hole) continue;
        left.portal.on_a = cut_line(portal.on_a, from, to);
        left.portal.on_b = cut_line(portal.on_b, from, to);
      }
    }
  }
  return made;
}

// Of blocks that were cut again, and those of which other pieces are blocked now.
void NodeChanges::cut_portals(const std::vector<uint32_t>& recut) {
  std::vector<uint32_t> stale = stale_portals_.sorted();
  for (const uint32_t block : recut) {
    const auto portals = mesh_->portals_of(block);
    stale.insert(stale.end(), portals.begin(), portals.end());
  }
  sort_unique(stale);
  for (const uint32_t p : stale) {
    uint16_t blocked = 0;
    const auto changes = portal_changes_.find(p);
    if (changes != portal_changes_.end()) {
      for (const ChangeId id : changes->second) {
        const std::vector<BlockedPieces>& pieces = changes_[id - 1].pieces;
        auto at =
            std::lower_bound(pieces.begin(), pieces.end(), p,
                             [](const BlockedPieces& one, uint32_t q) { return one.portal < q; });
        for (; at != pieces.end() && at->portal == p; ++at) blocked |= at->pieces;
      }
    }
    const graph::PortalSides sides = mesh_->portals().sides(p);
    const bool is_closed =
        blocked != 0 || find_cut(sides.a) != nullptr || find_cut(sides.b) != nullptr;
    if (is_closed) {
      left_.insert_or_assign(p, left_of(p, blocked));
    } else {
      left_.erase(p);
    }
  }
}

void NodeChanges::list_portals() {
  const auto base = static_cast<uint32_t>(mesh_->blocks().size());
  touched_ = cut_blocks_;
  for (const Replaced& r : replaced_) {
    const graph::PortalSides portal = mesh_->portals().sides(r.portal);
    touched_.push_back(portal.a);
    touched_.push_back(portal.b);
  }
  for (size_t k = portals_.size() - link_costs_.size(); k < portals_.size(); ++k) {
    for (const uint32_t end : {portals_[k].a, portals_[k].b}) {
      if (end < base) touched_.push_back(end);
    }
  }
  std::sort(touched_.begin(), touched_.end());
  touched_.erase(std::unique(touched_.begin(), touched_.end()), touched_.end());
  place_of_touched_.clear();
  for (uint32_t i = 0; i < touched_.size(); ++i) place_of_touched_.emplace(touched_[i], i);
  const auto place = [&](uint32_t block) {
    return block < base ? place_of_touched_.at(block)
                        : static_cast<uint32_t>(touched_.size()) + block - base;
  };
  // Those that stay, then new ones: rising. A cut block keeps none.
  const auto count = static_cast<uint32_t>(mesh_->portals().size());
  std::vector<std::pair<uint32_t, uint32_t>> pairs;  // place, portal
  for (uint32_t i = 0; i < touched_.size(); ++i) {
    if (cuts_.contains(touched_[i])) continue;
    for (const uint32_t p : mesh_->portals_of(touched_[i])) {
      const auto at = std::lower_bound(replaced_.begin(), replaced_.end(), p,
                                       [](const Replaced& r, uint32_t q) { return r.portal < q; });
      if (at == replaced_.end() || at->portal != p) pairs.emplace_back(i, p);
    }
  }
  std::sort(pairs.begin(), pairs.end());
  for (uint32_t k = 0; k < portals_.size(); ++k) {
    pairs.emplace_back(place(portals_[k].a), count + k);
    pairs.emplace_back(place(portals_[k].b), count + k);
  }
  // By counting: the portals of each place are in order already.
  first_portal_.assign(touched_.size() + parts_.size() + 1, 0);
  for (const auto& [at, portal] : pairs) ++first_portal_[at + 1];
  for (size_t i = 1; i < first_portal_.size(); ++i) first_portal_[i] += first_portal_[i - 1];
  std::vector<uint32_t> next(first_portal_.begin(), first_portal_.end() - 1);
  portal_of_.resize(pairs.size());
  for (const auto& [at, portal] : pairs) portal_of_[next[at]++] = portal;
}

std::optional<std::span<const uint32_t>> NodeChanges::portals_of(uint32_t block) const {
  size_t place = 0;
  if (block >= mesh_->blocks().size()) {
    place = touched_.size() + block - mesh_->blocks().size();
  } else {
    const auto at = place_of_touched_.find(block);
    if (at == place_of_touched_.end()) return std::nullopt;
    place = at->second;
  }
  return std::span(portal_of_)
      .subspan(first_portal_[place], first_portal_[place + 1] - first_portal_[place]);
}

std::optional<std::pair<uint32_t, uint32_t>> NodeChanges::parts_of(uint32_t block) const {
  const auto cut = cuts_.find(block);
  if (cut == cuts_.end()) return std::nullopt;
  const auto base = static_cast<uint32_t>(mesh_->blocks().size());
  return std::pair{base + cut->second.first, base + cut->second.last};
}

uint32_t NodeChanges::part_at(uint32_t block, double s, double t) const {
  const auto parts = parts_of(block);
  if (!parts) return block;
  for (uint32_t p = parts->first; p < parts->second; ++p) {
    const graph::NodeBlock& part = parts_[p - mesh_->blocks().size()];
    const double side = part.side(), ds = s - part.s * side, dt = t - part.t * side;
    if (std::min(ds, dt) >= -kRounded && std::max(ds, dt) <= side + kRounded) return p;
  }
  return graph::kNoNode;
}

uint64_t NodeChanges::bytes() const {
  uint64_t bytes = 2 * parts_.size() * sizeof(graph::NodeBlock) +
                   2 * portals_.size() * sizeof(graph::NodePortal) +
                   (cut_tiles_.size() + cut_curved_.size()) * sizeof(CutBlock) +
                   left_.size() * sizeof(std::vector<LeftPortal>) +
                   (base_of_part_.size() + touched_.size() + first_portal_.size() +
                    portal_of_.size() + cut_blocks_.size()) *
                       sizeof(uint32_t) +
                   area_of_part_.size() + link_costs_.size() * sizeof(double) +
                   stale_tiles_.bytes() + stale_blocks_.bytes() + stale_portals_.bytes();
  for (const Change& change : changes_) {
    bytes += change.tiles.size() * sizeof(BlockedTile) +
             change.squares.size() * sizeof(BlockedSquare) +
             change.pieces.size() * sizeof(BlockedPieces);
  }
  return bytes;
}

}  // namespace throng::path
