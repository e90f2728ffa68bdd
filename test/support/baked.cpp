// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "baked.h"

#include <gtest/gtest.h>

#include <utility>

#include "throng/bake.h"

// Bakes in zones of few tiles.
namespace throng::test {

Scene builtin(const BuiltinWorldConfig& config) {
  auto scene = create_builtin_world(config);
  EXPECT_TRUE(scene) << scene.error().message;
  return scene ? *std::move(scene) : Scene{};
}

World bake(const Scene& scene, double cell, std::vector<AvatarClass> classes, bool fine) {
  Context context;
  const auto world = bake_world(
      scene, {.cell = cell, .fine = fine, .zone = 25.6, .classes = std::move(classes)}, context);
  EXPECT_TRUE(world) << world.error().message;
  return world ? *world : World{};
}

}  // namespace throng::test
