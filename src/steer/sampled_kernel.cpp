// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "steer/sampled_kernel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "steer/fan.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "steer/sampled_kernel.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
#include <hwy/highway.h>

#include "core/arrays/compress-inl.h"

// Every operation is one of sampled.cpp, in its order, and none is fused: the bits are the same.
HWY_BEFORE_NAMESPACE();
namespace throng::steer {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
namespace simd = throng::HWY_NAMESPACE;

using D = hn::CappedTag<float, kMaxNear>;
using V = hn::Vec<D>;
static_assert(kTrials % kMaxNear == 0);

HWY_INLINE V times(V a, float b) { return hn::Mul(a, hn::Set(D(), b)); }

HWY_INLINE V size_of(V x, V z) { return hn::Sqrt(hn::Add(hn::Mul(x, x), hn::Mul(z, z))); }

// The touch of another whose offset is divided by `apart` already; `share` is 1 / apart.
struct Touch {
  V approach, inside;
  hn::Mask<D> happens;
};

HWY_INLINE Touch touch(V x, V z, V vx, V vz, V share) {
  const D d;
  const V zero = hn::Zero(d);
  Touch t;
  t.approach = hn::Neg(hn::Add(hn::Mul(x, vx), hn::Mul(z, vz)));
  const V speed = hn::Add(hn::Mul(vx, vx), hn::Mul(vz, vz));
  t.inside = hn::Sub(hn::Mul(t.approach, t.approach), hn::Mul(speed, share));
  t.happens = hn::And(hn::Gt(t.approach, zero), hn::Gt(t.inside, zero));
  return t;
}

HWY_INLINE V soonness(const Touch& t) {
  const V root = hn::Sqrt(hn::Max(t.inside, hn::Zero(D())));
  return hn::IfThenElseZero(t.happens, hn::Add(t.approach, root));
}

HWY_INLINE V share_of(V apart) {
  const D d;
  return hn::Div(hn::Set(d, 1), hn::Max(apart, hn::Set(d, kMinApart)));
}

// By vectors of neighbours: the minimum of their limits does not depend on the order.
Plane Following(const SampledSettings& settings, const Situation& s) {
  const D d;
  const float desired = std::sqrt(s.preferred.x * s.preferred.x + s.preferred.z * s.preferred.z);
  if (!(desired > 1e-6f)) return s.preferred;
  const Plane ahead{s.preferred.x / desired, s.preferred.z / desired};
  const V zero = hn::Zero(d), one = hn::Set(d, 1),
          fastest = hn::Set(d, settings.unbound * s.fastest);
  const V ahead_x = hn::Set(d, ahead.x), ahead_z = hn::Set(d, ahead.z);
  const float same = settings.same_direction * settings.same_direction;
  const float per_metre = 1 / (settings.headway * s.fastest);
  V max_speed = hn::Set(d, desired);
  for (size_t n = 0; n < s.near.size; n += hn::Lanes(d)) {
    const V x = hn::Load(d, &s.near.x[n]), z = hn::Load(d, &s.near.z[n]);
    const V along = hn::Add(hn::Mul(x, ahead_x), hn::Mul(z, ahead_z));
    const V square = hn::Add(hn::Mul(x, x), hn::Mul(z, z));
    const V apart = hn::Load(d, &s.near.apart[n]);
    const V radii = hn::Sqrt(hn::Max(hn::Sub(square, apart), zero));
    const V aside = hn::Mul(hn::Set(d, settings.lane), radii);
    const V off = hn::Sub(square, hn::Mul(along, along));
    auto leads = hn::And(hn::FirstN(d, s.near.size - n), hn::Gt(along, zero));
    leads = hn::And(leads, hn::Lt(off, hn::Mul(aside, aside)));
    const V wx = hn::Load(d, &s.near.wx[n]), wz = hn::Load(d, &s.near.wz[n]);
    const V along_ahead = hn::Add(hn::Mul(wx, ahead_x), hn::Mul(wz, ahead_z));
    const V min_square = times(hn::Add(hn::Mul(wx, wx), hn::Mul(wz, wz)), same);
    leads = hn::And(leads, hn::Gt(along_ahead, zero));
    leads = hn::And(leads, hn::Gt(hn::Mul(along_ahead, along_ahead), min_square));
    if (hn::AllFalse(d, leads)) continue;
    const V bodies = hn::Min(radii, hn::Set(d, settings.body));
    const V distance = hn::Sqrt(square);
    const V spacing = hn::Max(hn::Sub(distance, bodies), zero);
    const V u = times(spacing, per_metre);
    const V half = times(u, 0.5f);
    const V sum = hn::Add(u, hn::Mul(half, hn::Add(u, hn::Mul(u, u))));
    const V limit = hn::Mul(fastest, hn::Sub(one, hn::Div(one, hn::Add(one, sum))));
    const V leader = hn::Add(hn::Mul(hn::Load(d, &s.near.vx[n]), ahead_x),
                             hn::Mul(hn::Load(d, &s.near.vz[n]), ahead_z));
    const V faster = hn::Max(hn::Sub(leader, limit), zero);
    const V allowed = hn::Min(hn::Add(limit, times(faster, settings.foresight)),
                              times(distance, settings.max_flow));
    max_speed = hn::IfThenElse(leads, hn::Min(max_speed, allowed), max_speed);
  }
  const float speed = hn::GetLane(hn::MinOfLanes(d, max_speed));
  return speed < desired ? Plane{ahead.x * speed, ahead.z * speed} : s.preferred;
}

bool PreferredIsOpen(const SampledSettings& settings, const Situation& s) {
  const D d;
  const V min_soonness = hn::Set(d, 1 / settings.horizon);
  for (size_t n = 0; n < s.near.size; n += hn::Lanes(d)) {
    const V vx = hn::Sub(hn::Load(d, &s.near.vx[n]), hn::Set(d, s.preferred.x));
    const V vz = hn::Sub(hn::Load(d, &s.near.vz[n]), hn::Set(d, s.preferred.z));
    const V share = share_of(hn::Load(d, &s.near.apart[n]));
    const Touch t = touch(hn::Mul(hn::Load(d, &s.near.x[n]), share),
                          hn::Mul(hn::Load(d, &s.near.z[n]), share), vx, vz, share);
    const auto here = hn::FirstN(d, s.near.size - n);
    if (!hn::AllFalse(d, hn::And(here, hn::Gt(soonness(t), min_soonness)))) return false;
  }
  if (!s.has_walls) return true;
  const float desired = std::sqrt(s.preferred.x * s.preferred.x + s.preferred.z * s.preferred.z);
  return nearness_of_wall(s.free_distance[0], desired) <=
         1 / (settings.wall_horizon + kMinTouchTime);
}

bool IsOpposed(const LaneSettings& settings, const Situation& s) {
  const D d;
  const V zero = hn::Zero(d);
  const V preferred_x = hn::Set(d, s.preferred.x), preferred_z = hn::Set(d, s.preferred.z);
  const V desired = hn::Set(d, s.preferred.x * s.preferred.x + s.preferred.z * s.preferred.z);
  const V opposed = hn::Set(d, settings.opposed * settings.opposed);
  size_t opposers = 0;
  for (size_t n = 0; n < s.near.size; n += hn::Lanes(d)) {
    const V wx = hn::Load(d, &s.near.wx[n]), wz = hn::Load(d, &s.near.wz[n]);
    const V x = hn::Load(d, &s.near.x[n]), z = hn::Load(d, &s.near.z[n]);
    const V towards = hn::Neg(hn::Add(hn::Mul(wx, preferred_x), hn::Mul(wz, preferred_z)));
    const V along = hn::Add(hn::Mul(x, preferred_x), hn::Mul(z, preferred_z));
    const V both = hn::Mul(hn::Add(hn::Mul(wx, wx), hn::Mul(wz, wz)), desired);
    const auto in_counterflow = hn::And(hn::Gt(towards, zero), hn::Gt(along, zero));
    const auto comes = hn::Gt(hn::Mul(towards, towards), hn::Mul(opposed, both));
    const auto here = hn::FirstN(d, s.near.size - n);
    opposers += hn::CountTrue(d, hn::And(here, hn::And(in_counterflow, comes)));
  }
  return opposers >= static_cast<size_t>(std::max(settings.opposers, 0));
}

// Parts of a trial along and right of the first direction, and its part of the fastest speed.
struct Shares {
  alignas(64) std::array<float, kTrials> cosine, sine, part;
};
constexpr Shares shares() {
  Shares s{};
  for (size_t t = 0; t < kTrials; ++t) {
    s.cosine[t] = turns().cosine[t / kSpeeds];
    s.sine[t] = turns().sine[t / kSpeeds];
    s.part[t] = part_of_speed(t % kSpeeds);
  }
  return s;
}
constexpr Shares kShares = shares();

void FindTrials(const Situation& s, float desired, Plane ahead, Trials& trials) {
  const D d;
  const V x = hn::Set(d, ahead.x), z = hn::Set(d, ahead.z), fastest = hn::Set(d, s.fastest);
  for (size_t t = 0; t < kTrials; t += hn::Lanes(d)) {
    const V cosine = hn::Load(d, &kShares.cosine[t]), sine = hn::Load(d, &kShares.sine[t]);
    const V part = hn::Load(d, &kShares.part[t]);
    const V fan_x = hn::Sub(hn::Mul(x, cosine), hn::Mul(z, sine));
    const V fan_z = hn::Add(hn::Mul(x, sine), hn::Mul(z, cosine));
    hn::Store(hn::Mul(hn::Mul(fan_x, fastest), part), d, &trials.x[t]);
    hn::Store(hn::Mul(hn::Mul(fan_z, fastest), part), d, &trials.z[t]);
  }
  for (size_t i = 0; desired > 1e-6f && i < kSpeeds; ++i) {
    trials.x[i] = s.preferred.x * part_of_speed(i);
    trials.z[i] = s.preferred.z * part_of_speed(i);
  }
  trials.x[kTrials / 2] = trials.z[kTrials / 2] = 0;
}

// Neighbours that no velocity up to `fastest` touches within the horizon cost nothing and are left
// out. The distance to a touch shrinks fastest at first, so a touch takes at least (distance -
// radii) / (speed towards each other) seconds; with a margin for rounding.
struct Relevant {
  // As input of `touch`, with space for one more vector.
  alignas(64) std::array<float, 2 * kMaxNear> x, z, vx, vz, share;
};
size_t CopyNear(const SampledSettings& settings, const Situation& s, Relevant& near) {
  const D d;
  const V horizon = hn::Set(d, settings.horizon * 1.001f), fastest = hn::Set(d, s.fastest * 1.001f);
  size_t size = 0;
  for (size_t n = 0; n < s.near.size; n += hn::Lanes(d)) {
    const V x = hn::Load(d, &s.near.x[n]), z = hn::Load(d, &s.near.z[n]);
    const V vx = hn::Load(d, &s.near.vx[n]), vz = hn::Load(d, &s.near.vz[n]);
    const V apart = hn::Load(d, &s.near.apart[n]);
    const V square = hn::Add(hn::Mul(x, x), hn::Mul(z, z));
    const V far = hn::Sqrt(square);
    const V radii = hn::Sqrt(hn::Max(hn::Sub(square, apart), hn::Zero(d)));
    const V gap = hn::Sub(hn::Sub(far, radii), hn::Set(d, 1e-3f));
    const V leaves = hn::Add(hn::Mul(x, vx), hn::Mul(z, vz));
    const V closing = hn::Sub(hn::Mul(fastest, far), leaves);
    const auto here = hn::FirstN(d, s.near.size - n);
    const auto matters = hn::And(here, hn::Lt(hn::Mul(gap, far), hn::Mul(horizon, closing)));
    const V share = share_of(apart);
    hn::StoreU(simd::compress(hn::Mul(x, share), matters), d, &near.x[size]);
    hn::StoreU(simd::compress(hn::Mul(z, share), matters), d, &near.z[size]);
    hn::StoreU(simd::compress(vx, matters), d, &near.vx[size]);
    hn::StoreU(simd::compress(vz, matters), d, &near.vz[size]);
    hn::StoreU(simd::compress(share, matters), d, &near.share[size]);
    size += hn::CountTrue(d, matters);
  }
  return size;
}

// Costs of trials, a vector at a time: first without the others, then with them.
class TrialCosts {
 public:
  TrialCosts(const SampledSettings& settings, const Situation& s)
      : settings_(settings), s_(s), count_(CopyNear(settings, s, near_)) {
    desired_ = std::sqrt(s.preferred.x * s.preferred.x + s.preferred.z * s.preferred.z);
    ahead_ = ahead_of(s.preferred);
    FindTrials(s, desired_, ahead_, trials_);
  }
  [[nodiscard]] const Trials& trials() const { return trials_; }

  // The lost progress, which is one term of the cost: a lower bound.
  HWY_INLINE V lower_bound(size_t t) const {
    const D d;
    const V x = hn::Load(d, &trials_.x[t]), z = hn::Load(d, &trials_.z[t]);
    const V along = hn::Add(hn::Mul(x, hn::Set(d, ahead_.x)), hn::Mul(z, hn::Set(d, ahead_.z)));
    const V lost = hn::Max(hn::Sub(hn::Set(d, desired_), along), hn::Zero(d));
    return hn::Div(hn::Mul(hn::Set(d, settings_.straightness), lost), hn::Set(d, s_.fastest));
  }

  HWY_INLINE V alone(size_t t) const {
    const D d;
    const V zero = hn::Zero(d);
    const V x = hn::Load(d, &trials_.x[t]), z = hn::Load(d, &trials_.z[t]);
    const V ahead_x = hn::Set(d, ahead_.x), ahead_z = hn::Set(d, ahead_.z);
    const V along = hn::Add(hn::Mul(x, ahead_x), hn::Mul(z, ahead_z));
    const V left = hn::Sub(hn::Mul(ahead_z, x), hn::Mul(ahead_x, z));
    V cost = hn::Mul(
        hn::Set(d, 1 - settings_.straightness),
        size_of(hn::Sub(x, hn::Set(d, s_.preferred.x)), hn::Sub(z, hn::Set(d, s_.preferred.z))));
    const V lost = hn::Max(hn::Sub(hn::Set(d, desired_), along), zero);
    cost = hn::Add(cost, hn::Mul(hn::Set(d, settings_.straightness), lost));
    const V gained = hn::Max(hn::Sub(along, hn::Set(d, desired_)), zero);
    cost = hn::Add(cost, hn::Mul(hn::Set(d, settings_.excess), gained));
    const V changed =
        size_of(hn::Sub(x, hn::Set(d, s_.velocity.x)), hn::Sub(z, hn::Set(d, s_.velocity.z)));
    cost = hn::Add(cost, hn::Mul(hn::Set(d, settings_.keep), changed));
    cost = hn::Add(cost, hn::Mul(hn::Set(d, settings_.right), hn::Max(left, zero)));
    return hn::Div(cost, hn::Set(d, s_.fastest));
  }

  HWY_INLINE V among_others(size_t t, V cost) const {
    const D d;
    const V zero = hn::Zero(d);
    const V x = hn::Load(d, &trials_.x[t]), z = hn::Load(d, &trials_.z[t]);
    V soonest = zero;
    for (size_t n = 0; n < count_; ++n) {
      const Touch to =
          touch(hn::Set(d, near_.x[n]), hn::Set(d, near_.z[n]), hn::Sub(hn::Set(d, near_.vx[n]), x),
                hn::Sub(hn::Set(d, near_.vz[n]), z), hn::Set(d, near_.share[n]));
      // The root adds no more than the approach.
      const auto sooner = hn::Gt(hn::Add(to.approach, to.approach), soonest);
      if (hn::AllFalse(d, hn::And(to.happens, sooner))) continue;
      soonest = hn::Max(soonest, soonness(to));
    }
    const V near =
        hn::Div(soonest, hn::Add(hn::Set(d, 1), hn::Mul(hn::Set(d, kMinTouchTime), soonest)));
    const V min_nearness = hn::Set(d, 1 / (settings_.horizon + kMinTouchTime));
    cost = hn::Add(cost, times(hn::Max(hn::Sub(near, min_nearness), zero), settings_.threat));
    if (!s_.has_walls) return cost;
    alignas(64) std::array<float, kMaxNear> distances;
    for (size_t n = 0; n < hn::Lanes(d); ++n) distances[n] = s_.free_distance[(t + n) / kSpeeds];
    const V speed = size_of(x, z);
    const V close = hn::Div(
        speed, hn::Add(hn::Load(d, distances.data()), hn::Mul(hn::Set(d, kMinTouchTime), speed)));
    const V min_of_wall = hn::Set(d, 1 / (settings_.wall_horizon + kMinTouchTime));
    const V urgent =
        hn::Max(hn::Sub(hn::IfThenElseZero(hn::Gt(speed, zero), close), min_of_wall), zero);
    return hn::Add(cost, times(urgent, settings_.wall));
  }

 private:
  const SampledSettings& settings_;
  const Situation& s_;
  Trials trials_;
  Relevant near_;
  size_t count_;
  float desired_;
  Plane ahead_;
};

void CostsOf(const SampledSettings& settings, const Situation& s, Trials& trials, Costs& costs) {
  const D d;
  const TrialCosts all(settings, s);
  trials = all.trials();
  for (size_t t = 0; t < kTrials; t += hn::Lanes(d)) {
    hn::Store(all.among_others(t, all.alone(t)), d, &costs[t]);
  }
}

// Others only add to a cost: trials that cost more than the best so far without them are left out.
// The preferred velocity is among the first trials and those near it among the first and the last,
// so these come first.
Plane Best(const SampledSettings& settings, const Situation& s) {
  const D d;
  const size_t lanes = hn::Lanes(d), pieces = kTrials / lanes;
  const TrialCosts all(settings, s);
  float lowest = std::numeric_limits<float>::infinity();
  size_t best = 0;
  for (size_t n = 0; n < pieces; ++n) {
    const size_t piece = n % 2 == 0 ? n / 2 : pieces - 1 - n / 2;
    const size_t t = piece * lanes;
    const V limit = hn::Set(d, lowest);
    if (hn::AllFalse(d, hn::Le(all.lower_bound(t), limit))) continue;
    const V alone = all.alone(t);
    if (hn::AllFalse(d, hn::Le(alone, limit))) continue;
    const V cost = all.among_others(t, alone);
    const float min_cost = hn::GetLane(hn::MinOfLanes(d, cost));
    if (min_cost > lowest) continue;
    const intptr_t lane = hn::FindFirstTrue(d, hn::Eq(cost, hn::Set(d, min_cost)));
    const size_t here = t + static_cast<size_t>(lane);
    if (min_cost < lowest || here < best) best = here;
    lowest = min_cost;
  }
  return {all.trials().x[best], all.trials().z[best]};
}

Plane TakeBest(const Trials& trials, Costs& costs) {
  const D d;
  V min_costs = hn::LoadU(d, costs.data());
  for (size_t t = hn::Lanes(d); t < kTrials; t += hn::Lanes(d)) {
    min_costs = hn::Min(min_costs, hn::LoadU(d, &costs[t]));
  }
  const V lowest = hn::MinOfLanes(d, min_costs);
  for (size_t t = 0; t < kTrials; t += hn::Lanes(d)) {
    const intptr_t lane = hn::FindFirstTrue(d, hn::Eq(hn::LoadU(d, &costs[t]), lowest));
    if (lane < 0) continue;
    const size_t best = t + static_cast<size_t>(lane);
    costs[best] = std::numeric_limits<float>::infinity();
    return {trials.x[best], trials.z[best]};
  }
  return {};
}

}  // namespace HWY_NAMESPACE
}  // namespace throng::steer
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace throng::steer {

HWY_EXPORT(Following);
HWY_EXPORT(PreferredIsOpen);
HWY_EXPORT(IsOpposed);
HWY_EXPORT(CostsOf);
HWY_EXPORT(Best);
HWY_EXPORT(TakeBest);

Plane following_fast(const SampledSettings& settings, const Situation& situation) {
  return HWY_DYNAMIC_DISPATCH(Following)(settings, situation);
}
bool preferred_is_open_fast(const SampledSettings& settings, const Situation& situation) {
  return HWY_DYNAMIC_DISPATCH(PreferredIsOpen)(settings, situation);
}
bool is_opposed_fast(const LaneSettings& settings, const Situation& situation) {
  return HWY_DYNAMIC_DISPATCH(IsOpposed)(settings, situation);
}
Plane best_fast(const SampledSettings& settings, const Situation& situation) {
  return HWY_DYNAMIC_DISPATCH(Best)(settings, situation);
}
void costs_of_fast(const SampledSettings& settings, const Situation& situation, Trials& trials,
                   Costs& costs) {
  HWY_DYNAMIC_DISPATCH(CostsOf)(settings, situation, trials, costs);
}
Plane take_best_fast(const Trials& trials, Costs& costs) {
  return HWY_DYNAMIC_DISPATCH(TakeBest)(trials, costs);
}

}  // namespace throng::steer
#endif
