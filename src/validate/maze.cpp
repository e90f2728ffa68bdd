// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "validate/maze.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

#include "core/random.h"

// A random spanning tree of the blocks (Kruskal's, with edges in random order), and some of the
// edges that it leaves out. Where no passing place and no corridor is, boxes stand.
namespace throng::validate {
namespace {

constexpr uint32_t kBlocks = 8;         // along each side of the maze
constexpr size_t kMinPlaces = 36;       // passing places
constexpr double kShareOfLoops = 0.1;   // of the edges outside the tree
constexpr double kShareOfPlaces = 0.5;  // of the blocks that a corridor only leads through
constexpr int32_t kCellsInMetre = 20;   // Walls lie on the cells of the tests' worlds.
constexpr int32_t kHalfBlock = 24;      // [cells] from its middle
constexpr int32_t kHalfCorridor = 6;    // [cells]
constexpr int32_t kHalfPlace = 14;      // [cells]
enum Stream : uint64_t { kEdgeStream = 1, kLoopStream, kPlaceStream, kTripStream, kShiftStream };

// The open sides of a block: towards +x, +z, -x, -z.
struct Block {
  std::array<bool, 4> open{};

  [[nodiscard]] int64_t degree() const { return std::count(open.begin(), open.end(), true); }
};

// Between a block and the next one along an axis: 0 for x, 1 for z.
struct Edge {
  uint32_t block = 0, next = 0;
  size_t axis = 0;
};

template <class T>
void shuffle(std::vector<T>& all, uint64_t seed, uint64_t stream) {
  for (size_t n = all.size(); n > 1; --n) {
    std::swap(all[n - 1], all[random_below(seed, stream, n, n)]);
  }
}

std::vector<Edge> edges_in_random_order(uint64_t seed) {
  std::vector<Edge> edges;
  for (uint32_t z = 0; z < kBlocks; ++z) {
    for (uint32_t x = 0; x < kBlocks; ++x) {
      const uint32_t block = z * kBlocks + x;
      if (x + 1 < kBlocks) edges.push_back({block, block + 1, 0});
      if (z + 1 < kBlocks) edges.push_back({block, block + kBlocks, 1});
    }
  }
  shuffle(edges, seed, kEdgeStream);
  return edges;
}

std::vector<Block> connected_blocks(uint64_t seed) {
  std::vector<Block> blocks(kBlocks * kBlocks);
  std::vector<uint32_t> component(blocks.size());
  std::iota(component.begin(), component.end(), 0U);
  uint64_t n = 0;
  for (const Edge& edge : edges_in_random_order(seed)) {
    const uint32_t from = component[edge.block], to = component[edge.next];
    if (from == to && random_unit(seed, kLoopStream, n++) >= kShareOfLoops) continue;
    std::replace(component.begin(), component.end(), to, from);
    blocks[edge.block].open[edge.axis] = true;
    blocks[edge.next].open[edge.axis + 2] = true;
  }
  return blocks;
}

std::vector<uint8_t> passing_places(const std::vector<Block>& blocks, uint64_t seed) {
  std::vector<uint8_t> is_place(blocks.size(), 0);
  for (size_t b = 0; b < blocks.size(); ++b) {
    const bool leads_through = blocks[b].degree() == 2;
    is_place[b] = !leads_through || random_unit(seed, kPlaceStream, b) < kShareOfPlaces ? 1 : 0;
  }
  auto count = static_cast<size_t>(std::count(is_place.begin(), is_place.end(), 1));
  for (size_t b = 0; b < blocks.size() && count < kMinPlaces; ++b) {
    if (is_place[b] != 0) continue;
    is_place[b] = 1;
    ++count;
  }
  return is_place;
}

// The middle of a block along an axis. [cells]
int32_t middle_of(uint32_t index) { return static_cast<int32_t>(2 * index + 1) * kHalfBlock; }

double metres(int32_t cells) { return static_cast<double>(cells) / kCellsInMetre; }

// Boxes around the middle of a block, from corner to corner. [cells]
class BlockBoxes {
 public:
  BlockBoxes(PlaneConfig& plane, int32_t x, int32_t z) : plane_(plane), x_(x), z_(z) {}

  void add(int32_t x0, int32_t z0, int32_t x1, int32_t z1) {
    plane_.obstacles.push_back(box(metres(x_ + std::min(x0, x1)), metres(z_ + std::min(z0, z1)),
                                   metres(x_ + std::max(x0, x1)), metres(z_ + std::max(z0, z1))));
  }

 private:
  PlaneConfig& plane_;
  int32_t x_, z_;
};

// Fills what is neither the square in the middle, `half` from middle to side, nor a corridor.
void add_walls(const Block& block, int32_t half, BlockBoxes boxes) {
  constexpr int32_t kEnd = kHalfBlock, kSide = kHalfCorridor;
  for (const int32_t x : {-1, 1}) {  // each of the four corners
    for (const int32_t z : {-1, 1}) {
      boxes.add(x * kSide, z * half, x * kEnd, z * kEnd);
      if (half > kSide) boxes.add(x * half, z * kSide, x * kEnd, z * half);
    }
  }
  for (size_t side = 0; side < 4; ++side) {  // where no corridor leads on
    if (block.open[side]) continue;
    const int32_t sign = side < 2 ? 1 : -1;
    if (side % 2 == 0) boxes.add(sign * half, -kSide, sign * kEnd, kSide);
    if (side % 2 == 1) boxes.add(-kSide, sign * half, kSide, sign * kEnd);
  }
}

}  // namespace

Maze make_maze(uint64_t seed) {
  const std::vector<Block> blocks = connected_blocks(seed);
  const std::vector<uint8_t> is_place = passing_places(blocks, seed);
  Maze maze;
  const double end = metres(2 * kHalfBlock * static_cast<int32_t>(kBlocks));
  maze.plane.ground = box(0, 0, end, end);
  for (uint32_t b = 0; b < blocks.size(); ++b) {
    const int32_t x = middle_of(b % kBlocks), z = middle_of(b / kBlocks);
    const int32_t half = is_place[b] != 0 ? kHalfPlace : kHalfCorridor;
    add_walls(blocks[b], half, BlockBoxes(maze.plane, x, z));
    if (is_place[b] != 0) maze.places.push_back({metres(x), metres(z)});
  }
  return maze;
}

Trips maze_trips(const Maze& maze, uint64_t people, uint64_t seed) {
  std::vector<size_t> order(maze.places.size());
  std::iota(order.begin(), order.end(), size_t{0});
  shuffle(order, seed, kTripStream);
  const uint64_t shift = 1 + random_below(seed, kShiftStream, 0, order.size() - 1);
  Trips trips;
  for (uint64_t n = 0; n < people; ++n) {
    trips.starts.push_back(maze.places[order[n]]);
    trips.goals.push_back(maze.places[order[(n + shift) % order.size()]]);
  }
  return trips;
}

}  // namespace throng::validate
