// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "verify/body_check.h"
#include "verify/claims.h"

/// A body that goes straight from one claimed place to another.
namespace throng::verify {

struct SegmentRecord {
  bool entered = false;                         ///< Somewhere a triangle meets the body.
  bool unsupported = false;                     ///< Somewhere it has nothing to stand on.
  bool broken = false;                          ///< A point of it has no legal place.
  Vec3d entered_at, unsupported_at, broken_at;  ///< The first of each.
  uint32_t intruder = 0;
  uint64_t bodies = 0;  ///< Looked at.
};

/// Looks at the body after each `spacing` metres and at the end, its feet where the world says that
/// they are. Adds to `record`; goes no farther where the segment is broken.
void check_segment(const Claims& claims, const BodyCheck& body, const Place& from, const Place& to,
                   double spacing, SegmentRecord& record);

}  // namespace throng::verify
