// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <numeric>
#include <string>
#include <unordered_set>
#include <utility>
#include <vector>

#include "core/access.h"
#include "core/arrays/disjoint_sets.h"
#include "core/check_class.h"
#include "throng/bake.h"

// The legal cells of a class as polygons: runs of cells in rows, and runs that share a side are one
// piece (disjoint sets). Each border is traced with the piece on its right (x to the right, z
// down). Where two of its cells touch at a corner only, the trace continues along the other cell:
// what they enclose is a hole that touches the outer ring in a point, and no ring touches itself,
// as polygons must. Time: linear in the cells, times the logarithm of the runs in a row along
// borders.
namespace throng {
namespace {

struct Run {
  int32_t first = 0, last = 0;  // cells [first, last)
  uint32_t piece = 0;
};

class Plane {
 public:
  Plane(int64_t width, int64_t depth) : width_(width), bits_(words(width, depth)) {
    rows_.resize(static_cast<size_t>(depth));
  }
  void set(int64_t x, int64_t z) { bits_[bit(x, z) / 64] |= uint64_t{1} << bit(x, z) % 64; }

  // Turns the cells into runs and labels these by piece. Returns the number of pieces.
  uint32_t find_pieces();
  [[nodiscard]] const std::vector<std::vector<Run>>& rows() const { return rows_; }
  [[nodiscard]] bool in_piece(int32_t x, int32_t z, uint32_t piece) const;

 private:
  static size_t words(int64_t width, int64_t depth) {
    return static_cast<size_t>((width * depth + 63) / 64);
  }
  [[nodiscard]] size_t bit(int64_t x, int64_t z) const {
    return static_cast<size_t>(z * width_ + x);
  }
  [[nodiscard]] bool is_set(int64_t x, int64_t z) const {
    return (bits_[bit(x, z) / 64] >> bit(x, z) % 64 & 1) != 0;
  }

  int64_t width_;
  std::vector<uint64_t> bits_;
  std::vector<std::vector<Run>> rows_;
};

uint32_t Plane::find_pieces() {
  uint32_t count = 0;
  for (size_t z = 0; z < rows_.size(); ++z) {
    for (int64_t x = 0; x < width_; ++x) {
      if (!is_set(x, static_cast<int64_t>(z))) continue;
      const int64_t first = x;
      while (x < width_ && is_set(x, static_cast<int64_t>(z))) ++x;
      rows_[z].push_back({static_cast<int32_t>(first), static_cast<int32_t>(x), count++});
    }
  }
  DisjointSets sets(count);
  for (size_t z = 1; z < rows_.size(); ++z) {
    const auto& above = rows_[z - 1];
    size_t a = 0;
    for (const Run& run : rows_[z]) {
      while (a < above.size() && above[a].last <= run.first) ++a;
      for (size_t k = a; k < above.size() && above[k].first < run.last; ++k) {
        sets.join(above[k].piece, run.piece);
      }
    }
  }
  std::vector<uint32_t> number(count, UINT32_MAX);
  uint32_t pieces = 0;
  for (auto& row : rows_) {
    for (Run& run : row) {
      uint32_t& piece = number[sets.find(run.piece)];
      if (piece == UINT32_MAX) piece = pieces++;
      run.piece = piece;
    }
  }
  return pieces;
}

bool Plane::in_piece(int32_t x, int32_t z, uint32_t piece) const {
  if (z < 0 || z >= static_cast<int32_t>(rows_.size())) return false;
  const auto& row = rows_[static_cast<size_t>(z)];
  const auto after = std::upper_bound(row.begin(), row.end(), x,
                                      [](int32_t at, const Run& run) { return at < run.first; });
  return after != row.begin() && x < std::prev(after)->last && std::prev(after)->piece == piece;
}

struct Corner {
  int32_t x = 0, z = 0;
};

// The rings of all pieces, in corners of cells.
class Tracer {
 public:
  explicit Tracer(const Plane& plane) : plane_(plane) {}

  // Calls take(piece, ring) once for each ring.
  template <class Take>
  void trace(Take take) {
    const auto depth = static_cast<int32_t>(plane_.rows().size());
    for (int32_t z = 0; z < depth; ++z) {
      for (const Run& run : plane_.rows()[static_cast<size_t>(z)]) {
        for (int32_t x = run.first; x < run.last; ++x) {
          if (plane_.in_piece(x, z - 1, run.piece) || walked_.contains(key(x, z))) continue;
          take(run.piece, walk(x, z, run.piece));
        }
      }
    }
  }

 private:
  static uint64_t key(int32_t x, int32_t z) {
    return uint64_t{static_cast<uint32_t>(z)} << 32 | static_cast<uint32_t>(x);
  }

  // From the upper side of cell (x, z) around and back to it.
  std::vector<Corner> walk(int32_t x, int32_t z, uint32_t piece) {
    std::vector<Corner> ring;
    Corner at{x, z};
    uint32_t direction = 0;  // +x, +z, -x, -z
    do {
      if (direction == 0) walked_.insert(key(at.x, at.z));
      constexpr int32_t kX[4] = {1, 0, -1, 0}, kZ[4] = {0, 1, 0, -1};
      at = {at.x + kX[direction], at.z + kZ[direction]};
      // The cells ahead, to the right (the piece's side) and to the left.
      constexpr Corner kRight[4] = {{0, 0}, {-1, 0}, {-1, -1}, {0, -1}};
      constexpr Corner kLeft[4] = {{0, -1}, {0, 0}, {-1, 0}, {-1, -1}};
      const auto ours = [&](Corner cell) {
        return plane_.in_piece(at.x + cell.x, at.z + cell.z, piece);
      };
      uint32_t next = direction;
      if (ours(kLeft[direction])) {
        next = (direction + 3) % 4;
      } else if (!ours(kRight[direction])) {
        next = (direction + 1) % 4;
      }
      if (next != direction) ring.push_back(at);
      direction = next;
    } while (at.x != x || at.z != z || direction != 0);
    return ring;
  }

  const Plane& plane_;
  std::unordered_set<uint64_t> walked_;  // upper sides of cells; the order is never used
};

}  // namespace

Result<std::vector<WalkablePiece>> walkable_pieces(const World& world, int32_t avatar_class,
                                                   double lowest, double highest,
                                                   Context& context) {
  if (data_of(world) == nullptr) return Error{Errc::kBadInput, "surface: the world is empty"};
  const WorldSummary summary = world.summary();
  if (auto ok = check_class(summary.classes, avatar_class, "surface"); !ok) return ok.error();
  if (auto ok = world.check_ground(); !ok) return ok.error();
  const int64_t width = int64_t{summary.tiles_x} * kTileCells;
  const int64_t depth = int64_t{summary.tiles_z} * kTileCells;
  if (width * depth > int64_t{1} << 32) {
    return Error{Errc::kLimit, "surface: more than 2^32 cells; bake a part of the world"};
  }
  Plane plane(width, depth);
  for (uint32_t level = 0; level < world.level_tile_count(); ++level) {
    if (level % 256 == 0) {
      if (context.on_progress) context.on_progress({"surface", level, world.level_tile_count()});
      if (context.cancel) return Error{Errc::kCancelled, "surface: cancelled"};
    }
    const LevelTileContent tile = world.level_tile(level);
    const auto& legal = tile.clearance[static_cast<size_t>(avatar_class)];
    for (int32_t c = 0; c < kTileCells * kTileCells; ++c) {
      const double height = summary.origin.y + tile.floor[static_cast<size_t>(c)] * 1e-3;
      if (legal[static_cast<size_t>(c)] == 0 || height < lowest || height > highest) continue;
      plane.set(int64_t{tile.tile_x} * kTileCells + c % kTileCells,
                int64_t{tile.tile_z} * kTileCells + c / kTileCells);
    }
  }

  std::vector<WalkablePiece> pieces(plane.find_pieces());
  Tracer(plane).trace([&](uint32_t piece, const std::vector<Corner>& corners) {
    Ring ring;
    int64_t twice = 0;  // its area in cells, negative for a hole
    for (size_t i = 0; i < corners.size(); ++i) {
      const Corner a = corners[i], b = corners[(i + 1) % corners.size()];
      twice += int64_t{a.x} * b.z - int64_t{b.x} * a.z;
      ring.push_back(
          {summary.origin.x + a.x * summary.cell, summary.origin.z + a.z * summary.cell});
    }
    WalkablePiece& to = pieces[piece];
    to.area += static_cast<double>(twice) / 2 * summary.cell * summary.cell;
    if (twice > 0) {
      to.polygon.outer = std::move(ring);
    } else {
      to.polygon.holes.push_back(std::move(ring));
    }
  });
  std::stable_sort(pieces.begin(), pieces.end(),
                   [](const WalkablePiece& a, const WalkablePiece& b) { return a.area > b.area; });
  return pieces;
}

std::string to_wkt(const Polygon& polygon) {
  fmt::memory_buffer text;
  const auto add = [&](const Ring& ring) {
    fmt::format_to(std::back_inserter(text), "(");
    for (const auto& [x, z] : ring) {
      fmt::format_to(std::back_inserter(text), "{:.3f} {:.3f}, ", x, z);
    }
    if (!ring.empty()) {
      fmt::format_to(std::back_inserter(text), "{:.3f} {:.3f})", ring[0][0], ring[0][1]);
    }
  };
  fmt::format_to(std::back_inserter(text), "POLYGON (");
  add(polygon.outer);
  for (const Ring& hole : polygon.holes) {
    fmt::format_to(std::back_inserter(text), ", ");
    add(hole);
  }
  fmt::format_to(std::back_inserter(text), ")");
  return fmt::to_string(text);
}

}  // namespace throng
