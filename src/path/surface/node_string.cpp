// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "path/surface/node_string.h"

#include <algorithm>
#include <cmath>

#include "path/ground/pull_string.h"

// One crossing after the other moves to where the straight lines from the one before it and to the
// one after it, unfolded around the portal, meet it; forward and back along the path, until its
// cost no longer falls. The result lies in the same blocks, so it is as legal as the input. Linear
// in the crossings, kRounds times at most.
namespace throng::path {
namespace {

constexpr double kMinGain = 1e-4;  // Of the whole cost: a round that gains less is the last.

// Where the shortest path from p to q over the line from a to b meets it, 0 at a and 1 at b.
double unfolded(Vec3d p, Vec3d q, Vec3d a, Vec3d b) {
  const Vec3d along = b - a;
  const double size2 = dot(along, along);
  if (!(size2 > 1e-12)) return 0.5;
  const double ps = dot(p - a, along) / size2, qs = dot(q - a, along) / size2;
  const double pd = length(p - (a + along * ps)), qd = length(q - (a + along * qs));
  const double sum = pd + qd;
  return std::clamp(sum > 0 ? (qd * ps + pd * qs) / sum : (ps + qs) / 2, 0.0, 1.0);
}

}  // namespace

void NodeString::place(PulledCrossing& crossing, double along) const {
  const graph::NodePortal portal = view_->portal(crossing.crossing.portal);
  const bool backward = crossing.crossing.backward;
  const auto on = [&](const std::array<double, 4>& line, uint32_t block) {
    return BlockPoint{block, line[0] + along * (line[2] - line[0]),
                      line[1] + along * (line[3] - line[1])};
  };
  const BlockPoint a = on(portal.on_a, portal.a), b = on(portal.on_b, portal.b);
  crossing.along = along;
  crossing.out = backward ? b : a;
  crossing.in = backward ? a : b;
  crossing.out_at = view_->surface(crossing.out.block).at(crossing.out.s, crossing.out.t);
  crossing.in_at = view_->surface(crossing.in.block).at(crossing.in.s, crossing.in.t);
}

double NodeString::cost_around(const std::vector<PulledCrossing>& crossings, size_t i,
                               const PulledCrossing& crossing) const {
  const BlockPoint& before = i > 0 ? crossings[i - 1].in : from_;
  const BlockPoint& after = i + 1 < crossings.size() ? crossings[i + 1].out : to_;
  return (*cost_)(crossing.out.block, before.s, before.t, i > 0 ? crossings[i - 1].in_at : from_at_,
                  crossing.out.s, crossing.out.t, crossing.out_at)
             .cost +
         view_->cost_through(crossing.crossing.portal, view_->portal(crossing.crossing.portal),
                             crossing.out_at, crossing.in_at) +
         (*cost_)(crossing.in.block, crossing.in.s, crossing.in.t, crossing.in_at, after.s, after.t,
                  i + 1 < crossings.size() ? crossings[i + 1].out_at : to_at_)
             .cost;
}

void NodeString::pull(const BlockPoint& from, const BlockPoint& to,
                      const std::vector<Crossing>& crossings, std::vector<PulledCrossing>& out) {
  out.clear();
  for (const Crossing& crossing : crossings) {
    out.emplace_back().crossing = crossing;
    place(out.back(), 0);
    out.back().first_at = out.back().out_at;
    place(out.back(), 1);
    out.back().last_at = out.back().out_at;
    place(out.back(), 0.5);
  }
  if (out.empty()) return;
  from_ = from;
  to_ = to;
  from_at_ = view_->surface(from.block).at(from.s, from.t);
  to_at_ = view_->surface(to.block).at(to.s, to.t);
  pull_string(*this, out);
}

bool NodeString::move(std::vector<PulledCrossing>& crossings, int round) const {
  double gained = 0, all = 0;
  for (size_t k = 0; k < crossings.size(); ++k) {
    const size_t i = round % 2 == 0 ? k : crossings.size() - 1 - k;
    PulledCrossing& here = crossings[i];
    const graph::NodePortal portal = view_->portal(here.crossing.portal);
    if (portal.over_hole) continue;
    if (here.settled) {
      all += here.around;
      continue;
    }
    here.settled = true;
    const double before = cost_around(crossings, i, here);
    all += before;
    here.around = before;
    const double along = unfolded(i > 0 ? crossings[i - 1].in_at : from_at_,
                                  i + 1 < crossings.size() ? crossings[i + 1].out_at : to_at_,
                                  here.first_at, here.last_at);
    if (std::fabs(along - here.along) < 1e-6) continue;
    PulledCrossing moved = here;
    place(moved, along);
    const double after = cost_around(crossings, i, moved);
    if (!(after < before)) continue;
    gained += before - after;
    here = moved;
    here.settled = false;
    if (i > 0) crossings[i - 1].settled = false;
    if (i + 1 < crossings.size()) crossings[i + 1].settled = false;
  }
  return gained > kMinGain * all;
}

}  // namespace throng::path
