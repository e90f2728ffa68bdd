// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>

#include "crowd/walk/crowd_engine.h"

// Rest at the end of a path: docs/design/008-engine.md, "Rest". A body that has come to its goal,
// or as near as others that rest there permit, stands; it makes room if it is asked to, and returns
// once. Constant time for each body and its neighbours.
namespace throng::crowd {
namespace {

using steer::Plane;

constexpr float kAtGoal = 0.005f;      // [m] as near to its goal a body rests at once
constexpr float kNearGoal = 0.3f;      // [m] as near it rests if it stands
constexpr float kStandsBefore = 0.5f;  // [s] until it rests
constexpr float kReturnsAfter = 1;     // [s] after it made room
constexpr float kNearGoals = 1;        // [m] between goals that bodies share
constexpr float kTries = 1;            // [s] to get past others that rest
constexpr float kBlockedGap = 0.1f;    // [m] to one that rests before it

// On the last segment of its path to a goal of its own?
bool nears_goal(const Body& body) {
  constexpr uint8_t kAll = Body::kHasGoal | Body::kLast | Body::kExternal | Body::kMovedElsewhere;
  return (body.flags & kAll) == (Body::kHasGoal | Body::kLast) && !body.leaves;
}

}  // namespace

// Only near their goals are rows read.
bool CrowdEngine::may_rest(const Body& body) const {
  return config_.queues && nears_goal(body) &&
         nearer_than(body.local_target_x - body.x, body.local_target_z - body.z, sight_);
}

// Does it stand until something changes, instead of heading to its goal?
bool CrowdEngine::rests(const Body& body) const { return body.at_rest && may_rest(body); }

// Is it so of any other body that rests in sight, on its level?
template <typename Is>
bool CrowdEngine::any_at_rest(uint32_t i, const NeighbourGrid::Around& around, Is is) const {
  const Body& body = bodies_[i];
  for (const Entries& piece : around.pieces()) {
    for (uint32_t j = piece.first; j < piece.last; ++j) {
      const Body& other = bodies_[j];
      if (j != i && std::abs(other.y - body.y) <= body.height &&
          nearer_than(other.x - body.x, other.z - body.z, sight_) && rests(other) && is(other)) {
        return true;
      }
    }
  }
  return false;
}

// Does another body that rests stand where it would stand at its goal? Or does one before it rest
// that has the same goal and does not reach it either?
bool CrowdEngine::is_goal_taken(uint32_t i, const NeighbourGrid::Around& around) const {
  const Body& body = bodies_[i];
  const Plane ahead = path_ahead(body);
  const auto gap = static_cast<int64_t>(kBlockedGap / config_.units.unit);
  return any_at_rest(i, around, [&](const Body& other) {
    const int64_t room = int64_t{other.radius} + body.radius;
    if (nearer_than(other.x - body.local_target_x, other.z - body.local_target_z, room)) {
      return true;
    }
    const Plane apart = config_.units.metres(other.x - body.x, other.z - body.z);
    return apart.x * ahead.x + apart.z * ahead.z > 0 &&
           nearer_than(other.x - body.x, other.z - body.z, room + gap) &&
           nearer_than(other.local_target_x - body.local_target_x,
                       other.local_target_z - body.local_target_z, room);
  });
}

// Does it touch one, about, that rests and has a goal near its own?
bool CrowdEngine::touches_resting(uint32_t i, const NeighbourGrid::Around& around) const {
  const Body& body = bodies_[i];
  const auto gap = static_cast<int64_t>(kBlockedGap / config_.units.unit);
  const auto near_goals = static_cast<int64_t>(kNearGoals / config_.units.unit);
  return any_at_rest(i, around, [&](const Body& other) {
    return nearer_than(other.x - body.x, other.z - body.z,
                       int64_t{other.radius} + body.radius + gap) &&
           nearer_than(other.local_target_x - body.local_target_x,
                       other.local_target_z - body.local_target_z, near_goals);
  });
}

// Does it rest from the next step on?
Rest CrowdEngine::next_rest(uint32_t i, const NeighbourGrid::Around& around) const {
  const Body& body = bodies_[i];
  if (!may_rest(body)) return Rest::kNo;
  const QueueProgress& progress = progress_[body.slot];
  const float left =
      size_of(config_.units.metres(body.local_target_x - body.x, body.local_target_z - body.z));
  switch (progress.rest) {
    case Rest::kNo:
      if (left < kAtGoal || (left < kNearGoal && is_goal_taken(i, around))) return Rest::kRests;
      if (progress.vain >= kTries && touches_resting(i, around)) return Rest::kRests;
      if (!stands(body) || progress.stood < kStandsBefore) return Rest::kNo;
      return left < kNearGoal || is_goal_taken(i, around) ? Rest::kRests : Rest::kNo;
    case Rest::kRests:
      if (!stands(body) && progress.stood == 0) return Rest::kMadeRoom;
      return left < kNearGoal || is_goal_taken(i, around) ? Rest::kRests : Rest::kNo;
    case Rest::kMadeRoom:
      if (!stands(body) || progress.stood < kReturnsAfter) return Rest::kMadeRoom;
      return is_goal_taken(i, around) ? Rest::kRests : Rest::kNo;
  }
  return Rest::kNo;
}

}  // namespace throng::crowd
