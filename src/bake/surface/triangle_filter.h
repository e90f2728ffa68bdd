// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "bake/surface/body_sweep.h"

/// Triangles near some bodies in single precision, tested a vector at a time: which of them surely
/// stay outside, and which bodies are surely entered. Each comparison allows more than its rounding
/// error, so an exact test of the rest finds the same as one of all.
namespace throng::bake {

/// Triangles around an origin. Coordinate k of corner c of triangle i is
/// corner[(3 * c + k) * stride + i]; its normal is plane[k * stride + i], along which it lies from
/// plane[3 * stride + i] to plane[4 * stride + i]; then come the middle and the radius of a ball
/// around it.
struct FilterList {
  Vec3d origin;
  double extent = 0;  ///< No coordinate is larger. [m]
  size_t count = 0;
  size_t stride = 0;  ///< Space for `count` and a vector.
  std::vector<float> corner;
  std::vector<float> plane;  ///< Known after close().
  std::vector<uint32_t> triangle;

  void clear(Vec3d around);
  void add(uint32_t id, const LocalTriangle& corners);
  void add(const Scene& scene, std::span<const uint32_t> ids);
  void close();  ///< After the last was added, before any query.
};

/// Replaces `out` by those triangles of `list` whose balls may touch `box`: none that overlaps it
/// is lost. Linear.
void narrow(const FilterList& list, const Box3d& box, FilterList& out);

/// A cylinder around a query's axis. A solid that enters `decisive`, which is a part of it, answers
/// the query for it.
struct FilterTube {
  BodySweep whole, decisive;
};

/// A query of a list. Nothing outside of `first` and `second` enters any tube.
struct FilterQuery {
  BodyFrame frame;
  BodySweep first, second;
  std::span<const FilterTube> tubes;  ///< [at most 31]
};

/// Bit i: some triangle's plane and ball come into tube i; all triangles stay outside of the other
/// tubes of which `asked` has the bits. It costs a fraction of filter(). [at most 31 tubes] Linear.
[[nodiscard]] uint32_t glance(const FilterList& list, const BodyFrame& frame,
                              std::span<const BodySweep> tubes, uint32_t asked);

/// True only if a triangle enters an upright tube; most that do are noticed. Linear.
[[nodiscard]] bool surely_enters(const FilterList& list, Vec3d centre, const BodySweep& tube);

/// Bit i: tube i, which is upright, is queried, and a triangle surely enters it uphill from its
/// axis, as ground does on which a body stands too steep. [at most 31 tubes] Linear.
[[nodiscard]] uint32_t surely_enters_uphill(const FilterList& list, Vec3d centre,
                                            std::span<const BodySweep> tubes, uint32_t asked);

/// Triangles that may enter tubes: hit i those of which tubes[i] has the bits.
struct FilterHits {
  size_t count = 0;
  std::vector<uint32_t> triangle, tubes;  ///< With space for more than `count`.
};

/// Replaces `hits` by what may enter tubes that are not answered. Returns those that are: bit i, if
/// a corner is surely inside tubes[i].decisive. If all are, hits are missing. Linear.
[[nodiscard]] uint32_t filter(const FilterList& list, const FilterQuery& question,
                              FilterHits& hits);

}  // namespace throng::bake
