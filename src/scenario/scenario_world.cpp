// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "throng/bake.h"
#include "throng/scenario.h"

// The world of a scenario: opened, or baked in memory from models, a built-in world or a plane.
namespace throng {

Result<Scene> load_scene(const Scenario& scenario, Context& context, SceneMaterials materials) {
  if (!scenario.world.empty()) {
    return Error{Errc::kBadConfig, scenario.world + ": a baked world keeps no triangles"};
  }
  if (!scenario.models.empty()) {
    SceneConfig config;
    config.materials = materials;
    for (const std::string& model : scenario.models) {
      config.sources.push_back({.path = model, .up = {}, .scale = {}, .transform = {}});
    }
    return load_scene(config, context);
  }
  if (!scenario.builtins.empty()) return create_builtin_world(scenario.builtins.front());
  if (!scenario.planes.empty()) return create_plane_scene(scenario.planes.front());
  return Error{Errc::kBadConfig, "the scenario names no world"};
}

Result<World> bake_world(const Scenario& scenario, const Scene& scene, Context& context) {
  BakeConfig bake;
  bake.cell = scenario.cell;
  if (!scenario.classes.empty()) bake.classes = scenario.classes;
  return bake_world(scene, bake, context);
}

Result<World> open_world(const Scenario& scenario, Context& context) {
  if (!scenario.world.empty()) return World::open(scenario.world, {.part = scenario.part});
  const Result<Scene> scene = load_scene(scenario, context);
  if (!scene) return scene.error();
  return bake_world(scenario, *scene, context);
}

}  // namespace throng
