// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "path/edits/ground_view.h"
#include "path/ground/mesh.h"

/// Goals on ground that is not connected with the start.
namespace throng::path {

/// The point of a component of a baked mesh that is nearest to a goal, heights counted; of equally
/// near cells the first, by level and row. `view`: the same ground with edits, whose blocked and
/// closed cells are left out; null if there are none. None if nothing of the component is left.
/// Time: tiles in the order of their distance from the goal, as far as a nearer point may lie.
std::optional<Stop> nearest_of_component(const world::WorldData& world, const PathMesh& mesh,
                                         GroundView* view, uint32_t component, const Stop& goal);

}  // namespace throng::path
