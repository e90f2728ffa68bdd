// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "path/ground/rects.h"

#include <algorithm>
#include <bit>

// Greedy: runs of cells, stacked while they are alike, by rows and by columns; the fewer rectangles
// win. Linear in the tile's cells.
namespace throng::path {
namespace {

world::CellRows transposed(const world::CellRows& rows) {
  world::CellRows out{};
  for (size_t z = 0; z < 64; ++z) {
    for (uint64_t left = rows[z]; left != 0; left &= left - 1)
      out[static_cast<size_t>(std::countr_zero(left))] |= uint64_t{1} << z;
  }
  return out;
}

// The run of row z that begins at x, cut where no step leads on.
uint64_t run_from(const world::CellRows& open, const graph::StepCuts* cuts, size_t z, int32_t x) {
  uint64_t ends = ~open[z];
  // A cut after cell i ends the run before cell i + 1.
  if (cuts != nullptr) ends |= cuts->across[z] << 1;
  const uint64_t from = ~uint64_t{0} << x;
  ends &= from & ~(uint64_t{1} << x);
  const int32_t end = ends == 0 ? 64 : std::countr_zero(ends);
  return end == 64 ? from : from & ((uint64_t{1} << end) - 1);
}

// True if the row's run that begins where `run` does is `run` itself.
bool continues(const world::CellRows& open, const graph::StepCuts* cuts, size_t z, uint64_t run) {
  const int32_t x = std::countr_zero(run);
  const uint64_t before = x > 0 ? uint64_t{1} << (x - 1) : 0;
  if ((open[z] & run) != run) return false;
  const bool joined =
      (open[z] & before) != 0 && (cuts == nullptr || (cuts->across[z] & before) == 0);
  return !joined && run_from(open, cuts, z, x) == run;
}

std::vector<CellRect> stack_rows(const world::CellRows& open, const graph::StepCuts* cuts) {
  std::vector<CellRect> rects;
  world::CellRows left = open;
  for (size_t z = 0; z < 64; ++z) {
    while (left[z] != 0) {
      const uint64_t run = run_from(left, cuts, z, std::countr_zero(left[z]));
      size_t end = z + 1;
      left[z] &= ~run;
      while (end < 64 && continues(left, cuts, end, run) &&
             (cuts == nullptr || (cuts->along[end - 1] & run) == 0)) {
        left[end++] &= ~run;
      }
      const int32_t x = std::countr_zero(run);
      rects.push_back(
          {x, static_cast<int32_t>(z), x + std::popcount(run), static_cast<int32_t>(end)});
    }
  }
  return rects;
}

}  // namespace

std::vector<CellRect> tile_with_rects(const world::CellRows& open, const graph::StepCuts* cuts) {
  std::vector<CellRect> rects = stack_rows(open, cuts);
  if (rects.size() < 2) return rects;
  graph::StepCuts turned;
  if (cuts != nullptr) turned = {transposed(cuts->along), transposed(cuts->across)};
  std::vector<CellRect> columns = stack_rows(transposed(open), cuts != nullptr ? &turned : nullptr);
  if (columns.size() >= rects.size()) return rects;
  for (CellRect& rect : columns) rect = {rect.z0, rect.x0, rect.z1, rect.x1};
  std::sort(columns.begin(), columns.end(), [](const CellRect& a, const CellRect& b) {
    return a.z0 != b.z0 ? a.z0 < b.z0 : a.x0 < b.x0;
  });
  return columns;
}

}  // namespace throng::path
