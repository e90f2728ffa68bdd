// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "graph/ground_parts.h"

#include <array>
#include <bit>
#include <cstdlib>

// Unpacks where a class may stand on a level, and finds steps between its cells. Linear in the
// cells.
namespace throng::graph {

world::CellRows legal_rows(const world::GroundLevel& level) {
  world::CellRows rows{};
  if (level.kind == format::CellsKind::All) rows.fill(~uint64_t{0});
  if (level.legal != nullptr) world::unpack_bits(level.legal, rows);
  return rows;
}

std::optional<StepCuts> step_cuts(const world::GroundLevel& level, const world::CellRows& legal,
                                  int32_t step) {
  if (level.step_safe || level.kind == format::CellsKind::None) return std::nullopt;
  StepCuts cuts;
  std::array<uint16_t, world::kBlocks * 64> samples;
  world::LevelView view = level.view;
  if (view.floor != nullptr && view.samples == nullptr) {
    world::unpack_floor(view, samples.data());
    view.samples = samples.data();
  }
  const auto is_high = [&](int32_t x, int32_t z, int32_t nx, int32_t nz) {
    return std::abs(view.sample(x, z) - view.sample(nx, nz)) > step;
  };
  for (int32_t z = 0; z < 64; ++z) {
    const auto row = static_cast<size_t>(z);
    for (uint64_t pairs = legal[row] & (legal[row] >> 1); pairs != 0; pairs &= pairs - 1) {
      const int32_t x = std::countr_zero(pairs);
      if (is_high(x, z, x + 1, z)) cuts.across[row] |= uint64_t{1} << x;
    }
    if (z == 63) break;
    for (uint64_t pairs = legal[row] & legal[row + 1]; pairs != 0; pairs &= pairs - 1) {
      const int32_t x = std::countr_zero(pairs);
      if (is_high(x, z, x, z + 1)) cuts.along[row] |= uint64_t{1} << x;
    }
  }
  return cuts;
}

}  // namespace throng::graph
