// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <mutex>

#include "core/access.h"
#include "core/parallel.h"
#include "crowd/crowd_state.h"
#include "throng/crowd.h"

// Events of a step beside arrivals: avatars that entered watched areas, avatars without progress.
// Linear in the avatars and areas.
namespace throng {
namespace {

constexpr size_t kMaxAreas = 64;      // bits
constexpr size_t kEventGrain = 4096;  // bodies
constexpr double kNoProgress = 0.3;   // [m]

}  // namespace

Result<WatchedArea> Crowd::watch_area(std::span<const Prism> prisms) {
  State& s = *state_;
  auto made = crowd::Target::create(*data_of(s.shared.world), prisms);
  if (!made) return made.error();
  if (s.watched.size() >= kMaxAreas) {
    return Error{Errc::kLimit, "crowd: it watches 64 areas; watch fewer"};
  }
  s.watched.push_back(std::move(*made));
  return static_cast<WatchedArea>(s.watched.size() - 1);
}

std::span<const AreaEntry> Crowd::entered() const { return state_->entered; }
std::span<const AvatarId> Crowd::no_progress() const { return state_->no_progress; }

void Crowd::State::find_events() {
  entered.clear();
  no_progress.clear();
  if (!watched.empty()) find_entries();
  const auto every = static_cast<uint64_t>(
      std::max(1.0, std::round(shared.config.tuning.no_progress_after / shared.config.dt)));
  if (shared.config.tuning.no_progress_after > 0 && shared.step % every == 0) find_no_progress();
}

void Crowd::State::find_entries() {
  inside.resize(shared.names.slots(), 0);
  std::mutex adding;
  parallel_ranges(
      walk.bodies().size(), kEventGrain, shared.config.workers, [&](size_t begin, size_t end) {
        for (const crowd::Body& body : walk.bodies().subspan(begin, end - begin)) {
          uint64_t now = 0;
          const crowd::Body there = at_feet(body);
          for (size_t area = 0; area < watched.size(); ++area) {
            if (watched[area].contains(there)) now |= uint64_t{1} << area;
          }
          const uint64_t came = now & ~inside[body.slot];
          inside[body.slot] = now;
          if (came == 0) continue;
          const std::lock_guard lock(adding);
          for (size_t area = 0; area < watched.size(); ++area) {
            if ((came >> area & 1) == 0) continue;
            entered.push_back({shared.id_of(body.slot), static_cast<WatchedArea>(area)});
          }
        }
      });
  std::sort(entered.begin(), entered.end(), [](const AreaEntry& a, const AreaEntry& b) {
    return a.id.slot1 != b.id.slot1 ? a.id.slot1 < b.id.slot1 : a.area < b.area;
  });
}

void Crowd::State::find_no_progress() {
  checked_at.resize(shared.names.slots(), kNeverChecked);
  const double min_progress = kNoProgress / shared.unit;
  for (const crowd::Body& body : walk.bodies()) {
    auto& [x, z, y] = checked_at[body.slot];
    const double dx = double{1} * body.x - x, dz = double{1} * body.z - z;
    const double dy = (double{1} * body.y - y) * 1e-3 / shared.unit;
    const bool rests = body.has(crowd::Body::kArrived) && !link.waits(body.slot);
    const bool walks = body.has(crowd::Body::kHasGoal) && !rests;
    if (walks && dx * dx + dy * dy + dz * dz < min_progress * min_progress)
      no_progress.push_back(shared.id_of(body.slot));
    x = body.x;
    z = body.z;
    y = body.y;
  }
  std::sort(no_progress.begin(), no_progress.end(),
            [](AvatarId a, AvatarId b) { return a.slot1 < b.slot1; });
}

}  // namespace throng
