// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <limits>
#include <mutex>
#include <optional>
#include <string>

#include "core/access.h"
#include "core/parallel.h"
#include "crowd/crowd_state.h"
#include "throng/crowd.h"

// Targets: regions that many avatars head to. WalkMode has the flow fields that lead there.
namespace throng {
namespace {

constexpr size_t kMaxTargets = UINT16_MAX;
constexpr size_t kTargetGrain = 4096;  // bodies

}  // namespace

Result<TargetId> Crowd::add_target(std::span<const Prism> areas, Context& context) {
  State& s = *state_;
  if (s.shared.config.routing != Routing::kPaths) {
    return Error{Errc::kBadConfig, "crowd: Routing::kStraight supports no targets; give goals"};
  }
  auto made = crowd::Target::create(*data_of(s.shared.world), areas);
  if (!made) return made.error();
  if (s.shared.targets.size() >= kMaxTargets) {
    return Error{Errc::kLimit, "crowd: it has 65535 targets; use those that it has again"};
  }
  s.shared.targets.push_back(std::move(*made));
  for (size_t c = 0; c < s.shared.classes.size(); ++c) {
    if (!s.shared.classes[c]) continue;
    auto ok = s.walk.find_flows(c, context);
    if (ok) continue;
    s.shared.targets.pop_back();
    s.walk.drop_flows();
    return ok.error();
  }
  return static_cast<TargetId>(s.shared.targets.size());
}

double Crowd::distance(AvatarId id, TargetId target) const {
  State& s = *state_;
  if (!s.has_target(target)) return std::numeric_limits<double>::infinity();
  s.renew_flows();
  const crowd::Body* body = s.body(id);
  std::optional<double> found;
  if (body != nullptr && !body->has(crowd::Body::kMovedElsewhere)) {
    found = s.walk.distance(*body, target);
  }
  if (s.shared.share) found = s.shared.share->find_on_any(found);
  return found.value_or(std::numeric_limits<double>::infinity());
}

Result<std::vector<Place>> Crowd::places(TargetId target, int32_t avatar_class, size_t max_count,
                                         Context& context) {
  State& s = *state_;
  if (!s.has_target(target)) {
    return Error{Errc::kNotFound, "crowd: it has no target " + std::to_string(target) +
                                      "; add_target makes them, from 1 on"};
  }
  if (auto ok = s.open_class(avatar_class, context); !ok) return ok.error();
  return crowd::places_inside(
      *data_of(s.shared.world), s.shared.classes[static_cast<size_t>(avatar_class)]->ground,
      s.shared.targets[target - 1u].regions, std::max<size_t>(1, max_count));
}

// The paths to targets have changed: all that head there search again.
void Crowd::State::renew_flows() {
  if (!walk.renew_flows()) return;
  for (crowd::Body& body : walk.bodies()) {
    if (body.target != 0 && body.has(crowd::Body::kHasGoal) && !body.leaves) {
      body.flags |= crowd::Body::kNeedsPath;
    }
  }
}

void Crowd::State::arrive_in_targets() {
  const std::vector<crowd::Target>& targets = shared.targets;
  if (targets.empty()) return;
  const std::span<crowd::Body> all = walk.bodies();
  parallel_ranges(all.size(), kTargetGrain, shared.config.workers, [&](size_t begin, size_t end) {
    for (crowd::Body& body : all.subspan(begin, end - begin)) {
      if (body.target == 0 || !body.has(crowd::Body::kHasGoal) || body.has(crowd::Body::kArrived) ||
          !targets[body.target - 1u].contains(at_feet(body))) {
        continue;
      }
      body.flags |= crowd::Body::kArrived;
      const std::lock_guard lock(shared.goal_mutex);
      shared.arrived.push_back(shared.id_of(body.slot));
    }
  });
}

}  // namespace throng
