// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "scenario/file/density_image.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "core/files/read_file.h"

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#define STBI_NO_STDIO
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include <stb/stb_image.h>
#pragma GCC diagnostic pop

// Density maps from PNG files (stb_image) and from prisms painted on them.
namespace throng::scenario {
namespace {

constexpr int kMaxPixels = 16384;  // of a side

}  // namespace

Result<void> read_density_image(const std::string& path, DensityMap& map) {
  const auto bytes = read_file(path);
  if (!bytes) return bytes.error();
  const auto* data = reinterpret_cast<const stbi_uc*>(bytes->data());
  const auto size = static_cast<int>(std::min<size_t>(bytes->size(), INT32_MAX));
  int width = 0, height = 0, channels = 0;
  if (stbi_info_from_memory(data, size, &width, &height, &channels) == 0) {
    return Error{Errc::kBadFile, path + ": is no PNG; save the picture as one"};
  }
  if (width > kMaxPixels || height > kMaxPixels) {
    return Error{Errc::kBadFile, path + ": is larger than 16384 pixels a side; make it smaller"};
  }
  const std::unique_ptr<stbi_uc, void (*)(void*)> pixels(
      stbi_load_from_memory(data, size, &width, &height, &channels, 1), stbi_image_free);
  if (!pixels) return Error{Errc::kBadFile, path + ": is a damaged PNG; save it again"};
  map.width = width;
  map.height = height;
  map.weights.assign(pixels.get(),
                     pixels.get() + static_cast<size_t>(width) * static_cast<size_t>(height));
  return {};
}

void paint_density(DensityMap& map, std::span<const Prism> prisms, uint8_t weight) {
  const double dx = (map.x1 - map.x0) / map.width, dz = (map.z1 - map.z0) / map.height;
  for (int32_t row = 0; row < map.height; ++row) {
    for (int32_t column = 0; column < map.width; ++column) {
      const double x = map.x0 + (column + 0.5) * dx, z = map.z0 + (row + 0.5) * dz;
      const bool painted =
          std::any_of(prisms.begin(), prisms.end(), [&](const Prism& p) { return p.covers(x, z); });
      if (!painted) continue;
      map.weights[static_cast<size_t>(row) * static_cast<size_t>(map.width) +
                  static_cast<size_t>(column)] = weight;
    }
  }
}

}  // namespace throng::scenario

namespace throng {

Result<DensityGrid> load_density(const std::string& path) {
  DensityMap picture;
  if (auto ok = scenario::read_density_image(path, picture); !ok) return ok.error();
  DensityGrid map;
  map.width = picture.width, map.height = picture.height;
  map.weights = std::move(picture.weights);
  if (std::all_of(map.weights.begin(), map.weights.end(), [](uint8_t w) { return w == 0; })) {
    return Error{Errc::kBadFile, path + ": its weights are all 0; paint where avatars may be"};
  }
  return map;
}

}  // namespace throng
