// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>

#include "core/random.h"
#include "import/builtin/builtin_table.h"

// Ground as [PACS00] has it: hills and plateaus of Bezier patches, cliffs between them, overhangs,
// and rocks and arches that are surfaces of their own and reach through the ground. The ground is a
// lattice of cells of about 32 m, each one bicubic patch through its four vertices with slopes from
// the vertices around (so that neighbours join smoothly), then cut into 1, 4 or 16 patches, whose
// inner vertices get relief of their own: hence edges with 1, 2 and 4 neighbours.
namespace throng::importer::builtin {
namespace {

constexpr double kCell = 32;

// The use of each random number.
enum Stream : uint64_t {
  kHills,
  kMounds,
  kPlateaus,
  kRamps,
  kBumps,
  kOverhangs,
  kCuts,
  kRelief,
  kKnolls,
  kRocks,
  kArches
};

double millimetres(double metres) { return std::floor(metres * 1000 + 0.5001) / 1000; }
Vec3d rounded(Vec3d p) { return {millimetres(p.x), millimetres(p.y), millimetres(p.z)}; }

uint64_t lattice_counter(int64_t i, int64_t j) {
  return static_cast<uint64_t>(j + (1 << 20)) << 24 | static_cast<uint64_t>(i + (1 << 20));
}

class Numbers {  // Of one thing in one cell.
 public:
  Numbers(uint64_t seed, Stream what, int64_t i, int64_t j)
      : seed_(seed), stream_(static_cast<uint64_t>(what) << 48 | lattice_counter(i, j)) {}
  double operator()(double low, double high) {
    return low + (high - low) * random_unit(seed_, stream_, counter_++);
  }

 private:
  uint64_t seed_;
  uint64_t stream_;
  uint64_t counter_ = 0;
};

// Value noise: random numbers in [-1, 1] at whole places, smooth between.
double noise(uint64_t seed, Stream what, double x, double z) {
  const double ix = std::floor(x);
  const double iz = std::floor(z);
  const auto fade = [](double u) { return u * u * u * (u * (u * 6 - 15) + 10); };
  const double u = fade(x - ix);
  const double v = fade(z - iz);
  const auto at = [&](double dx, double dz) {
    const uint64_t counter =
        lattice_counter(static_cast<int64_t>(ix + dx), static_cast<int64_t>(iz + dz));
    return 2 * random_unit(seed, 1000 + what, counter) - 1;
  };
  return (at(0, 0) * (1 - u) + at(1, 0) * u) * (1 - v) + (at(0, 1) * (1 - u) + at(1, 1) * u) * v;
}

double clamped(double value) { return std::clamp(value, 0.0, 1.0); }

// The vertices of the ground, each a function of its place alone.
class Ground {
 public:
  Ground(double size, uint64_t seed)
      : n_(std::max<int64_t>(2, static_cast<int64_t>(size / kCell + 0.5))),
        cell_(size / static_cast<double>(n_)),
        seed_(seed) {}

  [[nodiscard]] int64_t cells() const { return n_; }
  [[nodiscard]] uint64_t seed() const { return seed_; }

  [[nodiscard]] BezierPatch surface(int64_t i, int64_t j) const {
    BezierPatch patch;
    for (int64_t b = 0; b < 2; ++b) {
      for (int64_t a = 0; a < 2; ++a) {
        const Vec3d v = vertex(i + a, j + b);
        const Vec3d by_x = slope(i + a, j + b, 1, 0) * (a == 0 ? 1.0 / 3 : -1.0 / 3);
        const Vec3d by_z = slope(i + a, j + b, 0, 1) * (b == 0 ? 1.0 / 3 : -1.0 / 3);
        const auto at = [&](int64_t s, int64_t t) -> Vec3d& {
          return patch.points[static_cast<size_t>(4 * (b == 0 ? t : 3 - t) + (a == 0 ? s : 3 - s))];
        };
        at(0, 0) = v;
        at(1, 0) = v + by_x;
        at(0, 1) = v + by_z;
        at(1, 1) = v + by_x + by_z;
      }
    }
    return patch;
  }

 private:
  [[nodiscard]] double plateau(int64_t i, int64_t j) const {
    return noise(seed_, kPlateaus, static_cast<double>(i) / 3.4, static_cast<double>(j) / 3.4) -
           0.05;
  }
  // 1 where a plateau's side is a ramp, 0 where it is a cliff.
  [[nodiscard]] double ramp(int64_t i, int64_t j) const {
    return clamped(5 *
                   noise(seed_, kRamps, static_cast<double>(i) / 3, static_cast<double>(j) / 3));
  }

  [[nodiscard]] double height(int64_t i, int64_t j) const {
    const auto x = static_cast<double>(i);
    const auto z = static_cast<double>(j);
    const double m = plateau(i, j);
    const double cliff = m > 0 ? 1 : 0;
    const double rise = clamped((m + 0.35) / 0.7);
    const double r = ramp(i, j);
    return 14 * noise(seed_, kHills, x / 7, z / 7) + 5 * noise(seed_, kMounds, x / 2.3, z / 2.3) +
           1.5 * noise(seed_, kBumps, x, z) + 13 * ((1 - r) * cliff + r * rise);
  }

  // Above and below a cliff vertices move towards it, those above more: it becomes steep or
  // leans out. Not across the first cells, whose curves would leave the world.
  [[nodiscard]] Vec3d vertex(int64_t i, int64_t j) const {
    Vec3d p{static_cast<double>(i) * cell_, height(i, j), static_cast<double>(j) * cell_};
    if (i <= 0 || j <= 0 || i >= n_ || j >= n_) return p;
    const bool above = plateau(i, j) > 0;
    double x = 0;
    double z = 0;
    if ((plateau(i + 1, j) > 0) != above) x += 1;
    if ((plateau(i - 1, j) > 0) != above) x -= 1;
    if ((plateau(i, j + 1) > 0) != above) z += 1;
    if ((plateau(i, j - 1) > 0) != above) z -= 1;
    const double lean = 0.45 + 0.3 * random_unit(seed_, kOverhangs, lattice_counter(i, j));
    const double by = cell_ * (1 - ramp(i, j)) * (above ? lean : 0.38) * (x * z == 0 ? 1 : 0.7);
    if (i > 1 && i < n_ - 1) p.x += x * by;
    if (j > 1 && j < n_ - 1) p.z += z * by;
    return p;
  }

  [[nodiscard]] Vec3d slope(int64_t i, int64_t j, int64_t di, int64_t dj) const {
    const bool first = (di == 1 ? i : j) == 0;
    const bool last = (di == 1 ? i : j) == n_;
    if (first) return vertex(i + di, j + dj) - vertex(i, j);
    if (last) return vertex(i, j) - vertex(i - di, j - dj);
    return (vertex(i + di, j + dj) - vertex(i - di, j - dj)) * 0.5;
  }

  int64_t n_;
  double cell_;
  uint64_t seed_;
};

// A cell's control points as one lattice of 3 n + 1 a side, and the patches it became.
struct Cell {
  uint32_t n = 1;
  uint32_t first = 0;
  [[nodiscard]] uint32_t patch(uint32_t column, uint32_t row) const {
    return first + row * n + column;
  }
};

uint32_t cuts_of(const Ground& ground, int64_t i, int64_t j) {
  // Even the smallest world has neighbours of every kind.
  if (i + j <= 1) return i == 1 ? 4 : j == 1 ? 2 : 1;
  const double roll = random_unit(ground.seed(), kCuts, lattice_counter(i, j));
  return roll < 0.5 ? 1 : roll < 0.78 ? 2 : 4;
}

std::vector<Vec3d> lattice_of(const BezierPatch& whole, uint32_t n) {
  const uint32_t side = 3 * n + 1;
  std::vector<Vec3d> lattice(static_cast<size_t>(side) * side);
  BezierPatch below = whole;
  for (uint32_t row = 0; row < n; ++row) {
    BezierPatch right = below;
    if (row + 1 < n) {
      const auto halves = split_t(below, 1.0 / (n - row));
      right = halves[0];
      below = halves[1];
    }
    for (uint32_t column = 0; column < n; ++column) {
      BezierPatch piece = right;
      if (column + 1 < n) {
        const auto halves = split_s(right, 1.0 / (n - column));
        piece = halves[0];
        right = halves[1];
      }
      for (uint32_t b = 0; b < 4; ++b) {
        for (uint32_t a = 0; a < 4; ++a) {
          lattice[static_cast<size_t>(3 * row + b) * side + 3 * column + a] =
              piece.points[4 * b + a];
        }
      }
    }
  }
  return lattice;
}

// Moves an inner vertex and the control points around it, so that the surface stays smooth and the
// cell's border stays where it is.
void move_vertex(std::vector<Vec3d>& lattice, uint32_t n, uint32_t column, uint32_t row, Vec3d by) {
  const uint32_t side = 3 * n + 1;
  for (uint32_t b = 3 * row - 1; b <= 3 * row + 1; ++b) {
    for (uint32_t a = 3 * column - 1; a <= 3 * column + 1; ++a) {
      Vec3d& p = lattice[static_cast<size_t>(b) * side + a];
      p = p + by;
    }
  }
}

void add_relief(std::vector<Vec3d>& lattice, const Ground& ground, int64_t i, int64_t j,
                uint32_t n) {
  Numbers roll(ground.seed(), kRelief, i, j);
  for (uint32_t row = 1; row < n; ++row) {
    for (uint32_t column = 1; column < n; ++column) {
      const double reach = 5.0 / n;
      move_vertex(lattice, n, column, row,
                  {roll(-reach, reach), roll(-0.6, 0.8) * reach, roll(-reach, reach)});
    }
  }
  Numbers knoll(ground.seed(), kKnolls, i, j);
  const bool outermost = i == 0 || j == 0 || i == ground.cells() - 1 || j == ground.cells() - 1;
  if (n != 4 || outermost || knoll(0, 1) > 0.3) return;
  // A table of rock: the ring of inner vertices goes up and out beyond the control points beside
  // the border, which stay, so that the side folds under the top.
  const double up = knoll(5, 9);
  const double out = knoll(5.6, 6.6);
  for (uint32_t row = 1; row < 4; ++row) {
    for (uint32_t column = 1; column < 4; ++column) {
      const double x = static_cast<double>(column) - 2;
      const double z = static_cast<double>(row) - 2;
      const double round = x * z == 0 ? 1 : knoll(0.45, 0.7);
      move_vertex(lattice, n, column, row,
                  {x * out * round, up + knoll(-1.5, 0.5), z * out * round});
    }
  }
}

// Edges 2 and 3 of a patch run against the axes.
void bind_cells(PatchSet& set, const Cell& a, uint32_t edge_a, const Cell& b, uint32_t edge_b) {
  const bool a_is_big = a.n <= b.n;
  const Cell& big = a_is_big ? a : b;
  const Cell& small = a_is_big ? b : a;
  const uint32_t edge_big = a_is_big ? edge_a : edge_b;
  const uint32_t edge_small = a_is_big ? edge_b : edge_a;
  const auto side = [](const Cell& cell, uint32_t edge, uint32_t k) -> PatchSide {
    const uint32_t column = edge == 0 ? 0 : edge == 2 ? cell.n - 1 : k;
    const uint32_t row = edge == 3 ? 0 : edge == 1 ? cell.n - 1 : k;
    return {cell.patch(column, row), edge};
  };
  const uint32_t parts = small.n / big.n;
  for (uint32_t k = 0; k < big.n; ++k) {
    std::array<PatchSide, 4> sides;
    for (uint32_t m = 0; m < parts; ++m) {
      sides[m] = side(small, edge_small, k * parts + (edge_big >= 2 ? parts - 1 - m : m));
    }
    if (parts == 1) {
      set.bind(side(big, edge_big, k), sides[0]);
    } else {
      set.bind_parts(side(big, edge_big, k), {sides.data(), parts});
    }
  }
}

std::vector<Cell> add_ground(PatchSet& set, const Ground& ground) {
  const int64_t n = ground.cells();
  std::vector<Cell> cells;
  cells.reserve(static_cast<size_t>(n * n));
  set.begin_run("", "ground", "grass");
  for (int64_t j = 0; j < n; ++j) {
    for (int64_t i = 0; i < n; ++i) {
      Cell cell{.n = cuts_of(ground, i, j), .first = static_cast<uint32_t>(set.size())};
      auto lattice = lattice_of(ground.surface(i, j), cell.n);
      add_relief(lattice, ground, i, j, cell.n);
      const uint32_t side = 3 * cell.n + 1;
      for (uint32_t row = 0; row < cell.n; ++row) {
        for (uint32_t column = 0; column < cell.n; ++column) {
          BezierPatch patch;
          for (uint32_t k = 0; k < 16; ++k) {
            patch.points[k] =
                rounded(lattice[static_cast<size_t>(3 * row + k / 4) * side + 3 * column + k % 4]);
          }
          set.add(patch);
          if (column > 0) set.bind({cell.patch(column - 1, row), 2}, {cell.patch(column, row), 0});
          if (row > 0) set.bind({cell.patch(column, row - 1), 1}, {cell.patch(column, row), 3});
        }
      }
      if (i > 0) bind_cells(set, cells.back(), 2, cell, 0);
      if (j > 0) bind_cells(set, cells[static_cast<size_t>((j - 1) * n + i)], 1, cell, 3);
      cells.push_back(cell);
    }
  }
  return cells;
}

// A cube blown up to a boulder: six patches. Control points between two corners lie 1.3 times
// as far out, those inside a face 2.1 times, which makes a ball of a cube.
void add_rock(PatchSet& set, Vec3d centre, double radius, Numbers& roll) {
  const auto [ux, uz] = unit_circle(roll(0, 1));
  const Vec3d stretch{roll(0.7, 1.4), roll(0.6, 1.2), roll(0.7, 1.4)};
  std::array<Vec3d, 8> corner;
  for (size_t k = 0; k < 8; ++k) {
    const double r = radius * roll(0.42, 0.66);  // 0.577 on a ball.
    const double x = ((k & 1) != 0 ? r : -r) * stretch.x;
    const double y = ((k & 2) != 0 ? r : -r) * stretch.y;
    const double z = ((k & 4) != 0 ? r : -r) * stretch.z;
    corner[k] = {x * ux - z * uz, y, x * uz + z * ux};
  }
  constexpr std::array<std::array<size_t, 4>, 6> kFaces{
      {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}};
  constexpr std::array<double, 4> kThirds{0, 1.0 / 3, 2.0 / 3, 1};
  const auto first = static_cast<uint32_t>(set.size());
  for (const auto& face : kFaces) {
    BezierPatch patch;
    for (size_t j = 0; j < 4; ++j) {
      for (size_t i = 0; i < 4; ++i) {
        const double s = kThirds[i];
        const double t = kThirds[j];
        const Vec3d p = corner[face[0]] * (kThirds[3 - i] * kThirds[3 - j]) +
                        corner[face[1]] * (kThirds[3 - i] * t) + corner[face[2]] * (s * t) +
                        corner[face[3]] * (s * kThirds[3 - j]);
        const int within = (i % 3 != 0 ? 1 : 0) + (j % 3 != 0 ? 1 : 0);
        patch.points[4 * j + i] = rounded(centre + p * (within == 2   ? 2.1
                                                        : within == 1 ? 1.3
                                                                      : 1.0));
      }
    }
    set.add(patch);
  }
  for (uint32_t f = 0; f < 6; ++f) {
    for (uint32_t e = 0; e < 4; ++e) {
      for (uint32_t g = f + 1; g < 6; ++g) {
        for (uint32_t h = 0; h < 4; ++h) {
          const bool shared =
              kFaces[f][e] == kFaces[g][(h + 1) % 4] && kFaces[f][(e + 1) % 4] == kFaces[g][h];
          if (shared) set.bind({first + f, e}, {first + g, h});
        }
      }
    }
  }
}

// A round bar bent over 220 degrees, so that both feet end below the ground.
void add_arch(PatchSet& set, Vec3d centre, Numbers& roll) {
  constexpr uint32_t kSegments = 5;
  constexpr double kSegmentArm = 0.259173;   // 4/3 tan(44 degrees / 4): control points of an arc.
  constexpr double kQuarterArm = 0.5522847;  // The same for 90 degrees.
  const auto [ux, uz] = unit_circle(roll(0, 1));
  const double large = roll(5, 9);
  const double small = roll(0.9, 1.6);
  const auto first = static_cast<uint32_t>(set.size());
  for (uint32_t a = 0; a < kSegments; ++a) {
    const auto from = unit_circle((-20.0 + 44.0 * a) / 360);
    const auto to = unit_circle((-20.0 + 44.0 * (a + 1)) / 360);
    const std::array<std::array<double, 2>, 4> along{
        {from,
         {from[0] - kSegmentArm * from[1], from[1] + kSegmentArm * from[0]},
         {to[0] + kSegmentArm * to[1], to[1] - kSegmentArm * to[0]},
         to}};
    for (uint32_t q = 0; q < 4; ++q) {
      BezierPatch patch;
      for (size_t j = 0; j < 4; ++j) {
        constexpr std::array<std::array<double, 2>, 4> kArc{
            {{1, 0}, {1, -kQuarterArm}, {kQuarterArm, -1}, {0, -1}}};
        std::array<double, 2> around = kArc[j];
        for (uint32_t r = 0; r < q; ++r) around = {around[1], -around[0]};
        for (size_t i = 0; i < 4; ++i) {
          const double out = large + small * around[0];
          const double x = out * along[i][0];
          const double z = small * around[1];
          patch.points[4 * j + i] =
              rounded(centre + Vec3d{x * ux - z * uz, out * along[i][1], x * uz + z * ux});
        }
      }
      set.add(patch);
    }
  }
  for (uint32_t a = 0; a < kSegments; ++a) {
    for (uint32_t q = 0; q < 4; ++q) {
      const uint32_t patch = first + 4 * a + q;
      set.bind({patch, 1}, {first + 4 * a + (q + 1) % 4, 3});
      if (a > 0) set.bind({patch - 4, 2}, {patch, 0});
    }
  }
}

// Calls place(numbers, point of the ground) for a share of the cells.
template <class Place>
void scatter(const PatchSet& set, const std::vector<Cell>& cells, const Ground& ground, Stream what,
             double share, Place place) {
  const int64_t n = ground.cells();
  for (int64_t j = 0; j < n; ++j) {
    for (int64_t i = 0; i < n; ++i) {
      Numbers roll(ground.seed(), what, i, j);
      const bool here = roll(0, 1) < share || (i == n / 2 && j == n / 2);
      if (!here) continue;
      const Cell& cell = cells[static_cast<size_t>(j * n + i)];
      // Nothing reaches over the border of the world.
      const double margin = i == 0 || j == 0 || i == n - 1 || j == n - 1 ? 0.45 : 0.3;
      const double s = roll(margin, 1 - margin) * cell.n;
      const double t = roll(margin, 1 - margin) * cell.n;
      const auto column = static_cast<uint32_t>(s);
      const auto row = static_cast<uint32_t>(t);
      place(roll, set.patches[cell.patch(column, row)].at(s - column, t - row));
    }
  }
}

}  // namespace

double landscape_tolerance(double size) {
  constexpr double kDefaultTolerance = 0.02;
  constexpr double kTriangles = 7;  // On a square metre at that tolerance; nearly inverse to it.
  constexpr double kMax = 90e6;
  return std::max(kDefaultTolerance, kDefaultTolerance * kTriangles * size * size / kMax);
}

PatchSet build_landscape(const BuiltinWorldConfig& config) {
  const Ground ground(config.size, config.seed);
  PatchSet set;
  const auto cells = add_ground(set, ground);
  set.begin_run("", "rocks", "stone");
  scatter(set, cells, ground, kRocks, 0.35, [&](Numbers& roll, Vec3d at) {
    const double radius = roll(1.5, 5);
    add_rock(set, at + Vec3d{0, -0.3 * radius, 0}, radius, roll);
    if (roll(0, 1) < 0.4) {
      // Another, half inside the first.
      const auto [x, z] = unit_circle(roll(0, 1));
      add_rock(set, at + Vec3d{x * radius, -0.1 * radius, z * radius}, radius * roll(0.5, 0.9),
               roll);
    }
  });
  set.begin_run("", "arches", "stone");
  scatter(set, cells, ground, kArches, 0.08, [&](Numbers& roll, Vec3d at) {
    add_arch(set, at + Vec3d{0, -0.5, 0}, roll);
  });
  return set;
}

}  // namespace throng::importer::builtin
