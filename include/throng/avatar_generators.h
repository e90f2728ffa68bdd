// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>

#include "throng/base.h"
#include "throng/context.h"
#include "throng/crowd.h"
#include "throng/math.h"
#include "throng/result.h"
#include "throng/world.h"

/// A populated world around an eye, of which only what can be seen, and a band around it, is
/// simulated. Source: [TC00] 5, avatar generators.
namespace throng {

struct GeneratorConfig {
  Place home = {};  ///< People are where one can walk to from here.
  int32_t avatar_class = 0;
  double density = 0.05;  ///< Avatars on a square metre of that ground. [1/m^2, > 0, <= 1]
  /// Instead of a density, if not 0: so many on all of that ground, at most one on each square
  /// metre. [>= 0]
  double people = 0;
  double radius = 100;  ///< Ground further from the eye is left alone. [m, > 0]
  double band = 16;     ///< How far unseen ground beside what is seen is populated. [m, > 0]
  int32_t steps_per_query = 10;  ///< Between two questions of what can be seen. [steps, > 0]
  uint64_t seed = 1;
  int32_t workers = 0;  ///< Threads to use, 0 for all cores. Never changes the result. [>= 0]
};

/// Whether anything inside a box can be seen from where the eye is. May say yes of what cannot:
/// then less is hidden, and more is simulated. Who says no of what can be seen lets people appear.
using Sight = std::function<bool(const Box3d&)>;

/// How things stand after an update.
struct GeneratorReport {
  double seen_area = 0;       ///< Of ground cells of which something can be seen. [m^2]
  double band_area = 0;       ///< Of those around them. [m^2]
  uint32_t seen_avatars = 0;  ///< On the first; wanted: density times area.
  uint32_t band_avatars = 0;
  uint32_t added = 0;    ///< In this update, none of them where it could be seen.
  uint32_t removed = 0;  ///< Likewise.
};

/// Keeps a crowd at a density in what an eye can see. Ground cells are level tiles. On cells of the
/// band, whatever is missing is added and what is too much is removed, out of sight; who arrives
/// gets another goal, among the seen cells the rather the fewer are there. Movable, not copyable;
/// the same calls give the same crowd on any machine.
class THRONG_API AvatarGenerators {
 public:
  /// Reads every zone once. Fails with kBadConfig, kNotFound (class), kBadInput (home is no place
  /// of the class), and as Graph::make does.
  [[nodiscard]] static Result<AvatarGenerators> make(const World& world,
                                                     const GeneratorConfig& config,
                                                     Context& context);
  AvatarGenerators(AvatarGenerators&&) noexcept;
  AvatarGenerators& operator=(AvatarGenerators&&) noexcept;
  ~AvatarGenerators();

  /// At the beginning, and when the eye has jumped: removes all of its avatars and populates what
  /// is seen and the band around it at once. Fails as Crowd::add does.
  [[nodiscard]] Result<GeneratorReport> populate(Crowd& crowd, Vec3d eye, const Sight& can_see,
                                                 Context& context);
  /// After each step of the crowd. The crowd must be the same one each time, of the same world;
  /// others' avatars in it are left alone. Fails as Crowd::add does. Time: linear in its avatars
  /// and in the cells within reach.
  [[nodiscard]] Result<GeneratorReport> update(Crowd& crowd, Vec3d eye, const Sight& can_see,
                                               Context& context);
  /// Whom they have added, and not removed.
  [[nodiscard]] std::span<const AvatarId> members() const;
  /// Area of all ground that one can walk to from home. [m^2]
  [[nodiscard]] double area() const;

 private:
  struct State;
  explicit AvatarGenerators(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace throng
