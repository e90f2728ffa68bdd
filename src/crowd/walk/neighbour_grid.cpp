// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "crowd/walk/neighbour_grid.h"

#include <algorithm>
#include <bit>

#include "core/parallel.h"

// Sorts bodies by square with a counting sort, in parallel parts. Linear in the bodies and squares.
namespace throng::crowd {
namespace {

constexpr size_t kReadMargin = 64;  // entries that a vector may read past the end
constexpr size_t kMin = 16384;      // squares of a table, however few bodies there are
constexpr size_t kMaxParts = 4;     // of the bodies: each has a table while they are sorted

uint32_t squares_of(int32_t cells, int32_t square) {
  return std::max(8u, std::bit_ceil(static_cast<uint32_t>(cells / square) + 1));
}

}  // namespace

NeighbourGrid::NeighbourGrid(int32_t width, int32_t depth, int64_t sight, size_t bodies)
    : squares_(std::clamp(static_cast<int32_t>(((sight + 1) / kRange >> world::kUnitBits) + 1), 1,
                          4096)) {
  uint32_t across = squares_of(width, squares_.cells()), down = squares_of(depth, squares_.cells());
  const size_t max_squares = std::max(kMin, std::bit_floor(bodies - bodies / 4));
  while (size_t{across} * down > max_squares && across * down > 64) {
    (across > down ? across : down) /= 2;
  }
  across = std::max(across, 8u);
  down = std::max(down, 8u);
  bits_x_ = static_cast<uint32_t>(std::countr_zero(across));
  mask_x_ = across - 1;
  mask_z_ = down - 1;
  first_.resize(size_t{across} * down + 1);
  for (HugeArray<int32_t>* places : {&x_, &z_, &y_})
    *places = HugeArray<int32_t>(bodies + kReadMargin);
}

void NeighbourGrid::sort(std::span<const Body> bodies, std::span<Body> sorted, int32_t workers) {
  const auto parts = std::min(kMaxParts, static_cast<size_t>(worker_count(workers)));
  const size_t squares = first_.size() - 1;
  next_.resize(parts);
  const auto begin_of = [&](size_t part) { return bodies.size() * part / parts; };
  parallel_for(parts, workers, [&](size_t part) {
    next_[part].assign(squares, 0);
    for (size_t i = begin_of(part); i < begin_of(part + 1); ++i) ++next_[part][square(bodies[i])];
  });
  uint32_t before = 0;
  for (size_t s = 0; s < squares; ++s) {
    first_[s] = before;
    for (std::vector<uint32_t>& next : next_) {
      const uint32_t count = next[s];
      next[s] = before;
      before += count;
    }
  }
  first_[squares] = before;
  parallel_for(parts, workers, [&](size_t part) {
    for (size_t i = begin_of(part); i < begin_of(part + 1); ++i) {
      const Body& body = bodies[i];
      const uint32_t to = next_[part][square(body)]++;
      sorted[to] = body;
      x_[to] = body.x;
      z_[to] = body.z;
      y_[to] = body.y;
    }
  });
}

NeighbourGrid::Around NeighbourGrid::around(uint32_t square, uint32_t range) const {
  const uint32_t x = square & mask_x_, z = square >> bits_x_;
  const uint32_t left = (x - range) & mask_x_, right = (x + range) & mask_x_;
  Around pieces;
  for (uint32_t row = 0; row < 2 * range + 1; ++row) {
    const uint32_t base = ((z + row - range) & mask_z_) << bits_x_;
    if (left <= right) {
      pieces.add({first_[base + left], first_[base + right + 1]});
    } else {
      pieces.add({first_[base + left], first_[base + mask_x_ + 1]});
      pieces.add({first_[base], first_[base + right + 1]});
    }
  }
  return pieces;
}

uint64_t NeighbourGrid::bytes() const {
  uint64_t bytes = first_.capacity() * sizeof(uint32_t) + 3 * x_.size() * sizeof(int32_t);
  for (const auto& next : next_) bytes += next.capacity() * sizeof(uint32_t);
  return bytes;
}

}  // namespace throng::crowd
