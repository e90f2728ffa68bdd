// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "throng/picture.h"

#include <fmt/format.h>

#include "render/poster.h"

// Draws a baked world as a picture: converts the public World to what the poster needs, and is the
// only file that knows both.
namespace throng {

Result<Image> draw_world(const World& world, std::span<const PictureAvatar> avatars,
                         const PictureConfig& config) {
  const WorldSummary summary = world.summary();
  if (config.avatar_class < 0 ||
      static_cast<size_t>(config.avatar_class) >= summary.classes.size()) {
    return Error{Errc::kNotFound,
                 fmt::format("picture: no avatar class {}; this world has 0 to {}",
                             config.avatar_class, static_cast<int>(summary.classes.size()) - 1)};
  }
  const auto index = static_cast<size_t>(config.avatar_class);
  const AvatarClass& avatar = summary.classes[index];
  render::PictureWorld source;
  source.cell = summary.cell;
  source.origin = summary.origin;
  source.bounds = summary.bounds;
  source.tiles_x = summary.tiles_x;
  source.tiles_z = summary.tiles_z;
  source.storeys = world.storeys();
  source.level_tile = [&](uint32_t tile) { return world.level_tile(tile); };
  source.avatar_class = config.avatar_class;
  source.class_name = avatar.name;

  const Vec3d size = summary.bounds.max - summary.bounds.min;
  render::PosterText text;
  text.title = config.title.empty() ? "A walkable world" : config.title;
  text.lines.push_back(
      fmt::format("{:.1f} x {:.1f} m, {:.1f} m high, cells of {:g} m, {} triangles", size.x, size.z,
                  size.y, summary.cell, summary.source_triangles));
  std::string walkers =
      fmt::format("{}: {:g} m high, radius {:g} m, step {:g} m, stands on {:.0f} m2", avatar.name,
                  avatar.height, avatar.radius, avatar.step_height, summary.walkable_area[index]);
  if (!avatars.empty()) walkers += fmt::format("; {} avatars", avatars.size());
  text.lines.push_back(walkers);
  return render::draw_poster(source, text, avatars, config);
}

}  // namespace throng
