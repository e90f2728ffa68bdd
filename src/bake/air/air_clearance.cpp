// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "bake/air/air_clearance.h"

#include <algorithm>
#include <bit>
#include <vector>

#include "core/parallel.h"

// Distances in the plane count rows and columns alike (the larger of the two): a cell is at most r
// from a solid if the square of r cells around it holds some. So solids grow by a cell all around,
// 64 cells at a time, and reach the cells in order of distance; squares of 4 x 4 cells keep the
// smallest, as no air box is smaller or lies across them. The same distances as the sweeps of
// [RP66], which go from cell to cell.
namespace throng::bake {
namespace {

// Per layer and square: the distance from its cells to the nearest one that is not free; 0 if one
// of them is not, 1 if one beside them. At most 1 more than the clearance that can be promised.
class Distances {
 public:
  Distances(const world::AirTreeSource& source, int32_t apron, int32_t workers)
      : side_(source.side / 4), height_(source.rows->height), base_(source.base) {
    distances_.resize(static_cast<size_t>(side_) * static_cast<size_t>(side_) *
                      static_cast<size_t>(height_));
    max_distance_ = std::min(apron, world::kMaxAirClearance);
    pad_ = (max_distance_ + 3) & -4;
    words_ = static_cast<size_t>((source.side + 2 * pad_ + 63) / 64);
    rows_ = static_cast<size_t>(source.side + 2 * max_distance_);
    std::vector<Layer> layers(static_cast<size_t>(worker_count(workers)));
    parallel_for_worker(static_cast<size_t>(height_), workers, [&](size_t y, int32_t worker) {
      grow(source, static_cast<int32_t>(y), layers[static_cast<size_t>(worker)]);
    });
  }

  /// Over all cells of an air box's footprint, in one layer of the world. Layers over and under the
  /// rows are like the highest of them: without a solid, but no wider than what is known.
  [[nodiscard]] int32_t distance(const world::AirCube& cube, int32_t y) const {
    const int32_t row = y < base_ || y >= base_ + height_ ? height_ - 1 : y - base_;
    int32_t min_distance = max_distance_ + 1;
    for (int32_t z = cube.z / 4; z < (cube.z + cube.side) / 4; ++z) {
      for (int32_t x = cube.x / 4; x < (cube.x + cube.side) / 4; ++x) {
        min_distance = std::min<int32_t>(min_distance, distances_[index(x, row, z)]);
      }
    }
    return min_distance;
  }

 private:
  [[nodiscard]] size_t index(int32_t x, int32_t y, int32_t z) const {
    return (static_cast<size_t>(y) * static_cast<size_t>(side_) + static_cast<size_t>(z)) *
               static_cast<size_t>(side_) +
           static_cast<size_t>(x);
  }

  // Solids of one layer as bits, `rows_` by `words_`: the zone and `max_distance_` rows around, and
  // so many columns that its squares stay within half bytes.
  struct Layer {
    std::vector<uint64_t> solid, wide;
    std::vector<uint64_t> known;  // by row of squares, a bit for each: its distance is written
  };

  // 64 columns from x on; what lies beside the rows is free.
  static uint64_t solid_at(const world::AirRows& rows, const uint64_t* row, int32_t x) {
    const auto word = [&](int32_t w) {
      if (w < 0 || w >= rows.words) return uint64_t{0};
      const int32_t left = rows.width - 64 * w;
      return ~row[w] & (left < 64 ? (uint64_t{1} << left) - 1 : ~uint64_t{0});
    };
    const int32_t first = x >> 6, off = x & 63;
    return off == 0 ? word(first) : word(first) >> off | word(first + 1) << (64 - off);
  }

  void grow(const world::AirTreeSource& source, int32_t y, Layer& layer) {
    const world::AirRows& rows = *source.rows;
    layer.solid.resize(rows_ * words_);
    layer.wide.resize(rows_ * words_);
    uint64_t any = 0;
    for (size_t z = 0; z < rows_; ++z) {
      const uint64_t* row = rows.row(y, source.z - max_distance_ + static_cast<int32_t>(z));
      for (size_t w = 0; w < words_; ++w) {
        const int32_t x = source.x - pad_ + 64 * static_cast<int32_t>(w);
        any |= layer.solid[z * words_ + w] = solid_at(rows, row, x);
      }
    }
    std::fill_n(distances_.begin() + static_cast<ptrdiff_t>(index(0, y, 0)),
                static_cast<size_t>(side_) * static_cast<size_t>(side_),
                static_cast<uint8_t>(max_distance_ + 1));
    if (any == 0) return;
    layer.known.assign(static_cast<size_t>(side_) * words_, 0);
    size_t left = static_cast<size_t>(side_) * static_cast<size_t>(side_);
    for (int32_t r = 0; r <= max_distance_ && left > 0; ++r) {
      if (r > 0) widen(layer);
      left -= note(r, y, layer);
    }
  }

  // By one cell along x, then along z.
  void widen(Layer& layer) const {
    for (size_t z = 0; z < rows_; ++z) {
      const uint64_t* in = &layer.solid[z * words_];
      uint64_t* out = &layer.wide[z * words_];
      for (size_t w = 0; w < words_; ++w) {
        const uint64_t before = w > 0 ? in[w - 1] >> 63 : 0;
        const uint64_t after = w + 1 < words_ ? in[w + 1] << 63 : 0;
        out[w] = in[w] | in[w] << 1 | in[w] >> 1 | before | after;
      }
    }
    for (size_t z = 0; z < rows_; ++z) {
      const uint64_t* here = &layer.wide[z * words_];
      const uint64_t* before = z > 0 ? here - words_ : here;
      const uint64_t* after = z + 1 < rows_ ? here + words_ : here;
      uint64_t* out = &layer.solid[z * words_];
      for (size_t w = 0; w < words_; ++w) out[w] = before[w] | here[w] | after[w];
    }
  }

  // Writes the distance of squares that solids have grown into. Returns how many.
  size_t note(int32_t r, int32_t y, Layer& layer) {
    size_t found = 0;
    for (int32_t z = 0; z < side_; ++z) {
      const uint64_t* rows = &layer.solid[static_cast<size_t>(max_distance_ + 4 * z) * words_];
      uint64_t* known = &layer.known[static_cast<size_t>(z) * words_];
      for (size_t w = 0; w < words_; ++w) {
        uint64_t met = rows[w] | rows[words_ + w] | rows[2 * words_ + w] | rows[3 * words_ + w];
        met |= met >> 1;
        met = (met | met >> 2) & 0x1111111111111111 & ~known[w];
        known[w] |= met;
        for (; met != 0; met &= met - 1) {
          const int32_t x = (64 * static_cast<int32_t>(w) + std::countr_zero(met) - pad_) / 4;
          if (x < 0 || x >= side_ || 64 * static_cast<int32_t>(w) + std::countr_zero(met) < pad_) {
            continue;
          }
          distances_[index(x, y, z)] = static_cast<uint8_t>(r);
          ++found;
        }
      }
    }
    return found;
  }

  int32_t side_, height_, base_;
  int32_t max_distance_ = 0;
  int32_t pad_ = 0;              // columns before the zone's in a layer's bits
  size_t rows_ = 0, words_ = 0;  // of a layer's bits
  std::vector<uint8_t> distances_;
};

class ClearanceWriter {
 public:
  ClearanceWriter(const Distances& distances, world::AirTreeData& tree)
      : distances_(distances), tree_(tree) {}

  void write(const world::AirCube& cube, size_t node) {
    const uint32_t word = tree_.nodes[node];
    if (world::air_kind(word) == world::AirKind::kFree) {
      tree_.nodes[node] =
          world::air_word(world::AirKind::kFree, world::air_clearance_number(clearance(cube)));
    }
    if (world::air_kind(word) != world::AirKind::kInner) return;
    const int32_t half = cube.side / 2;
    for (int32_t c = 0; c < 8; ++c) {
      write({cube.x + (c & 1) * half, cube.y + (c >> 1 & 1) * half, cube.z + (c >> 2) * half, half},
            world::air_number(word) + static_cast<size_t>(c));
    }
  }

 private:
  [[nodiscard]] world::AirClearance clearance(const world::AirCube& cube) const {
    world::AirClearance found{.width = world::kMaxAirClearance, .height = 0};
    for (int32_t y = cube.y; y < cube.y + cube.side; ++y) {
      found.width = std::min(found.width, distances_.distance(cube, y) - 1);
    }
    const int32_t top = cube.y + cube.side;
    while (found.height < world::kMaxAirClearance &&
           distances_.distance(cube, top + found.height) > found.width) {
      ++found.height;
    }
    return found;
  }

  const Distances& distances_;
  world::AirTreeData& tree_;
};

}  // namespace

void measure_clearance(const world::AirTreeSource& source, int32_t apron, int32_t workers,
                       world::AirTreeData& tree) {
  const Distances distances(source, apron, workers);
  ClearanceWriter writer(distances, tree);
  for (uint32_t r = 0; r < tree.roots; ++r) {
    writer.write({0, tree.base + static_cast<int32_t>(r) * tree.side, 0, tree.side}, r);
  }
}

}  // namespace throng::bake
