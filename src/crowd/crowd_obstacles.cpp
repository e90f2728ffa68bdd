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

// Of triangles the box around them, which may be flat.
Prism prism_of(const path::Solid& solid) {
  if (solid.triangles.empty()) return solid.prism;
  constexpr double kBoxMargin = 0.001;  // [m]
  const Prism& box = solid.prism;
  const auto [low, high] = std::minmax_element(box.corners.begin(), box.corners.end());
  return Prism::box({(*low)[0] - kBoxMargin, box.low - kBoxMargin, (*low)[1] - kBoxMargin},
                    {(*high)[0] + kBoxMargin, box.high + kBoxMargin, (*high)[1] + kBoxMargin});
}

ObstaclePhase phase_of(const crowd::CrowdObstacle& obstacle) {
  if (obstacle.is_up) {
    return obstacle.waits() ? ObstaclePhase::kWaitsToMove : ObstaclePhase::kUp;
  }
  return obstacle.waits() ? ObstaclePhase::kWaitsToComeUp : ObstaclePhase::kOff;
}

Error no_obstacle() { return {Errc::kNotFound, "crowd: there is no obstacle of that id"}; }

}  // namespace

Result<ObstacleId> Crowd::add_obstacle(const Prism& prism, ObstacleKind kind,
                                       ObstaclePolicy policy) {
  if (auto ok = check_prism(prism); !ok) return ok.error();
  State& s = *state_;
  const uint32_t slot = s.shared.obstacles.add(prism, kind, /*wanted_up=*/true, policy);
  s.shared.obstacles.at(slot).requested_step = s.shared.step;
  s.settle_obstacles(std::span(&slot, 1), nullptr);
  return ObstacleId{slot + 1, s.shared.obstacles.at(slot).generation};
}

Result<void> Crowd::move_obstacle(ObstacleId id, const Prism& prism) {
  if (auto ok = check_prism(prism); !ok) return ok.error();
  State& s = *state_;
  if (s.shared.obstacles.find(id) == nullptr) return no_obstacle();
  const uint32_t slot = id.slot1 - 1;
  const bool closed = s.shared.obstacles.at(slot).closes();
  s.shared.obstacles.request_move(slot, prism);
  s.settle_obstacles(std::span(&slot, 1), nullptr);
  if (closed && !s.shared.obstacles.at(slot).has_cells) s.ground_changed();
  return {};
}

bool Crowd::set_obstacle_active(ObstacleId id, bool active) {
  State& s = *state_;
  if (s.shared.obstacles.find(id) == nullptr) return false;
  const uint32_t slot = id.slot1 - 1;
  const crowd::CrowdObstacle& obstacle = s.shared.obstacles.at(slot);
  const bool had_cells = obstacle.has_cells, was_wanted = obstacle.wanted_up;
  s.shared.obstacles.request_active(slot, active);
  if (active && !was_wanted) s.shared.obstacles.at(slot).requested_step = s.shared.step;
  s.settle_obstacles(std::span(&slot, 1), nullptr);
  if (had_cells && !active) {
    s.ground_changed();
    s.sync_paths(slot);
  }
  return true;
}

bool Crowd::remove_obstacle(ObstacleId id) {
  State& s = *state_;
  if (!set_obstacle_active(id, false)) return false;
  const uint32_t slot = id.slot1 - 1;
  for (crowd::Mode* mode : s.modes) mode->forget_obstacle(s.shared.obstacles.at(slot));
  s.shared.obstacles.remove(slot);
  return true;
}

Result<ObstacleState> Crowd::obstacle(ObstacleId id) const {
  const crowd::CrowdObstacle* found = state_->shared.obstacles.find(id);
  if (found == nullptr) return no_obstacle();
  const auto seconds = [&](uint64_t step) {
    return step == crowd::CrowdObstacle::kNever
               ? -1
               : static_cast<double>(step) * state_->shared.config.dt;
  };
  return ObstacleState{found->place,
                       phase_of(*found),
                       found->kind,
                       found->policy,
                       seconds(found->requested_step),
                       seconds(found->up_step),
                       found->occupants};
}

// Obstacles of edits are those of add_obstacle. One that is not active is not added, so that it
// costs nothing.
void Crowd::follow_edits() {
  State& s = *state_;
  const path::EditList& list = s.shared.edits();
  if (s.edits_version == list.version()) return;
  bool areas_changed = false, links_changed = false;
  s.of_edit.resize(std::max(s.of_edit.size(), list.edits.size()));
  list.for_changed(s.edits_version, [&](const path::EditList::Changed& what) {
    using Kind = path::EditList::Kind;
    const Kind kind = what.edit == 0 ? Kind::kArea : list.edits[what.edit - 1].kind;
    areas_changed = areas_changed || kind == Kind::kArea;
    links_changed = links_changed || kind == Kind::kOffMeshLink;
    if (kind != Kind::kObstacle) return;
    const path::EditList::Edit& edit = list.edits[what.edit - 1];
    ObstacleId& own = s.of_edit[what.edit - 1];
    if (edit.removed) {
      remove_obstacle(own);
      own = {};
    } else if (own) {
      set_obstacle_active(own, edit.active);
    } else if (edit.active) {
      const auto added = add_obstacle(prism_of(edit.solid));
      if (added) own = *added;  // Edits has checked it.
    }
  });
  s.edits_version = list.version();
  if (!areas_changed && !links_changed) return;
  // Links change no path of a crowd in which none takes them.
  const std::span<crowd::Body> all = s.walk.bodies();
  const bool some_change =
      areas_changed || std::any_of(all.begin(), all.end(), [&](const crowd::Body& body) {
        return &s.mode_of(body) == &s.link;
      });
  for (crowd::Mode* mode : s.modes) {
    mode->areas_changed(some_change ? all : std::span<crowd::Body>());
  }
}

ObstacleId Crowd::obstacle_of(EditId edit) const {
  return edit >= 1 && edit <= state_->of_edit.size() ? state_->of_edit[edit - 1] : ObstacleId{};
}

std::vector<Prism> Crowd::obstacles() const {
  std::vector<Prism> prisms;
  for (const crowd::CrowdObstacle& obstacle : state_->shared.obstacles.all()) {
    if (obstacle.exists && obstacle.is_up) prisms.push_back(obstacle.place);
  }
  return prisms;
}

std::span<const AvatarId> Crowd::blockers() const { return state_->blockers; }

size_t Crowd::State::settle_obstacles(std::span<const uint32_t> slots,
                                      std::vector<AvatarId>* in_their_path) {
  if (in_their_path != nullptr) in_their_path->clear();
  const bool begins_step = in_their_path != nullptr;
  if (slots.empty()) {
    if (begins_step && shared.some_leave) mark_leaving({}, begins_step);
    return 0;
  }
  const std::span<const crowd::Body> bodies = walk.bodies();
  crowd::BlockerPairs found;
  for (const crowd::Mode* mode : modes) mode->add_blockers(slots, bodies, found);
  std::sort(found.begin(), found.end());
  size_t waiting = 0;
  std::vector<uint32_t> cut;
  std::vector<std::pair<uint32_t, uint32_t>> leaving;
  bool changed = false;
  for (const uint32_t slot : slots) {
    const crowd::CrowdObstacle& obstacle = shared.obstacles.at(slot);
    const auto first = std::lower_bound(found.begin(), found.end(), std::pair(slot, uint32_t{0}));
    const auto last =
        std::lower_bound(found.begin(), found.end(), std::pair(slot + 1, uint32_t{0}));
    const bool refuses = obstacle.policy == ObstaclePolicy::kRefuseEntry && !obstacle.is_up;
    // (Of pointers: the page's standard library makes no span of two iterators.)
    const std::span<const std::pair<uint32_t, uint32_t>> here(
        found.data() + (first - found.begin()), static_cast<size_t>(last - first));
    if (!obstacle.waits() && !obstacle.is_exit_only) continue;
    const bool had_cells = obstacle.has_cells && !obstacle.is_elsewhere;
    const bool was_exit_only = obstacle.is_exit_only, waited = obstacle.waits();
    bool comes = here.empty();
    if (!here.empty() && (refuses || obstacle.is_exit_only)) {
      leaving.insert(leaving.end(), here.begin(), here.end());
      const auto walks = [&](const auto& pair) {
        return !bodies[pair.second].has(crowd::Body::kMovedElsewhere);
      };
      shared.obstacles.set_exit_only(slot, std::any_of(here.begin(), here.end(), walks));
      if (refuses) {
        shared.obstacles.close(slot);
        comes = !is_occupied(slot, here);
      }
    } else if (here.empty()) {
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
    shared.obstacles.at(slot).occupants = obstacle.waits() ? static_cast<uint32_t>(here.size()) : 0;
    if (!obstacle.waits()) continue;
    ++waiting;
    if (!begins_step) continue;
    for (const auto& pair : here) {
      in_their_path->push_back(shared.id_of(bodies[pair.second].slot));
    }
  }
  if (begins_step) {
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
