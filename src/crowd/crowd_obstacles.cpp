// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <string>

#include "core/access.h"
#include "crowd/crowd_state.h"
#include "throng/crowd.h"

// Obstacles that are added, moved and removed while a crowd walks. Between two steps all avatars
// stand; an obstacle appears only where none does, so it stays true that no avatar enters a wall.
namespace throng {
namespace {

ObstaclePhase phase_of(const crowd::CrowdObstacle& obstacle) {
  if (obstacle.is_up) {
    return obstacle.waits() ? ObstaclePhase::kWaitsToMove : ObstaclePhase::kUp;
  }
  return obstacle.waits() ? ObstaclePhase::kWaitsToComeUp : ObstaclePhase::kOff;
}

// Those of one obstacle, of sorted ones.
std::span<const std::pair<uint32_t, uint32_t>> pairs_of(
    std::span<const std::pair<uint32_t, uint32_t>> found, uint32_t slot) {
  const auto first = std::lower_bound(found.begin(), found.end(), std::pair(slot, uint32_t{0}));
  const auto last = std::lower_bound(found.begin(), found.end(), std::pair(slot + 1, uint32_t{0}));
  // (Of pointers: the page's standard library makes no span of two iterators.)
  return {found.data() + (first - found.begin()), static_cast<size_t>(last - first)};
}

}  // namespace

Result<ObstacleState> Crowd::obstacle(EditId edit) const {
  const State& s = *state_;
  const path::EditList::Edit* known = s.shared.edits().find(edit);
  if (known == nullptr || !known->is_obstacle()) {
    return Error{Errc::kNotFound,
                 "crowd: no obstacle of its edits has the id " + std::to_string(edit)};
  }
  const uint32_t slot1 = edit <= s.slot1_of_edit.size() ? s.slot1_of_edit[edit - 1] : 0;
  if (slot1 == 0) {
    ObstacleState state;
    state.prism = *known->place;
    state.phase = known->active ? ObstaclePhase::kWaitsToComeUp : ObstaclePhase::kOff;
    state.kind = known->obstacle_kind;
    state.policy = known->policy;
    return state;
  }
  const crowd::CrowdObstacle& found = s.shared.obstacles.all()[slot1 - 1];
  const auto seconds = [&](uint64_t step) {
    return step == crowd::CrowdObstacle::kNever ? -1
                                                : static_cast<double>(step) * s.shared.config.dt;
  };
  return ObstacleState{found.place,
                       phase_of(found),
                       found.kind,
                       found.policy,
                       seconds(found.requested_step),
                       seconds(found.up_step),
                       found.occupants};
}

std::vector<Prism> Crowd::obstacles() const { return state_->up_obstacles(); }

std::vector<Prism> Crowd::State::up_obstacles() const {
  std::vector<Prism> prisms;
  for (const crowd::CrowdObstacle& obstacle : shared.obstacles.all()) {
    if (obstacle.exists && obstacle.is_up) prisms.push_back(obstacle.place);
  }
  return prisms;
}

std::span<const AvatarId> Crowd::blockers() const { return state_->blockers; }

uint32_t Crowd::State::add_obstacle(EditId edit, const Prism& prism) {
  const path::EditList::Edit& of = shared.edits().edits[edit - 1];
  const uint32_t slot =
      shared.obstacles.add(prism, of.obstacle_kind, /*wanted_up=*/true, of.policy);
  shared.obstacles.at(slot).edit = edit;
  shared.obstacles.at(slot).requested_step = shared.step;
  settle_obstacles(std::span(&slot, 1), nullptr);
  return slot;
}

void Crowd::State::move_obstacle(uint32_t slot, const Prism& prism) {
  const bool closed = shared.obstacles.at(slot).closes();
  shared.obstacles.request_move(slot, prism);
  settle_obstacles(std::span(&slot, 1), nullptr);
  if (closed && !shared.obstacles.at(slot).has_cells) ground_changed();
}

void Crowd::State::set_obstacle_active(uint32_t slot, bool active) {
  const crowd::CrowdObstacle& obstacle = shared.obstacles.at(slot);
  const bool had_cells = obstacle.has_cells, was_wanted = obstacle.wanted_up;
  shared.obstacles.request_active(slot, active);
  if (active && !was_wanted) shared.obstacles.at(slot).requested_step = shared.step;
  settle_obstacles(std::span(&slot, 1), nullptr);
  if (had_cells && !active) {
    ground_changed();
    sync_paths(slot);
  }
}

void Crowd::State::remove_obstacle(uint32_t slot) {
  set_obstacle_active(slot, false);
  for (crowd::Mode* mode : modes) mode->forget_obstacle(shared.obstacles.at(slot));
  shared.obstacles.remove(slot);
}

// Of each of these obstacles.
std::vector<Crowd::State::Blocked> Crowd::State::find_blocked_obstacles(
    std::span<const uint32_t> slots, std::span<const std::pair<uint32_t, uint32_t>> found) const {
  std::vector<Blocked> all;
  for (const uint32_t slot : slots) {
    const crowd::CrowdObstacle& obstacle = shared.obstacles.all()[slot];
    const auto here = pairs_of(found, slot);
    Blocked& by = all.emplace_back();
    by.bodies = static_cast<uint32_t>(here.size());
    for (const auto& pair : here) {
      by.walkers += walk.bodies()[pair.second].has(crowd::Body::kMovedElsewhere) ? 0 : 1;
    }
    const bool refuses = obstacle.policy == ObstaclePolicy::kRefuseEntry && !obstacle.is_up;
    by.inside = refuses && is_occupied(slot, here) ? 1 : 0;
  }
  if (!shared.share) return all;
  const std::vector<Blocked> of_ranks = shared.share->gather(std::span<const Blocked>(all));
  for (size_t n = 0; n < all.size(); ++n) {
    all[n] = {};
    for (size_t at = n; at < of_ranks.size(); at += slots.size()) {
      all[n].bodies += of_ranks[at].bodies;
      all[n].walkers += of_ranks[at].walkers;
      all[n].inside += of_ranks[at].inside;
    }
  }
  return all;
}

size_t Crowd::State::settle_obstacles(std::span<const uint32_t> slots,
                                      std::vector<AvatarId>* in_their_path) {
  if (in_their_path != nullptr) in_their_path->clear();
  const bool begins_step = in_their_path != nullptr;
  if (begins_step) end_leaving_zero();
  if (slots.empty()) {
    if (begins_step && shared.some_leave) mark_leaving({}, begins_step);
    return 0;
  }
  const std::span<const crowd::Body> bodies = walk.bodies();
  crowd::BlockerPairs found;
  for (const crowd::Mode* mode : modes) mode->add_blockers(slots, bodies, found);
  std::sort(found.begin(), found.end());
  const std::vector<Blocked> blocked = find_blocked_obstacles(slots, found);
  size_t waiting = 0, nth = 0;
  std::vector<uint32_t> cut;
  std::vector<std::pair<uint32_t, uint32_t>> leaving;
  bool changed = false;
  for (const uint32_t slot : slots) {
    const crowd::CrowdObstacle& obstacle = shared.obstacles.at(slot);
    const Blocked by = blocked[nth++];
    const bool refuses = obstacle.policy == ObstaclePolicy::kRefuseEntry && !obstacle.is_up;
    const std::span<const std::pair<uint32_t, uint32_t>> here = pairs_of(found, slot);
    if (!obstacle.waits() && !obstacle.is_exit_only) continue;
    const bool had_cells = obstacle.has_cells && !obstacle.is_elsewhere;
    const bool was_exit_only = obstacle.is_exit_only, waited = obstacle.waits();
    bool comes = by.bodies == 0;
    if (by.bodies > 0 && (refuses || obstacle.is_exit_only)) {
      leaving.insert(leaving.end(), here.begin(), here.end());
      shared.obstacles.set_exit_only(slot, by.walkers > 0);
      if (refuses) {
        shared.obstacles.close(slot);
        comes = by.inside == 0;
      }
    } else if (by.bodies == 0) {
      shared.obstacles.set_exit_only(slot, false);
    }
    if (waited && comes) {
      shared.obstacles.settle(slot);
      if (obstacle.up_step == crowd::CrowdObstacle::kNever) {
        shared.obstacles.at(slot).up_step = begins_step ? shared.step - 1 : shared.step;
      }
    }
    changed = changed || (waited && comes) || was_exit_only != obstacle.is_exit_only ||
              had_cells != obstacle.has_cells;
    if (obstacle.has_cells && !had_cells) cut.push_back(slot);
    shared.obstacles.at(slot).occupants = obstacle.waits() ? by.bodies : 0;
    if (!obstacle.waits()) continue;
    ++waiting;
    if (!begins_step) continue;
    for (const auto& pair : here) {
      in_their_path->push_back(shared.id_of(bodies[pair.second].slot));
    }
  }
  if (begins_step) {
    if (shared.share) {
      *in_their_path = shared.share->gather(std::span<const AvatarId>(*in_their_path));
    }
    const auto before = [](AvatarId a, AvatarId b) { return a.slot1 < b.slot1; };
    std::sort(in_their_path->begin(), in_their_path->end(), before);
    in_their_path->erase(std::unique(in_their_path->begin(), in_their_path->end()),
                         in_their_path->end());
  }
  if (changed) ground_changed();
  mark_leaving(leaving, begins_step);
  if (cut.empty()) return waiting;
  for (const uint32_t slot : cut) sync_paths(slot);
  for (crowd::Mode* mode : modes) mode->cut_paths(cut, walk.bodies());
  return waiting;
}

void Crowd::State::ground_changed() {
  shared.obstacles.block_cells();
  for (crowd::Mode* mode : modes) mode->ground_changed();
  // What flyers and climbers test.
  const Vec3d& origin = shared.origin();
  for (const uint32_t slot : shared.obstacles.take_changed()) {
    const crowd::CrowdObstacle& obstacle = shared.obstacles.at(slot);
    if (!obstacle.exists || !obstacle.has_cells) {
      shared.obstacle_grid.erase(slot);
      continue;
    }
    shared.obstacle_grid.set(
        slot, crowd::AirObstacle(obstacle.place, origin, shared.unit, obstacle.closes()),
        {obstacle.place, {}});
  }
}

void Crowd::State::sync_paths(uint32_t slot) {
  for (size_t c = 0; c < shared.classes.size(); ++c) sync_paths(slot, c);
}

void Crowd::State::sync_paths(uint32_t slot, size_t number) {
  crowd::CrowdObstacle& obstacle = shared.obstacles.at(slot);
  if (obstacle.kind != ObstacleKind::kStatic || !obstacle.exists || !shared.classes[number]) return;
  crowd::CrowdObstacle::OfClass& synced = obstacle.of_class[number];
  const bool is_new =
      obstacle.has_cells && (!synced.is_synced || synced.synced_version != obstacle.version);
  if (is_new) {
    synced.is_synced = true;
    synced.synced_version = obstacle.version;
  }
  for (crowd::Mode* mode : modes) mode->sync_obstacle(obstacle, number, is_new);
}

}  // namespace throng
