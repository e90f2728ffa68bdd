// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "patch_nets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "core/random.h"

// Nets of random patches, and their meshes checked edge by edge.
namespace throng::test {
namespace {

// A cell of the net: 1, 2 or 4 patches along a side, by (column along x, row along z).
struct Cell {
  uint32_t n = 1;
  std::vector<uint32_t> patch;
  std::vector<uint32_t> turns;
};

class Net {
 public:
  explicit Net(const NetConfig& config) : config_(config) {}

  PatchSet make() {
    const int32_t n = config_.side;
    for (int32_t z = 0; z < n; ++z) {
      for (int32_t x = 0; x < n; ++x) add_cell(x, z);
    }
    for (int32_t z = 0; z < n; ++z) {
      for (int32_t x = 0; x < n; ++x) {
        if (x + 1 < n || config_.closed) bind(cell(x, z), 2, cell(x + 1, z), 0);
        if (z + 1 < n || config_.closed) bind(cell(x, z), 1, cell(x, z + 1), 3);
      }
    }
    return std::move(set_);
  }

 private:
  double roll() { return random_unit(config_.seed, 77, counter_++); }
  double roll_at(int32_t x, int32_t z, uint64_t what) const {
    const int32_t n = config_.side;
    if (config_.closed) {
      x = (x + n) % n;
      z = (z + n) % n;
    }
    return 2 * random_unit(
                   config_.seed, what,
                   static_cast<uint64_t>(x + 1000) * 100000 + static_cast<uint64_t>(z + 1000)) -
           1;
  }

  // The plane or the torus.
  [[nodiscard]] Vec3d place(double u, double v, double height) const {
    if (!config_.closed) return {u * config_.cell, height, v * config_.cell};
    const double a = 2 * std::numbers::pi * u / config_.side;
    const double b = 2 * std::numbers::pi * v / config_.side;
    const double small = config_.cell * config_.side / 8 + height;
    const double large = config_.cell * config_.side / 3;
    const double around = large + small * std::cos(b);
    return {around * std::cos(a), small * std::sin(b), -around * std::sin(a)};
  }

  [[nodiscard]] Vec3d vertex(int32_t x, int32_t z) const {
    const auto inside = [&](int32_t k) { return config_.closed || (k > 0 && k < config_.side); };
    const double sideways = config_.sideways / config_.cell;
    return place(x + (inside(x) ? sideways * roll_at(x, z, 1) : 0),
                 z + (inside(z) ? sideways * roll_at(x, z, 2) : 0),
                 config_.relief * roll_at(x, z, 3));
  }

  [[nodiscard]] Vec3d slope_x(int32_t x, int32_t z) const {
    if (!config_.closed && (x == 0 || x == config_.side)) {
      return x == 0 ? vertex(1, z) - vertex(0, z) : vertex(x, z) - vertex(x - 1, z);
    }
    return (vertex(x + 1, z) - vertex(x - 1, z)) * 0.5;
  }
  [[nodiscard]] Vec3d slope_z(int32_t x, int32_t z) const {
    if (!config_.closed && (z == 0 || z == config_.side)) {
      return z == 0 ? vertex(x, 1) - vertex(x, 0) : vertex(x, z) - vertex(x, z - 1);
    }
    return (vertex(x, z + 1) - vertex(x, z - 1)) * 0.5;
  }

  // s along x, t along z: the normal of along_t x along_s then points up.
  [[nodiscard]] BezierPatch surface(int32_t x, int32_t z) const {
    BezierPatch patch;
    for (int32_t b = 0; b < 2; ++b) {
      for (int32_t a = 0; a < 2; ++a) {
        const Vec3d v = vertex(x + a, z + b);
        const Vec3d along_x = slope_x(x + a, z + b) * ((a == 0 ? 1.0 : -1.0) / 3);
        const Vec3d along_z = slope_z(x + a, z + b) * ((b == 0 ? 1.0 : -1.0) / 3);
        const auto at = [&](int32_t i, int32_t j) -> Vec3d& {
          return patch.points[static_cast<size_t>(4 * (b == 0 ? j : 3 - j) + (a == 0 ? i : 3 - i))];
        };
        at(0, 0) = v;
        at(1, 0) = v + along_x;
        at(0, 1) = v + along_z;
        at(1, 1) = v + along_x + along_z;
      }
    }
    return patch;
  }

  void add_cell(int32_t x, int32_t z) {
    Cell cell;
    cell.n = config_.split_some ? 1u << random_below(config_.seed, 5, counter_++, 3) : 1;
    const BezierPatch whole = surface(x, z);
    for (uint32_t j = 0; j < cell.n; ++j) {
      for (uint32_t i = 0; i < cell.n; ++i) {
        BezierPatch part = cut(whole, i, j, cell.n);
        for (const size_t inner : {5, 6, 9, 10}) {
          part.points[inner] = part.points[inner] + Vec3d{roll(), 2 * roll(), roll()};
        }
        if (config_.jitter > 0) {
          for (Vec3d& p : part.points) {
            p = p + Vec3d{0, config_.jitter * (2 * roll() - 1) * 0.5, 0};
          }
        }
        const auto turns = static_cast<uint32_t>(random_below(config_.seed, 6, counter_++, 4));
        cell.turns.push_back(turns);
        cell.patch.push_back(set_.add(turn(part, turns)));
      }
    }
    for (uint32_t j = 0; j < cell.n; ++j) {
      for (uint32_t i = 0; i < cell.n; ++i) {
        const auto side = [&](uint32_t column, uint32_t row, uint32_t e) {
          const size_t at = static_cast<size_t>(row) * cell.n + column;
          return PatchSide{cell.patch[at], (e + cell.turns[at]) % 4};
        };
        if (i + 1 < cell.n) set_.bind(side(i, j, 2), side(i + 1, j, 0));
        if (j + 1 < cell.n) set_.bind(side(i, j, 1), side(i, j + 1, 3));
      }
    }
    cells_.push_back(std::move(cell));
  }

  static BezierPatch cut(const BezierPatch& whole, uint32_t i, uint32_t j, uint32_t n) {
    BezierPatch part = whole;
    const auto trim = [n](BezierPatch& p, uint32_t k, auto split) {
      if (k > 0) p = split(p, static_cast<double>(k) / n)[1];
      if (k + 1 < n) p = split(p, 1.0 / (n - k))[0];
    };
    trim(part, i, split_s);
    trim(part, j, split_t);
    return part;
  }

  const Cell& cell(int32_t x, int32_t z) const {
    const int32_t n = config_.side;
    return cells_[static_cast<size_t>((z % n) * n + x % n)];
  }

  // Part k along the side of a cell that its patches know as edge `e`, counted along x or z.
  static PatchSide side_of(const Cell& cell, uint32_t e, uint32_t k) {
    const uint32_t i = e == 0 ? 0 : e == 2 ? cell.n - 1 : k;
    const uint32_t j = e == 3 ? 0 : e == 1 ? cell.n - 1 : k;
    const size_t at = static_cast<size_t>(j) * cell.n + i;
    return {cell.patch[at], (e + cell.turns[at]) % 4};
  }

  void bind(const Cell& a, uint32_t ea, const Cell& b, uint32_t eb) {
    const bool a_is_big = a.n <= b.n;
    const Cell& big = a_is_big ? a : b;
    const Cell& small = a_is_big ? b : a;
    const uint32_t e_big = a_is_big ? ea : eb;
    const uint32_t e_small = a_is_big ? eb : ea;
    const uint32_t parts = small.n / big.n;
    // Edges 2 and 3 run against the axes.
    const bool backward = e_big >= 2;
    for (uint32_t k = 0; k < big.n; ++k) {
      std::vector<PatchSide> sides;
      for (uint32_t m = 0; m < parts; ++m) {
        sides.push_back(side_of(small, e_small, k * parts + (backward ? parts - 1 - m : m)));
      }
      if (parts == 1) {
        set_.bind(side_of(big, e_big, k), sides[0]);
      } else {
        set_.bind_parts(side_of(big, e_big, k), sides);
      }
    }
  }

  NetConfig config_;
  PatchSet set_;
  std::vector<Cell> cells_;
  uint64_t counter_ = 0;
};

bool less(Vec3d a, Vec3d b) { return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z); }

// A number per position, so that positions can be compared like indices.
std::vector<uint32_t> number_places(const std::vector<Vec3d>& positions) {
  std::map<Vec3d, uint32_t, decltype(&less)> places(&less);
  std::vector<uint32_t> number;
  for (const Vec3d& p : positions) {
    number.push_back(places.emplace(p, static_cast<uint32_t>(places.size())).first->second);
  }
  return number;
}

bool on_open_edge(const PatchSet& set, uint32_t p, Vec3d a, Vec3d b) {
  for (uint32_t e = 0; e < 4; ++e) {
    if (set.edges[p][e].bind != EdgeBind::kOpen) continue;
    const auto curve = set.patches[p].edge(static_cast<int32_t>(e));
    const auto lies_on = [&](Vec3d point) {
      // The nearest point of the curve, by ever finer steps around the nearest so far.
      double nearest = INFINITY, middle = 0.5;
      for (double reach = 0.5; reach > 1e-7; reach /= 32) {
        const double around = middle;
        for (int k = -64; k <= 64; ++k) {
          const double at = std::clamp(around + reach * k / 64, 0.0, 1.0);
          const double far = length(point - cubic_point(curve, at));
          if (far >= nearest) continue;
          nearest = far;
          middle = at;
        }
      }
      return nearest < 0.05;
    };
    if (lies_on(a) && lies_on(b)) return true;
  }
  return false;
}

}  // namespace

PatchSet make_net(const NetConfig& config) { return Net(config).make(); }

BezierPatch turn(BezierPatch patch, uint32_t turns) {
  for (uint32_t k = 0; k < turns; ++k) {
    const BezierPatch old = patch;
    for (size_t j = 0; j < 4; ++j) {
      for (size_t i = 0; i < 4; ++i) patch.points[4 * j + i] = old.points[4 * i + 3 - j];
    }
  }
  return patch;
}

size_t expect_watertight(const PatchSet& set, const PatchMesh& mesh) {
  EXPECT_EQ(mesh.first.size(), set.size() + 1);
  const auto place = number_places(mesh.positions);
  using Edge = std::pair<uint32_t, uint32_t>;
  std::map<Edge, uint32_t> by_index;  // Directed edge -> patch.
  std::map<Edge, uint32_t> by_place;
  for (uint32_t p = 0; p < set.size(); ++p) {
    for (uint32_t t = mesh.first[p]; t < mesh.first[p + 1]; ++t) {
      for (int k = 0; k < 3; ++k) {
        const uint32_t a = mesh.triangles[t][static_cast<size_t>(k)];
        const uint32_t b = mesh.triangles[t][static_cast<size_t>((k + 1) % 3)];
        EXPECT_NE(a, b);
        EXPECT_TRUE(by_index.emplace(Edge{a, b}, p).second) << "met twice in patch " << p;
        EXPECT_TRUE(by_place.emplace(Edge{place[a], place[b]}, p).second);
      }
    }
  }
  size_t alone = 0;
  std::vector<Edge> undirected;
  for (const auto& [edge, p] : by_index) {
    const auto [a, b] = edge;
    const bool has_partner = by_index.count({b, a}) > 0;
    EXPECT_TRUE(!has_partner || by_place.count({place[b], place[a]}) > 0);
    if (!has_partner) {
      ++alone;
      EXPECT_TRUE(on_open_edge(set, p, mesh.positions[a], mesh.positions[b]))
          << "a crack in patch " << p;
    }
    if (!has_partner || a < b) undirected.push_back(edge);
  }
  // T-junctions: a vertex within 0.1 mm of the inside of an edge. By cells of 4 m.
  std::map<std::array<int, 3>, std::vector<uint32_t>> near;
  const auto cell_of = [](double v) { return static_cast<int>(std::floor(v / 4)); };
  std::set<uint32_t> seen;
  for (uint32_t i = 0; i < mesh.positions.size(); ++i) {
    const Vec3d& p = mesh.positions[i];
    if (seen.insert(place[i]).second) near[{cell_of(p.x), cell_of(p.y), cell_of(p.z)}].push_back(i);
  }
  size_t junctions = 0;
  for (const auto& [ia, ib] : undirected) {
    const Vec3d a = mesh.positions[ia];
    const Vec3d b = mesh.positions[ib];
    const double whole = length(b - a);
    for (int x = cell_of(std::fmin(a.x, b.x)); x <= cell_of(std::fmax(a.x, b.x)); ++x) {
      for (int y = cell_of(std::fmin(a.y, b.y)); y <= cell_of(std::fmax(a.y, b.y)); ++y) {
        for (int z = cell_of(std::fmin(a.z, b.z)); z <= cell_of(std::fmax(a.z, b.z)); ++z) {
          const auto found = near.find({x, y, z});
          if (found == near.end()) continue;
          for (const uint32_t i : found->second) {
            if (place[i] == place[ia] || place[i] == place[ib]) continue;
            const Vec3d q = mesh.positions[i];
            if (length(q - a) + length(b - q) - whole < 1e-9 * whole) ++junctions;
          }
        }
      }
    }
  }
  EXPECT_EQ(junctions, 0u);
  return alone;
}

double distance_to_triangle(Vec3d p, Vec3d a, Vec3d b, Vec3d c) {
  const auto to_segment = [](Vec3d q, Vec3d s, Vec3d t) {
    const Vec3d d = t - s;
    const double length2 = dot(d, d);
    const double k = length2 > 0 ? std::fmin(1, std::fmax(0, dot(q - s, d) / length2)) : 0;
    return length(q - (s + d * k));
  };
  const Vec3d n = cross(b - a, c - a);
  if (dot(n, n) > 0 && dot(cross(b - a, p - a), n) >= 0 && dot(cross(c - b, p - b), n) >= 0 &&
      dot(cross(a - c, p - c), n) >= 0) {
    return std::fabs(dot(p - a, n)) / length(n);
  }
  return std::fmin(to_segment(p, a, b), std::fmin(to_segment(p, b, c), to_segment(p, c, a)));
}

double worst_distance(const PatchSet& set, const PatchMesh& mesh, uint32_t p, int32_t samples) {
  double worst = 0;
  for (int32_t i = 0; i < samples; ++i) {
    const auto counter = static_cast<uint64_t>(2 * i);
    const Vec3d point =
        set.patches[p].at(random_unit(p, 9, counter), random_unit(p, 9, counter + 1));
    double nearest = INFINITY;
    for (uint32_t t = mesh.first[p]; t < mesh.first[p + 1]; ++t) {
      const auto& [a, b, c] = mesh.triangles[t];
      nearest = std::fmin(nearest, distance_to_triangle(point, mesh.positions[a], mesh.positions[b],
                                                        mesh.positions[c]));
    }
    worst = std::fmax(worst, nearest);
  }
  return worst;
}

Scene net_scene(const NetConfig& config) { return patch_scene(make_net(config)); }

Scene patch_scene(const PatchSet& set) {
  Scene scene;
  scene.patches = set;
  Context context;
  const auto mesh = tessellate_patches(set, {}, context);
  EXPECT_TRUE(mesh);
  if (!mesh) return scene;
  scene.positions = mesh->positions;
  scene.triangles = mesh->triangles;
  scene.patch_part = mesh->parts;
  scene.patch_off = mesh->off;
  scene.area.assign(scene.triangles.size(), kAreaWalkable);
  for (uint32_t p = 0; p < set.size(); ++p) {
    scene.patch_of_triangle.insert(scene.patch_of_triangle.end(),
                                   mesh->first[p + 1] - mesh->first[p], p);
  }
  return scene;
}

}  // namespace throng::test
