// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "crowd/saved_density.h"

#include <cstring>
#include <memory>
#include <type_traits>
#include <utility>

#include "crowd/mode/saved_rows.h"
#include "path/edits/density_cells.h"

// Class after class: a head, then the weights up to a whole number of words. Linear in the pixels.
namespace throng::crowd {
namespace {

struct Head {
  double x0 = 0, z0 = 0, x1 = 0, z1 = 0, low = 0, high = 0;
  int32_t width = 0, height = 0;
  uint64_t body = 0;
};
static_assert(sizeof(Head) == 64 && std::is_trivially_copyable_v<Head>);

uint64_t padded(uint64_t pixels) { return (pixels + 7) / 8 * 8; }

}  // namespace

std::vector<uint8_t> save_densities(std::span<const DensityClass> classes) {
  std::vector<uint8_t> out;
  for (const DensityClass& of : classes) {
    const DensityGrid& map = of.cells->map();
    const Head head{.x0 = map.x0,
                    .z0 = map.z0,
                    .x1 = map.x1,
                    .z1 = map.z1,
                    .low = map.low,
                    .high = map.high,
                    .width = map.width,
                    .height = map.height,
                    .body = of.body};
    put_rows(out, &head, 1);
    put_rows(out, map.weights.data(), map.weights.size());
    out.resize(padded(out.size()), 0);
  }
  return out;
}

std::optional<std::vector<DensityClass>> restore_densities(std::span<const uint8_t> saved,
                                                           size_t bodies) {
  std::vector<DensityClass> classes;
  while (!saved.empty()) {
    Head head;
    if (saved.size() < sizeof head || bodies + classes.size() >= size_t{kMaxAvatarClasses}) {
      return {};
    }
    std::memcpy(&head, saved.data(), sizeof head);
    saved = saved.subspan(sizeof head);
    if (head.width < 1 || head.height < 1 || head.body >= bodies) return {};
    const uint64_t pixels = static_cast<uint64_t>(head.width) * static_cast<uint64_t>(head.height);
    if (padded(pixels) > saved.size()) return {};
    DensityGrid map{.x0 = head.x0,
                    .z0 = head.z0,
                    .x1 = head.x1,
                    .z1 = head.z1,
                    .low = head.low,
                    .high = head.high,
                    .width = head.width,
                    .height = head.height,
                    .weights = {saved.data(), saved.data() + pixels}};
    saved = saved.subspan(padded(pixels));
    if (!path::check_density(map)) return {};
    classes.push_back({static_cast<size_t>(head.body),
                       std::make_shared<const path::DensityCells>(std::move(map))});
  }
  return classes;
}

}  // namespace throng::crowd
