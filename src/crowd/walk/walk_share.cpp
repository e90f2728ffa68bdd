// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "crowd/walk/walk_share.h"

#include <algorithm>

#include "crowd/walk/walk_mode.h"

// What ranks that share a crowd say to each other of avatars on foot. Linear in the bodies, and in
// those near the borders between ranks.
namespace throng::crowd {

void RankExchange::begin() {
  const size_t neighbours = shared_.share->owners().neighbours().size();
  shown_.resize(neighbours);
  bodies_.resize(neighbours);
  moves_.resize(neighbours);
  accepted_.resize(neighbours);
}

void RankExchange::end() {
  for (const uint32_t slot : slots_) shared_.names.give_slot_back(slot);
  slots_.clear();
}

std::span<const Ghost> RankExchange::exchange_bodies(CrowdEngine& engine) {
  RankShare& share = *shared_.share;
  for (auto& names : shown_) names.clear();
  for (auto& bodies : bodies_) bodies.clear();
  for (size_t n = 0; n < engine.bodies().size(); ++n) {
    const Body& body = engine.bodies()[n];
    share.owners().find_near(body.x, body.z, near_);
    if (near_.empty()) continue;
    engine.show_to_others(n);
    Ghost ghost = engine.ghost_of(n, shared_.sub_step - 1);
    ghost.body.slot = engine.name_of(body);
    for (const uint32_t neighbour : near_) {
      bodies_[neighbour].push_back(ghost);
      shown_[neighbour].push_back(ghost.body.slot);
    }
  }
  for (auto& names : shown_) std::sort(names.begin(), names.end());
  share.exchange(std::span<const std::vector<Ghost>>(bodies_), ghosts_);
  for (Ghost& ghost : ghosts_) {
    ghost.body.slot = shared_.names.take_passing_slot(ghost.body.slot);
    slots_.push_back(ghost.body.slot);
  }
  engine.fit_rows(shared_.names.slots());
  return ghosts_;
}

// Of all that are shown, which are in order of name, to each neighbour those that it sees.
template <class T, class Name>
std::span<const T> RankExchange::send_shown(std::span<const T> all, Name name_of,
                                            std::vector<std::vector<T>>& to, std::vector<T>& from) {
  for (size_t n = 0; n < to.size(); ++n) {
    to[n].clear();
    auto shown = shown_[n].begin();
    for (const T& one : all) {
      while (shown != shown_[n].end() && *shown < name_of(one)) ++shown;
      if (shown == shown_[n].end()) break;
      if (*shown == name_of(one)) to[n].push_back(one);
    }
  }
  return shared_.share->exchange(std::span<const std::vector<T>>(to), from);
}

std::span<const GhostMove> RankExchange::exchange_moves(std::span<const GhostMove> shown) {
  return send_shown(
      shown, [](const GhostMove& move) { return move.name; }, moves_, ghost_moves_);
}

std::span<const uint32_t> RankExchange::exchange_accepted(std::span<const uint32_t> shown) {
  return send_shown(
      shown, [](uint32_t name) { return name; }, accepted_, ghosts_accepted_);
}

void WalkMode::share() {
  exchange_ = std::make_unique<RankExchange>(shared_);
  engine_.set_names(shared_.names);
  engine_.reserve(1);
}

MovedWalker WalkMode::moved(size_t n) const {
  const Body& body = engine_.bodies()[n];
  MovedWalker walker{.ghost = engine_.ghost_of(n, next_step()),
                     .choice = engine_.choice(body.slot),
                     .route = routes_[body.slot],
                     .progress = progress_[body.slot]};
  walker.ghost.body.slot = shared_.name_of(body);
  return walker;
}

// At the end of the bodies.
void WalkMode::take_over(const MovedWalker& walker, uint32_t slot) {
  fit_rows();
  Ghost ghost = walker.ghost;
  ghost.body.slot = slot;
  engine_.take_over(ghost, walker.choice, next_step());
  routes_[slot] = walker.route;
  progress_[slot] = walker.progress;
}

// All ranks decide alike which bodies stand aside: each gets those that matter from the others.
size_t WalkMode::gather_aside() {
  const std::span<Body> bodies = engine_.bodies();
  std::vector<uint32_t> ended;
  for (const StandsAside& one : yielding_.all) {
    if (one.has_ended != 0) ended.push_back(one.name);
  }
  for (const uint32_t name : shared_.share->gather(std::span<const uint32_t>(ended))) {
    StandsAside* const one = yielding_.find(name);
    if (one != nullptr) one->has_ended = 1;
  }
  const size_t own = bodies.size();
  if (!shared_.share->any(!yielding_.blocked.empty()) && yielding_.all.empty()) return own;
  std::vector<uint32_t> needed;  // names
  for (const StandsAside& one : yielding_.all)
    needed.insert(needed.end(), {one.name, one.for_name});
  std::sort(needed.begin(), needed.end());
  std::vector<MovedWalker> mine;
  for (size_t n = 0; n < own; ++n) {
    const bool is_blocked = std::binary_search(yielding_.blocked.begin(), yielding_.blocked.end(),
                                               static_cast<uint32_t>(n));
    if (is_blocked || is_slow(bodies[n]) ||
        std::binary_search(needed.begin(), needed.end(), shared_.name_of(bodies[n]))) {
      mine.push_back(moved(n));
    }
  }
  for (const MovedWalker& walker : shared_.share->gather(std::span<const MovedWalker>(mine))) {
    if (shared_.share->is_own(walker.ghost.body)) continue;
    take_over(walker, shared_.names.take_passing_slot(walker.ghost.body.slot));
  }
  return own;
}

void WalkMode::drop_gathered(size_t own) {
  for (const Body& body : engine_.bodies().subspan(own)) shared_.names.give_slot_back(body.slot);
  engine_.shrink(own);
}

}  // namespace throng::crowd
