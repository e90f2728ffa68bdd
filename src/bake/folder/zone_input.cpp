// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "bake/folder/zone_input.h"

#include <algorithm>
#include <array>
#include <bit>
#include <vector>

#include "core/hash.h"
#include "core/parallel.h"
#include "world/zone_data.h"

// The XXH3 hash of all that a zone's bytes depend on. Linear in its triangles.
namespace throng::bake {
namespace {

constexpr size_t kChunk = 512;  // triangles
using TriangleWords = std::array<uint64_t, 10>;

// Codes are numbered over the whole scene, so what a code stands for is taken, not its number: a
// new kind of surface elsewhere changes nothing here.
TriangleWords words_of(const CellTriangle& triangle, const SurfaceCodes& codes) {
  TriangleWords words;
  for (size_t i = 0; i < 3; ++i) {
    words[i] = std::bit_cast<uint64_t>(triangle.x[i]);
    words[3 + i] = std::bit_cast<uint64_t>(triangle.y[i]);
    words[6 + i] = std::bit_cast<uint64_t>(triangle.z[i]);
  }
  const SurfaceCode& code = codes.codes[triangle.code];
  const bool blocks_all = triangle.code + size_t{1} == codes.codes.size();
  words[9] = blocks_all ? UINT64_MAX : uint64_t{code.slope_bin} << 8 | code.area;
  return words;
}

}  // namespace

uint64_t zone_input(const BakePlan& plan, int32_t zone_x, int32_t zone_z,
                    std::span<const uint32_t> triangles) {
  std::vector<uint64_t> hashes((triangles.size() + kChunk - 1) / kChunk);
  parallel_for(hashes.size(), plan.config->workers, [&](size_t chunk) {
    std::array<TriangleWords, kChunk> words;
    const auto part = triangles.subspan(chunk * kChunk)
                          .first(std::min(kChunk, triangles.size() - chunk * kChunk));
    for (size_t i = 0; i < part.size(); ++i) {
      const uint8_t code = plan.coder->code(part[i]);
      words[i] = words_of(to_cell_triangle(*plan.scene, part[i], plan.grid, code), plan.codes);
    }
    hashes[chunk] = hash_bytes(words.data(), part.size() * sizeof(TriangleWords));
  });

  // Tiles of the ring around the zone that lie beyond the world's last ones have no neighbour.
  const int32_t side = plan.tiles_per_zone;
  const auto end = [&](int32_t zone, int32_t tiles) {
    return std::min((zone + 1) * side + 1, tiles);
  };
  std::vector<uint64_t> words{kBakeVersion,
                              world::kZoneVersion,
                              static_cast<uint64_t>(zone_x),
                              static_cast<uint64_t>(zone_z),
                              static_cast<uint64_t>(side),
                              static_cast<uint64_t>(end(zone_x, plan.grid.tiles_x())),
                              static_cast<uint64_t>(end(zone_z, plan.grid.tiles_z())),
                              std::bit_cast<uint64_t>(plan.grid.origin_x),
                              std::bit_cast<uint64_t>(plan.grid.origin_z),
                              std::bit_cast<uint64_t>(plan.config->cell),
                              std::bit_cast<uint64_t>(plan.config->resolution),
                              plan.config->classes.size(),
                              triangles.size()};
  for (const AvatarClass& avatar : plan.config->classes) {
    for (const double number :
         {avatar.height, avatar.radius, avatar.step_height, avatar.max_slope}) {
      words.push_back(std::bit_cast<uint64_t>(number));
    }
  }
  if (plan.config->fine) words.push_back(1);
  if (plan.config->one_sided) words.push_back(2);
  words.insert(words.end(), hashes.begin(), hashes.end());
  return hash_span(std::span<const uint64_t>(words));
}

}  // namespace throng::bake
