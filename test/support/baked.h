// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "throng/avatar_class.h"
#include "throng/builtin_worlds.h"
#include "throng/scene.h"
#include "throng/world.h"

/// Worlds to walk in, in small zones. A failure, and an empty world, if they cannot be made.
namespace throng::test {

Scene builtin(const BuiltinWorldConfig& config);
World bake(const Scene& scene, double cell, std::vector<AvatarClass> classes = default_classes(),
           bool fine = true);

}  // namespace throng::test
