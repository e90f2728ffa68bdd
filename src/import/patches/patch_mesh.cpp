// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numeric>

#include "core/parallel.h"
#include "import/patches/patch_edges.h"
#include "import/patches/patch_steps.h"
#include "throng/scene.h"

// Cuts patches into triangles without cracks. A *seam* is a run of vertices between two corners of
// pieces, which the pieces on both sides use by index. Seams end wherever a piece on either side
// does, so a piece has one or more on each edge. If they are as fine as its inside, it is a grid;
// else a ring of triangles joins the seams to a grid of inner points. No seam is coarser than a
// piece beside it, so the ring's triangles span no more than the piece's own steps (see join), and
// the bound of their deviation holds for them too. Linear in the triangles.
namespace throng {
namespace {

constexpr uint32_t kParts = 256;  // of a parameter of a patch, as PatchPart counts

struct Seam {
  uint32_t steps = 1;
  uint32_t start = 0, end = 0;  // vertices
  uint32_t first = 0;           // of the steps - 1 vertices between
  bool collapsed = false;
};

// The seams along the whole edge of a patch, in its direction, except along an edge that two
// smaller neighbours divide.
struct Run {
  PatchSide side;  // whose curve it is
  uint32_t first = 0, count = 1;
};

// A line between two pieces of one patch.
struct InnerSeam {
  uint32_t patch = 0;
  uint32_t i = 0, j = 0;  // where it begins, in pieces
  bool along_s = false;   // else along t
};

struct EdgePoint {
  uint32_t vertex = 0;
  double at = 0;  // along the edge
};

uint32_t along(importer::Steps h, uint32_t edge) { return edge % 2 == 0 ? h.t : h.s; }

// k of n pieces or steps.
double share(uint32_t k, uint32_t n) { return static_cast<double>(k) / n; }

uint32_t ceil_div(uint32_t a, uint32_t b) { return (a + b - 1) / b; }

class Tessellator {
 public:
  Tessellator(const PatchSet& set, const TessellationConfig& config, Context& context)
      : set_(set), config_(config), context_(context) {
    // Millimetres, or a twentieth of the tolerance if that is finer, so that rounding stays within
    // the tolerance.
    grid_ = std::max(1000.0, std::ceil(20 / config.tolerance));
  }

  Result<PatchMesh> run() {
    measure();
    if (context_.cancel) return cancelled();
    number_corners();
    make_runs();
    make_inner_seams();
    if (!number_vertices()) return too_many();
    if (context_.cancel) return cancelled();
    if (!count_triangles()) return too_many();
    // The first touch of memory costs as much as the writing itself.
    const std::array<std::function<void()>, 3> make_room{
        [&] { mesh_.positions.resize(vertices_); },
        [&] { mesh_.triangles.resize(mesh_.first.back()); },
        [&] { mesh_.parts.resize(mesh_.first.back()); }};
    parallel_for(make_room.size(), config_.workers, [&](size_t i) { make_room[i](); });
    mesh_.off.resize(set_.size());
    place_vertices();
    for_each_patch([&](uint32_t p) {
      size_t out = mesh_.first[p];
      for_each_triangle(p, [&](uint32_t a, uint32_t b, uint32_t c, PatchPart part) {
        mesh_.parts[out] = part;
        mesh_.triangles[out++] = {a, b, c};
      });
      mesh_.off[p] = vertices_off(p);
    });
    return std::move(mesh_);
  }

 private:
  static Error cancelled() { return {Errc::kCancelled, "cancelled while cutting patches"}; }
  [[nodiscard]] Error too_many() const {
    return {Errc::kLimit,
            fmt::format("patches: {} patches give more than {} triangles at a tolerance of {} m; "
                        "raise curve_tolerance, or check the scale",
                        set_.size(), config_.max_triangles, config_.tolerance)};
  }

  [[nodiscard]] double rounding() const { return std::sqrt(3.0) / 2 / grid_; }

  template <class Body>
  void for_each_patch(Body body) const {
    parallel_ranges(set_.size(), 64, config_.workers, [&](size_t begin, size_t end) {
      for (size_t p = begin; p < end; ++p) body(static_cast<uint32_t>(p));
    });
  }

  [[nodiscard]] uint32_t pieces(uint32_t p) const { return static_cast<uint32_t>(cuts_[p].pieces); }

  void measure() {
    cuts_.resize(set_.size());
    for_each_patch([&](uint32_t p) {
      cuts_[p] = importer::cut_within(set_.patches[p], config_.tolerance - rounding());
    });
  }

  // Corners that are one vertex get one number, in the order of their first patch.
  void number_corners() {
    corner_ = importer::weld_corners(set_);
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
      if (pieces(p) > 1) continue;
      for (uint32_t e = 0; e < 4; ++e) {
        if (corner_[4 * p + e] != corner_[4 * p + (e + 1) % 4]) continue;
        if (importer::is_collapsed(set_.patches[p].edge(static_cast<int32_t>(e)))) continue;
        uint8_t& steps = e % 2 == 0 ? cuts_[p].steps[0].t : cuts_[p].steps[0].s;
        steps = std::max<uint8_t>(steps, 4);
      }
    }
  }

  [[nodiscard]] const PatchEdge& edge_at(PatchSide side) const {
    return set_.edges[side.patch][side.edge];
  }

  // A run lies on the smaller patch's edge, or on that of the patch that comes first.
  [[nodiscard]] bool owns_run(PatchSide side) const {
    const PatchEdge& edge = edge_at(side);
    if (edge.bind == EdgeBind::kTwo || edge.bind == EdgeBind::kFour) return false;
    if (edge.bind != EdgeBind::kOne) return true;
    const PatchSide next = edge.next[0];
    return side.patch != next.patch ? side.patch < next.patch : side.edge < next.edge;
  }

  // The k-th piece along an edge of a patch, in the edge's direction.
  [[nodiscard]] importer::Steps piece_along(PatchSide side, uint32_t k) const {
    const importer::PatchCut& cut = cuts_[side.patch];
    const uint32_t last = pieces(side.patch) - 1;
    switch (side.edge) {
      case 0:
        return cut.at(0, k);
      case 1:
        return cut.at(k, last);
      case 2:
        return cut.at(last, last - k);
      default:
        return cut.at(last - k, 0);
    }
  }

  // Steps that part k of `count` of an edge needs; the parts are no longer than its pieces.
  [[nodiscard]] uint32_t steps_needed(PatchSide side, uint32_t k, uint32_t count) const {
    const uint32_t each = count / pieces(side.patch);
    return ceil_div(along(piece_along(side, k / each), side.edge), each);
  }

  void make_runs() {
    run_of_.assign(4 * set_.size(), 0);
    for (uint32_t p = 0; p < set_.size(); ++p) {
      for (uint32_t e = 0; e < 4; ++e) {
        const PatchSide side{p, e};
        if (!owns_run(side)) continue;
        const PatchEdge& edge = edge_at(side);
        // The neighbour's edge is one, two or four such runs.
        const PatchSide next = edge.next[0];
        const bool is_open = edge.bind == EdgeBind::kOpen;
        const uint32_t runs =
            edge.bind == EdgeBind::kPart
                ? static_cast<uint32_t>(importer::neighbour_count(edge_at(next).bind))
                : 1;
        Run run{.side = side, .first = static_cast<uint32_t>(seams_.size()), .count = pieces(p)};
        uint32_t which = 0;  // of the neighbour's runs, in its direction
        if (!is_open) {
          run.count = std::max(run.count, pieces(next.patch) / runs);
          while (edge.bind == EdgeBind::kPart && edge_at(next).next[which] != side) ++which;
        }
        run_of_[4 * p + e] = static_cast<uint32_t>(runs_.size());
        if (edge.bind == EdgeBind::kOne) {
          run_of_[4 * next.patch + next.edge] = run_of_[4 * p + e];
        }
        runs_.push_back(run);
        const bool collapsed =
            importer::is_collapsed(set_.patches[p].edge(static_cast<int32_t>(e)));
        for (uint32_t k = 0; k < run.count; ++k) {
          Seam seam{.steps = steps_needed(side, k, run.count), .collapsed = collapsed};
          if (!is_open) {
            const uint32_t across = (which + 1) * run.count - 1 - k;
            seam.steps = std::max(seam.steps, steps_needed(next, across, runs * run.count));
          }
          seams_.push_back(seam);
        }
      }
    }
  }

  // By patch, first those along t, then those along s.
  void make_inner_seams() {
    inner_first_seam_.resize(set_.size());
    outer_seams_ = static_cast<uint32_t>(seams_.size());
    for (uint32_t p = 0; p < set_.size(); ++p) {
      inner_first_seam_[p] = static_cast<uint32_t>(seams_.size());
      const uint32_t n = pieces(p);
      const importer::PatchCut& cut = cuts_[p];
      for (uint32_t i = 1; i < n; ++i) {
        for (uint32_t j = 0; j < n; ++j) {
          seams_.push_back({.steps = std::max(cut.at(i - 1, j).t, cut.at(i, j).t)});
          inner_.push_back({p, i, j, false});
        }
      }
      for (uint32_t j = 1; j < n; ++j) {
        for (uint32_t i = 0; i < n; ++i) {
          seams_.push_back({.steps = std::max(cut.at(i, j - 1).s, cut.at(i, j).s)});
          inner_.push_back({p, i, j, true});
        }
      }
    }
  }

  // The seam before pieces (i, j): between (i - 1, j) and (i, j) along t, or between (i, j - 1) and
  // (i, j) along s.
  [[nodiscard]] uint32_t inner_seam(uint32_t p, uint32_t i, uint32_t j, bool along_s) const {
    const uint32_t n = pieces(p), lines = along_s ? (n - 1) * n : 0;
    return inner_first_seam_[p] + lines + (along_s ? (j - 1) * n + i : (i - 1) * n + j);
  }

  // First the corners of patches, then those of pieces on their edges and inside, then the seams,
  // then the inner points of each piece.
  bool number_vertices() {
    uint64_t next = corner_source_.size();
    for (const Run& run : runs_) {
      const uint32_t start = corner_[4 * run.side.patch + run.side.edge];
      const uint32_t end = corner_[4 * run.side.patch + (run.side.edge + 1) % 4];
      for (uint32_t k = 0; k < run.count; ++k) {
        Seam& seam = seams_[run.first + k];
        seam.start = k == 0 ? start : seams_[run.first + k - 1].end;
        seam.end =
            k + 1 == run.count ? end : static_cast<uint32_t>(seam.collapsed ? start : next++);
      }
    }
    crossing_first_.resize(set_.size());
    for (uint32_t p = 0; p < set_.size(); ++p) {
      crossing_first_[p] = static_cast<uint32_t>(next);
      next += uint64_t{pieces(p) - 1} * (pieces(p) - 1);
    }
    for (size_t k = 0; k < inner_.size(); ++k) {
      const InnerSeam& line = inner_[k];
      Seam& seam = seams_[outer_seams_ + k];
      seam.start = piece_corner(line.patch, line.i, line.j);
      seam.end = piece_corner(line.patch, line.i + line.along_s, line.j + !line.along_s);
    }
    for (Seam& seam : seams_) {
      seam.first = static_cast<uint32_t>(next);
      if (!seam.collapsed) next += seam.steps - 1;
    }
    if (next > config_.max_triangles) return false;
    piece_first_.assign(1, 0);
    for (uint32_t p = 0; p < set_.size(); ++p) {
      const uint32_t n = pieces(p);
      for (uint32_t k = 0; k < n * n; ++k) {
        const importer::Steps h = inner_steps(p, k % n, k / n);
        inner_first_.push_back(static_cast<uint32_t>(next));
        next += uint64_t{h.s - 1u} * (h.t - 1u);
      }
      if (next > config_.max_triangles) return false;  // There are twice as many triangles.
      piece_first_.push_back(static_cast<uint32_t>(inner_first_.size()));
    }
    vertices_ = next;
    return true;
  }

  // The vertex where pieces of a patch meet. [i, j at most the pieces along a side]
  [[nodiscard]] uint32_t piece_corner(uint32_t p, uint32_t i, uint32_t j) const {
    const uint32_t n = pieces(p);
    if (i > 0 && i < n && j > 0 && j < n) return crossing_first_[p] + (j - 1) * (n - 1) + i - 1;
    // On an edge: where the piece that begins there, in the edge's direction, has its first seam.
    uint32_t e = 0, k = j;
    if (j == n && i < n) {
      e = 1;
      k = i;
    } else if (i == n && j > 0) {
      e = 2;
      k = n - j;
    } else if (j == 0 && i > 0) {
      e = 3;
      k = n - i;
    }
    uint32_t vertex = 0;
    bool found = false;
    for_each_seam({p, e}, k, [&](const Seam& seam, bool backward) {
      if (!found) vertex = backward ? seam.end : seam.start;
      found = true;
    });
    return vertex;
  }

  // The seams along the k-th piece of an edge, in the edge's direction.
  template <class Body>
  void for_each_seam(PatchSide side, uint32_t k, Body body) const {
    const PatchEdge& edge = edge_at(side);
    const uint32_t n = pieces(side.patch);
    const bool is_own = owns_run(side);
    const auto count = std::max(1u, static_cast<uint32_t>(importer::neighbour_count(edge.bind)));
    const uint32_t runs = is_own ? 1 : count;
    // In parts of the edge that end wherever a piece or a run does.
    const uint32_t parts = std::max(n, runs);
    for (uint32_t part = k * parts / n; part < (k + 1) * parts / n; ++part) {
      const uint32_t which = part * runs / parts;
      const uint32_t in_run = parts / runs, at = part % in_run;
      const PatchSide other = is_own ? side : edge.next[which];
      const Run& run = runs_[run_of_[4 * other.patch + other.edge]];
      const uint32_t each = run.count / in_run;
      for (uint32_t i = at * each; i < (at + 1) * each; ++i) {
        body(seams_[run.first + (is_own ? i : run.count - 1 - i)], !is_own);
      }
    }
  }

  bool count_triangles() {
    std::vector<uint32_t> count(set_.size());
    for_each_patch([&](uint32_t p) {
      uint32_t triangles = 0;
      for_each_triangle(p, [&](uint32_t, uint32_t, uint32_t, PatchPart) { ++triangles; });
      count[p] = triangles;
    });
    mesh_.first.assign(1, 0);
    mesh_.first.reserve(set_.size() + 1);
    uint64_t sum = 0;
    for (const uint32_t triangles : count) {
      sum += triangles;
      if (sum > config_.max_triangles) return false;
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
    parallel_ranges(runs_.size(), 64, config_.workers, [&](size_t begin, size_t end) {
      for (size_t r = begin; r < end; ++r) {
        const Run& run = runs_[r];
        const auto curve = set_.patches[run.side.patch].edge(static_cast<int32_t>(run.side.edge));
        for (uint32_t k = 0; k < run.count; ++k) {
          const Seam& seam = seams_[run.first + k];
          if (seam.collapsed) continue;
          for (uint32_t i = 1; i < seam.steps; ++i) {
            mesh_.positions[seam.first + i - 1] =
                rounded(cubic_point(curve, (k + share(i, seam.steps)) / run.count));
          }
          if (k + 1 < run.count) {
            mesh_.positions[seam.end] = rounded(cubic_point(curve, share(k + 1, run.count)));
          }
        }
      }
    });
    parallel_ranges(inner_.size(), 64, config_.workers, [&](size_t begin, size_t end) {
      for (size_t k = begin; k < end; ++k) {
        const InnerSeam& line = inner_[k];
        const Seam& seam = seams_[outer_seams_ + k];
        const BezierPatch& patch = set_.patches[line.patch];
        const uint32_t n = pieces(line.patch);
        for (uint32_t i = 1; i < seam.steps; ++i) {
          const double at = share(i, seam.steps);
          mesh_.positions[seam.first + i - 1] = rounded(patch.at(
              (line.i + (line.along_s ? at : 0)) / n, (line.j + (line.along_s ? 0 : at)) / n));
        }
      }
    });
    for_each_patch([&](uint32_t p) {
      const BezierPatch& patch = set_.patches[p];
      const uint32_t n = pieces(p);
      for (uint32_t j = 1; j < n; ++j) {
        for (uint32_t i = 1; i < n; ++i) {
          mesh_.positions[piece_corner(p, i, j)] = rounded(patch.at(share(i, n), share(j, n)));
        }
      }
      for (uint32_t piece = 0; piece < n * n; ++piece) {
        const uint32_t i = piece % n, j = piece / n;
        const importer::Steps h = inner_steps(p, i, j);
        uint32_t vertex = inner_first_[piece_first_[p] + piece];
        for (uint32_t b = 1; b < h.t; ++b) {
          for (uint32_t a = 1; a < h.s; ++a) {
            mesh_.positions[vertex++] =
                rounded(patch.at((i + share(a, h.s)) / n, (j + share(b, h.t)) / n));
          }
        }
      }
    });
  }

  // Calls body(seam, backward) for those along an edge of a piece, in the edge's direction.
  template <class Body>
  void for_each_seam_of_piece(uint32_t p, uint32_t i, uint32_t j, uint32_t e, Body body) const {
    const uint32_t last = pieces(p) - 1;
    if (e == 0 && i > 0) {
      body(seams_[inner_seam(p, i, j, false)], false);
    } else if (e == 1 && j < last) {
      body(seams_[inner_seam(p, i, j + 1, true)], false);
    } else if (e == 2 && i < last) {
      body(seams_[inner_seam(p, i + 1, j, false)], true);
    } else if (e == 3 && j > 0) {
      body(seams_[inner_seam(p, i, j, true)], true);
    } else {
      const uint32_t k = e == 0 ? j : e == 1 ? i : e == 2 ? last - j : last - i;
      for_each_seam({p, e}, k, body);
    }
  }

  // No seam is coarser than the piece, so equal counts mean equal steps.
  [[nodiscard]] bool is_grid(uint32_t p, uint32_t i, uint32_t j) const {
    const importer::Steps h = cuts_[p].at(i, j);
    for (uint32_t e = 0; e < 4; ++e) {
      uint32_t steps = 0;
      for_each_seam_of_piece(p, i, j, e, [&](const Seam& seam, bool) { steps += seam.steps; });
      if (steps != along(h, e)) return false;
    }
    return true;
  }

  // A ring needs an inside.
  [[nodiscard]] importer::Steps inner_steps(uint32_t p, uint32_t i, uint32_t j) const {
    const importer::Steps h = cuts_[p].at(i, j);
    if (is_grid(p, i, j)) return h;
    return {std::max<uint8_t>(h.s, 2), std::max<uint8_t>(h.t, 2)};
  }

  // All vertices along an edge of a piece, from corner to corner.
  void collect_edge(uint32_t p, uint32_t i, uint32_t j, uint32_t e,
                    std::vector<EdgePoint>& out) const {
    out.clear();
    uint32_t parts = 0, part = 0, last = 0;
    for_each_seam_of_piece(p, i, j, e, [&](const Seam&, bool) { ++parts; });
    for_each_seam_of_piece(p, i, j, e, [&](const Seam& seam, bool backward) {
      for (uint32_t k = 0; k < seam.steps; ++k) {
        const uint32_t step = backward ? seam.steps - k : k;
        uint32_t vertex = seam.first + step - 1;
        if (step == 0 || seam.collapsed) vertex = seam.start;
        if (step == seam.steps) vertex = seam.end;
        out.push_back({vertex, (part + share(k, seam.steps)) / parts});
      }
      ++part;
      last = backward ? seam.start : seam.end;
    });
    out.push_back({last, 1});
  }

  // How far the vertices of a patch are from its surface at their parameters. Those of its edges
  // may lie on a neighbour's curve.
  [[nodiscard]] double vertices_off(uint32_t p) const {
    thread_local std::vector<EdgePoint> points;
    double off = rounding();
    const uint32_t n = pieces(p), last = n - 1;
    for (uint32_t e = 0; e < 4; ++e) {
      const auto curve = set_.patches[p].edge(static_cast<int32_t>(e));
      for (uint32_t k = 0; k < n; ++k) {
        const uint32_t i = e == 0 ? 0 : e == 1 ? k : e == 2 ? last : last - k;
        const uint32_t j = e == 0 ? k : e == 1 ? last : e == 2 ? last - k : 0;
        collect_edge(p, i, j, e, points);
        for (const EdgePoint& point : points) {
          const Vec3d own = cubic_point(curve, (k + point.at) / n);
          off = std::max(off, length(mesh_.positions[point.vertex] - own));
        }
      }
    }
    return off;
  }

  // From one parameter of a piece to another, of the patch's parts.
  static std::array<uint8_t, 2> part_between(uint32_t piece, uint32_t pieces, double from,
                                             double to) {
    const double scale = static_cast<double>(kParts) / pieces;
    const auto begin = static_cast<int32_t>(std::floor((piece + from) * scale));
    const auto end = static_cast<int32_t>(std::ceil((piece + to) * scale));
    return {static_cast<uint8_t>(begin), static_cast<uint8_t>(end - 1)};
  }

  // Calls emit(a, b, c, part) for each triangle of a patch; those that a collapsed edge makes flat
  // are left out.
  template <class Emit>
  void for_each_triangle(uint32_t p, Emit emit_any) const {
    const auto emit = [&](uint32_t a, uint32_t b, uint32_t c, PatchPart part) {
      if (a != b && b != c && a != c) emit_any(a, b, c, part);
    };
    const uint32_t n = pieces(p);
    for (uint32_t j = 0; j < n; ++j) {
      for (uint32_t i = 0; i < n; ++i) cut_piece(p, i, j, emit);
    }
  }

  template <class Emit>
  void cut_piece(uint32_t p, uint32_t i, uint32_t j, Emit emit) const {
    thread_local std::array<std::vector<EdgePoint>, 4> edges;
    for (uint32_t e = 0; e < 4; ++e) collect_edge(p, i, j, e, edges[e]);
    const uint32_t n = pieces(p);
    const bool grid = is_grid(p, i, j);
    const importer::Steps h = inner_steps(p, i, j);
    const uint32_t ns = h.s, nt = h.t, first = inner_first_[piece_first_[p] + j * n + i];
    const auto inner = [&](uint32_t a, uint32_t b) { return first + (b - 1) * (ns - 1) + (a - 1); };
    const auto cut_quads = [&](uint32_t a0, uint32_t a1, uint32_t b0, uint32_t b1, auto vertex) {
      for (uint32_t b = b0; b < b1; ++b) {
        const auto [t0, t1] = part_between(j, n, share(b, nt), share(b + 1, nt));
        for (uint32_t a = a0; a < a1; ++a) {
          const uint32_t low = vertex(a, b), high = vertex(a + 1, b + 1);
          const auto [s0, s1] = part_between(i, n, share(a, ns), share(a + 1, ns));
          emit(low, vertex(a, b + 1), high, {s0, s1, t0, t1});
          emit(low, high, vertex(a + 1, b), {s0, s1, t0, t1});
        }
      }
    };
    if (grid) {
      cut_quads(0, ns, 0, nt, [&](uint32_t a, uint32_t b) {
        if (a == 0) return edges[0][b].vertex;
        if (b == nt) return edges[1][a].vertex;
        if (a == ns) return edges[2][nt - b].vertex;
        if (b == 0) return edges[3][ns - a].vertex;
        return inner(a, b);
      });
      return;
    }
    cut_quads(1, ns - 1, 1, nt - 1, inner);
    // The ring's triangles lie between an edge and the first inner points beside it. Edges 2 and 3
    // run back along their parameter.
    const auto emit_ring = [&](uint32_t e) {
      const double across = share(1, e % 2 == 0 ? ns : nt);
      const uint32_t piece_across = e % 2 == 0 ? i : j, piece_along = e % 2 == 0 ? j : i;
      const auto [w0, w1] = e == 0 || e == 3 ? part_between(piece_across, n, 0, across)
                                             : part_between(piece_across, n, 1 - across, 1);
      return [&emit, e, n, piece_along, w0 = w0, w1 = w1](uint32_t a, uint32_t b, uint32_t c,
                                                          double from, double to) {
        const auto [l0, l1] = e < 2 ? part_between(piece_along, n, from, to)
                                    : part_between(piece_along, n, 1 - to, 1 - from);
        emit(a, b, c, e % 2 == 0 ? PatchPart{w0, w1, l0, l1} : PatchPart{l0, l1, w0, w1});
      };
    };
    join(edges[0], nt, emit_ring(0), [&](uint32_t k) { return inner(1, k); });
    join(edges[1], ns, emit_ring(1), [&](uint32_t k) { return inner(k, nt - 1); });
    join(edges[2], nt, emit_ring(2), [&](uint32_t k) { return inner(ns - 1, nt - k); });
    join(edges[3], ns, emit_ring(3), [&](uint32_t k) { return inner(ns - k, 1); });
  }

  // Triangles between an edge and the row of n - 1 inner points beside it, at k / n; each with its
  // range along the edge. A step between inner points is joined to a point of the edge within it,
  // the one nearest to its middle; there is one, since no step of the edge is longer. So the steps
  // of the edge that are joined to an inner point lie within a step of it, and no triangle spans
  // more than 1 / n.
  template <class Emit, class Row>
  static void join(const std::vector<EdgePoint>& edge, uint32_t n, Emit emit, Row row) {
    uint32_t k = 1;
    for (size_t b = 0; b + 1 < edge.size() || k + 1 < n;) {
      const double here = share(k, n);
      const bool along_edge =
          k + 1 >= n ||
          (b + 1 < edge.size() && (edge[b].at < here || 2 * n * edge[b + 1].at <= 2 * k + 1));
      const double from = std::min(edge[b].at, here);
      if (along_edge) {
        emit(edge[b].vertex, edge[b + 1].vertex, row(k), from, std::max(edge[b + 1].at, here));
        ++b;
      } else {
        emit(edge[b].vertex, row(k + 1), row(k), from, std::max(edge[b].at, share(k + 1, n)));
        ++k;
      }
    }
  }

  const PatchSet& set_;
  const TessellationConfig& config_;
  Context& context_;
  double grid_;  // Vertices lie on whole 1 / grid_ of a metre.
  std::vector<importer::PatchCut> cuts_;
  std::vector<uint32_t> corner_;         // Vertex of corner 4 * patch + i.
  std::vector<uint32_t> corner_source_;  // The corner that places vertex i.
  std::vector<Run> runs_;
  std::vector<uint32_t> run_of_;  // By 4 * patch + edge; unused where an edge has several.
  std::vector<Seam> seams_;       // those of runs, then those inside patches
  uint32_t outer_seams_ = 0;
  std::vector<InnerSeam> inner_;
  std::vector<uint32_t> inner_first_seam_;  // by patch
  std::vector<uint32_t> crossing_first_;    // by patch: vertices where four of its pieces meet
  std::vector<uint32_t> piece_first_;       // by patch, and the end
  std::vector<uint32_t> inner_first_;       // by piece: its inner points
  uint64_t vertices_ = 0;
  PatchMesh mesh_;
};

}  // namespace

Result<PatchMesh> tessellate_patches(const PatchSet& set, const TessellationConfig& config,
                                     Context& context) {
  constexpr uint64_t kMax = 4'000'000'000;
  if (!(config.tolerance > 0 && config.tolerance <= 1e6 && config.workers >= 0 &&
        config.max_triangles <= kMax)) {
    return Error{Errc::kBadConfig,
                 "patches: need tolerance > 0, workers >= 0, max_triangles <= 4e9"};
  }
  if (set.size() >= kNoPatch / 4) {
    return Error{Errc::kLimit, "patches: more than 1.07 thousand million; bake them in parts"};
  }
  if (const auto checked = check_patches(set); !checked) return checked.error();
  return Tessellator(set, config, context).run();
}

}  // namespace throng
