// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "throng/base.h"
#include "throng/world.h"

namespace throng::app {

/// "WORLD: --from (1, 2, 3) " and the fault of that position. [kBadInput]
[[nodiscard]] Error bad_position(const std::string& world, const std::string& option,
                                 const Vec3d& position, const std::string& what);

/// The three numbers of an option as a position. Fails with a sentence if it lies outside the
/// world, seen from above.
[[nodiscard]] Result<Vec3d> position_in(const World& world, const std::string& name,
                                        const std::string& option, const std::vector<double>& at);

}  // namespace throng::app
