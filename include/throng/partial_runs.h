// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <bit>
#include <cstdint>

namespace throng {

/// Calls visit(s, t, count) for each run of cells in a row of a partial node (NodeInfo::cells,
/// Nodes::partial_cells): `count` cells along s from (s, t) of its block of 8 x 8 on.
template <class Visit>
void for_partial_runs(uint64_t cells, Visit visit) {
  for (int32_t t = 0; t < 8; ++t) {
    for (auto row = static_cast<uint32_t>(cells >> (8 * t) & 0xff); row != 0;) {
      const int32_t s = std::countr_zero(row), count = std::countr_one(row >> s);
      visit(s, t, count);
      row &= ~(((1u << count) - 1) << s);
    }
  }
}

}  // namespace throng
