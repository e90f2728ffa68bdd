// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "view/timeline_frame.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/random.h"
#include "throng/avatar.h"

// Frames are matched by id and generation, as sorted lists; positions and headings are interpolated
// linearly, headings of climbers after parallel transport between their axes. Time: linear.
namespace throng::view {
namespace {

// Between these speeds a figure goes on with what it does: else it changes with each small move.
constexpr float kStands = 0.08f, kWalks = 0.2f;  // [m/s]
// How far a figure may rise or sink, so that it does not hop from tread to tread.
constexpr double kRise = 0.9;         // per metre walked: no slope that is walked is steeper
constexpr double kRiseSpeed = 0.4;    // [m/s], in addition
constexpr double kMaxOff = 0.4;       // [m] from the floor
constexpr double kTurnSpeed = 0.9;    // [turns/s]
constexpr double kSpeedMemory = 0.4;  // [s]

// The smaller of the two rotations between two angles, in turns.
double turn_between(double from, double to) { return std::remainder(to - from, 1.0); }

float in_turn(double turns) { return static_cast<float>(turns - std::floor(turns)); }

constexpr Vec3d kUpright{0, 1, 0};

// Parallel transport: the heading after the smallest rotation from one axis to another. In turns.
float transported(float heading, Vec3d from, Vec3d to) {
  if (from == to) return heading;
  const double angle = 2 * std::numbers::pi * heading;
  const Vec3d ahead = leaned({std::sin(angle), 0, std::cos(angle)}, from);
  // The rotation as two reflections: at the plane normal to `from`, then normal to from + to.
  const Vec3d half = from + to;
  const double size = dot(half, half);
  if (!(size > 1e-9)) return heading;
  const Vec3d across = ahead - from * (2 * dot(ahead, from));
  const Vec3d own = unleaned(across - half * (2 * dot(across, half) / size), to);
  return in_turn(std::atan2(own.x, own.z) / (2 * std::numbers::pi));
}

uint16_t steps_of(double turns) {
  return static_cast<uint16_t>(static_cast<int64_t>(std::floor(turns * 65536)) & 0xffff);
}

// The first clip that walks, for an avatar that moves; else the first that stands.
size_t clip_for(const Atlas& atlas, bool moves) {
  for (size_t i = 0; i < atlas.clips.size(); ++i) {
    if ((atlas.clips[i].stride != 0) == moves) return i;
  }
  return 0;
}

// Calls each(i, j) for all i of `b`; j is the index of the same avatar in `a`, or a.size().
template <class Each>
void for_each_pair(const TimelineFrame& a, const TimelineFrame& b, Each each) {
  const auto generation = [](const TimelineFrame& m, size_t k) {
    return m.generations.empty() ? 0 : m.generations[k];
  };
  size_t j = 0;
  for (size_t i = 0; i < b.size(); ++i) {
    while (j < a.size() && a.ids[j] < b.ids[i]) ++j;
    const bool same = j < a.size() && a.ids[j] == b.ids[i] && generation(a, j) == generation(b, i);
    each(i, same ? j : a.size());
  }
}

}  // namespace

void TimelineFrame::resize(size_t avatars) {
  ids.resize(avatars);
  classes.resize(avatars);
  moves.resize(avatars);
  for (auto* array : {&x, &y, &z, &heading, &walked, &speed}) array->resize(avatars);
}

size_t TimelineFrame::find(uint64_t id) const {
  const auto at = std::lower_bound(ids.begin(), ids.end(), id);
  return at != ids.end() && *at == id ? static_cast<size_t>(at - ids.begin()) : ids.size();
}

void put_states(const std::vector<AvatarState>& states, Vec3d origin, TimelineFrame& frame) {
  frame.resize(states.size());
  const bool lean = std::any_of(states.begin(), states.end(),
                                [](const AvatarState& s) { return !(s.up == kUpright); });
  frame.ups.resize(lean ? states.size() : 0);
  for (size_t i = 0; i < states.size(); ++i) {
    const AvatarState& s = states[i];
    const Vec3d p = s.position - origin;
    frame.ids[i] = s.id;
    frame.classes[i] = static_cast<uint8_t>(s.avatar_class);
    frame.x[i] = static_cast<float>(p.x);
    frame.y[i] = static_cast<float>(p.y);
    frame.z[i] = static_cast<float>(p.z);
    const double turns = std::atan2(s.heading_x, s.heading_z) / (2 * std::numbers::pi);
    frame.heading[i] = in_turn(turns);
    if (lean) frame.ups[i] = s.up;
  }
}

void follow(const TimelineFrame& before, TimelineFrame& now) {
  const double seconds = now.time - before.time, apart = std::max(1e-6, std::abs(seconds));
  for_each_pair(before, now, [&](size_t i, size_t j) {
    if (j == before.size()) {
      now.walked[i] = static_cast<float>(2 * random_unit(3, 0, now.ids[i]));
      now.speed[i] = 0;
      now.moves[i] = 0;
      if (now.heading[i] == 0) now.heading[i] = in_turn(random_unit(3, 1, now.ids[i]));
      return;
    }
    const bool leans = !(now.up(i) == kUpright) || !(before.up(j) == kUpright);
    const double flat = std::hypot(now.x[i] - before.x[j], now.z[i] - before.z[j]);
    const double moved = leans ? std::hypot(flat, now.y[i] - before.y[j]) : flat;
    const float was = transported(before.heading[j], before.up(j), now.up(i));
    now.walked[i] = static_cast<float>(before.walked[j] + (seconds < 0 ? -moved : moved));
    if (!leans) {
      const double rise = kRise * flat + kRiseSpeed * apart, floor = now.y[i], was_at = before.y[j];
      const double next = was_at + std::clamp(floor - was_at, -rise, rise);
      now.y[i] = static_cast<float>(std::clamp(next, floor - kMaxOff, floor + kMaxOff));
    }
    const double keep = std::exp(-apart / kSpeedMemory);
    now.speed[i] = static_cast<float>(before.speed[j] * keep + moved / apart * (1 - keep));
    now.moves[i] = now.speed[i] > (before.moves[j] != 0 ? kStands : kWalks) ? 1 : 0;
    // An avatar that has not moved yet has no heading, and one that stands none in recordings of
    // wanderers: players give that along +Z then.
    const bool stands = moved < 1e-3 * apart && now.heading[i] == 0;
    const double turn = stands ? 0 : turn_between(was, now.heading[i]);
    const double max_turn = kTurnSpeed * apart;
    now.heading[i] = in_turn(was + std::clamp(turn, -max_turn, max_turn));
  });
}

void BlendedCrowd::blend(const TimelineFrame& a, const TimelineFrame& b, double share,
                         const Figures& figures, double cut) {
  for (auto& [key, group] : groups_) {
    for (auto* array : {&group.x, &group.y, &group.z}) array->clear();
    for (auto* array : {&group.heading, &group.phase, &group.look}) array->clear();
    group.ups.clear();
  }
  now_.resize(b.size());
  now_.ups.assign(a.ups.empty() && b.ups.empty() ? 0 : b.size(), kUpright);
  now_.time = a.time + (b.time - a.time) * share;
  now_.report = b.report;
  now_.flow = b.flow;
  now_.curved = b.curved;
  const auto s = static_cast<float>(share);
  for_each_pair(a, b, [&](size_t i, size_t j) {
    now_.ids[i] = b.ids[i];
    now_.classes[i] = b.classes[i];
    now_.speed[i] = b.speed[i];
    now_.moves[i] = b.moves[i];
    const bool both = j < a.size();
    const auto between = [&](const std::vector<float>& p, const std::vector<float>& q) {
      return both ? p[j] + (q[i] - p[j]) * s : q[i];
    };
    now_.x[i] = between(a.x, b.x);
    now_.y[i] = between(a.y, b.y);
    now_.z[i] = between(a.z, b.z);
    now_.walked[i] = between(a.walked, b.walked);
    if (!now_.ups.empty()) {
      const Vec3d up = both ? a.up(j) * (1 - share) + b.up(i) * share : b.up(i);
      const double size = length(up);
      now_.ups[i] = size > 1e-3 ? up * (1 / size) : b.up(i);
    }
    const float from = both ? transported(a.heading[j], a.up(j), now_.up(i)) : 0;
    const float to = transported(b.heading[i], b.up(i), now_.up(i));
    now_.heading[i] = both ? in_turn(from + turn_between(from, to) * share) : to;
    if (now_.y[i] > cut || static_cast<int64_t>(now_.ids[i]) == hidden_) return;
    if (!figures.of_class.empty()) put(i, figures);
  });
  crowds_.clear();
  for (const auto& [key, g] : groups_) {
    if (g.x.empty()) continue;
    crowds_.push_back({.atlas = std::get<0>(key),
                       .clip = std::get<1>(key),
                       .avatars = {g.x, g.y, g.z, g.heading, g.phase, g.look},
                       .up_vectors = g.ups});
  }
}

void BlendedCrowd::put(size_t i, const Figures& figures) {
  const uint64_t id = now_.ids[i];
  const size_t row = std::min<size_t>(now_.classes[i], figures.of_class.size() - 1);
  const std::vector<size_t>& choice = figures.of_class[row];
  const auto pick = static_cast<size_t>(random_unit(5, 0, id) * static_cast<double>(choice.size()));
  const size_t atlas = choice[std::min(pick, choice.size() - 1)];
  const size_t clip = clip_for(figures.shapes[atlas], now_.moves[i] != 0);
  const Vec3d up = now_.up(i);
  const bool leans = !(up == kUpright);
  Group& group = groups_[{atlas, clip, leans}];
  if (leans) group.ups.push_back(up);
  group.x.push_back(now_.x[i]);
  group.y.push_back(now_.y[i]);
  group.z.push_back(now_.z[i]);
  group.heading.push_back(steps_of(now_.heading[i]));
  const double start = random_unit(5, 1, id);
  group.phase.push_back(
      steps_of(walk_phase(figures.shapes[atlas].clips[clip], now_.walked[i], start, now_.time)));
  group.look.push_back(static_cast<uint16_t>(random_unit(5, 2, id) * 2048));
}

}  // namespace throng::view
