// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "bake/air_room.h"

#include <algorithm>
#include <vector>

#include "core/parallel.h"

// Distances in the plane count rows and columns alike (the larger of the two), so two sweeps over a
// layer give them exactly; squares of 4 x 4 cells keep the smallest, as no cube is smaller or
// lies across them. Source: [RP66].
namespace throng {
namespace {

// Per layer and square: the distance from its cells to the nearest one that is not free; 0 if one
// of them is not, 1 if one beside them. At most 1 more than the room that can be promised.
class Distances {
 public:
  Distances(const AirTreeSource& source, int32_t apron, int32_t workers)
      : side_(source.side / 4), height_(source.rows->height), base_(source.base) {
    distances_.resize(static_cast<size_t>(side_) * static_cast<size_t>(side_) *
                      static_cast<size_t>(height_));
    most_ = std::min(apron, kMostAirRoom);
    std::vector<std::vector<uint8_t>> layers(static_cast<size_t>(worker_count(workers)));
    parallel_for_worker(static_cast<size_t>(height_), workers, [&](size_t y, int32_t worker) {
      sweep(source, apron, static_cast<int32_t>(y), layers[static_cast<size_t>(worker)]);
    });
  }

  /// Over all cells of a cube's footprint, in one layer of the world. Layers over and under the
  /// rows are like the highest of them: without matter, but no wider than what is known.
  [[nodiscard]] int32_t distance(const AirCube& cube, int32_t y) const {
    const int32_t row = y < base_ || y >= base_ + height_ ? height_ - 1 : y - base_;
    int32_t least = most_ + 1;
    for (int32_t z = cube.z / 4; z < (cube.z + cube.side) / 4; ++z) {
      for (int32_t x = cube.x / 4; x < (cube.x + cube.side) / 4; ++x) {
        least = std::min<int32_t>(least, distances_[index(x, row, z)]);
      }
    }
    return least;
  }

 private:
  [[nodiscard]] size_t index(int32_t x, int32_t y, int32_t z) const {
    return (static_cast<size_t>(y) * static_cast<size_t>(side_) + static_cast<size_t>(z)) *
               static_cast<size_t>(side_) +
           static_cast<size_t>(x);
  }

  // `layer` holds one more than the width: 0 where a cell is not free.
  void sweep(const AirTreeSource& source, int32_t apron, int32_t y, std::vector<uint8_t>& layer) {
    const AirRows& rows = *source.rows;
    const int32_t side = source.side + 2 * apron;
    const auto far = static_cast<uint8_t>(most_ + 1);
    layer.resize(static_cast<size_t>(side) * static_cast<size_t>(side));
    const auto cell = [&](int32_t x, int32_t z) -> uint8_t& {
      return layer[static_cast<size_t>(z) * static_cast<size_t>(side) + static_cast<size_t>(x)];
    };
    for (int32_t z = 0; z < side; ++z) {
      for (int32_t x = 0; x < side; ++x) {
        const bool free = rows.is_free(source.x - apron + x, y, source.z - apron + z);
        cell(x, z) = free ? far : 0;
      }
    }
    const auto relax = [&](uint8_t& at, int32_t x, int32_t z) {
      if (x < 0 || z < 0 || x >= side || z >= side) return;
      at = std::min<uint8_t>(at, static_cast<uint8_t>(cell(x, z) + 1));
    };
    for (int32_t z = 0; z < side; ++z) {
      for (int32_t x = 0; x < side; ++x) {
        uint8_t& at = cell(x, z);
        if (at == 0) continue;
        relax(at, x - 1, z);
        for (int32_t i = -1; i <= 1; ++i) relax(at, x + i, z - 1);
      }
    }
    for (int32_t z = side; z-- > 0;) {
      for (int32_t x = side; x-- > 0;) {
        uint8_t& at = cell(x, z);
        if (at == 0) continue;
        relax(at, x + 1, z);
        for (int32_t i = -1; i <= 1; ++i) relax(at, x + i, z + 1);
      }
    }
    for (int32_t z = 0; z < side_; ++z) {
      for (int32_t x = 0; x < side_; ++x) {
        uint8_t least = far;
        for (int32_t i = 0; i < 16; ++i) {
          least = std::min(least, cell(apron + 4 * x + i % 4, apron + 4 * z + i / 4));
        }
        distances_[index(x, y, z)] = least;
      }
    }
  }

  int32_t side_, height_, base_;
  int32_t most_ = 0;
  std::vector<uint8_t> distances_;
};

class RoomWriter {
 public:
  RoomWriter(const Distances& distances, AirTreeData& tree) : distances_(distances), tree_(tree) {}

  void write(const AirCube& cube, size_t node) {
    const uint32_t word = tree_.nodes[node];
    if (air_kind(word) == AirKind::kFree) {
      tree_.nodes[node] = air_word(AirKind::kFree, air_room_number(room(cube)));
    }
    if (air_kind(word) != AirKind::kInner) return;
    const int32_t half = cube.side / 2;
    for (int32_t c = 0; c < 8; ++c) {
      write({cube.x + (c & 1) * half, cube.y + (c >> 1 & 1) * half, cube.z + (c >> 2) * half, half},
            air_number(word) + static_cast<size_t>(c));
    }
  }

 private:
  [[nodiscard]] AirRoom room(const AirCube& cube) const {
    AirRoom found{.width = kMostAirRoom, .height = 0};
    for (int32_t y = cube.y; y < cube.y + cube.side; ++y) {
      found.width = std::min(found.width, distances_.distance(cube, y) - 1);
    }
    const int32_t top = cube.y + cube.side;
    while (found.height < kMostAirRoom &&
           distances_.distance(cube, top + found.height) > found.width) {
      ++found.height;
    }
    return found;
  }

  const Distances& distances_;
  AirTreeData& tree_;
};

}  // namespace

void measure_room(const AirTreeSource& source, int32_t apron, int32_t workers, AirTreeData& tree) {
  const Distances distances(source, apron, workers);
  RoomWriter writer(distances, tree);
  for (uint32_t r = 0; r < tree.roots; ++r) {
    writer.write({0, tree.base + static_cast<int32_t>(r) * tree.side, 0, tree.side}, r);
  }
}

}  // namespace throng
