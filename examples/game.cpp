// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
//
// A game: load a level from a GLB, cast a ray, find a path, put up a crate, shut a door, and lead a
// player through a crowd of 500 avatars. No avatar enters a wall or another avatar.
//   build/release/examples/game [LEVEL.glb]
// Expected output (without an argument: a part of a city, written to game_level.glb):
//   60.8 m to the goal: ray 6.4 m, path 125.7 m, with crate and shut door 128.3 m
//   the player arrives after 77.6 s; 258 of 500 avatars have arrived; 0 faults
#include <throng/bake.h>
#include <throng/crowd.h>
#include <throng/path.h>
#include <throng/scene.h>

#include <cstdio>
#include <cstdlib>

using namespace throng;

template <class T>
T need(Result<T> result) {  // The value, or the end of the program with the error's sentence.
  if (!result) std::printf("game: %s\n", result.error().message.c_str()), std::exit(1);
  if constexpr (!std::is_void_v<T>) return *std::move(result);
}

int main(int argc, char** argv) {
  Context context;  // Progress and cancel, for long calls.
  SceneConfig input;
  input.sources.emplace_back().path = argc > 1 ? argv[1] : "game_level.glb";
  if (argc < 2) need(write_glb(need(create_builtin_world({"city", 100})), "game_level.glb"));
  const World world = need(bake_world(need(load_scene(input, context)), {}, context));

  // A ray along the ground, and the path between the same places. Class 0 is the adult.
  const Place from = world.random_place(0, /*seed=*/1, 0), to = world.random_place(0, 1, 1);
  const Vec3d line = to.position - from.position;
  GroundQuery query = need(GroundQuery::create(world, 0));
  const double seen = length(query.ray(from, line.x, line.z).place.position - from.position);
  Edits edits;
  PathFinder finder = need(PathFinder::create(world, {.edits = edits}, context));
  Path path;
  finder.find(from, to, path);
  if (path.end != PathEnd::kReached) return std::puts("game: no path to the goal"), 1;
  std::printf("%.1f m to the goal: ray %.1f m, path %.1f m", length(line), seen, path.length);

  // A door around the path's middle corner, a crate before the player, and the path past both.
  const Vec3d corner = path.points[path.points.size() / 2].position;
  const Prism shut = Prism::box(corner - Vec3d{2, 0, 2}, corner + Vec3d{2, 2, 2});
  const EditId door = need(edits.add_obstacle(shut));
  need(edits.add_obstacle(Prism::circle(from.position + line * 0.1, 0.6, 1)));
  finder.find(from, to, path);
  if (path.end != PathEnd::kReached) return std::puts(": crate and door cut off the goal"), 1;
  std::printf(", with crate and shut door %.1f m\n", path.length);
  FlowField guide = need(FlowField::create(finder, {&to, 1}, {}, context));

  // The crowd: a player, and 500 avatars with goals. It reads the same edits; the door is open.
  edits.set_active(door, false);
  Crowd crowd = need(Crowd::create(world, {.dt = 0.1, .edits = edits}));
  const auto player = need(crowd.add(std::vector{AvatarSpawn{.place = from, .speed = 2}}, context));
  const auto others = need(crowd.scatter(500, {}, context));
  std::vector<Place> goals(500);
  for (size_t n = 0; n < 500; ++n) goals[n] = world.random_place(0, /*seed=*/1, n);
  crowd.set_goals(others, goals);

  // Until the player is there: a velocity for it, as from its keys, and a step of all.
  int arrived = 0, faults = 0, step = 0;
  for (Vec3d here = from.position; step < 1200 && length(to.position - here) > 0.5; ++step) {
    if (step == 50) edits.set_active(door, true);  // It shuts as soon as no avatar is inside.
    const Vec3d ahead = guide.next(world.find_place(0, here, 0.5)).position - here;
    const Vec3d velocity = ahead * (2 / length(ahead));
    crowd.set_velocities(player, {&velocity, 1});
    arrived += static_cast<int>(crowd.step().arrived);
    const CrowdCheck check = crowd.check();
    faults += static_cast<int>(check.overlaps + check.wall_entries + check.obstacle_entries);
    here = crowd.read(player[0])->position;
  }
  std::printf("the player arrives after %.1f s; %d of 500 avatars have arrived; %d faults\n",
              step * 0.1, arrived, faults);
  return step < 1200 && faults == 0 ? 0 : 1;
}
