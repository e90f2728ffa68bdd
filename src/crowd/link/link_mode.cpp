// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "crowd/link/link_mode.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "crowd/mode/saved_rows.h"
#include "path/edits/edit_list.h"
#include "throng/avatar.h"
#include "world/place.h"
#include "world/tile_grid.h"

// Off-mesh links of a crowd: the contract of modes but for turns (link_turns.cpp) and moves
// (link_step.cpp). What is said of an avatar on foot, WalkMode answers.
namespace throng::crowd {

namespace {

// Where a link begins or ends, on the level that its place names. None: there is no such place.
std::optional<Stand> stand_of(const world::WorldData& world, const Place& place) {
  if (!world::ground_point(world, place)) return std::nullopt;
  const PathPoint at = point_of(world, place);
  const world::GroundLevel level = world::ground_level(world, at.level, 0);
  if (level.zone == nullptr) return std::nullopt;
  const double feet = world::place_at(world, level, {at.x, at.z}).position.y;
  return Stand{at.x, at.z, static_cast<int32_t>(std::lrint(std::clamp(feet, -1e6, 1e6) * 1000)),
               at.level};
}

}  // namespace

LinkMode::LinkMode(SharedState& shared, WalkMode& walk) : Mode(shared), walk_(walk) {
  walk_.set_takes_links(*this);
  double lowest = HUGE_VAL;
  for (const AvatarClass& avatar : data_of(shared.world)->summary.classes) {
    lowest = std::min(lowest, avatar.height);
  }
  lowest_ = std::max(1, static_cast<int32_t>(std::min(lowest, 1e5) * 1000));  // [100 km]
}

// Whether a class can stand at both ends, its finders know: they lead to no other link.
void LinkMode::read_links() {
  links_.clear();
  if (shared_.config.routing != Routing::kPaths) return;
  const world::WorldData& world = *data_of(shared_.world);
  const path::EditList& list = shared_.edits();
  if (list.active_links == 0) return;
  for (EditId id = 1; id <= list.edits.size(); ++id) {
    const path::EditList::Edit& edit = list.edits[id - 1];
    if (edit.kind != path::EditList::Kind::kOffMeshLink || !edit.active || edit.removed) continue;
    const OffMeshLink& link = edit.link;
    if (path::is_over_nodes(link)) continue;
    const auto from = stand_of(world, link.from), to = stand_of(world, link.to);
    if (!from || !to) continue;
    Link& added = links_.emplace_back();
    added.edit = id;
    added.from = *from;
    added.to = *to;
    added.cost = link.cost;
    added.two_way = link.two_way;
  }
  find_corridors();
}

// Links along x, each with those that begin before it ends.
void LinkMode::find_corridors() {
  constexpr double kRise = 0.5;  // [m] between a link's start and where an avatar leaves the ground
  std::vector<LinkLine> lines;
  std::vector<std::array<double, 2>> extents;  // along x
  std::vector<uint32_t> order, parent;
  for (const Link& link : links_) {
    const double radius = taking_.widest * shared_.unit + kEntryRadius;
    const LinkLine line{point_of(link.from), point_of(link.to), radius, 0,
                        taking_.tallest * 1e-3 + kRise};
    extents.push_back(
        {std::min(line.from.x, line.to.x) - radius, std::max(line.from.x, line.to.x) + radius});
    order.push_back(static_cast<uint32_t>(lines.size()));
    parent.push_back(order.back());
    lines.push_back(line);
  }
  std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
    return std::pair(extents[a], a) < std::pair(extents[b], b);
  });
  const auto root_of = [&](uint32_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  for (size_t n = 0; n < order.size(); ++n) {
    for (size_t m = n + 1; m < order.size() && extents[order[m]][0] <= extents[order[n]][1]; ++m) {
      if (!meets(lines[order[n]], lines[order[m]])) continue;
      const uint32_t a = root_of(order[n]), b = root_of(order[m]);
      parent[std::max(a, b)] = std::min(a, b);
    }
  }
  for (uint32_t i = 0; i < links_.size(); ++i) links_[i].corridor = root_of(i);
  corridors_.assign(links_.size(), {});
}

const LinkMode::Link* LinkMode::find_link(EditId edit) const {
  const auto at = std::lower_bound(links_.begin(), links_.end(), edit,
                                   [](const Link& link, EditId id) { return link.edit < id; });
  return at != links_.end() && at->edit == edit ? &*at : nullptr;
}

void LinkMode::fit_taking(const BodyExtent& body) {
  if (body.widest <= taking_.widest && body.tallest <= taking_.tallest) return;
  taking_.widest = std::max(taking_.widest, body.widest);
  taking_.tallest = std::max(taking_.tallest, body.tallest);
  find_corridors();
}

uint64_t LinkMode::count_riding() const {
  return static_cast<uint64_t>(std::count_if(users_.begin(), users_.end(), [&](uint32_t slot) {
    return uses_[slot].state == LinkUse::kRides;
  }));
}

Vec3d LinkMode::point_of(const Stand& stand) const {
  const Vec3d& origin = shared_.origin();
  return {origin.x + (stand.x + 0.5) * shared_.unit, stand.y * 1e-3,
          origin.z + (stand.z + 0.5) * shared_.unit};
}

Stand LinkMode::stand_at(const LinkUse& use, double part) {
  if (part >= 1) return use.to;
  const auto between = [&](int32_t from, int32_t to) {
    return from + static_cast<int32_t>(std::lrint(part * (static_cast<double>(to) - from)));
  };
  return {between(use.from.x, use.to.x), between(use.from.z, use.to.z),
          between(use.from.y, use.to.y), use.from.level};
}

double LinkMode::part_of(const LinkUse& use) const {
  const double size = length(point_of(use.to) - point_of(use.from));
  return size > 0 ? use.along / size : 0;
}

// Of a walker, so that it counts as one where it leaves the ground and where it comes back.
LinkLine LinkMode::line_of(const Body& body, const Stand& from, const Stand& to) const {
  constexpr double kRounded = 2;           // [units]
  constexpr double kRoundedHeight = 1e-3;  // [m]
  const AvatarClass& avatar = shared_.body_class(body.avatar_class);
  return {.from = point_of(from),
          .to = point_of(to),
          .radius = avatar.radius + kRounded * shared_.unit,
          .bottom = body_bottom(avatar) - kRoundedHeight,
          .top = body.height * 1e-3 + kRoundedHeight};
}

LinkLine LinkMode::rest_of_line(const Body& body) const {
  return line_of(body, body.stand(), uses_[body.slot].to);
}

Result<void> LinkMode::open_class(size_t /*number*/, Context& /*context*/) {
  read_links();
  return {};
}

bool LinkMode::put(NewAvatar& avatar, const AvatarSpawn& spawn) const {
  return walk_.put(avatar, spawn);
}

Result<bool> LinkMode::begin_draws(const AvatarSpawn& like) { return walk_.begin_draws(like); }

bool LinkMode::draw(NewAvatar& avatar, const AvatarSpawn& like, uint64_t n) const {
  return walk_.draw(avatar, like, n);
}

void LinkMode::add(const NewAvatar& avatar) {
  const Body& body = avatar.body;
  if (!shared_.flies(body.avatar_class) && !shared_.climbs(body.avatar_class)) {
    fit_taking({body.radius, body.radius, body.height});
  }
  if (uses_.empty()) return;
  uses_.resize(shared_.names.slots());
  uses_[body.slot] = {};
}

// One that is on a link arrives at its end first. One that waits keeps its turn until it knows
// whether its new path takes the same link. One that gives room has not arrived any more.
void LinkMode::set_goal(Body& body, const Place& goal) {
  walk_.set_goal(body, goal);
  if (body.on_link) {
    body.flags = (body.flags & Body::kHasGoal) | Body::kMovedElsewhere;
    head_to_end(body);
  } else if (!uses_.empty() && !body.has(Body::kHasGoal)) {
    uses_[body.slot] = {};
  }
  stop_giving_room(body);
}

void LinkMode::set_target(Body& body) {
  if (body.on_link) head_to_end(body);
  stop_giving_room(body);
}

void LinkMode::head_to_end(Body& body) const {
  body.local_target_x = uses_[body.slot].to.x;
  body.local_target_z = uses_[body.slot].to.z;
}

void LinkMode::set_velocity(Body& body, const Vec3d& velocity) {
  if (!body.on_link && !uses_.empty()) uses_[body.slot] = {};
  walk_.set_velocity(body, velocity);
}

void LinkMode::areas_changed(std::span<Body> /*bodies*/) { read_links(); }

// The rest of the line counts, so that no obstacle ever comes up before a body that cannot turn;
// and the cell at its end, because obstacles block whole cells.
void LinkMode::add_blockers(std::span<const uint32_t> slots, std::span<const Body> bodies,
                            BlockerPairs& found) const {
  if (users_.empty()) return;
  for (uint32_t i = 0; i < bodies.size(); ++i) {
    if (!bodies[i].on_link) continue;
    const LinkLine line = rest_of_line(bodies[i]);
    for (const uint32_t slot : slots) {
      const CrowdObstacle& obstacle = shared_.obstacles.all()[slot];
      if (!obstacle.waits()) continue;
      const Prism& passed =
          obstacle.is_up ? hull_of(obstacle.place, obstacle.wanted) : obstacle.wanted;
      if (meets(line, passed) || lands_on(bodies[i], obstacle)) found.emplace_back(slot, i);
    }
  }
}

bool LinkMode::is_inside(const Body& body, const ObstacleGrid::Item& obstacle) const {
  if (!body.on_link) return walk_.is_inside(body, obstacle);
  return meets(rest_of_line(body), obstacle.solid.prism) ||
         lands_on(body, shared_.obstacles.all()[obstacle.slot]);
}

bool LinkMode::lands_on(const Body& body, const CrowdObstacle& obstacle) const {
  const Stand& to = uses_[body.slot].to;
  const world::GroundPoint p{to.x, to.z};
  const std::vector<LevelCells>& swept = obstacle.of_class[body.avatar_class].swept;
  return std::any_of(swept.begin(), swept.end(), [&](const LevelCells& cells) {
    const uint64_t row = cells.rows[static_cast<size_t>(world::in_tile(p.cell_z()))];
    return cells.level == to.level && (row >> world::in_tile(p.cell_x()) & 1) != 0;
  });
}

bool LinkMode::must_leave(const Body& body, const Prism& obstacle) const {
  return !body.on_link && walk_.must_leave(body, obstacle);
}

bool LinkMode::leads_out(const Body& body, std::span<const uint32_t> slots) const {
  return body.on_link || walk_.leads_out(body, slots);
}

void LinkMode::end_leaving(Body& body) {
  if (!body.on_link) walk_.end_leaving(body);
}

AvatarState LinkMode::state_of(const Body& body) const {
  AvatarState state = walk_.state_of(body);
  if (body.on_link) state.mode = MoveMode::kLink;
  return state;
}

void LinkMode::check(std::span<const Body> bodies, CrowdCheck& found) const {
  if (users_.empty()) return;
  for (const Body& body : bodies) {
    if (body.on_link && !is_in_place(body)) ++found.wall_entries;
  }
}

uint64_t LinkMode::hash(const Body& body, uint64_t hash) const {
  return hash_row(uses_, body.slot, hash);
}

void LinkMode::add_memory(CrowdMemory& memory) const {
  memory.paths += uses_.capacity() * kRowBytes + links_.capacity() * sizeof(Link) +
                  corridors_.capacity() * sizeof(Corridor) + lines_.capacity() * sizeof(lines_[0]) +
                  is_user_.capacity() / 8 + near_.bytes() +
                  (users_.capacity() + bodies_.capacity() + came_.capacity() + merged_.capacity() +
                   order_.capacity()) *
                      sizeof(uint32_t);
}

void LinkMode::save(std::vector<uint8_t>& out) const { put_rows(out, uses_.data(), uses_.size()); }

const uint8_t* LinkMode::restore(const uint8_t* saved, size_t rows) {
  saved = take_rows(saved, rows, uses_);
  users_.clear();
  for (uint32_t slot = 0; slot < uses_.size(); ++slot) {
    if (uses_[slot].state != LinkUse::kNone) users_.push_back(slot);
  }
  return saved;
}

bool LinkMode::is_sound(const Body& body) const {
  if (uses_.empty()) return !body.on_link;
  const LinkUse& use = uses_[body.slot];
  const bool rides = use.state == LinkUse::kRides;
  if (use.state > LinkUse::kGivesRoom || body.on_link != rides) return false;
  if (use.state == LinkUse::kNone) return true;
  if (body.has(Body::kMovedElsewhere) != rides || body.climbs || shared_.flies(body.avatar_class)) {
    return false;
  }
  if (use.since / SharedState::kTimeUnits > shared_.step || use.stands > 1 || use.arrived > 1) {
    return false;
  }
  constexpr uint8_t kRests = Body::kArrived | Body::kHasGoal;
  const bool rests = (body.flags & (kRests | Body::kExternal)) == kRests;
  if (use.state == LinkUse::kGivesRoom && !rests) return false;
  const world::WorldData& world = *data_of(shared_.world);
  const auto is_place = [&](const Stand& at) {
    constexpr int32_t kMaxHeight = 1'000'000'000;  // [mm]
    if (at.y < -kMaxHeight || at.y > kMaxHeight) return false;
    if (at.x < 0 || at.z < 0 || !world::in_grid(world, {at.x, at.z})) return false;
    const world::GroundPoint p{at.x, at.z};
    const auto tile =
        world.tile_levels(world::tile_along(p.cell_x()), world::tile_along(p.cell_z()));
    return at.level >= tile.first && at.level < tile.last;
  };
  const bool finite = std::isfinite(use.along) && use.along >= 0 && use.factor > 0;
  return finite && use.factor <= 1 && use.link > 0 && use.link <= shared_.edits().edits.size() &&
         use.back <= 1 && is_place(use.from) && is_place(use.to);
}

bool LinkMode::is_in_place(const Body& body) const {
  if (!body.on_link) return true;
  const LinkUse& use = uses_[body.slot];
  const double part = part_of(use);
  const Stand at = stand_at(use, part);
  return part < 1 && at.x == body.x && at.z == body.z && at.y == body.y && at.level == body.level;
}

}  // namespace throng::crowd
