// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "paths/path_options.h"
#include "throng/path.h"
#include "throng/world.h"

namespace throng::app {

/// What `throng path` searches: for one class, in one space of a world.
struct PathStage {
  const World& world;
  const PathOptions& options;
  int32_t avatar_class = 0;
  PathSpace space = PathSpace::kGround;
};

/// "WORLD: --from (1, 2, 3) " and the fault of that end.
[[nodiscard]] Error bad_end(const PathOptions& options, const Vec3d& position, const char* option,
                            const std::string& what);

/// One end of the path as a position. Fails with a sentence if it lies outside the world.
[[nodiscard]] Result<Vec3d> position_of(const World& world, const PathOptions& options,
                                        const std::vector<double>& at, const char* option);

/// One end of the path as a place. Fails with a sentence if the class cannot stand there.
[[nodiscard]] Result<Place> place_of(const PathStage& stage, const std::vector<double>& at,
                                     const char* option);

/// The same over nodes: for a class that only walks the ground above or below; for others, and
/// where there is none, the nearest place. Fails with a sentence if none is within the tolerance.
[[nodiscard]] Result<NodePlace> node_place_of(const PathStage& stage, PathFinder& finder,
                                              const std::vector<double>& at, const char* option);

/// Adds what the options put up in the world to the edits of a finder.
[[nodiscard]] Result<void> put_up(const PathStage& stage, PathFinder& finder, Edits& edits);

}  // namespace throng::app
