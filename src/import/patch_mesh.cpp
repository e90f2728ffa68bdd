// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numeric>

#include "core/parallel.h"
#include "import/patch_edges.h"
#include "import/patch_steps.h"
#include "throng/patch.h"

// Without cracks: a *seam* is what two patches share, the whole edge of one of them, cut once; both
// sides use its vertices by index. A patch takes the seams around it as they come: where they are
// as fine as its inside it is a grid, else a ring of triangles joins the seams to a grid of inner
// points. Steps are powers of two and no seam is coarser than a patch beside it, so that the ring's
// triangles span no more than the patch's own steps, and what bounds the gap of those holds for
// them.
namespace throng {
namespace {

constexpr uint32_t kUnits =
    1024;  // Of a parameter along an edge: 2^7 steps in each of 4 parts fit.

// One run of shared vertices: between its ends, which are corners, `first` and what follows.
struct Seam {
  PatchSide side;  // Whose curve it is.
  int32_t halvings = 0;
  uint32_t start = 0, end = 0;  // Vertices.
  uint32_t first = 0;           // The first of 2^halvings - 1 vertices, in the direction of `side`.
  bool collapsed = false;
};

struct EdgePoint {
  uint32_t vertex = 0;
  uint32_t at = 0;  // Along the edge. [1 / kUnits]
};

int32_t along(const Halvings& h, uint32_t edge) { return edge % 2 == 0 ? h.t : h.s; }

class Tessellator {
 public:
  Tessellator(const PatchSet& set, const TessellationConfig& config, Context& context)
      : set_(set), config_(config), context_(context) {
    // Millimetres, or a twentieth of the tolerance if that is finer: what rounding adds stays
    // within.
    grid_ = std::max(1000.0, std::ceil(20 / config.tolerance));
  }

  Result<PatchMesh> run() {
    measure();
    if (context_.cancel) return cancelled();
    number_corners();
    make_seams();
    if (!number_vertices()) return too_many();
    if (context_.cancel) return cancelled();
    if (!count_triangles()) return too_many();
    // Memory that is touched for the first time costs as much as what is then written there.
    const std::array<std::function<void()>, 3> make_room{
        [&] { mesh_.positions.resize(vertices_); },
        [&] { mesh_.triangles.resize(mesh_.first.back()); },
        [&] { mesh_.parts.resize(mesh_.first.back()); }};
    parallel_for(make_room.size(), config_.workers, [&](size_t i) { make_room[i](); });
    mesh_.off.resize(set_.size());
    place_vertices();
    parallel_ranges(set_.size(), 64, config_.workers, [&](size_t begin, size_t end) {
      for (size_t p = begin; p < end; ++p) {
        size_t out = mesh_.first[p];
        for_each_triangle(static_cast<uint32_t>(p),
                          [&](uint32_t a, uint32_t b, uint32_t c, PatchPart part) {
                            mesh_.parts[out] = part;
                            mesh_.triangles[out++] = {a, b, c};
                          });
        mesh_.off[p] = vertices_off(static_cast<uint32_t>(p));
      }
    });
    return std::move(mesh_);
  }

 private:
  static Error cancelled() { return {Errc::kCancelled, "cancelled while cutting patches"}; }
  [[nodiscard]] Error too_many() const {
    return {Errc::kLimit,
            fmt::format("patches: {} patches give more than {} triangles at a tolerance of {} m; "
                        "raise curve_tolerance, or check the scale",
                        set_.size(), config_.most_triangles, config_.tolerance)};
  }

  [[nodiscard]] double rounding() const { return std::sqrt(3.0) / 2 / grid_; }

  void measure() {
    steps_.resize(set_.size());
    parallel_ranges(set_.size(), 64, config_.workers, [&](size_t begin, size_t end) {
      for (size_t p = begin; p < end; ++p) {
        steps_[p] = steps_within(set_.patches[p], config_.tolerance - rounding());
      }
    });
  }

  // Corners that are one vertex get one number, in order of their first patch.
  void number_corners() {
    corner_ = weld_corners(set_);
    for (uint32_t i = 0; i < corner_.size(); ++i) {
      if (corner_[i] == i) {
        corner_[i] = static_cast<uint32_t>(corner_source_.size());
        corner_source_.push_back(i);
      } else {
        corner_[i] = corner_[corner_[i]];
      }
    }
    // A patch that closes on itself needs points between to enclose anything.
    for (uint32_t p = 0; p < set_.size(); ++p) {
      for (uint32_t e = 0; e < 4; ++e) {
        if (corner_[4 * p + e] != corner_[4 * p + (e + 1) % 4]) continue;
        if (is_collapsed(set_.patches[p].edge(static_cast<int32_t>(e)))) continue;
        int32_t& halvings = e % 2 == 0 ? steps_[p].t : steps_[p].s;
        halvings = std::max(halvings, 2);
      }
    }
  }

  [[nodiscard]] const PatchEdge& edge_at(PatchSide side) const {
    return set_.edges[side.patch][side.edge];
  }

  // A seam lies on the smaller patch's edge, or on that of the patch that comes first.
  [[nodiscard]] bool owns_seam(PatchSide side) const {
    const PatchEdge& edge = edge_at(side);
    if (edge.bind == EdgeBind::kTwo || edge.bind == EdgeBind::kFour) return false;
    if (edge.bind != EdgeBind::kOne) return true;
    const PatchSide next = edge.next[0];
    return side.patch != next.patch ? side.patch < next.patch : side.edge < next.edge;
  }

  void make_seams() {
    seam_of_.assign(4 * set_.size(), 0);
    for (uint32_t p = 0; p < set_.size(); ++p) {
      for (uint32_t e = 0; e < 4; ++e) {
        const PatchSide side{p, e};
        if (!owns_seam(side)) continue;
        Seam seam{.side = side,
                  .halvings = along(steps_[p], e),
                  .start = corner_[4 * p + e],
                  .end = corner_[4 * p + (e + 1) % 4],
                  .first = 0,
                  .collapsed = is_collapsed(set_.patches[p].edge(static_cast<int32_t>(e)))};
        const PatchEdge& edge = edge_at(side);
        if (edge.bind != EdgeBind::kOpen) {
          // A half or a quarter of the neighbour's edge needs one or two halvings less.
          const PatchSide next = edge.next[0];
          const size_t parts = neighbour_count(edge_at(next).bind);
          const int32_t less = parts == 4 ? 2 : parts == 2 ? 1 : 0;
          seam.halvings = std::max(seam.halvings, along(steps_[next.patch], next.edge) - less);
        }
        seam_of_[4 * p + e] = static_cast<uint32_t>(seams_.size());
        if (edge.bind == EdgeBind::kOne) {
          seam_of_[4 * edge.next[0].patch + edge.next[0].edge] = seam_of_[4 * p + e];
        }
        seams_.push_back(seam);
      }
    }
  }

  // First the corners, then the seams, then the inner points of each patch.
  bool number_vertices() {
    uint64_t next = corner_source_.size();
    for (Seam& seam : seams_) {
      seam.first = static_cast<uint32_t>(next);
      if (!seam.collapsed) next += (uint64_t{1} << seam.halvings) - 1;
    }
    inner_first_.resize(set_.size());
    inner_steps_.resize(set_.size());
    for (uint32_t p = 0; p < set_.size(); ++p) {
      Halvings h = steps_[p];
      if (!is_grid(p)) h = {std::max(h.s, 1), std::max(h.t, 1)};  // A ring needs an inside.
      inner_steps_[p] = h;
      inner_first_[p] = static_cast<uint32_t>(next);
      next += ((uint64_t{1} << h.s) - 1) * ((uint64_t{1} << h.t) - 1);
      if (next > config_.most_triangles) return false;  // There are twice as many triangles.
    }
    vertices_ = next;
    return true;
  }

  bool count_triangles() {
    std::vector<uint32_t> count(set_.size());
    parallel_ranges(set_.size(), 64, config_.workers, [&](size_t begin, size_t end) {
      for (size_t p = begin; p < end; ++p) {
        uint32_t triangles = 0;
        for_each_triangle(static_cast<uint32_t>(p),
                          [&](uint32_t, uint32_t, uint32_t, PatchPart) { ++triangles; });
        count[p] = triangles;
      }
    });
    mesh_.first.assign(1, 0);
    mesh_.first.reserve(set_.size() + 1);
    uint64_t sum = 0;
    for (const uint32_t triangles : count) {
      sum += triangles;
      if (sum > config_.most_triangles) return false;
      mesh_.first.push_back(static_cast<uint32_t>(sum));
    }
    return true;
  }

  [[nodiscard]] Vec3d rounded(Vec3d p) const {
    const auto round = [&](double value) { return std::floor(value * grid_ + 0.5) / grid_; };
    return {round(p.x), round(p.y), round(p.z)};
  }

  void place_vertices() {
    for (size_t i = 0; i < corner_source_.size(); ++i) {
      const uint32_t source = corner_source_[i];
      mesh_.positions[i] =
          rounded(set_.patches[source / 4].vertex(static_cast<int32_t>(source % 4)));
    }
    parallel_ranges(seams_.size(), 64, config_.workers, [&](size_t begin, size_t end) {
      for (size_t i = begin; i < end; ++i) {
        const Seam& seam = seams_[i];
        if (seam.collapsed) continue;
        const auto curve = set_.patches[seam.side.patch].edge(static_cast<int32_t>(seam.side.edge));
        const uint32_t n = 1u << seam.halvings;
        for (uint32_t k = 1; k < n; ++k) {
          mesh_.positions[seam.first + k - 1] =
              rounded(cubic_point(curve, static_cast<double>(k) / n));
        }
      }
    });
    parallel_ranges(set_.size(), 64, config_.workers, [&](size_t begin, size_t end) {
      for (size_t p = begin; p < end; ++p) {
        const uint32_t ns = 1u << inner_steps_[p].s;
        const uint32_t nt = 1u << inner_steps_[p].t;
        uint32_t vertex = inner_first_[p];
        for (uint32_t j = 1; j < nt; ++j) {
          for (uint32_t i = 1; i < ns; ++i) {
            mesh_.positions[vertex++] = rounded(
                set_.patches[p].at(static_cast<double>(i) / ns, static_cast<double>(j) / nt));
          }
        }
      }
    });
  }

  // The number of steps along an edge of the patch, over all its seams.
  [[nodiscard]] uint32_t edge_steps(PatchSide side) const {
    const PatchEdge& edge = edge_at(side);
    const size_t count = neighbour_count(edge.bind);
    if (count <= 1) return 1u << seams_[seam_of_[4 * side.patch + side.edge]].halvings;
    uint32_t steps = 0;
    for (size_t k = 0; k < count; ++k) {
      steps += 1u << seams_[seam_of_[4 * edge.next[k].patch + edge.next[k].edge]].halvings;
    }
    return steps;
  }

  // No seam is coarser than the patch, so equal counts mean equal steps.
  [[nodiscard]] bool is_grid(uint32_t p) const {
    const uint32_t ns = 1u << steps_[p].s;
    const uint32_t nt = 1u << steps_[p].t;
    return edge_steps({p, 0}) == nt && edge_steps({p, 1}) == ns && edge_steps({p, 2}) == nt &&
           edge_steps({p, 3}) == ns;
  }

  // Appends a seam that covers `part` of `parts` of an edge, without its last vertex.
  void append_seam(const Seam& seam, bool backward, uint32_t part, uint32_t parts,
                   std::vector<EdgePoint>& out) const {
    const uint32_t n = 1u << seam.halvings;
    for (uint32_t k = 0; k < n; ++k) {
      const uint32_t step = backward ? n - k : k;
      uint32_t vertex = seam.first + step - 1;
      if (step == 0 || seam.collapsed) vertex = seam.start;
      if (step == n) vertex = seam.end;
      out.push_back({vertex, (part * n + k) * (kUnits / parts / n)});
    }
  }

  // All vertices along an edge, from corner to corner.
  void collect_edge(PatchSide side, std::vector<EdgePoint>& out) const {
    out.clear();
    const PatchEdge& edge = edge_at(side);
    const size_t count = neighbour_count(edge.bind);
    if (count <= 1) {
      append_seam(seams_[seam_of_[4 * side.patch + side.edge]], !owns_seam(side), 0, 1, out);
    } else {
      for (uint32_t k = 0; k < count; ++k) {
        const PatchSide next = edge.next[k];
        append_seam(seams_[seam_of_[4 * next.patch + next.edge]], true, k,
                    static_cast<uint32_t>(count), out);
      }
    }
    out.push_back({corner_[4 * side.patch + (side.edge + 1) % 4], kUnits});
  }

  // How far the vertices of a patch are from its surface at their parameters. Those of its edges
  // may lie on a neighbour's curve.
  [[nodiscard]] double vertices_off(uint32_t p) const {
    thread_local std::vector<EdgePoint> points;
    double off = rounding();
    for (uint32_t e = 0; e < 4; ++e) {
      collect_edge({p, e}, points);
      const auto curve = set_.patches[p].edge(static_cast<int32_t>(e));
      for (const EdgePoint& point : points) {
        const Vec3d own = cubic_point(curve, static_cast<double>(point.at) / kUnits);
        off = std::max(off, length(mesh_.positions[point.vertex] - own));
      }
    }
    return off;
  }

  // Between two parameters that are given in units, along s or t.
  static std::array<uint8_t, 2> part_between(uint32_t from, uint32_t to) {
    constexpr uint32_t kUnitsAPart = kUnits / 256;
    const uint32_t end = (to + kUnitsAPart - 1) / kUnitsAPart;
    return {static_cast<uint8_t>(from / kUnitsAPart), static_cast<uint8_t>(end - 1)};
  }

  // Calls emit(a, b, c, part) for each triangle of a patch; those that a collapsed edge makes flat
  // are left out.
  template <class Emit>
  void for_each_triangle(uint32_t p, Emit emit_any) const {
    const auto emit = [&](uint32_t a, uint32_t b, uint32_t c, PatchPart part) {
      if (a != b && b != c && a != c) emit_any(a, b, c, part);
    };
    thread_local std::array<std::vector<EdgePoint>, 4> edges;
    for (uint32_t e = 0; e < 4; ++e) collect_edge({p, e}, edges[e]);
    const uint32_t ns = 1u << inner_steps_[p].s;
    const uint32_t nt = 1u << inner_steps_[p].t;
    const auto inner = [&](uint32_t i, uint32_t j) {
      return inner_first_[p] + (j - 1) * (ns - 1) + (i - 1);
    };
    const auto cut_quads = [&](uint32_t i0, uint32_t i1, uint32_t j0, uint32_t j1, auto vertex) {
      for (uint32_t j = j0; j < j1; ++j) {
        const auto [t0, t1] = part_between(j * (kUnits / nt), (j + 1) * (kUnits / nt));
        for (uint32_t i = i0; i < i1; ++i) {
          const uint32_t a = vertex(i, j);
          const uint32_t c = vertex(i + 1, j + 1);
          const auto [s0, s1] = part_between(i * (kUnits / ns), (i + 1) * (kUnits / ns));
          emit(a, vertex(i, j + 1), c, {s0, s1, t0, t1});
          emit(a, c, vertex(i + 1, j), {s0, s1, t0, t1});
        }
      }
    };
    if (edges[0].size() == nt + 1 && edges[1].size() == ns + 1 && edges[2].size() == nt + 1 &&
        edges[3].size() == ns + 1) {
      cut_quads(0, ns, 0, nt, [&](uint32_t i, uint32_t j) {
        if (i == 0) return edges[0][j].vertex;
        if (j == nt) return edges[1][i].vertex;
        if (i == ns) return edges[2][nt - j].vertex;
        if (j == 0) return edges[3][ns - i].vertex;
        return inner(i, j);
      });
      return;
    }
    cut_quads(1, ns - 1, 1, nt - 1, inner);
    // The ring's triangles lie between an edge and the first inner points beside it. Edges 2 and 3
    // run back along their parameter.
    const auto emit_ring = [&](uint32_t e) {
      const uint32_t across = kUnits / (e % 2 == 0 ? ns : nt);
      const auto [w0, w1] =
          e == 0 || e == 3 ? part_between(0, across) : part_between(kUnits - across, kUnits);
      return [&emit, e, w0 = w0, w1 = w1](uint32_t a, uint32_t b, uint32_t c, uint32_t from,
                                          uint32_t to) {
        const auto [l0, l1] =
            e < 2 ? part_between(from, to) : part_between(kUnits - to, kUnits - from);
        emit(a, b, c, e % 2 == 0 ? PatchPart{w0, w1, l0, l1} : PatchPart{l0, l1, w0, w1});
      };
    };
    join(edges[0], nt, emit_ring(0), [&](uint32_t k) { return inner(1, k); });
    join(edges[1], ns, emit_ring(1), [&](uint32_t k) { return inner(k, nt - 1); });
    join(edges[2], nt, emit_ring(2), [&](uint32_t k) { return inner(ns - 1, nt - k); });
    join(edges[3], ns, emit_ring(3), [&](uint32_t k) { return inner(ns - k, 1); });
  }

  // Triangles between an edge and the row of inner points beside it, n - 1 of them at k / n, each
  // with from where to where it reaches along the edge. Goes along both and always closes the gap
  // towards the nearer next point.
  template <class Emit, class Row>
  static void join(const std::vector<EdgePoint>& edge, uint32_t n, Emit emit, Row row) {
    uint32_t k = 1;
    for (size_t b = 0; b + 1 < edge.size() || k + 1 < n;) {
      const bool along_edge =
          k + 1 >= n || (b + 1 < edge.size() && 2 * n * edge[b + 1].at <= kUnits * (2 * k + 1));
      const uint32_t here = k * (kUnits / n), from = std::min(edge[b].at, here);
      if (along_edge) {
        emit(edge[b].vertex, edge[b + 1].vertex, row(k), from, std::max(edge[b + 1].at, here));
        ++b;
      } else {
        emit(edge[b].vertex, row(k + 1), row(k), from,
             std::max(edge[b].at, (k + 1) * (kUnits / n)));
        ++k;
      }
    }
  }

  const PatchSet& set_;
  const TessellationConfig& config_;
  Context& context_;
  double grid_;  // Vertices lie on whole 1 / grid_ of a metre.
  std::vector<Halvings> steps_;
  std::vector<Halvings> inner_steps_;
  std::vector<uint32_t> corner_;         // Vertex of corner 4 * patch + i.
  std::vector<uint32_t> corner_source_;  // The corner that places vertex i.
  std::vector<Seam> seams_;
  std::vector<uint32_t> seam_of_;  // By 4 * patch + edge; unused where an edge has several.
  std::vector<uint32_t> inner_first_;
  uint64_t vertices_ = 0;
  PatchMesh mesh_;
};

}  // namespace

Result<PatchMesh> tessellate_patches(const PatchSet& set, const TessellationConfig& config,
                                     Context& context) {
  constexpr uint64_t kMost = 4'000'000'000;
  if (!(config.tolerance > 0 && config.tolerance <= 1e6 && config.workers >= 0 &&
        config.most_triangles <= kMost)) {
    return Error{Errc::kBadConfig,
                 "patches: need tolerance > 0, workers >= 0, most_triangles <= 4e9"};
  }
  if (set.size() >= kNoPatch / 4) {
    return Error{Errc::kLimit, "patches: more than 1.07 thousand million; bake them in parts"};
  }
  if (const auto checked = check_patches(set); !checked) return checked.error();
  return Tessellator(set, config, context).run();
}

}  // namespace throng
