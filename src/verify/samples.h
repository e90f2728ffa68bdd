// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>

#include "throng/base.h"
#include "verify/body_check.h"
#include "verify/claims.h"
#include "verify/segment_check.h"
#include "verify/stance.h"
#include "verify/surface_sampler.h"

/// What one random sample finds: of the states, of the moves, of the surfaces. Each is a pure
/// function of (seed, n).
namespace throng::verify {

struct StateRecord {
  bool exists = false;  ///< The world has a place.
  bool entered = false;
  bool unsupported = false;
  std::optional<double> feet_error;  ///< [m]
  Vec3d feet;
  uint32_t intruder = 0;
};

/// Takes the world's n-th random place.
[[nodiscard]] StateRecord check_state(const Claims& claims, const BodyCheck& body, uint64_t seed,
                                      uint64_t n);

struct MoveRecord {
  bool legal = false;  ///< The world let the move arrive.
  SegmentRecord segment;
};

/// Moves from the world's n-th random place, 0.02 to 3 m in a random direction, and tests the body
/// four times a cell on it.
[[nodiscard]] MoveRecord check_move(const Claims& claims, const BodyCheck& body, uint64_t seed,
                                    uint64_t n);

enum class Stand : uint8_t {
  kNo,        ///< The body does not stand there.
  kKept,      ///< The world has a floor there.
  kLost,      ///< It has none, and the body could walk to one (or the area is large).
  kIsolated,  ///< It has none, and the body could not leave the small area.
};

struct PointRecord {
  Stand exact = Stand::kNo;
  Stand grown = Stand::kNo;
};

/// Judges points of the surface. Owns scratch memory: one per thread.
class PointCheck {
 public:
  PointCheck(const Claims& claims, const TriangleTree& tree);

  [[nodiscard]] PointRecord check(Vec3d feet);

 private:
  [[nodiscard]] bool is_kept(Vec3d feet) const;
  [[nodiscard]] Stand denied(Stance& stance, Vec3d feet) const;

  const Claims* claims_;
  Stance exact_;
  Stance grown_;
};

}  // namespace throng::verify
