// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "crowd/ground/level_line.h"

#include <cstddef>

// Bits of 4 x 4 blocks out of 64 rows of cells. Constant time.
namespace throng::crowd {

std::array<uint16_t, 16> full_blocks(const uint64_t* rows) {
  std::array<uint16_t, 16> blocks{};
  for (size_t z = 0; z < 16; ++z) {
    uint64_t all = rows[4 * z] & rows[4 * z + 1] & rows[4 * z + 2] & rows[4 * z + 3];
    all &= all >> 1;
    all &= all >> 2;  // bit 4 x: four cells in a row, four rows deep
    for (size_t x = 0; x < 16; ++x) {
      blocks[z] = static_cast<uint16_t>(blocks[z] | ((all >> (4 * x)) & 1) << x);
    }
  }
  return blocks;
}

}  // namespace throng::crowd
