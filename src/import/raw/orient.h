// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

/// On which side of a line a point lies, decided exactly: signs that contradict each other cause
/// cracks and endless loops in polygon code.
namespace throng::importer {

struct Vec2d {
  double x = 0, y = 0;
  friend bool operator==(const Vec2d&, const Vec2d&) = default;
};

/// 1 if c lies left of the line from a to b, -1 if right, 0 if on it. Exact for finite coordinates
/// whose products neither overflow nor underflow (1e-140 to 1e140).
[[nodiscard]] int orient(Vec2d a, Vec2d b, Vec2d c);

}  // namespace throng::importer
