// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "throng/bake.h"
#include "throng/scenario.h"

namespace throng {

Result<World> open_world(const Scenario& scenario, Context& context) {
  if (!scenario.world.empty()) return World::open(scenario.world);
  Result<Scene> scene = Error{Errc::kBadConfig, "the scenario names no world"};
  if (!scenario.models.empty()) {
    SceneConfig config;
    for (const std::string& model : scenario.models) {
      config.sources.push_back({.path = model, .up = {}, .scale = {}, .transform = {}});
    }
    scene = load_scene(config, context);
  } else if (!scenario.builtins.empty()) {
    scene = make_builtin_world(scenario.builtins.front());
  } else if (!scenario.planes.empty()) {
    scene = make_plane_scene(scenario.planes.front());
  }
  if (!scene) return scene.error();
  BakeConfig bake;
  bake.cell = scenario.cell;
  if (!scenario.classes.empty()) bake.classes = scenario.classes;
  return bake_world(*scene, bake, context);
}

}  // namespace throng
