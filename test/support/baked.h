// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "throng/avatar.h"
#include "throng/scene.h"
#include "throng/world.h"

/// Baked worlds in small zones. Fails the test and returns an empty world if a bake fails.
namespace throng::test {

Scene builtin(const BuiltinWorldConfig& config);
World bake(const Scene& scene, double cell, std::vector<AvatarClass> classes = default_classes(),
           bool fine = true);

}  // namespace throng::test
