// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "import/builtin/world_builder.h"

/// The parts of the built-in worlds: boxes, slabs with holes, walls with doors,
/// flights of stairs, spirals, pipes, cars, trees. All in the builder's current frame, Y up, faces
/// outward.
namespace throng::importer::shapes {

enum Face : uint32_t {
  kLowX = 1,
  kHighX = 2,
  kLowY = 4,
  kHighY = 8,
  kLowZ = 16,
  kHighZ = 32,
  kSides = kLowX | kHighX | kLowZ | kHighZ,
  kNoBottom = kSides | kHighY,
  kAllFaces = kSides | kLowY | kHighY,
};

/// A rectangle in plan.
struct Rect {
  double x0 = 0, z0 = 0, x1 = 0, z1 = 0;
};

void box(WorldBuilder& b, Mat material, Vec3d low, Vec3d high, uint32_t faces = kAllFaces);

/// A box whose corners may be anywhere: bottom ring, then top ring, in the order (x0, z0), (x0,
/// z1), (x1, z1), (x1, z0).
void hexahedron(WorldBuilder& b, Mat material, const std::array<Vec3d, 8>& corners,
                uint32_t faces = kAllFaces);

/// A single level surface, facing up.
void floor_rect(WorldBuilder& b, Mat material, const Rect& r, double y);

/// A single upright surface over the segment (x0, z0) to (x1, z1).
void thin_wall(WorldBuilder& b, Mat material, double x0, double z0, double x1, double z1, double y0,
               double y1);

/// A level slab from y0 to y1 with rectangular holes (disjoint, inside `r`).
void slab(WorldBuilder& b, Mat top, Mat below, const Rect& r, std::span<const Rect> holes,
          double y0, double y1);
/// The same without thickness: only the walkable surface.
void floor_with_holes(WorldBuilder& b, Mat material, const Rect& r, std::span<const Rect> holes,
                      double y);

/// An opening in a wall: [from, to] along it, [low, high] over the wall's foot.
struct Opening {
  double from = 0, to = 0, low = 0, high = 0;
};

/// A wall of a given thickness whose middle runs from (x0, z0) to (x1, z1), with openings in order.
void wall(WorldBuilder& b, Mat material, double x0, double z0, double x1, double z1, double y0,
          double y1, double thickness, std::span<const Opening> openings = {});

/// A flight towards +x: `risers` risers from (x, y), so risers - 1 treads; the landing begins at
/// x + (risers - 1) * run, y + risers * rise. `thickness` measures the waist, at least `rise`.
struct Flight {
  double x = 0, y = 0, z = 0;
  double width = 1.4;
  double rise = 0.17, run = 0.29;
  int32_t risers = 10;
  double thickness = 0.3;
  [[nodiscard]] double length() const { return (risers - 1) * run; }
  [[nodiscard]] double top() const { return y + risers * rise; }
};
void flight(WorldBuilder& b, Mat material, const Flight& f);

/// Two flights side by side with a landing halfway, up through one storey. The well begins at the
/// edge of the landing at (x, y, z) and needs `length` x `depth` of hole in the floor above.
struct Dogleg {
  double x = 0, y = 0, z = 0;
  double height = 3;
  double width = 1.4;  ///< Of a flight.
  double gap = 0.2;    ///< Between the flights.
  double run = 0.28;
  double landing = 1.4;
  int32_t risers = 9;  ///< Per flight.
  [[nodiscard]] double length() const { return (risers - 1) * run + landing; }
  [[nodiscard]] double depth() const { return 2 * width + gap; }
};
void dogleg(WorldBuilder& b, Mat material, const Dogleg& d);

/// Winding treads around (x, z). A positive `turn` winds from +x towards +z.
struct Spiral {
  double x = 0, y = 0, z = 0;
  double inner = 0.2, outer = 1.8;
  double from = 0;     ///< Where it begins. [turns from +x towards +z]
  double turn = 0.75;  ///< How far it winds. [turns]
  double height = 3;
  int32_t risers = 18;
  double thickness = 0.12;
};
void spiral(WorldBuilder& b, Mat material, const Spiral& s);

/// A sector of a ring as a slab: a landing of a spiral.
void sector(WorldBuilder& b, Mat material, double x, double z, double inner, double outer,
            double from, double turn, double y0, double y1);

/// A round bar or pipe between two points.
void cylinder(WorldBuilder& b, Mat material, Vec3d from, Vec3d to, double radius, int32_t sides,
              bool caps);
/// A pipe along a line of points, with mitred corners.
void pipe(WorldBuilder& b, Mat material, std::span<const Vec3d> path, double radius, int32_t sides);
/// An upright cone frustum or dome ring pair.
void frustum(WorldBuilder& b, Mat material, Vec3d foot, double radius0, double radius1,
             double height, int32_t sides, bool caps);

/// Posts and two rails along a segment at feet height `from.y`.
void railing(WorldBuilder& b, Vec3d from, Vec3d to, double height = 1.0, double spacing = 2.0);
/// Two stringers and rungs; not walkable.
void ladder(WorldBuilder& b, Vec3d foot, double height, double along_x, double along_z);

enum class CarDetail { kFull, kPlain };
/// A parked car with its nose towards +x of the frame, centred on (0, 0, 0). About 4.3 x 1.75 m.
void car(WorldBuilder& b, uint32_t variant, CarDetail detail);
/// A trunk and a crown; `random` picks its size and kind.
void tree(WorldBuilder& b, Vec3d foot, uint64_t random);

}  // namespace throng::importer::shapes
