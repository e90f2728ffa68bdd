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

/// Avatar generators: keep a crowd populated around a viewer's eye. Only what the eye sees, and a
/// band around it, is simulated. Source: [TC00] 5.
namespace throng {

/// Settings for AvatarGenerators::make.
struct GeneratorConfig {
  Place home = {};  ///< Only ground that the class can reach from here is populated.
  int32_t avatar_class = 0;
  double density = 0.05;  ///< Avatars per square metre of that ground. [1/m^2, > 0, <= 1]
  /// If not 0, in place of `density`: number of avatars on all of that ground, at most one per
  /// square metre. [>= 0]
  double people = 0;
  double radius = 100;           ///< Ground farther from the eye is not populated. [m, > 0]
  double band = 16;              ///< Width of the unseen band beside what is seen. [m, > 0]
  int32_t steps_per_query = 10;  ///< Steps between two queries of what is seen. [steps, > 0]
  uint64_t seed = 1;
  int32_t workers = 0;  ///< Threads to use, 0 for all cores. Never changes the result. [>= 0]
};

/// Returns whether anything inside a box can be seen from the eye. It may return true for a hidden
/// box: then more is simulated. If it returns false for a visible box, avatars appear in view.
using Sight = std::function<bool(const Box3d&)>;

/// State after an update.
struct GeneratorReport {
  double seen_area = 0;       ///< Area of the ground cells that are at least partly seen. [m^2]
  double band_area = 0;       ///< Area of the ground cells of the band. [m^2]
  uint32_t seen_avatars = 0;  ///< Avatars on seen cells. The target is density times area.
  uint32_t band_avatars = 0;
  uint32_t added = 0;    ///< In this update, none where it could be seen.
  uint32_t removed = 0;  ///< Likewise.
};

/// Keeps a crowd at a density in what an eye can see. Ground cells are level tiles. On cells of the
/// band, avatars are added or removed out of sight to keep the density; an avatar that arrives gets
/// a new goal, preferably on seen cells with few avatars. Movable, not copyable. The same calls
/// give the same crowd on any machine.
class THRONG_API AvatarGenerators {
 public:
  /// Makes the generators. Reads every zone once. Fails with kBadConfig, kNotFound (class),
  /// kBadInput (home is no place of the class), and as Graph::make does.
  [[nodiscard]] static Result<AvatarGenerators> make(const World& world,
                                                     const GeneratorConfig& config,
                                                     Context& context);
  AvatarGenerators(AvatarGenerators&&) noexcept;
  AvatarGenerators& operator=(AvatarGenerators&&) noexcept;
  ~AvatarGenerators();

  /// Removes all own avatars and populates what is seen and the band at once: call it first, and
  /// when the eye has jumped. Fails as Crowd::add does.
  [[nodiscard]] Result<GeneratorReport> populate(Crowd& crowd, Vec3d eye, const Sight& can_see,
                                                 Context& context);
  /// Adds and removes avatars: call it after each step of the crowd. The crowd must be the same
  /// each time, of the same world; avatars that others added are not touched. Fails as Crowd::add
  /// does. Time: linear in its avatars and in the cells within `radius`.
  [[nodiscard]] Result<GeneratorReport> update(Crowd& crowd, Vec3d eye, const Sight& can_see,
                                               Context& context);
  /// The avatars that the generators added and did not remove.
  [[nodiscard]] std::span<const AvatarId> members() const;
  /// Area of all ground that the class can reach from home. [m^2]
  [[nodiscard]] double area() const;

 private:
  struct State;
  explicit AvatarGenerators(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace throng
