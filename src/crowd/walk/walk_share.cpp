// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "crowd/walk/walk_share.h"

#include <algorithm>
#include <cstdlib>

#include "core/arrays/release.h"
#include "crowd/mode/saved_rows.h"
#include "crowd/walk/walk_mode.h"

// What ranks that share a crowd say to each other of avatars on foot. Linear in the bodies, and in
// those near the borders between ranks.
namespace throng::crowd {
namespace {

// All ranks run the same program, so a message is always read as it was written.
void require(bool is_read) {
  if (!is_read) std::abort();
}

}  // namespace

// Where columns have other owners, both sides forget what they have shown.
void RankExchange::begin() {
  const ColumnOwners& owners = shared_.share->owners();
  if (version_ == owners.version()) return;
  version_ = owners.version();
  neighbours_.clear();
  neighbours_.resize(owners.neighbours().size());
  outgoing_.resize(neighbours_.size());
}

void RankExchange::end() {
  for (const uint32_t slot : slots_) shared_.names.give_slot_back(slot);
  slots_.clear();
}

std::span<const RankGroup::Bytes> RankExchange::send() {
  return shared_.share->exchange_bytes(outgoing_);
}

std::span<const Ghost> RankExchange::exchange_bodies(CrowdEngine& engine) {
  for (Neighbour& neighbour : neighbours_) neighbour.shown.clear();
  for (size_t n = 0; n < engine.bodies().size(); ++n) {
    const Body& body = engine.bodies()[n];
    shared_.share->owners().find_near(body.x, body.z, near_);
    if (near_.empty()) continue;
    Ghost ghost = engine.ghost_of(n, shared_.sub_step - 1);
    ghost.body.slot = engine.name_of(body);
    if (CrowdEngine::finds_preferred(body)) ghost.body.preferred = {};
    engine.show_to_others(n);
    for (const uint32_t neighbour : near_) neighbours_[neighbour].shown.push_back(ghost);
  }
  for (size_t n = 0; n < neighbours_.size(); ++n) {
    std::vector<Ghost>& shown = neighbours_[n].shown;
    std::sort(shown.begin(), shown.end(),
              [](const Ghost& a, const Ghost& b) { return a.body.slot < b.body.slot; });
    outgoing_[n].clear();
    neighbours_[n].of_shown.encode(shown, engine.units(), outgoing_[n]);
  }
  const auto came = send();
  ghosts_.clear();
  for (size_t n = 0; n < neighbours_.size(); ++n) {
    std::vector<Ghost>& seen = neighbours_[n].seen;
    seen.clear();
    size_t at = 0;
    require(neighbours_[n].of_seen.decode(came[n], at, engine.units(), seen));
    ghosts_.insert(ghosts_.end(), seen.begin(), seen.end());
  }
  for (Ghost& ghost : ghosts_) {
    ghost.body.slot = shared_.names.take_passing_slot(ghost.body.slot);
    slots_.push_back(ghost.body.slot);
  }
  engine.fit_rows(shared_.names.slots());
  return ghosts_;
}

std::span<const GhostMove> RankExchange::exchange_moves(std::span<const GhostMove> shown) {
  for (size_t n = 0; n < neighbours_.size(); ++n) {
    outgoing_[n].clear();
    encode_moves(shown, neighbours_[n].shown, outgoing_[n]);
  }
  const auto came = send();
  moves_.clear();
  for (size_t n = 0; n < neighbours_.size(); ++n) {
    require(decode_moves(came[n], neighbours_[n].seen, moves_));
  }
  return moves_;
}

std::span<const uint32_t> RankExchange::exchange_accepted(std::span<const uint32_t> shown) {
  for (size_t n = 0; n < neighbours_.size(); ++n) {
    outgoing_[n].clear();
    encode_names(shown, neighbours_[n].shown, outgoing_[n]);
  }
  const auto came = send();
  names_.clear();
  for (size_t n = 0; n < neighbours_.size(); ++n) {
    require(decode_names(came[n], names_));
  }
  return names_;
}

void SavedWalkers::add(const MovedWalker& walker) {
  const uint32_t name = walker.ghost.body.slot;
  routes_[name] = walker.route;
  progress_[name] = walker.progress;
  level_speeds_[name] = walker.ghost.level_speed;
  queue_[name] = walker.ghost.progress;
  choices_[name] = walker.choice;
  requests_[name] = walker.ghost.request;
}

void SavedWalkers::save(bool queues, std::vector<uint8_t>& out) const {
  put_rows(out, routes_.data(), routes_.size());
  put_rows(out, progress_.data(), progress_.size());
  put_rows(out, level_speeds_.data(), level_speeds_.size());
  put_rows(out, queue_.data(), queue_.size());
  put_rows(out, choices_.data(), choices_.size());
  if (queues) put_rows(out, requests_.data(), requests_.size());
}

void WalkMode::share() {
  engine_.shrink(0);
  engine_.forget_rows();
  release(engine_.level_speeds());
  release(routes_);
  release(progress_);
  exchange_ = std::make_unique<RankExchange>(shared_);
  engine_.set_names(shared_.names);
  engine_.reserve(1);
}

MovedWalker WalkMode::moved(size_t n, uint64_t next) const {
  const Body& body = engine_.bodies()[n];
  MovedWalker walker{.ghost = engine_.ghost_of(n, next),
                     .choice = engine_.choice(body.slot),
                     .route = routes_[body.slot],
                     .progress = progress_[body.slot]};
  walker.ghost.body.slot = shared_.name_of(body);
  return walker;
}

// At the end of the bodies.
void WalkMode::take_over(const MovedWalker& walker, uint32_t slot, uint64_t next) {
  fit_rows();
  Ghost ghost = walker.ghost;
  ghost.body.slot = slot;
  engine_.take_over(ghost, walker.choice, next);
  routes_[slot] = walker.route;
  progress_[slot] = walker.progress;
}

// A rank alone knows that one of its bodies has lost its path.
std::vector<StandsAside> WalkMode::standing_aside_everywhere() const {
  std::vector<StandsAside> all = yielding_.all;
  std::vector<uint8_t> ended;
  for (const StandsAside& one : all) ended.push_back(one.has_ended);
  const std::vector<uint8_t> of_ranks = shared_.share->gather(std::span<const uint8_t>(ended));
  for (size_t n = 0; n < of_ranks.size(); ++n) all[n % all.size()].has_ended |= of_ranks[n];
  return all;
}

// All ranks decide alike which bodies stand aside: each gets those that matter from the others.
size_t WalkMode::gather_aside() {
  const std::span<Body> bodies = engine_.bodies();
  yielding_.all = standing_aside_everywhere();
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
      mine.push_back(moved(n, this_step()));
    }
  }
  for (const MovedWalker& walker : shared_.share->gather(std::span<const MovedWalker>(mine))) {
    if (shared_.share->is_own(walker.ghost.body)) continue;
    take_over(walker, shared_.names.take_passing_slot(walker.ghost.body.slot), this_step());
  }
  return own;
}

void WalkMode::drop_gathered(size_t own) {
  for (const Body& body : engine_.bodies().subspan(own)) shared_.names.give_slot_back(body.slot);
  engine_.shrink(own);
}

}  // namespace throng::crowd
