// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "crowd/link/link_mode.h"

#include <algorithm>
#include <cmath>

#include "crowd/mode/saved_rows.h"
#include "path/edits/edit_list.h"
#include "throng/avatar.h"
#include "world/place.h"
#include "world/tile_grid.h"

// Off-mesh links of a crowd: the contract of modes but for turns (link_turns.cpp) and moves
// (link_step.cpp). What is said of an avatar on foot, WalkMode answers.
namespace throng::crowd {

LinkMode::LinkMode(SharedState& shared, WalkMode& walk) : Mode(shared), walk_(walk) {
  walk_.set_takes_links(*this);
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
    if (!world::ground_point(world, link.from) || !world::ground_point(world, link.to)) continue;
    links_.push_back({.edit = id,
                      .from = throng::crowd::point_of(world, link.from),
                      .to = throng::crowd::point_of(world, link.to),
                      .cost = link.cost,
                      .two_way = link.two_way});
  }
  if (!links_.empty()) uses_.resize(shared_.generation.size());
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
  constexpr double kRounded = 2;  // [units]
  const AvatarClass& avatar = shared_.body_class(body.avatar_class);
  return {.from = point_of(from),
          .to = point_of(to),
          .radius = avatar.radius + kRounded * shared_.unit,
          .bottom = body_bottom(avatar),
          .top = body.height * 1e-3};
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
  if (uses_.empty() && links_.empty()) return;
  uses_.resize(shared_.generation.size());
  uses_[avatar.body.slot] = {};
}

void LinkMode::fit(const BodyExtent& all, float /*fastest*/) { widest_ = all.widest; }

// One that is on a link arrives at its end first.
void LinkMode::set_goal(Body& body, const Place& goal) {
  const bool rides = body.on_link;
  if (!rides && !uses_.empty()) uses_[body.slot] = {};
  walk_.set_goal(body, goal);
  if (rides) body.flags = (body.flags & Body::kHasGoal) | Body::kMovedElsewhere;
}

void LinkMode::set_target(Body& body) {
  if (!body.on_link && !uses_.empty()) uses_[body.slot] = {};
}

void LinkMode::set_velocity(Body& body, const Vec3d& velocity) {
  if (!body.on_link && !uses_.empty()) uses_[body.slot] = {};
  walk_.set_velocity(body, velocity);
}

void LinkMode::areas_changed(std::span<Body> /*bodies*/) { read_links(); }

// The rest of the line counts, so that no obstacle ever comes up before a body that cannot turn.
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
      if (meets(line, passed)) found.emplace_back(slot, i);
    }
  }
}

bool LinkMode::is_inside(const Body& body, const ObstacleGrid::Item& obstacle) const {
  if (!body.on_link) return walk_.is_inside(body, obstacle);
  return meets(rest_of_line(body), obstacle.solid.prism);
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

uint64_t LinkMode::hash(std::span<const Body> by_slot, uint64_t hash) const {
  return hash_rows(by_slot, uses_, hash);
}

void LinkMode::add_memory(CrowdMemory& memory) const {
  memory.paths += uses_.capacity() * kRowBytes;
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
  if (use.state > LinkUse::kRides || body.on_link != rides) return false;
  if (use.state == LinkUse::kNone) return true;
  if (body.has(Body::kMovedElsewhere) != rides || body.climbs || shared_.flies(body.avatar_class)) {
    return false;
  }
  const world::WorldData& world = *data_of(shared_.world);
  const auto is_place = [&](const Stand& at) {
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
