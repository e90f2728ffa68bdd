// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "throng/base.h"
#include "throng/context.h"
#include "throng/math.h"
#include "throng/result.h"

/// Curved ground: bicubic Bezier patches that know their neighbours, and their triangles.
/// Source: [PACS00] 1.1, where a world is made of patches with 1, 2 or 4 neighbours on each edge.
namespace throng {

/// A patch: a bicubic Bezier surface, a point for each (s, t) in [0, 1] x [0, 1]. Control point i
/// of s and j of t is points[4 * j + i]. Vertices 0 to 3 lie at (s, t) = (0, 0), (0, 1), (1, 1),
/// (1, 0); edge e runs from vertex e to vertex (e + 1) % 4, which is counter-clockwise seen from
/// the side of the normal. An edge or a vertex may be collapsed. [m]
struct THRONG_API BezierPatch {
  std::array<Vec3d, 16> points{};

  [[nodiscard]] Vec3d at(double s, double t) const;
  [[nodiscard]] Vec3d along_s(double s, double t) const;  ///< First derivative by s.
  [[nodiscard]] Vec3d along_t(double s, double t) const;  ///< First derivative by t.
  /// The unit normal, along_t x along_s. Where the two are parallel or vanish (a collapsed edge),
  /// the limit from inside the patch, to about 1e-5 rad. Zero only if the patch has no area there.
  [[nodiscard]] Vec3d normal(double s, double t) const;
  /// A box that contains the surface; usually a little larger.
  [[nodiscard]] Box3d bounds() const;
  [[nodiscard]] Vec3d vertex(int32_t corner) const;
  /// The control points of an edge's curve, from vertex e on. `edge` is 0 to 3.
  [[nodiscard]] std::array<Vec3d, 4> edge(int32_t edge) const;
};

/// The point of a cubic Bezier curve at `u` in [0, 1].
[[nodiscard]] THRONG_API Vec3d cubic_point(const std::array<Vec3d, 4>& curve, double u);

/// The parts of a patch below and above parameter `at`, by de Casteljau's construction: together
/// the same surface, each with parameters from 0 to 1 of its own.
[[nodiscard]] THRONG_API std::array<BezierPatch, 2> split_s(const BezierPatch& patch, double at);
[[nodiscard]] THRONG_API std::array<BezierPatch, 2> split_t(const BezierPatch& patch, double at);

/// The same surface with a higher degree: `degree_s` and `degree_t` are 1 to 3, and `points` holds
/// (degree_s + 1) * (degree_t + 1) control points, those along s next to each other. Quake 3's
/// curved pieces have degree 2 in both.
[[nodiscard]] THRONG_API BezierPatch raise_degree(int32_t degree_s, int32_t degree_t,
                                                  std::span<const Vec3d> points);

/// Index of no patch.
inline constexpr uint32_t kNoPatch = UINT32_MAX;

/// One side of one patch.
struct PatchSide {
  uint32_t patch = kNoPatch;
  uint32_t edge = 0;  ///< 0 to 3
  friend bool operator==(PatchSide, PatchSide) = default;
};

/// How many neighbours an edge has: the number is theirs, except for kPart.
enum class EdgeBind : uint8_t {
  kOpen = 0,
  kOne = 1,
  kTwo = 2,
  kFour = 4,
  kPart = 5,  ///< The whole edge is one half or quarter of a bigger patch's edge.
};

/// The neighbours of one edge. A neighbour's edge runs in the opposite direction, so that both
/// patches face the same side. next[0] is the neighbour nearest to the edge's first vertex; unused
/// ones are null. Part k of n ends at the bigger edge's parameters k / n and (k + 1) / n.
struct PatchEdge {
  EdgeBind bind = EdgeBind::kOpen;
  std::array<PatchSide, 4> next{};
};

/// The origin of a run of patches: one node and material of a file.
struct PatchRun {
  std::string file;
  std::string node;
  std::string material;
  uint8_t kind = 1;  ///< AreaKind, before any rule.
  uint32_t first_patch = 0;
  uint32_t patch_count = 0;
};

/// Patches and their neighbours as arrays: edges[p][e] belongs to patches[p].
struct THRONG_API PatchSet {
  std::vector<BezierPatch> patches;
  std::vector<std::array<PatchEdge, 4>> edges;
  std::vector<PatchRun> runs;  ///< In order of patches; covers all of them.

  [[nodiscard]] bool empty() const { return patches.empty(); }
  [[nodiscard]] size_t size() const { return patches.size(); }

  /// Begins a run: patches that are added from here on belong to it.
  void begin_run(std::string_view file, std::string_view node, std::string_view material,
                 uint8_t kind = 1);
  /// Adds a patch with four open edges; returns its index.
  uint32_t add(const BezierPatch& patch);
  /// Makes two edges neighbours, one to one.
  void bind(PatchSide a, PatchSide b);
  /// Gives edge `big` 2 or 4 neighbours, in order from its first vertex.
  void bind_parts(PatchSide big, std::span<const PatchSide> parts);
  /// Appends all of `other`.
  void append(const PatchSet& other);
  /// A patch's name for messages: "FILE: patch 3 of 3_AC", counted within its run.
  [[nodiscard]] std::string name_of(uint32_t patch) const;
};

/// Checks the invariants of a set: finite points, runs that cover all patches, neighbours that
/// exist, name each other and run in opposite directions, and curves that meet within 0.1 m. Fails
/// with kBadInput, the first bad patch and its edge. Linear in the patches.
[[nodiscard]] THRONG_API Result<void> check_patches(const PatchSet& set);

/// The connected component of each patch, by edges: numbered from 0 in order of their first
/// patches. The set must pass check_patches.
[[nodiscard]] THRONG_API std::vector<uint32_t> patch_components(const PatchSet& set);

/// Settings of tessellation.
struct TessellationConfig {
  double tolerance = 0.02;  ///< Largest distance of a patch from its triangles. [m, > 0]
  int32_t workers = 0;      ///< Threads, 0 for all cores. Never changes the result. [>= 0]
  uint64_t max_triangles = 100'000'000;  ///< More are refused. [<= 4 thousand million]
};

/// The part of a patch's parameters that a triangle covers, in 256ths rounded outward, with both
/// ends: s from s0 / 256 to (s1 + 1) / 256.
struct PatchPart {
  uint8_t s0 = 0, s1 = 255, t0 = 0, t1 = 255;
  friend bool operator==(const PatchPart&, const PatchPart&) = default;
};

/// Triangles of patches. Those of patch p are triangles[first[p]] to triangles[first[p + 1]],
/// counter-clockwise seen from the side of the normal.
struct PatchMesh {
  std::vector<Vec3d> positions;
  std::vector<std::array<uint32_t, 3>> triangles;
  std::vector<uint32_t> first;   ///< patches + 1
  std::vector<PatchPart> parts;  ///< One per triangle.
  /// Per patch: largest distance of its vertices from its surface at their parameters, from
  /// rounding and, on an edge whose neighbour has another curve, from the difference of the curves.
  /// [m]
  std::vector<double> off;
};

/// Cuts all patches into triangles, as finely as their curvature needs: each as a whole, or in 4 x
/// 4 pieces, in equal divisions (at most 128 along a side; only a patch that needs more is off by
/// more than the tolerance). Neighbours share their vertices by index whatever their divisions,
/// across halves and quarters too, so there is no crack: each edge of a triangle that is not on an
/// open edge of a patch belongs to two triangles, in opposite directions. Where the curves of
/// neighbours differ, the curve of one patch is used for both. Vertices lie on whole millimetres
/// (finer if the tolerance requires it). Time and memory are linear in the triangles. Fails with
/// kBadConfig, with kBadInput like check_patches, with kLimit or kCancelled.
[[nodiscard]] THRONG_API Result<PatchMesh> tessellate_patches(const PatchSet& set,
                                                              const TessellationConfig& config,
                                                              Context& context);

/// Writes a patch file (docs/file_format.md) that load_scene reads; numbers keep all their digits.
/// Fails with kBadInput (see check_patches) or kIo; then no file is left.
[[nodiscard]] THRONG_API Result<void> write_patches(const PatchSet& set, const std::string& path);

}  // namespace throng
