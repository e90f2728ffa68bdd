#include <throng/bake.h>
#include <throng/builtin_worlds.h>
#include <throng/crowd.h>

#include <cstdio>
#include <vector>

int main() {
  const auto scene = throng::make_builtin_world({.name = "garage", .size = 45, .levels = 2});
  if (!scene) return std::puts(scene.error().message.c_str()), 1;

  throng::Context context;  // progress and cancel, if you want them
  const auto world = throng::bake_world(*scene, {.cell = 0.2}, context);
  if (!world) return std::puts(world.error().message.c_str()), 1;

  auto crowd = throng::Crowd::create(*world, {.avatars = 100, .dt = 0.1, .seed = 1});
  if (!crowd) return std::puts(crowd.error().message.c_str()), 1;

  for (int i = 0; i < 100; ++i) crowd->step();

  std::vector<throng::AvatarState> avatars;
  crowd->read(avatars);
  std::printf("avatar 0 stands at %.2f %.2f %.2f\n", avatars[0].position.x, avatars[0].position.y,
              avatars[0].position.z);
}
