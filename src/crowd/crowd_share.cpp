// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include "core/access.h"
#include "core/arrays/release.h"
#include "crowd/crowd_state.h"
#include "crowd/mode/saved_rows.h"
#include "crowd/shared_crowd.h"
#include "crowd/standing_map.h"

// A crowd that ranks share. Each has the avatars on its columns of the plane, and makes the same
// calls in the same order. docs/design/019-ranks.md.
namespace throng {
namespace {

constexpr double kMaxImbalance = 1.1;   // largest share of the avatars by the mean one
constexpr uint64_t kStepsBetween = 50;  // at least, before columns are assigned again
constexpr size_t kMinAvatars = 100;     // a rank: fewer are not worth it

template <class Values>
uint32_t size_of(const Values& values) {
  return static_cast<uint32_t>(values.size());
}

}  // namespace

namespace crowd {

Result<Crowd> share_crowd(Result<Crowd> crowd, RankGroup& group) {
  if (!crowd) return crowd;
  if (auto ok = Access::state(*crowd)->share_with(group); !ok) return ok.error();
  return crowd;
}

std::vector<AvatarState> own_avatars(const Crowd& crowd) {
  return Access::state(crowd)->own_states();
}

}  // namespace crowd

// Of the avatars that it has, each rank keeps those on its columns.
Result<void> Crowd::State::share_with(RankGroup& group) {
  for (const crowd::Body& body : walk.bodies()) {
    if (&mode_of(body) != &link) return share_refused(body.avatar_class);
  }
  const world::WorldData& data = *data_of(shared.world);
  shared.share = std::make_unique<crowd::RankShare>(group, data.width, data.depth);
  if (auto ok = check_links(); !ok) return ok;
  shared.share->assign_columns(walk.bodies());
  assigned_for = walk.bodies().size();
  assigned_at = shared.step;
  std::vector<Moved> own;
  for (size_t n = 0; n < walk.bodies().size(); ++n) {
    if (shared.share->is_own(walk.bodies()[n])) own.push_back(moved(n, shared.sub_step));
  }
  shared.names.share();
  walk.share();
  if (crowd::DelayMap* delays = walk.delays(); delays != nullptr && group.rank() > 0) {
    delays->forget_sums();
  }
  release(shared.orientations);
  release(where);
  own_curves = {};
  for (const Moved& one : own) take(one, shared.sub_step);
  where_is_old = true;
  return {};
}

Error Crowd::State::share_refused(size_t avatar_class) const {
  return {Errc::kBadConfig,
          "crowd: class " + shared.body_class(avatar_class).name +
              (shared.flies(avatar_class) ? " flies" : " goes over nodes") +
              "; ranks share only avatars that walk: take another class or one process"};
}

Result<void> Crowd::State::check_links() const {
  if (!shared.share || !shared.has_links()) return {};
  return Error{Errc::kBadConfig,
               "crowd: ranks share no crowd that takes off-mesh links; switch them off or take one "
               "process"};
}

std::vector<uint8_t> Crowd::State::find_blocked(std::span<const crowd::NewAvatar> avatars,
                                                int32_t widest) const {
  const crowd::StandingMap map(walk.bodies(), widest, 0);
  std::vector<uint8_t> blocked(avatars.size());
  for (size_t i = 0; i < avatars.size(); ++i) blocked[i] = map.is_clear(avatars[i].body) ? 0 : 1;
  if (!shared.share) return blocked;
  const std::vector<uint8_t> all = shared.share->gather(std::span<const uint8_t>(blocked));
  for (size_t i = 0; i < all.size(); ++i) blocked[i % avatars.size()] |= all[i];
  return blocked;
}

crowd::Body* Crowd::State::commanded(AvatarId id) {
  crowd::Body* const here = body(id);
  if (here == nullptr && shared.share && shared.names.is_alive(id)) walk.forget_path(id.slot1 - 1);
  return here;
}

Crowd::State::Moved Crowd::State::moved(size_t n, uint64_t next) const {
  const uint32_t slot = walk.bodies()[n].slot;
  Moved moved{.walker = walk.moved(n, next),
              .orientation = shared.orientations[slot],
              .inside = slot < inside.size() ? inside[slot] : 0,
              .checked_at = slot < checked_at.size() ? checked_at[slot] : kNeverChecked};
  if (const CurvilinearTuning* curves = own_curves.find(slot); curves != nullptr) {
    moved.has_curves = 1;
    moved.curves = *curves;
  }
  return moved;
}

void Crowd::State::take(const Moved& moved, uint64_t next) {
  const uint32_t slot = shared.names.take_slot(moved.walker.ghost.body.slot);
  shared.orientations.resize(shared.names.slots());
  where.resize(shared.names.slots(), kNoBody);
  walk.take_over(moved.walker, slot, next);
  shared.orientations[slot] = moved.orientation;
  inside.resize(std::max(inside.size(), slot + size_t{1}), 0);
  inside[slot] = moved.inside;
  checked_at.resize(std::max(checked_at.size(), slot + size_t{1}), kNeverChecked);
  checked_at[slot] = moved.checked_at;
  if (moved.has_curves != 0) own_curves.set(slot, moved.curves);
  shared.some_leave = shared.some_leave || moved.walker.ghost.body.leaves;
}

std::vector<Crowd::State::Moved> Crowd::State::moved_everywhere() const {
  std::vector<Moved> own;
  for (size_t n = 0; n < walk.bodies().size(); ++n) own.push_back(moved(n, shared.sub_step));
  std::vector<Moved> all = shared.share->gather(std::span<const Moved>(own));
  std::sort(all.begin(), all.end(), [](const Moved& a, const Moved& b) {
    return a.walker.ghost.body.slot < b.walker.ghost.body.slot;
  });
  return all;
}

// Where columns have other owners.
void Crowd::State::keep_near_ground() {
  const crowd::ColumnOwners& owners = shared.share->owners();
  if (near_version == owners.version()) return;
  near_version = owners.version();
  for (const auto& of : shared.classes) {
    if (!of) continue;
    of->ground.keep_near([&](int32_t x, int32_t z) { return owners.is_near(x, z); });
  }
}

void Crowd::State::migrate() {
  crowd::RankShare& share = *shared.share;
  share.set_reach(walk.engine().sight());
  const bool reassigns = shared.names.alive() > 2 * assigned_for || is_uneven;
  if (reassigns) {
    share.assign_columns(walk.bodies());
    assigned_for = shared.names.alive();
    assigned_at = shared.step;
    is_uneven = false;
  }
  keep_near_ground();
  const std::span<const int32_t> neighbours = share.owners().neighbours();
  std::vector<std::vector<Moved>> to(reassigns ? static_cast<size_t>(share.size())
                                               : neighbours.size());
  for (size_t n = 0; n < walk.bodies().size();) {
    crowd::Body& body = walk.bodies()[n];
    const int32_t owner = share.owners().owner_at(body.x, body.z);
    if (owner == share.rank()) {
      ++n;
      continue;
    }
    size_t box = static_cast<size_t>(owner);
    if (!reassigns) {
      const auto at = std::lower_bound(neighbours.begin(), neighbours.end(), owner);
      THRONG_ASSERT(at != neighbours.end() && *at == owner);  // No step leads farther.
      box = static_cast<size_t>(at - neighbours.begin());
    }
    to[box].push_back(moved(n, shared.sub_step - 1));
    own_curves.forget(body.slot);
    shared.names.give_slot_back(body.slot);
    body = walk.bodies().back();
    walk.engine().shrink(walk.bodies().size() - 1);
  }
  std::vector<Moved> came;
  if (reassigns) {
    came = share.exchange_with_all(std::span<const std::vector<Moved>>(to));
  } else {
    share.exchange(std::span<const std::vector<Moved>>(to), came);
  }
  for (const Moved& one : came) take(one, shared.sub_step - 1);
  where_is_old = true;
}

// In one message.
void Crowd::State::gather_events(crowd::EngineCounts& counts, CrowdReport& report) {
  crowd::RankShare& share = *shared.share;
  struct Sums {
    crowd::EngineCounts counts;
    uint64_t planned = 0, out_of_memory = 0, jam_searches = 0, changed_route = 0;
    uint64_t avatars = 0, sent_bytes = 0;
    std::array<uint32_t, 4> events = {};  // how many of each kind follow
  };
  const Sums mine{counts,
                  shared.planned,
                  shared.out_of_memory,
                  shared.jam_searches,
                  shared.changed_route,
                  walk.bodies().size(),
                  share.sent_bytes(),
                  {size_of(shared.arrived), size_of(shared.goal_unreachable), size_of(no_progress),
                   size_of(entered)}};
  std::vector<uint8_t> bytes;
  crowd::put_rows(bytes, &mine, 1);
  for_events([&](auto& events) {
    crowd::put_rows(bytes, events.data(), events.size());
    events.clear();
  });
  counts = {};
  Sums all;
  for (const RankGroup::Bytes& came : share.gather_bytes(bytes)) {
    const std::span<const uint8_t> from(came);
    Sums of;
    std::memcpy(&of, from.data(), sizeof of);
    size_t at = sizeof of, kind = 0;
    for_events([&](auto& events) {
      const size_t size = of.events[kind++] * sizeof(events[0]);
      append_values(from.subspan(at, size), events);
      at += size;
    });
    counts.add(of.counts);
    all.planned += of.planned;
    all.out_of_memory += of.out_of_memory;
    all.jam_searches += of.jam_searches;
    all.changed_route += of.changed_route;
    all.avatars = std::max(all.avatars, of.avatars);
    all.sent_bytes = std::max(all.sent_bytes, of.sent_bytes);
  }
  std::sort(no_progress.begin(), no_progress.end(),
            [](AvatarId a, AvatarId b) { return a.slot1 < b.slot1; });
  std::sort(entered.begin(), entered.end(), [](const AreaEntry& a, const AreaEntry& b) {
    return a.id.slot1 != b.id.slot1 ? a.id.slot1 < b.id.slot1 : a.area < b.area;
  });
  report.ranks = share.size();
  report.most_avatars = all.avatars;
  report.sent_bytes = all.sent_bytes;
  shared.planned = all.planned;
  shared.out_of_memory = all.out_of_memory;
  shared.jam_searches = all.jam_searches;
  shared.changed_route = all.changed_route;
  const double mean = static_cast<double>(count()) / share.size();
  is_uneven = mean >= kMinAvatars && static_cast<double>(all.avatars) > kMaxImbalance * mean &&
              shared.step >= assigned_at + kStepsBetween;
}

std::vector<AvatarState> Crowd::State::own_states() const {
  std::vector<AvatarState> states;
  for (const crowd::Body& body : walk.bodies()) states.push_back(mode_of(body).state_of(body));
  return states;
}

const std::vector<AvatarState>& Crowd::State::states_everywhere() const {
  if (!everywhere.empty()) return everywhere;
  const std::vector<AvatarState> own = own_states();
  everywhere = shared.share->gather(std::span<const AvatarState>(own));
  std::sort(everywhere.begin(), everywhere.end(),
            [](const AvatarState& a, const AvatarState& b) { return a.id < b.id; });
  return everywhere;
}

std::optional<AvatarState> Crowd::State::state_everywhere(AvatarId id) const {
  if (!shared.names.is_alive(id)) return std::nullopt;
  const std::vector<AvatarState>& all = states_everywhere();
  const auto at =
      std::lower_bound(all.begin(), all.end(), id.slot1 - 1,
                       [](const AvatarState& state, uint32_t name) { return state.id < name; });
  return at != all.end() && at->id == id.slot1 - 1 ? std::optional(*at) : std::nullopt;
}

// What touches on two ranks each of them counts: half of it.
CrowdCheck Crowd::State::check_shared() const {
  crowd::RankShare& share = *shared.share;
  std::vector<crowd::CheckedBody> own;
  own.reserve(walk.bodies().size());
  std::vector<std::vector<crowd::CheckedBody>> shown(share.owners().neighbours().size());
  std::vector<uint32_t> near;
  for (const crowd::Body& body : walk.bodies()) {
    own.push_back(checked(body));
    share.owners().find_near(body.x, body.z, near);
    for (const uint32_t neighbour : near) shown[neighbour].push_back(own.back());
  }
  std::vector<crowd::CheckedBody> others, both = own;
  share.exchange(std::span<const std::vector<crowd::CheckedBody>>(shown), others);
  both.insert(both.end(), others.begin(), others.end());
  const auto check = [&](std::span<const crowd::CheckedBody> bodies) {
    return crowd::check_bodies(shared.world, bodies, up_obstacles(), shared.config.workers);
  };
  CrowdCheck found = check(own);
  for (const crowd::Mode* mode : modes) mode->check(walk.bodies(), found);
  struct Counts {
    uint64_t walls = 0, own = 0, crossing = 0, obstacles = 0;
  };
  const Counts mine{found.wall_entries, found.overlaps,
                    check(both).overlaps - found.overlaps - check(others).overlaps,
                    found.obstacle_entries};
  uint64_t crossing = 0;
  found = {};
  for (const Counts& of : share.gather(std::span<const Counts>(&mine, 1))) {
    found.wall_entries += of.walls;
    found.overlaps += of.own;
    found.obstacle_entries += of.obstacles;
    crossing += of.crossing;
  }
  found.overlaps += crossing / 2;
  return found;
}

}  // namespace throng
