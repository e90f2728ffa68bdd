// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "command.h"
#include "throng/surface.h"

/// How `throng query` and `throng path` print what nodes promise.
namespace throng::app {

/// `classes`: those of the world.
[[nodiscard]] Json clearance_json(const NodeClearance& clearance,
                                  const std::vector<AvatarClass>& classes);
/// Two lines. `where` begins the first: "here", "all along".
[[nodiscard]] std::string clearance_text(const NodeClearance& clearance,
                                         const std::vector<AvatarClass>& classes,
                                         const std::string& where);

}  // namespace throng::app
