// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "bake/patch_cells.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>

#include "world/node_data.h"

// A body with its feet at p, axis n and bottom b fills the points p + h n + l, where b <= h <=
// height and l is at most a radius long and across n. If all normals of a sub-patch lie within an
// angle w of m, and its points within a radius a of m's axis and between e0 and e1 along it, then
// all bodies on it lie within a + radius + height sin(w) of the axis and between
// e0 + b cos(w) - radius sin(w) and e1 + height + radius sin(w). No triangle there, no triangle in
// any body. The patch's own triangles and its neighbours' are tested like all others: only where
// they bend by more than a body's bottom do they get in its way.
namespace throng {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();
constexpr size_t kRegion = 256;        // cells that look for triangles together
constexpr size_t kPart = 32;           // cells of a region that choose among these together
constexpr size_t kSquare = 4;          // cells of a part that choose again
constexpr double kSlopeMargin = 1e-6;  // a plane at exactly a limit keeps it

bool overlap(const Box3d& a, const Box3d& b) {
  return a.min.x <= b.max.x && b.min.x <= a.max.x && a.min.y <= b.max.y && b.min.y <= a.max.y &&
         a.min.z <= b.max.z && b.min.z <= a.max.z;
}

BodySweep surface_sweep(const SurfaceBound& surface) {
  return {.radius = surface.radius, .low = surface.low, .high = surface.high};
}

// To 9 digits: the last bits of cos() differ between machines' libraries.
double rounded_cosine(double degrees) {
  return std::round(std::cos(degrees * std::numbers::pi / 180) * 1e9) / 1e9;
}

}  // namespace

std::vector<PatchBody> patch_bodies(std::span<const AvatarClass> classes) {
  std::vector<PatchBody> bodies;
  for (size_t c = 0; c < classes.size(); ++c) {
    const AvatarClass& avatar = classes[c];
    const bool climbs = avatar.climb_slope > 0;
    bodies.push_back(
        {.radius = avatar.radius,
         .bottom = climbs ? avatar.step : body_bottom(avatar),
         .height = avatar.height,
         .steepest = rounded_cosine(climbs ? avatar.climb_slope : avatar.max_slope) - kSlopeMargin,
         .climbs = climbs,
         .bit = static_cast<uint16_t>(1u << c)});
  }
  return bodies;
}

BodySweep sweep_of(const SurfaceBound& surface, const PatchBody& body) {
  return {.radius = surface.radius + body.radius + body.height * surface.sine,
          .low = surface.low + body.bottom * surface.cosine - body.radius * surface.sine,
          .high = surface.high + body.height + body.radius * surface.sine};
}

PatchJudge::PatchJudge(const TriangleSquares& triangles, std::span<const AvatarClass> classes,
                       const NodeBins& bins, double size)
    : triangles_(&triangles),
      set_(&triangles.scene().patches),
      bodies_(patch_bodies(classes)),
      bins_(&bins),
      size_(size) {
  for (const double edge : bins.inclination) {
    bin_cosine_.push_back(rounded_cosine(edge) - kSlopeMargin);
  }
  tallest_ = bins.height.back();
  least_bottom_ = kNever;
  for (const PatchBody& body : bodies_) least_bottom_ = std::min(least_bottom_, body.bottom);
}

int32_t PatchJudge::depth_of(const BezierPatch& patch) const {
  double longest = 0;
  for (int32_t e = 0; e < 4; ++e) {
    const auto curve = patch.edge(e);
    longest = std::max(longest, length(curve[1] - curve[0]) + length(curve[2] - curve[1]) +
                                    length(curve[3] - curve[2]));
  }
  int32_t depth = 0;
  while (depth < kDeepestPatch && longest > size_ * (1 << depth)) ++depth;
  return depth;
}

BezierCells PatchJudge::judge(uint32_t patch) {
  // The patch, its neighbours and theirs, among them those that share a corner with it.
  beside_ = {patch};
  for (int ring = 0; ring < 2; ++ring) {
    for (size_t i = 0, count = beside_.size(); i < count; ++i) {
      for (const PatchEdge& edge : set_->edges[beside_[i]]) {
        for (const PatchSide& next : edge.next) {
          if (next.patch == kNoPatch) continue;
          if (std::find(beside_.begin(), beside_.end(), next.patch) == beside_.end()) {
            beside_.push_back(next.patch);
          }
        }
      }
    }
  }
  is_beside_.resize(set_->size());
  for (const uint32_t p : beside_) is_beside_[p] = 1;
  BezierCells out;
  const BezierPatch& whole = set_->patches[patch];
  out.promise.depth = depth_of(whole);
  const size_t cells = size_t{1} << (2 * out.promise.depth);
  out.promise.cells.resize(cells);
  out.shape.resize(cells);
  visit(whole, 0, 0, 0, out);
  judge_pending(out);
  for (const uint32_t p : beside_) is_beside_[p] = 0;
  for (const uint32_t p : out.makers) is_beside_[p] = 0;
  std::sort(out.makers.begin(), out.makers.end());
  return out;
}

void PatchJudge::visit(const BezierPatch& part, int32_t level, int32_t s, int32_t t,
                       BezierCells& out) {
  if (level == out.promise.depth) {
    parts_.push_back(part);
    part_cell_.push_back(out.promise.index(s, t));
    if (parts_.size() >= kRegion) judge_pending(out);
    return;
  }
  const auto by_s = split_s(part, 0.5);
  for (int32_t i = 0; i < 2; ++i) {
    const auto by_t = split_t(by_s[static_cast<size_t>(i)], 0.5);
    for (int32_t j = 0; j < 2; ++j) {
      visit(by_t[static_cast<size_t>(j)], level + 1, 2 * s + i, 2 * t + j, out);
    }
  }
}

// What the surfaces alone tell; cells on which a body might stand are left pending.
void PatchJudge::bound_cells(BezierCells& out) {
  bounds_.resize(parts_.size());
  bound_cells_of(parts_, bounds_);
  const auto bin_of = [&](double cosine) {
    uint8_t code = 0;
    while (code < bin_cosine_.size() && cosine < bin_cosine_[code]) ++code;
    return code;
  };
  const auto open = static_cast<uint8_t>(bins_->height.size());
  for (size_t i = 0; i < parts_.size(); ++i) {
    Promise& promise = out.promise.cells[part_cell_[i]];
    promise = {.classes = 0, .inclination = 15, .height = 0, .headroom = 0};
    CellShape& shape = out.shape[part_cell_[i]];
    if (!bounds_[i].valid) {
      const Box3d box = parts_[i].bounds();
      const Vec3d middle = (box.min + box.max) * 0.5;
      shape = {static_cast<float>(middle.x), static_cast<float>(middle.y),
               static_cast<float>(middle.z), static_cast<float>(length(box.max - middle)), 0};
      continue;
    }
    const SurfaceBound& bound = bounds_[i].along;
    const Vec3d c = bound.frame.centre;
    const double deep = std::max(-bound.low, bound.high);
    shape = {static_cast<float>(c.x), static_cast<float>(c.y), static_cast<float>(c.z),
             static_cast<float>(std::sqrt(bound.radius * bound.radius + deep * deep)),
             static_cast<float>(bound.area)};
    double steepest = bound.steepest_cosine();
    promise.inclination = bin_of(steepest);
    // Every class's limit is an edge, so a closer look can change a verdict only if it can change
    // the bin.
    if (promise.inclination != bin_of(bound.frame.up.y)) {
      steepest = std::max(steepest, steepest_cosine(parts_[i], bound));
      promise.inclination = bin_of(steepest);
    }
    promise.height = promise.headroom = open;
    Pending& pending = pending_.emplace_back();
    pending.cell = part_cell_[i];
    pending.steepest = steepest;
    pending.surface = {bound, bounds_[i].upright};
    add_posture(0, pending);
    if (bound.frame.up.y <= bound.sine) {  // It may lean over: it is its own ceiling.
      promise.headroom = 0;
    } else {
      add_posture(1, pending);
    }
  }
  parts_.clear();
  part_cell_.clear();
}

void PatchJudge::add_posture(size_t posture, Pending& cell) const {
  const SurfaceBound& surface = cell.surface[posture];
  BodySweep& prism = cell.prism[posture];
  prism = {.radius = surface.radius + tallest_ * surface.sine,
           .low = surface.low + least_bottom_ * surface.cosine,
           .high = surface.high + tallest_};
  BodySweep& bodies = cell.bodies[posture];
  bool any = false;
  for (const PatchBody& body : bodies_) {
    if (!is_asked(body, posture, cell)) continue;
    const BodySweep sweep = sweep_of(surface, body);
    if (!any) bodies = sweep;
    any = true;
    bodies = {.radius = std::max(bodies.radius, sweep.radius),
              .low = std::min(bodies.low, sweep.low),
              .high = std::max(bodies.high, sweep.high)};
  }
  if (!any) bodies = prism;
  cell.box[posture] = sweep_box(surface.frame, {.radius = std::max(prism.radius, bodies.radius),
                                                .low = std::min(prism.low, bodies.low),
                                                .high = std::max(prism.high, bodies.high)});
  cell.postures = static_cast<int32_t>(posture) + 1;
}

// The cells of a region look for triangles together, then squares of them choose among these.
void PatchJudge::judge_pending(BezierCells& out) {
  bound_cells(out);
  if (pending_.empty()) return;
  const auto box_of = [&](std::span<const Pending> cells, size_t posture) {
    Box3d box;
    for (const Pending& cell : cells) {
      if (posture >= static_cast<size_t>(cell.postures)) continue;
      box.add(cell.box[posture].min);
      box.add(cell.box[posture].max);
    }
    return box;
  };
  const auto join = [](Box3d& box, const Box3d& other) {
    if (other.empty()) return;
    box.add(other.min);
    box.add(other.max);
  };
  const std::span<const Pending> all = pending_;
  Box3d box;
  for (const Pending& cell : all) {  // Makers come into the surface itself, below all bodies.
    join(box, sweep_box(cell.surface[0].frame, surface_sweep(cell.surface[0])));
  }
  join(box, box_of(all, 0));
  join(box, box_of(all, 1));
  gather(box);
  for (size_t begin = 0; begin < all.size(); begin += kPart) {
    const auto part = all.subspan(begin, std::min(kPart, all.size() - begin));
    Box3d around = box_of(part, 0);
    join(around, box_of(part, 1));
    narrow(near_, around, part_);
    for (size_t k = 0; k < part.size(); k += kSquare) {
      const auto cells = part.subspan(k, std::min(kSquare, part.size() - k));
      find_makers(cells, out);
      for (size_t posture = 0; posture < 2; ++posture) {
        narrow(part_, box_of(cells, posture), block_);
        for (const Pending& cell : cells) {
          if (posture >= static_cast<size_t>(cell.postures)) continue;
          judge_posture(cell, posture, out.promise.cells[cell.cell]);
        }
      }
    }
  }
  pending_.clear();
}

void PatchJudge::gather(const Box3d& box) {
  const Vec3d middle = (box.min + box.max) * 0.5;
  near_.clear(middle);
  foreign_.clear(middle);
  found_.clear();
  triangles_->find(box, found_);
  const auto& patch_of = triangles_->scene().patch_of_triangle;
  for (const uint32_t triangle : found_) {
    const LocalTriangle corners = triangles_->corners(triangle);
    Box3d around;
    for (const Vec3d& corner : corners) around.add(corner);
    if (!overlap(around, box)) continue;
    near_.add(triangle, corners);
    const uint32_t patch = patch_of.empty() ? kNoPatch : patch_of[triangle];
    if (patch != kNoPatch && is_beside_[patch] == 0) foreign_.add(triangle, corners);
  }
}

// Patches whose triangles come into the surfaces of cells.
void PatchJudge::find_makers(std::span<const Pending> cells, BezierCells& out) {
  if (foreign_.count == 0) return;
  Box3d box;
  for (const Pending& cell : cells) {
    const Box3d b = sweep_box(cell.surface[0].frame, surface_sweep(cell.surface[0]));
    box.add(b.min);
    box.add(b.max);
  }
  narrow(foreign_, box, block_);
  if (block_.count == 0) return;
  for (const Pending& cell : cells) {
    const BodyFrame& frame = cell.surface[0].frame;
    const BodySweep sweep = surface_sweep(cell.surface[0]);
    const SieveTube tube{.whole = sweep, .decisive = {.radius = 0}};
    (void)sieve(block_,
                {.frame = frame, .first = sweep, .second = sweep, .tubes = std::span(&tube, 1)},
                hits_);
    for (size_t i = 0; i < hits_.count; ++i) {
      const uint32_t triangle = hits_.triangle[i];
      const uint32_t patch = triangles_->scene().patch_of_triangle[triangle];
      if (is_beside_[patch] != 0) continue;
      LocalTriangle local = triangles_->corners(triangle);
      for (Vec3d& corner : local) corner = frame.local(corner);
      if (lowest_entry(local, sweep) == kNever) continue;
      out.makers.push_back(patch);
      is_beside_[patch] = 1;
    }
  }
}

// Tests the classes of one posture, and the free height along it.
void PatchJudge::judge_posture(const Pending& cell, size_t posture, Promise& promise) {
  const SurfaceBound& surface = cell.surface[posture];
  const BodyFrame& frame = surface.frame;
  const BodySweep& prism = cell.prism[posture];
  tubes_.clear();
  tube_bit_.clear();
  SieveTube& room = tubes_.emplace_back();
  room = {.whole = prism,
          .decisive = prism};  // What is deeper than any height asks for leaves none.
  room.decisive.high = std::min(prism.high, surface.high + bins_->height.front());
  for (const PatchBody& body : bodies_) {
    if (!is_asked(body, posture, cell)) continue;
    const BodySweep sweep = sweep_of(surface, body);
    tubes_.push_back({.whole = sweep, .decisive = sweep});
    tube_bit_.push_back(body.bit);
  }
  const uint32_t answered = sieve(
      block_, {.frame = frame, .first = prism, .second = cell.bodies[posture], .tubes = tubes_},
      hits_);
  const uint32_t all = (1u << tubes_.size()) - 1;
  uint32_t entered = answered;  // bit 0: no height; then bodies that matter has stopped
  double free = (answered & 1) != 0 ? surface.high : kNever;
  for (size_t i = 0; i < hits_.count && entered != all; ++i) {
    uint32_t asked = hits_.tubes[i] & ~entered;
    if (asked == 0) continue;
    LocalTriangle local = triangles_->corners(hits_.triangle[i]);
    for (Vec3d& corner : local) corner = frame.local(corner);
    if ((asked & 1) != 0) {
      const double low = std::min({local[0].z, local[1].z, local[2].z});
      if (low < free) free = std::min(free, lowest_entry(local, prism));
      if (free < kNever && bins_->height_code(std::max(0.0, free - surface.high)) == 0) {
        entered |= 1;
      }
      asked &= ~1u;
    }
    for (; asked != 0; asked &= asked - 1) {
      const auto b = static_cast<size_t>(std::countr_zero(asked));
      if (lowest_entry(local, tubes_[b].whole) < kNever) entered |= 1u << b;
    }
  }
  for (size_t b = 1; b < tubes_.size(); ++b) {
    if ((entered >> b & 1) == 0) promise.classes |= tube_bit_[b - 1];
  }
  // The highest feet have the least.
  if (free < kNever) {
    (posture == 0 ? promise.height : promise.headroom) =
        bins_->height_code(std::max(0.0, free - surface.high));
  }
}

}  // namespace throng
