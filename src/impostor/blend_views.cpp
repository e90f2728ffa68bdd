// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "impostor/blend_views.h"

#include <algorithm>
#include <cmath>

#include "impostor/choose_view.h"

// Blends the views around the direction to the eye by how near it is to the borders between them.
namespace throng::impostor {
namespace {

constexpr uint32_t kWhole = 256;  // Of a share.

// Two neighbours and the share of the second, or the same view twice.
struct Between {
  uint32_t first = 0, second = 0;
  uint32_t share = 0;
  [[nodiscard]] bool is_one() const { return first == second; }
};

// `fine`: 65536 a view, a border at each multiple. Within half of `band` of a border both views
// show.
Between between(uint32_t fine, float band, uint32_t count, bool circle) {
  const uint32_t at = fine >> 16;
  const float in = static_cast<float>(fine & 0xffffU) / 65536.0F;
  const bool is_upper = in < 0.5F;
  const float past = is_upper ? in : in - 1;  // The border.
  const float share = std::clamp(0.5F + past / std::max(band, 1e-6F), 0.0F, 1.0F);
  const auto part = static_cast<uint32_t>(share * kWhole + 0.5F);
  const bool ends = !circle && (is_upper ? at == 0 : at + 1 == count);
  if (ends || part == 0 || part == kWhole) return {at, at, 0};
  return is_upper ? Between{(at + count - 1) % count, at, part}
                  : Between{at, (at + 1) % count, part};
}

}  // namespace

size_t write_blends(const PackShared& s, const BlendShape& shape, const PackInput& in,
                    PackBlock& block, BlendedInstance* out) {
  const uint32_t sectors = 2 * s.directions;
  size_t written = 0;
  for (size_t i = 0; i < in.count; ++i) {
    if ((block.seen[i] & kSeenBetween) == 0) continue;
    const float x = block.to_x[i], y = block.to_y[i], z = block.to_z[i];
    const float flat = std::sqrt(x * x + z * z), far = std::sqrt(x * x + y * y + z * z);
    const float band = shape.share * std::clamp(5 * (1 - far / shape.far), 0.0F, 1.0F);
    const Between column = between(fine_sector(x, z, in.heading[i], sectors), band, sectors, true);
    const Between row = between(fine_row(flat, y, s.rows), band, s.rows, false);
    if (row.is_one() && column.is_one()) {
      block.seen[i] |= kSeenByView;
      continue;
    }
    uint32_t frame = (in.phase[i] * s.frames + 32768) >> 16;
    frame = frame >= s.frames ? frame - s.frames : frame;
    const uint32_t turned = half_cycle_on(frame, s.frames);
    const auto view = [&](uint32_t sector, uint32_t in_row) {
      const uint32_t mirrored = sector >= s.directions ? 1 : 0;
      const uint32_t col = mirrored != 0 ? sectors - 1 - sector : sector;
      const uint32_t shown = (mirrored != 0 ? turned : frame) + s.first_frame;
      return ((shown * s.rows + in_row) * s.directions + col) | mirrored << 20;
    };
    const uint32_t look = static_cast<uint32_t>(in.look[i]) << 21;
    out[written++] = {{in.x[i], in.y[i], in.z[i], view(column.first, row.first) | look},
                      {view(column.second, row.first), view(column.first, row.second),
                       view(column.second, row.second)},
                      column.share | row.share << 9};
  }
  return written;
}

}  // namespace throng::impostor
