// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "steer/surface.h"

#include <algorithm>
#include <limits>

#include "steer/sampled.h"

// The trials lie in the tangent plane. Cost: directions times speeds times neighbours.
namespace throng::steer {
namespace {

// Cosine and sine of the directions that are tried: ahead, 25, 50, 80, 115 and 150 degrees to both
// sides, back.
constexpr std::array<std::array<float, 2>, 12> kAlongSurface = {{{1, 0},
                                                                 {0.90630779f, 0.42261826f},
                                                                 {0.90630779f, -0.42261826f},
                                                                 {0.64278761f, 0.76604444f},
                                                                 {0.64278761f, -0.76604444f},
                                                                 {0.17364818f, 0.98480775f},
                                                                 {0.17364818f, -0.98480775f},
                                                                 {-0.42261826f, 0.90630779f},
                                                                 {-0.42261826f, -0.90630779f},
                                                                 {-0.86602540f, 0.5f},
                                                                 {-0.86602540f, -0.5f},
                                                                 {-1, 0}}};
constexpr std::array<float, 2> kAlongSpeeds = {1, 0.5f};

Space cross(Space a, Space b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

}  // namespace

SurfaceChoices best_along(const AirSettings& settings, const AirSituation& situation, Space up) {
  const float desired = size_of(situation.preferred), fastest = situation.fastest;
  const auto along = [&](Space v) { return v - dot(v, up) * up; };
  // Without a preferred velocity the fan starts at an arbitrary direction.
  Space ahead = along(desired > 1e-6f ? situation.preferred : Space{1, 0, 0});
  if (size_of(ahead) < 0.1f * std::max(desired, 1.0f)) ahead = along({0, 0, 1});
  const float size = size_of(ahead);
  ahead = size > 1e-6f ? (1 / size) * ahead : Space{1, 0, 0};
  const Space right = cross(ahead, up);
  struct Choice {
    float cost = std::numeric_limits<float>::infinity();
    Space velocity;
  };
  std::array<Choice, kSurfaceChoices> best;
  const auto consider = [&](Space v) {
    float cost = settings.straightness * (desired - dot(v, ahead)) / fastest +
                 (1 - settings.straightness) * size_of(v - situation.preferred) / fastest +
                 settings.keep * size_of(v - situation.velocity) / fastest +
                 settings.right * std::max(0.0f, -dot(v, right)) / fastest;
    if (cost >= best.back().cost) return;
    float soonest = 0;
    for (size_t n = 0; n < situation.size; ++n) {
      soonest = std::max(soonest, soonness(settings, situation, situation.near[n], v));
    }
    cost += settings.threat * nearness(soonest);
    if (cost >= best.back().cost) return;
    size_t at = best.size() - 1;
    for (; at > 0 && cost < best[at - 1].cost; --at) best[at] = best[at - 1];
    best[at] = {cost, v};
  };
  for (const auto& [cosine, sine] : kAlongSurface) {
    const Space direction = cosine * ahead + sine * right;
    for (const float part : kAlongSpeeds) {
      consider((cosine == 1 ? desired : fastest) * part * direction);
    }
  }
  consider({});
  SurfaceChoices choices;
  for (size_t n = 0; n < choices.size(); ++n) choices[n] = best[n].velocity;
  return choices;
}

}  // namespace throng::steer
