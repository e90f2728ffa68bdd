// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <mutex>
#include <utility>
#include <vector>

#include "core/parallel.h"
#include "impostor/figure_frames.h"
#include "impostor/figure_raster.h"
#include "impostor/srgb.h"
#include "impostor/view_packer.h"
#include "impostor/worn_parts.h"
#include "throng/impostor.h"

// [TC00] keeps views as equal squares, most of which are empty. Here a view keeps its own rectangle
// in blocks of four texels (what block compression and two mipmap levels need), and the rectangles
// share pages, as its section 5 proposes.
namespace throng {
namespace {

bool is_first_of_clip(const Atlas& atlas, size_t frame) {
  return std::any_of(atlas.clips.begin(), atlas.clips.end(), [&](const AtlasClip& clip) {
    return static_cast<size_t>(clip.first_frame) == frame;
  });
}

// Packs the views that were drawn, and shows rigid parts in the other frames by the view of the
// first one, moved by whole texels.
impostor::PageSize pack_drawn_views(const Character& character, const impostor::FigureFrames& poses,
                                    Atlas& atlas) {
  const AtlasShape& shape = atlas.shape;
  const size_t count = shape.view(shape.frames, 0, 0), a_frame = shape.view(1, 0, 0);
  std::vector<size_t> drawn;
  const auto is_drawn = [&](size_t view) {
    const size_t layer = view / count, frame = view % count / a_frame;
    return layer == 0 || !impostor::is_rigid(character.worn[layer - 1].kind) ||
           is_first_of_clip(atlas, frame);
  };
  for (size_t v = 0; v < atlas.views.size(); ++v) {
    if (is_drawn(v)) drawn.push_back(v);
  }
  std::vector<AtlasView> packed;
  for (const size_t v : drawn) packed.push_back(atlas.views[v]);
  const impostor::PageSize size = impostor::pack_views(packed);
  for (size_t i = 0; i < drawn.size(); ++i) atlas.views[drawn[i]] = packed[i];
  for (size_t layer = 1; layer <= character.worn.size(); ++layer) {
    if (!impostor::is_rigid(character.worn[layer - 1].kind)) continue;
    for (const AtlasClip& clip : atlas.clips) {
      const auto first = static_cast<size_t>(clip.first_frame);
      for (size_t frame = first + 1; frame < first + static_cast<size_t>(clip.frames); ++frame) {
        const Vec3d moved = impostor::movement_of(character, character.worn[layer - 1],
                                                  poses.frames[first], poses.frames[frame]);
        for (size_t v = 0; v < a_frame; ++v) {
          const auto column = static_cast<int32_t>(v) % shape.directions;
          const auto row = static_cast<int32_t>(v) / shape.directions;
          const impostor::FigureCamera camera =
              impostor::figure_camera(column, shape.directions, row, shape.elevations);
          const auto shifted = [&](uint16_t from, double metres) {
            const double texels = std::floor(metres * shape.pixels / shape.side + 0.5);
            return static_cast<uint16_t>(std::clamp(from + texels, 0.0, shape.pixels - 1.0));
          };
          AtlasView view = atlas.views[layer * count + first * a_frame + v];
          if (view.width > 4 || view.height > 4) {  // Else it shows nothing.
            view.left = shifted(view.left, dot(moved, camera.right));
            view.top = shifted(view.top, -dot(moved, camera.up));
          }
          atlas.views[layer * count + frame * a_frame + v] = view;
        }
      }
    }
  }
  return size;
}

// A view without its empty rows and columns, with one empty texel around.
AtlasView trim(const impostor::FigureView& view) {
  int32_t x0 = view.pixels, y0 = view.pixels, x1 = -1, y1 = -1;
  for (int32_t i = 0; i < view.pixels * view.pixels; ++i) {
    if (view.colour[static_cast<size_t>(i)][3] == 0) continue;
    const int32_t x = i % view.pixels, y = i / view.pixels;
    x0 = std::min(x0, x), x1 = std::max(x1, x);
    y0 = std::min(y0, y), y1 = std::max(y1, y);
  }
  AtlasView out{.width = 4, .height = 4};
  if (x1 < 0) return out;
  out.left = static_cast<uint16_t>(std::max(0, x0 - 1));
  out.top = static_cast<uint16_t>(std::max(0, y0 - 1));
  out.width = static_cast<uint16_t>((x1 + 2 - out.left + 3) / 4 * 4);
  out.height = static_cast<uint16_t>((y1 + 2 - out.top + 3) / 4 * 4);
  return out;
}

struct Texels {
  std::vector<std::array<uint8_t, 4>> colour;
  std::vector<std::array<uint8_t, 2>> normal;
  std::vector<uint8_t> mask;
};

// Empty texels beside covered ones take the mean of their colours and normals, twice, so that
// filters and blocks see an edge in alpha only.
void bleed(Texels& texels, int32_t width, int32_t height) {
  std::vector<uint8_t> known(texels.colour.size());
  for (size_t i = 0; i < known.size(); ++i) known[i] = texels.colour[i][3] != 0;
  for (int32_t round = 0; round < 2; ++round) {
    const std::vector<uint8_t> before = known;
    for (int32_t y = 0; y < height; ++y) {
      for (int32_t x = 0; x < width; ++x) {
        const auto here = static_cast<size_t>(y * width + x);
        if (before[here] != 0) continue;
        std::array<int32_t, 5> sum{};
        int32_t count = 0;
        for (int32_t n = 0; n < 9; ++n) {
          const int32_t nx = x + n % 3 - 1, ny = y + n / 3 - 1;
          if (nx < 0 || ny < 0 || nx >= width || ny >= height) continue;
          const auto there = static_cast<size_t>(ny * width + nx);
          if (before[there] == 0) continue;
          for (size_t c = 0; c < 3; ++c) sum[c] += texels.colour[there][c];
          for (size_t c = 0; c < 2; ++c) sum[3 + c] += texels.normal[there][c];
          texels.mask[here] = texels.mask[there];
          ++count;
        }
        if (count == 0) continue;
        for (size_t c = 0; c < 3; ++c) {
          texels.colour[here][c] = static_cast<uint8_t>((sum[c] + count / 2) / count);
        }
        for (size_t c = 0; c < 2; ++c) {
          texels.normal[here][c] = static_cast<uint8_t>((sum[3 + c] + count / 2) / count);
        }
        known[here] = 1;
      }
    }
  }
}

Texels cut_out(const impostor::FigureView& view, const AtlasView& part) {
  Texels out;
  const auto count = static_cast<size_t>(part.width) * part.height;
  out.colour.assign(count, {0, 0, 0, 0});
  out.normal.assign(count, {128, 128});
  out.mask.assign(count, 0);
  for (int32_t y = 0; y < part.height && part.top + y < view.pixels; ++y) {
    for (int32_t x = 0; x < part.width && part.left + x < view.pixels; ++x) {
      const auto from = static_cast<size_t>((part.top + y) * view.pixels + part.left + x);
      const auto to = static_cast<size_t>(y * part.width + x);
      out.colour[to] = view.colour[from];
      out.normal[to] = view.normal[from];
      out.mask[to] = view.mask[from];
    }
  }
  bleed(out, part.width, part.height);
  return out;
}

void paste(const Texels& texels, const AtlasView& view, Atlas& atlas) {
  for (int32_t y = 0; y < view.height; ++y) {
    for (int32_t x = 0; x < view.width; ++x) {
      const auto from = static_cast<size_t>(y * view.width + x);
      const size_t to =
          (static_cast<size_t>(view.page) * static_cast<size_t>(atlas.height) + view.y + y) *
              static_cast<size_t>(atlas.width) +
          view.x + x;
      std::copy_n(texels.colour[from].data(), 4, &atlas.colour[to * 4]);
      std::copy_n(texels.normal[from].data(), 2, &atlas.normal[to * 2]);
      atlas.mask[to] = texels.mask[from];
    }
  }
}

void find_part_colours(Atlas& atlas) {
  std::array<Vec3d, kBodyParts> sum;
  std::array<uint64_t, kBodyParts> count{};
  // Of the body alone: its tints must not depend on what it wears.
  std::vector<uint8_t> worn(atlas.mask.size());
  for (size_t v = atlas.shape.view(atlas.shape.frames, 0, 0); v < atlas.views.size(); ++v) {
    const AtlasView& view = atlas.views[v];
    for (size_t y = 0; y < view.height; ++y) {
      const size_t row = size_t{view.page} * static_cast<size_t>(atlas.height) + view.y + y;
      std::fill_n(&worn[row * static_cast<size_t>(atlas.width) + view.x], view.width, uint8_t{1});
    }
  }
  for (size_t i = 0; i < atlas.mask.size(); ++i) {
    const uint8_t* texel = &atlas.colour[i * 4];
    if (texel[3] < 128 || worn[i] != 0) continue;
    const auto part = static_cast<size_t>(atlas.mask[i] >> 5);
    sum[part] =
        sum[part] + Vec3d{impostor::decode_colour(texel[0]), impostor::decode_colour(texel[1]),
                          impostor::decode_colour(texel[2])};
    ++count[part];
  }
  for (size_t part = 0; part < kBodyParts; ++part) {
    if (count[part] == 0) continue;
    const Vec3d mean = sum[part] * (1.0 / static_cast<double>(count[part]));
    atlas.part_colour[part] = {impostor::encode_colour(mean.x), impostor::encode_colour(mean.y),
                               impostor::encode_colour(mean.z)};
  }
}

}  // namespace

Result<Atlas> create_atlas(const Character& character, const AtlasConfig& config,
                           Context& context) {
  if (auto sound = impostor::check_atlas_config(config); !sound) return sound.error();
  Result<impostor::FigureFrames> poses = impostor::pose_frames(character, config);
  if (!poses) return poses.error();

  Atlas atlas;
  atlas.clips = std::move(poses->clips);
  // Two empty texels on each side: the border of a view, and half a sample of rounding.
  const double side = 2 * poses->radius * config.pixels / (config.pixels - 4);
  atlas.shape = {.pixels = config.pixels,
                 .directions = config.directions,
                 .elevations = config.elevations,
                 .frames = static_cast<int32_t>(poses->frames.size()),
                 .side = side,
                 .centre = 0.5 * poses->height,
                 .height = poses->height};
  const size_t count = atlas.shape.view(atlas.shape.frames, 0, 0);
  for (const WornPart& part : character.worn) atlas.parts.push_back({part.name, part.kind});
  const size_t all = count * (1 + character.worn.size());  // The body, then part by part.
  if (all > impostor::kMaxViews) {
    return Error{Errc::kLimit, "atlas: " + std::to_string(all) + " views, more than " +
                                   std::to_string(impostor::kMaxViews) +
                                   "; take fewer clips, frames or parts"};
  }
  atlas.views.resize(all);
  std::vector<Texels> texels(all);
  const auto workers = static_cast<size_t>(worker_count(config.workers));
  std::vector<impostor::FigureRaster> rasters(workers,
                                              impostor::FigureRaster(character, config.pixels));
  std::vector<impostor::FigureView> views(workers);
  std::atomic<uint64_t> done = 0;
  std::mutex telling;
  parallel_for_worker(count, config.workers, [&](size_t index, int32_t worker) {
    if (context.cancel) return;
    const auto w = static_cast<size_t>(worker);
    const auto column = static_cast<int32_t>(index) % config.directions;
    const auto row = static_cast<int32_t>(index) / config.directions % config.elevations;
    const auto frame = index / static_cast<size_t>(config.directions * config.elevations);
    impostor::FigureCamera camera =
        impostor::figure_camera(column, config.directions, row, config.elevations);
    camera.centre = {0, atlas.shape.centre, 0};
    camera.side = side;
    const auto keep = [&](size_t view) {
      atlas.views[view] = trim(views[w]);
      texels[view] = cut_out(views[w], atlas.views[view]);
    };
    rasters[w].draw(poses->frames[frame], camera, views[w]);
    keep(index);
    for (size_t p = 0; p < character.worn.size(); ++p) {
      if (impostor::is_rigid(character.worn[p].kind) && !is_first_of_clip(atlas, frame)) continue;
      rasters[w].draw_worn(character.worn[p], poses->frames[frame], camera, views[w]);
      keep((1 + p) * count + index);
    }
    if (++done % 64 == 0 && context.on_progress) {
      const std::lock_guard lock(telling);
      context.on_progress({.stage = "draw", .done = done, .total = count});
    }
  });
  if (context.cancel) return Error{Errc::kCancelled, "atlas: cancelled"};

  const impostor::PageSize size = pack_drawn_views(character, *poses, atlas);
  if (size.pages > impostor::kMaxPages) {
    return Error{Errc::kLimit, "atlas: " + std::to_string(size.pages) + " pages, more than " +
                                   std::to_string(impostor::kMaxPages) +
                                   "; take fewer frames, directions or pixels"};
  }
  atlas.width = size.width;
  atlas.height = size.height;
  atlas.pages = size.pages;
  const auto texel_count = static_cast<size_t>(size.width) * static_cast<size_t>(size.height) *
                           static_cast<size_t>(size.pages);
  atlas.colour.assign(texel_count * 4, 0);
  atlas.normal.assign(texel_count * 2, 128);
  atlas.mask.assign(texel_count, 0);
  for (size_t i = 0; i < all; ++i) {
    if (!texels[i].colour.empty()) paste(texels[i], atlas.views[i], atlas);
  }
  find_part_colours(atlas);
  return atlas;
}

}  // namespace throng
