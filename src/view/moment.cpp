// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "view/moment.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/random.h"

namespace throng {
namespace {

constexpr double kStands = 0.12;     // [m/s] Slower is standing.
constexpr double kTurnSpeed = 0.9;   // [turns/s]
constexpr double kPaceMemory = 0.4;  // [s]

// Between two angles the short way, in turns.
double turn_between(double from, double to) { return std::remainder(to - from, 1.0); }

float in_turn(double turns) { return static_cast<float>(turns - std::floor(turns)); }

uint16_t steps_of(double turns) {
  return static_cast<uint16_t>(static_cast<int64_t>(std::floor(turns * 65536)) & 0xffff);
}

// Who moves, walks; who stands, stands in the first clip of his atlas that stands.
size_t clip_for(const Atlas& atlas, bool moves) {
  for (size_t i = 0; i < atlas.clips.size(); ++i) {
    if ((atlas.clips[i].stride != 0) == moves) return i;
  }
  return 0;
}

// Calls each(i, j) for all i of `b`; j is the index of the same one in `a`, or a.size().
template <class Each>
void for_each_pair(const Moment& a, const Moment& b, Each each) {
  const auto life = [](const Moment& m, size_t k) { return m.lives.empty() ? 0 : m.lives[k]; };
  size_t j = 0;
  for (size_t i = 0; i < b.size(); ++i) {
    while (j < a.size() && a.ids[j] < b.ids[i]) ++j;
    const bool same = j < a.size() && a.ids[j] == b.ids[i] && life(a, j) == life(b, i);
    each(i, same ? j : a.size());
  }
}

}  // namespace

void Moment::resize(size_t avatars) {
  ids.resize(avatars);
  classes.resize(avatars);
  for (auto* array : {&x, &y, &z, &heading, &walked, &pace}) array->resize(avatars);
}

size_t Moment::find(uint64_t id) const {
  const auto at = std::lower_bound(ids.begin(), ids.end(), id);
  return at != ids.end() && *at == id ? static_cast<size_t>(at - ids.begin()) : ids.size();
}

void put_states(const std::vector<AvatarState>& states, Vec3d origin, Moment& moment) {
  moment.resize(states.size());
  for (size_t i = 0; i < states.size(); ++i) {
    const AvatarState& s = states[i];
    const Vec3d p = s.position - origin;
    moment.ids[i] = s.id;
    moment.classes[i] = static_cast<uint8_t>(s.avatar_class);
    moment.x[i] = static_cast<float>(p.x);
    moment.y[i] = static_cast<float>(p.y);
    moment.z[i] = static_cast<float>(p.z);
    const double turns = std::atan2(s.heading_x, s.heading_z) / (2 * std::numbers::pi);
    moment.heading[i] = in_turn(turns);
  }
}

void follow(const Moment& before, Moment& now) {
  const double seconds = now.time - before.time, apart = std::max(1e-6, std::abs(seconds));
  for_each_pair(before, now, [&](size_t i, size_t j) {
    if (j == before.size()) {
      now.walked[i] = static_cast<float>(2 * random_unit(3, 0, now.ids[i]));
      now.pace[i] = 0;
      if (now.heading[i] == 0) now.heading[i] = in_turn(random_unit(3, 1, now.ids[i]));
      return;
    }
    const double gone = std::hypot(now.x[i] - before.x[j], now.z[i] - before.z[j]);
    now.walked[i] = static_cast<float>(before.walked[j] + (seconds < 0 ? -gone : gone));
    const double keep = std::exp(-apart / kPaceMemory);
    now.pace[i] = static_cast<float>(before.pace[j] * keep + gone / apart * (1 - keep));
    // Who stands has no heading of his own: sources give straight along +Z then.
    const bool stands = gone < 1e-3 * apart && now.heading[i] == 0;
    const double turn = stands ? 0 : turn_between(before.heading[j], now.heading[i]);
    const double most = kTurnSpeed * apart;
    now.heading[i] = in_turn(before.heading[j] + std::clamp(turn, -most, most));
  });
}

void BlendedCrowd::blend(const Moment& a, const Moment& b, double share, const Figures& figures,
                         double cut) {
  for (auto& [key, group] : groups_) {
    for (auto* array : {&group.x, &group.y, &group.z}) array->clear();
    for (auto* array : {&group.heading, &group.phase, &group.look}) array->clear();
  }
  now_.resize(b.size());
  now_.time = a.time + (b.time - a.time) * share;
  now_.report = b.report;
  now_.flow = b.flow;
  const auto s = static_cast<float>(share);
  for_each_pair(a, b, [&](size_t i, size_t j) {
    now_.ids[i] = b.ids[i];
    now_.classes[i] = b.classes[i];
    now_.pace[i] = b.pace[i];
    const bool both = j < a.size();
    const auto between = [&](const std::vector<float>& p, const std::vector<float>& q) {
      return both ? p[j] + (q[i] - p[j]) * s : q[i];
    };
    now_.x[i] = between(a.x, b.x);
    now_.y[i] = between(a.y, b.y);
    now_.z[i] = between(a.z, b.z);
    now_.walked[i] = between(a.walked, b.walked);
    const double turn = both ? turn_between(a.heading[j], b.heading[i]) : 0;
    now_.heading[i] = both ? in_turn(a.heading[j] + turn * share) : b.heading[i];
    if (now_.y[i] > cut || static_cast<int64_t>(now_.ids[i]) == hidden_) return;
    if (!figures.of_class.empty()) put(i, figures);
  });
  crowds_.clear();
  for (const auto& [key, g] : groups_) {
    if (g.x.empty()) continue;
    crowds_.push_back({.atlas = key.first,
                       .clip = key.second,
                       .avatars = {g.x, g.y, g.z, g.heading, g.phase, g.look}});
  }
}

void BlendedCrowd::put(size_t i, const Figures& figures) {
  const uint64_t id = now_.ids[i];
  const size_t row = std::min<size_t>(now_.classes[i], figures.of_class.size() - 1);
  const std::vector<size_t>& choice = figures.of_class[row];
  const auto pick = static_cast<size_t>(random_unit(5, 0, id) * static_cast<double>(choice.size()));
  const size_t atlas = choice[std::min(pick, choice.size() - 1)];
  const size_t clip = clip_for(figures.shapes[atlas], now_.pace[i] > kStands);
  Group& group = groups_[{atlas, clip}];
  group.x.push_back(now_.x[i]);
  group.y.push_back(now_.y[i]);
  group.z.push_back(now_.z[i]);
  group.heading.push_back(steps_of(now_.heading[i]));
  const double start = random_unit(5, 1, id);
  group.phase.push_back(
      steps_of(walk_phase(figures.shapes[atlas].clips[clip], now_.walked[i], start)));
  group.look.push_back(static_cast<uint16_t>(random_unit(5, 2, id) * 2048));
}

}  // namespace throng
