// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
//
// A digital twin: what a wheelchair can reach in a model of a city or a building: its components,
// the nearest places to exits and the distances to these, and the step that stops it. Then the
// model gets a kerb ramp, and only the zones that the ramp touches are baked again.
//   build/release/examples/digital_twin [MODEL.ifc | MODEL.city.json | ...]
// Expected output (without an argument: the built-in city, 130 x 130 m):
//   56 components, the largest 9940 m2; 108 of 1000 places reach an exit, mean 68 m
//   a step stops it at (4.85, 0.12, 50.00); with a ramp, 1 of 25 zones baked again:
//   55 components, the largest 11755 m2; 612 of 1000 places reach an exit, mean 116 m
#include <throng/bake.h>
#include <throng/path.h>
#include <throng/scene.h>
#include <throng/world.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>

using namespace throng;
Context context;  // Progress and cancel, for long calls.

template <class T>
T need(Result<T> result) {  // The value, or the end of the program with the error's sentence.
  if (!result) std::printf("digital_twin: %s\n", result.error().message.c_str()), std::exit(1);
  return *std::move(result);
}

// Prints components and the flow to two exits; returns the area of the largest component.
double report(const World& world, int32_t wheelchair, Vec3d exit_a, Vec3d exit_b) {
  const Graph graph = need(Graph::create(world, {}, context));
  const std::span<const Component> components = graph.components(wheelchair);
  if (components.empty()) std::puts("no place for a wheelchair"), std::exit(1);
  GroundQuery query = need(GroundQuery::create(world, wheelchair));
  const Place exits[] = {query.nearest_place(exit_a, 20), query.nearest_place(exit_b, 20)};
  const PathConfig config{.avatar_class = wheelchair, .speedup = PathSpeedup::kOnDemand};
  const PathFinder finder = need(PathFinder::create(world, config, context));
  FlowField flow = need(FlowField::create(finder, exits, {}, context));
  double sum = 0, reached = 0;
  for (uint64_t n = 0; n < 1000; ++n) {
    const double distance = flow.distance(world.random_place(wheelchair, /*seed=*/1, n));
    if (std::isfinite(distance)) sum += distance, ++reached;
  }
  std::printf(
      "%zu components, the largest %.0f m2; %.0f of 1000 places reach an exit, mean %.0f m\n",
      components.size(), components[0].area, reached, sum / reached);
  return components[0].area;
}

int main(int argc, char** argv) {
  SceneConfig input;
  if (argc > 1) input.sources.emplace_back().path = argv[1];
  Scene scene =
      argc > 1 ? need(load_scene(input, context)) : need(create_builtin_world({"city", 130}));
  const BakeConfig config{.zone = 30};
  need(bake_world_to("twin.throng", scene, config, context));
  const World world = need(World::open("twin.throng"));
  const int32_t wheelchair = *world.find_class("wheelchair");
  const auto [low, high] = world.summary().bounds;
  const Vec3d corner{high.x, low.y, high.z};
  const double before = report(world, wheelchair, low, corner);

  // From the pavement towards the street, straight on: what stops a wheelchair?
  GroundQuery query = need(GroundQuery::create(world, wheelchair));
  const Place pavement = query.nearest_place(low + Vec3d{6, 0, 50}, 20);
  const GroundRay ray = query.ray(pavement, -5, 0);
  if (ray.blocked_by != Blocker::kStep) return std::puts("no step stops it"), 0;
  // A ramp of 3 x 2 m down to the street, against the wall's normal. Other zones are reused.
  const Vec3d kerb = ray.place.position;
  const Vec3d out{-ray.normal_x, 0, -ray.normal_z}, side{ray.normal_z, 0, -ray.normal_x};
  const Vec3d top = kerb + out * 0.3, foot = kerb + out * 3.3 + Vec3d{0, low.y - kerb.y, 0};
  scene.add_quad(top - side, top + side, foot + side, foot - side);
  const BakeReport edit = need(bake_world_to("twin.throng", scene, config, context));
  std::printf("a step stops it at (%.2f, %.2f, %.2f); with a ramp, %d of %d zones baked again:\n",
              kerb.x, kerb.y, kerb.z, static_cast<int>(edit.zones_baked),
              static_cast<int>(edit.zones));
  return report(need(World::open("twin.throng")), wheelchair, low, corner) > before ? 0 : 1;
}
