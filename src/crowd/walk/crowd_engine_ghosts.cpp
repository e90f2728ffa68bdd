// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>

#include "crowd/walk/crowd_engine.h"

// Bodies that others move. They are among the bodies for a step, are sensed as all are, and propose
// what their own engine says that they propose; nothing here decides for them. Linear in the bodies
// (they are sorted out again) and in those that are shared.
namespace throng::crowd {

Ghost CrowdEngine::ghost_of(size_t n, uint64_t step) const {
  const Body& body = bodies_[n];
  Ghost ghost{.body = body,
              .progress = progress_[body.slot],
              .request = {},
              .level_speed = level_speed(body)};
  if (config_.queues && body.asks) ghost.request = requests_[(step + 1) % 2][body.slot];
  return ghost;
}

void CrowdEngine::add_with_rows(const Body& body, const Ghost& ghost, uint64_t step) {
  add(body);
  progress_[body.slot] = ghost.progress;
  if (config_.queues && body.asks) requests_[(step + 1) % 2][body.slot] = ghost.request;
  if (!body.slowed) return;
  if (level_speeds_.size() <= body.slot) level_speeds_.resize(body.slot + size_t{1});
  level_speeds_[body.slot] = ghost.level_speed;
}

void CrowdEngine::take_over(const Ghost& ghost, steer::Plane choice, uint64_t step) {
  add_with_rows(ghost.body, ghost, step);
  choices_[ghost.body.slot] = choice;
}

void CrowdEngine::add_ghosts(std::span<const Ghost> ghosts) {
  for (const Ghost& ghost : ghosts) {
    Body body = ghost.body;
    body.is_ghost = true;
    body.is_shown = false;
    add_with_rows(body, ghost, step_);
    if (finds_preferred(body))
      bodies_[size_ - 1].preferred = preferred_of(body, turned_aside(body));
  }
}

void CrowdEngine::list_shared() {
  ghosts_.clear();
  shown_.clear();
  for (uint32_t i = 0; i < size_; ++i) {
    const Body& body = bodies_[i];
    if (body.is_ghost) ghosts_.push_back({name_of(body), i});
    if (body.is_shown) shown_.push_back({name_of(body), i});
  }
  for (auto* list : {&ghosts_, &shown_}) {
    std::sort(list->begin(), list->end(),
              [](const Shared& a, const Shared& b) { return a.name < b.name; });
  }
}

const CrowdEngine::Shared* CrowdEngine::find_ghost(uint32_t name) const {
  const auto found = std::lower_bound(ghosts_.begin(), ghosts_.end(), name,
                                      [](const Shared& a, uint32_t of) { return a.name < of; });
  return found != ghosts_.end() && found->name == name ? &*found : nullptr;
}

void CrowdEngine::exchange_moves(uint8_t round) {
  moves_.clear();
  for (const auto& [name, i] : shown_) {
    if (bodies_[i].state != Body::kUndecided) continue;
    const Proposal& proposal = proposals()[i];
    if (round > 1 && proposal.round != round) continue;  // They know it from an earlier round.
    moves_.push_back({.name = name, .round = proposal.round, .place = proposal.place});
  }
  for (const GhostMove& move : exchange_->exchange_moves(moves_)) {
    const Shared* const ghost = find_ghost(move.name);
    if (ghost == nullptr) continue;  // Only others see it.
    bodies_[ghost->body].state = Body::kUndecided;
    Proposal& proposal = proposals()[ghost->body];
    proposal.place = move.place;
    proposal.round = static_cast<uint8_t>(move.round);
  }
}

void CrowdEngine::exchange_accepted(uint8_t round) {
  accepted_.clear();
  for (const auto& [name, i] : shown_) {
    if (bodies_[i].state == Body::kDecided && proposals()[i].round == round) {
      accepted_.push_back(name);
    }
  }
  for (const uint32_t name : exchange_->exchange_accepted(accepted_)) {
    const Shared* const ghost = find_ghost(name);
    if (ghost != nullptr) bodies_[ghost->body].state = Body::kDecided;
  }
}

void CrowdEngine::drop_ghosts() {
  size_t kept = 0;
  for (size_t i = 0; i < size_; ++i) {
    if (bodies_[i].is_ghost) continue;
    if (kept != i) bodies_[kept] = bodies_[i];
    bodies_[kept++].is_shown = false;
  }
  size_ = kept;
}

}  // namespace throng::crowd
