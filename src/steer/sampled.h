// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>

/// Steering by trying velocities: which of some velocities costs least, by how far it leads from
/// the wish and how soon the body would touch another. A model of avoidance that knows nothing of
/// how a crowd stores its avatars. docs/design/008-engine.md has how its settings were found.
namespace throng::steer {

/// In the plane. [m, m/s]
struct Plane {
  double x = 0, z = 0;
};

struct SampledSettings {
  double horizon = 2;         ///< Touching later than that is of no concern. [s, > 0]
  double straightness = 0.8;  ///< Share of "less progress", beside "another velocity", in a cost.
  double keep = 0.2;          ///< Cost of leaving one's present velocity.
  double right = 0.1;         ///< Cost of passing on the left.
  double threat = 0.5;        ///< Cost of the most urgent touch,
  double threats = 0.02;      ///< and of every one.
  double share = 1;           ///< How much of the avoiding one does oneself. [0.5 to 1]
  double gap = 0.02;          ///< Wished between two bodies. [m]
  int32_t speeds = 4;         ///< Speeds tried in each of the 24 directions. [1 to 8]
  int32_t neighbours = 10;    ///< The nearest so many are looked at. [1 to 64]
};

struct Neighbour {
  Plane at, velocity;  ///< `at` from the body's own middle.
  double radii = 0;    ///< Sum of both.
};

/// Velocities in order of their cost, the best first; several, because the best may be taken.
inline constexpr size_t kChoices = 8;
using Choices = std::array<Plane, kChoices>;

/// Time until two discs touch that go on as they do: infinity if never, 0 if they touch and
/// approach. `at` and `velocity`: the other's against one's own. [s]
double time_to_touch(Plane at, Plane velocity, double radii);

/// `wish`: the velocity if nobody were there. `fastest`: of the body. [m/s, > 0]
Choices choose_velocity(const SampledSettings& settings, Plane velocity, Plane wish, double fastest,
                        std::span<const Neighbour> neighbours);

/// Who is not getting on turns to the right, by and by, up to `most`, and back once he is: what a
/// jam needs to begin to turn as a whole. All as tan(angle / 2), which needs no sines.
struct Patience {
  double rate = 0.5;     ///< a second
  double most = 0.42;    ///< 46 degrees
  double back = 0.25;    ///< a second
  double content = 0.3;  ///< Share of the wished speed towards the goal that is getting on.
};

/// The next turn of an avatar. `progress`: its speed towards the goal by the wished one.
double next_turn(const Patience& patience, double turn, double progress, double dt);

/// `direction` turned to the right (seen from above, X to the right, Z down) by 2 atan(turn).
Plane turned_right(Plane direction, double turn);

}  // namespace throng::steer
