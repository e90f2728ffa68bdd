// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "bake/surface/patch_cells.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/math/float_origin.h"
#include "graph/node_data.h"

// A body with its feet at p, axis n and bottom b fills the points p + h n + l, where b <= h <=
// height and l is at most a radius long and across n. If all normals of a sub-patch lie within an
// angle w of m, and its points within a radius a of m's axis and between e0 and e1 along it, then
// all bodies on it lie within a + radius + height sin(w) of the axis and between
// e0 + b cos(w) - radius sin(w) and e1 + height + radius sin(w). No triangle there, no triangle in
// any body. The neighbours' triangles are tested like all others. So are the patch's own, unless
// they are known to rise by less than a body's bottom around any feet (own_ground): a cylinder that
// holds bodies all over a cell meets the cell's own slope where none of the bodies does.
namespace throng::bake {
namespace {

constexpr int32_t kRegionHalvings = 4;  // of a region's cells, that look for triangles together
constexpr int32_t kBlockHalvings = 2;   // of a block's, that choose among these together
constexpr size_t kBlock = size_t{1} << (2 * kBlockHalvings);
constexpr size_t kSquare = 4;          // cells of a block that choose again
constexpr double kRiseMargin = 1e-6;   // for rounding; all else is bounded [m]
constexpr double kSlopeMargin = 1e-6;  // a plane at exactly a limit keeps it

inline void join(Box3d& box, const Box3d& other) {
  box.min = {std::min(box.min.x, other.min.x), std::min(box.min.y, other.min.y),
             std::min(box.min.z, other.min.z)};
  box.max = {std::max(box.max.x, other.max.x), std::max(box.max.y, other.max.y),
             std::max(box.max.z, other.max.z)};
}

BodySweep surface_sweep(const SurfaceBound& surface) {
  return {.radius = surface.radius, .low = surface.low, .high = surface.high};
}

bool overlaps(const LocalTriangle& triangle, const Box3d& box) {
  const auto& [a, b, c] = triangle;
  return std::min({a.x, b.x, c.x}) <= box.max.x && std::max({a.x, b.x, c.x}) >= box.min.x &&
         std::min({a.y, b.y, c.y}) <= box.max.y && std::max({a.y, b.y, c.y}) >= box.min.y &&
         std::min({a.z, b.z, c.z}) <= box.max.z && std::max({a.z, b.z, c.z}) >= box.min.z;
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
         .bottom = climbs ? avatar.step_height : body_bottom(avatar),
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
  steepest_walk_ = 1;
  for (const PatchBody& body : bodies_) {
    greatest_bottom_ = std::max(greatest_bottom_, body.bottom);
    if (!body.climbs) steepest_walk_ = std::min(steepest_walk_, body.steepest);
  }
  if (steepest_walk_ == 1) steepest_walk_ = -1;  // All climb.
}

void find_patches_around(const PatchSet& set, uint32_t patch, std::vector<uint32_t>& out) {
  out = {patch};
  for (int ring = 0; ring < 2; ++ring) {
    for (size_t i = 0, count = out.size(); i < count; ++i) {
      for (const PatchEdge& edge : set.edges[out[i]]) {
        for (const PatchSide& next : edge.next) {
          if (next.patch == kNoPatch) continue;
          if (std::find(out.begin(), out.end(), next.patch) == out.end()) out.push_back(next.patch);
        }
      }
    }
  }
}

int32_t patch_depth(const BezierPatch& patch, double size) {
  double longest = 0;
  for (int32_t e = 0; e < 4; ++e) {
    const auto curve = patch.edge(e);
    longest = std::max(longest, length(curve[1] - curve[0]) + length(curve[2] - curve[1]) +
                                    length(curve[3] - curve[2]));
  }
  int32_t depth = 0;
  while (depth < graph::kDeepestPatch && longest > size * (1 << depth)) ++depth;
  return depth;
}

BezierCells PatchJudge::judge(uint32_t patch) {
  find_patches_around(*set_, patch, beside_);
  is_beside_.resize(set_->size());
  for (const uint32_t p : beside_) is_beside_[p] = 1;
  BezierCells out;
  const BezierPatch& whole = set_->patches[patch];
  out.promise.depth = patch_depth(whole, size_);
  const size_t cells = size_t{1} << (2 * out.promise.depth);
  out.promise.cells.resize(cells);
  const Box3d box = whole.bounds();
  out.origin = float_origin((box.min + box.max) * 0.5);
  out.shape.resize(cells);
  patch_ = patch;
  visit(whole, 0, 0, 0, out);
  for (const uint32_t p : beside_) is_beside_[p] = 0;
  for (const uint32_t p : out.makers) is_beside_[p] = 0;
  std::sort(out.makers.begin(), out.makers.end());
  return out;
}

void PatchJudge::visit(const BezierPatch& part, int32_t level, int32_t s, int32_t t,
                       BezierCells& out) {
  const int32_t left = out.promise.depth - level;
  if (left <= kRegionHalvings) {
    cut_region(part, left);
    for (uint32_t i = 0; i < parts_.count; ++i) {
      int32_t cell_s = s << left, cell_t = t << left;
      for (int32_t bit = 0; bit < left; ++bit) {
        cell_s |= static_cast<int32_t>(i >> (2 * bit + 1) & 1) << bit;
        cell_t |= static_cast<int32_t>(i >> (2 * bit) & 1) << bit;
      }
      part_cell_.push_back(out.promise.index(cell_s, cell_t));
    }
    bound_cells(out);
    if (!bounded_.empty()) judge_region(level, s, t, out);
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

// The cells of a part, in the order of a quadtree.
void PatchJudge::cut_region(const BezierPatch& part, int32_t halvings) {
  parts_.resize(1);
  parts_.set(0, part);
  for (int32_t k = 0; k < halvings; ++k) {
    if (halvings - k == kBlockHalvings) std::swap(blocks_, parts_);
    quarter_parts(halvings - k == kBlockHalvings ? blocks_ : parts_, coarser_);
    std::swap(parts_, coarser_);
  }
}

// What the surfaces alone give.
void PatchJudge::bound_cells(BezierCells& out) {
  bounds_.resize(parts_.count);
  bound_cells_of(parts_, bounds_);
  const auto bin_of = [&](double cosine) {
    uint8_t code = 0;
    while (code < bin_cosine_.size() && cosine < bin_cosine_[code]) ++code;
    return code;
  };
  bounded_.clear();
  block_at_.clear();
  for (size_t i = 0; i < parts_.count; ++i) {
    if (i % kBlock == 0) block_at_.push_back(bounded_.size());
    graph::Promise& promise = out.promise.cells[part_cell_[i]];
    promise = {.classes = 0, .inclination = 15, .height = 0, .headroom = 0};
    graph::CellShape& shape = out.shape[part_cell_[i]];
    if (!bounds_[i].valid) {
      const Box3d box = parts_.patch(i).bounds();
      const Vec3d middle = (box.min + box.max) * 0.5, at = middle - out.origin;
      shape = {static_cast<float>(at.x), static_cast<float>(at.y), static_cast<float>(at.z),
               static_cast<float>(length(box.max - middle)), 0};
      continue;
    }
    const SurfaceBound& bound = bounds_[i].along;
    const Vec3d c = bound.frame.centre - out.origin;
    const double deep = std::max(-bound.low, bound.high);
    shape = {static_cast<float>(c.x), static_cast<float>(c.y), static_cast<float>(c.z),
             static_cast<float>(std::sqrt(bound.radius * bound.radius + deep * deep)),
             static_cast<float>(bound.area)};
    double steepest = bound.steepest_cosine();
    promise.inclination = bin_of(steepest);
    // Every class's limit is an edge, so a closer look can change a verdict only if it can change
    // the bin.
    if (promise.inclination != bin_of(bound.frame.up.y)) {
      steepest = std::max(steepest, steepest_cosine(parts_.patch(i), bound));
      promise.inclination = bin_of(steepest);
    }
    promise.height = static_cast<uint8_t>(bins_->height.size());
    // Ground that may lean over is its own ceiling, and is not queried where no body stands
    // upright.
    const bool upright = bound.frame.up.y > bound.sine && steepest >= steepest_walk_;
    promise.headroom = upright ? promise.height : uint8_t{0};
    bounded_.push_back(
        {.cell = part_cell_[i], .part = i, .steepest = steepest, .upright = upright});
  }
  block_at_.push_back(bounded_.size());
  part_cell_.clear();
}

void PatchJudge::add_posture(size_t posture, Pending& cell) const {
  const SurfaceBound& surface = cell.surface(posture);
  BodySweep& prism = cell.prism[posture];
  prism = {.radius = surface.radius + tallest_ * surface.sine,
           .low = surface.low + greatest_bottom_ * surface.cosine,
           .high = surface.high + tallest_};
  BodySweep& bodies = cell.bodies[posture];
  bool any = false;
  for (const PatchBody& body : bodies_) {
    if (!is_asked(body, posture, cell.steepest)) continue;
    const BodySweep sweep = sweep_of(surface, body);
    if (!any) bodies = sweep;
    any = true;
    bodies = {.radius = std::max(bodies.radius, sweep.radius),
              .low = std::min(bodies.low, sweep.low),
              .high = std::max(bodies.high, sweep.high)};
  }
  if (!any) bodies = prism;
  // Makers come into the surface itself, below all bodies.
  const Box3d box =
      sweep_box(surface.frame, {.radius = std::max(prism.radius, bodies.radius),
                                .low = std::min({prism.low, bodies.low, surface.low}),
                                .high = std::max({prism.high, bodies.high, surface.high})});
  join(cell.box, box);
  cell.postures = static_cast<int32_t>(posture) + 1;
}

// The cells of a region look for triangles together, then blocks and squares of them choose among
// these. Where no triangle is left but spared ones, a block is done.
void PatchJudge::judge_region(int32_t level, int32_t s, int32_t t, BezierCells& out) {
  const int32_t side = 256 >> level;
  const SelfSupport own(set_->patches[patch_],
                        {static_cast<uint8_t>(s * side), static_cast<uint8_t>((s + 1) * side - 1),
                         static_cast<uint8_t>(t * side), static_cast<uint8_t>((t + 1) * side - 1)});
  const size_t blocks = block_at_.size() - 1;
  block_boxes_.assign(blocks, {});
  if (blocks > 1) {
    block_bounds_.resize(blocks);
    bound_cells_of(blocks_, block_bounds_);
  }
  Box3d around;
  for (size_t b = 0; b < blocks; ++b) {
    Box3d& box = block_boxes_[b];
    if (blocks > 1 && block_bounds_[b].valid) {
      box = box_of(block_bounds_[b]);
    } else {
      for (size_t i = block_at_[b]; i < block_at_[b + 1]; ++i) join(box, pending(bounded_[i]).box);
    }
    if (block_at_[b] < block_at_[b + 1]) join(around, box);
  }
  gather(around, own);
  for (size_t b = 0; b < blocks; ++b) {
    const auto cells = std::span(bounded_).subspan(block_at_[b], block_at_[b + 1] - block_at_[b]);
    if (!cells.empty()) judge_block(cells, block_boxes_[b], out);
  }
}

PatchJudge::Pending PatchJudge::pending(const Bounded& cell) const {
  Pending pending;
  pending.cell = cell.cell;
  pending.steepest = cell.steepest;
  pending.bounds = &bounds_[cell.part];
  add_posture(0, pending);
  if (cell.upright) add_posture(1, pending);
  return pending;
}

// Of all bodies on a block, whatever its inclination.
Box3d PatchJudge::box_of(const CellBounds& block) const {
  Pending whole;
  whole.steepest = 1;
  whole.bounds = &block;
  add_posture(0, whole);
  add_posture(1, whole);
  return whole.box;
}

void PatchJudge::judge_block(std::span<const Bounded> cells, const Box3d& box, BezierCells& out) {
  const bool alone = others_.region.count == 0;
  if (!alone) narrow(others_.region, box, others_.block);
  uint32_t asked = 0;
  bool upright = false;
  for (const Bounded& cell : cells) {
    asked |= bodies_on(cell);
    upright |= cell.upright;
  }
  all_is_asked_ = !spares_height_[0] || (upright && !spares_height_[1]) || (asked & ~spared_) != 0;
  if (!all_is_asked_ && (alone || others_.block.count == 0)) {
    for (const Bounded& cell : cells) stand_on(cell, out);
    return;
  }
  if (alone) others_.block.clear(others_.region.origin);
  if (all_is_asked_) {
    if (!all_is_filled_) fill_all();
    narrow(all_.region, box, all_.block);
  }
  pending_.clear();
  for (const Bounded& cell : cells) pending_.push_back(pending(cell));
  const std::span<const Pending> all = pending_;
  for (size_t k = 0; k < all.size(); k += kSquare) {
    const size_t count = std::min(kSquare, all.size() - k);
    const auto square = all.subspan(k, count);
    Box3d around;
    for (const Pending& cell : square) join(around, cell.box);
    find_makers(square, out);
    narrow(others_.block, around, others_.square);
    if (all_is_asked_) {
      narrow(all_.block, around, all_.square);
    } else if (others_.square.count == 0) {
      for (const Bounded& cell : cells.subspan(k, count)) stand_on(cell, out);
      continue;
    }
    for (const Pending& cell : square) {
      graph::Promise& promise = out.promise.cells[cell.cell];
      judge_posture(cell, 0, promise);
      if (cell.postures > 1) judge_posture(cell, 1, promise);
    }
  }
}

// Nothing blocks what a cell's inclination allows.
void PatchJudge::stand_on(const Bounded& cell, BezierCells& out) const {
  uint16_t& classes = out.promise.cells[cell.cell].classes;
  for (uint32_t left = bodies_on(cell); left != 0; left &= left - 1) {
    classes |= bodies_[static_cast<size_t>(std::countr_zero(left))].bit;
  }
}

// Of bodies_, those that a cell's inclination allows.
uint32_t PatchJudge::bodies_on(const Bounded& cell) const {
  uint32_t bodies = 0;
  for (size_t b = 0; b < bodies_.size(); ++b) {
    const size_t posture = bodies_[b].climbs ? 0 : 1;
    if (posture == 1 && !cell.upright) continue;
    if (is_asked(bodies_[b], posture, cell.steepest)) bodies |= 1u << b;
  }
  return bodies;
}

// The triangles near a box, except those of the patch itself that no body can meet.
void PatchJudge::gather(const Box3d& box, const SelfSupport& own) {
  const Vec3d middle = (box.min + box.max) * 0.5;
  all_.region.clear(middle);
  others_.region.clear(middle);
  not_beside_.clear(middle);
  all_is_filled_ = false;
  spared_ = 0;
  spares_height_ = {false, false};
  found_.clear();
  triangles_->find(box, found_);
  const Scene& scene = triangles_->scene();
  if (scene.patch_of_triangle.empty()) {
    others_.region.add(scene, found_);
    others_.region.close();
    return;
  }
  const bool known = knows_parts(scene);
  other_ids_.clear();
  int32_t span_s = 0, span_t = 0;  // of triangles that are left out
  for (const uint32_t triangle : found_) {
    const uint32_t patch = scene.patch_of_triangle[triangle];
    if (patch == patch_ && known) {
      const PatchPart& part = scene.patch_part[triangle];
      if (own.holds(part)) {
        const int32_t along_s = part.s1 + 1 - part.s0, along_t = part.t1 + 1 - part.t0;
        // Which others are found with it depends on the scene far from here.
        if ((along_s > span_s || along_t > span_t) &&
            overlaps(triangles_->corners(triangle), box)) {
          span_s = std::max(span_s, along_s);
          span_t = std::max(span_t, along_t);
        }
        continue;
      }
    }
    other_ids_.push_back(triangle);
    if (patch == kNoPatch || is_beside_[patch] != 0) continue;
    not_beside_.add(triangle, triangles_->corners(triangle));
  }
  if (!other_ids_.empty()) {
    found_others_.clear(middle);
    found_others_.add(scene, other_ids_);
    found_others_.close();
    narrow(found_others_, box, others_.region);
    not_beside_.close();
  }
  if (known) set_spared(own, own.deviation(span_s, span_t) + scene.patch_off[patch_]);
}

// Which bodies and heights no triangle of the part comes up to.
void PatchJudge::set_spared(const SelfSupport& own, double deviation) {
  for (size_t b = 0; b < bodies_.size(); ++b) {
    const double rise = own.rise(!bodies_[b].climbs, bodies_[b].radius, deviation);
    if (rise + kRiseMargin < bodies_[b].bottom) spared_ |= 1u << b;
  }
  for (size_t posture = 0; posture < 2; ++posture) {
    spares_height_[posture] = own.rise(posture == 1, 0, deviation) + kRiseMargin < greatest_bottom_;
  }
}

void PatchJudge::fill_all() {
  all_.region.add(triangles_->scene(), found_);
  all_.region.close();
  all_is_filled_ = true;
}

// Patches whose triangles come into the surfaces of cells.
void PatchJudge::find_makers(std::span<const Pending> cells, BezierCells& out) {
  if (not_beside_.count == 0) return;
  Box3d box;
  for (const Pending& cell : cells) {
    const Box3d b = sweep_box(cell.surface(0).frame, surface_sweep(cell.surface(0)));
    box.add(b.min);
    box.add(b.max);
  }
  narrow(not_beside_, box, maker_);
  if (maker_.count == 0) return;
  for (const Pending& cell : cells) {
    const BodyFrame& frame = cell.surface(0).frame;
    const BodySweep sweep = surface_sweep(cell.surface(0));
    const FilterTube tube{.whole = sweep, .decisive = {.radius = 0}};
    (void)filter(maker_,
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

BodySweep PatchJudge::headroom_sweep(const Pending& cell, size_t posture) const {
  BodySweep sweep = cell.prism[posture];
  sweep.high = std::min(sweep.high, cell.surface(posture).high + bins_->height.front());
  return sweep;
}

// Those of sweeps_ into which a plane through the cell's middle, as steep as the surface there,
// comes uphill at the rim.
uint32_t PatchJudge::too_steep(const Pending& cell) const {
  const Vec3d up = cell.surface(0).frame.up;
  const double slope = std::sqrt(std::max(0.0, 1 - up.y * up.y));
  uint32_t steep = 0;
  for (size_t b = 1; b < sweeps_.size(); ++b) {
    if (slope * sweeps_[b].radius > sweeps_[b].low * up.y) steep |= 1u << b;
  }
  return steep;
}

// Tests the classes of one posture, and the free height along it.
void PatchJudge::judge_posture(const Pending& cell, size_t posture, graph::Promise& promise) {
  sweeps_.clear();
  tube_bit_.clear();
  sweeps_.push_back(cell.prism[posture]);
  for (const PatchBody& body : bodies_) {
    if (!is_asked(body, posture, cell.steepest)) continue;
    sweeps_.push_back(sweep_of(cell.surface(posture), body));
    tube_bit_.push_back(body.bit);
  }
  // Bodies, and the height, that the patch's own triangles may meet are tested against all.
  const uint32_t asked = (1u << sweeps_.size()) - 1;
  uint32_t spared = spares_height_[posture] ? 1 : 0;
  for (size_t k = 0, b = 1; k < bodies_.size(); ++k) {
    if (!is_asked(bodies_[k], posture, cell.steepest)) continue;
    spared |= (spared_ >> k & 1) << b++;
  }
  uint32_t stopped = 0;
  if ((asked & spared) != 0) {
    stopped = judge_against(others_.square, cell, posture, asked & spared, promise);
  }
  if ((asked & ~spared) != 0) {
    stopped |= judge_against(all_.square, cell, posture, asked & ~spared, promise);
  }
  for (size_t b = 1; b < sweeps_.size(); ++b) {
    if ((stopped >> b & 1) == 0) promise.classes |= tube_bit_[b - 1];
  }
}

// Those bodies of sweeps_ that a triangle enters.
uint32_t PatchJudge::judge_against(const FilterList& list, const Pending& cell, size_t posture,
                                   uint32_t asked, graph::Promise& promise) {
  if (list.count == 0) return 0;
  const BodyFrame& frame = cell.surface(posture).frame;
  uint32_t stopped = 0, steep = 0;
  if (posture == 1) {
    // Upright, ground may be its own ceiling: that is seen at once.
    if ((asked & 1) != 0 && surely_enters(list, frame.centre, headroom_sweep(cell, 1))) {
      promise.headroom = bins_->height_code(0);
      asked &= ~1u;
    }
    // What stops bodies is mostly the ground that they stand on, where it is steep.
    steep = too_steep(cell) & asked;
    if (steep != 0) stopped = surely_enters_uphill(list, frame.centre, sweeps_, steep);
    asked &= ~stopped;
  }
  uint32_t met = asked == 0 ? 0 : glance(list, frame, sweeps_, asked);
  if (const uint32_t left = met & ~1u & ~steep; posture == 1 && left != 0) {
    const uint32_t uphill = surely_enters_uphill(list, frame.centre, sweeps_, left);
    stopped |= uphill;
    met &= ~uphill;
  }
  return met == 0 ? stopped : stopped | judge_met(list, cell, posture, met, promise);
}

// Those of sweeps_ that a plane comes into; returns those that a triangle does.
uint32_t PatchJudge::judge_met(const FilterList& list, const Pending& cell, size_t posture,
                               uint32_t met, graph::Promise& promise) {
  const SurfaceBound& surface = cell.surface(posture);
  const BodyFrame& frame = surface.frame;
  const BodySweep& prism = cell.prism[posture];
  tubes_.clear();
  for (uint32_t left = met; left != 0; left &= left - 1) {
    const auto b = static_cast<size_t>(std::countr_zero(left));
    // What is deeper than any height needs leaves none.
    const BodySweep decisive = b == 0 ? headroom_sweep(cell, posture) : sweeps_[b];
    tubes_.push_back({.whole = sweeps_[b], .decisive = decisive});
  }
  const uint32_t answered = filter(
      list, {.frame = frame, .first = prism, .second = cell.bodies[posture], .tubes = tubes_},
      hits_);
  const uint32_t height_bit = met & 1;  // bit 0, if it is queried
  const uint32_t all = (1u << tubes_.size()) - 1;
  uint32_t entered = answered;  // no height; then bodies that a solid blocks
  double free = (answered & height_bit) != 0 ? surface.high : kNever;
  for (size_t i = 0; i < hits_.count && entered != all; ++i) {
    uint32_t asked = hits_.tubes[i] & ~entered;
    if (asked == 0) continue;
    LocalTriangle local = triangles_->corners(hits_.triangle[i]);
    for (Vec3d& corner : local) corner = frame.local(corner);
    if ((asked & height_bit) != 0) {
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
  uint32_t stopped = 0;
  uint32_t bodies = met & ~1u;
  for (size_t b = height_bit; bodies != 0; ++b, bodies &= bodies - 1) {
    if ((entered >> b & 1) != 0) stopped |= bodies & (0 - bodies);
  }
  // The highest feet have the least.
  if (free < kNever) {
    (posture == 0 ? promise.height : promise.headroom) =
        bins_->height_code(std::max(0.0, free - surface.high));
  }
  return stopped;
}

}  // namespace throng::bake
