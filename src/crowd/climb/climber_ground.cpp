// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "crowd/climb/climber_ground.h"

#include <algorithm>
#include <cmath>

#include "core/access.h"
#include "world/place.h"
#include "world/zone_data.h"

// Moves over nodes. All poses lie on the path that the finder proved, or in a square all of which
// the class may stand on: docs/design/013-climbers.md. Additions, products and square roots only,
// so that the result is the same everywhere. Constant time, but for the points that a move passes.
namespace throng::crowd {
namespace {

constexpr double kMinLength = 1e-9;    // [m]
constexpr double kPointRadius = 2e-6;  // [m] within which a body stands on a point
constexpr double kEdgeStep = 1e-4;     // of a patch's parameters, for derivatives
constexpr int kMaxAttempts = 8;        // attempts to make a move short enough

// In the air, a part of the segment from one pose to another: it turns evenly.
std::optional<ClimbPose> pose_between(const ClimbPose& from, const ClimbPose& to, double part) {
  const Vec3d axis = from.axis * (1 - part) + to.axis * part;
  const double size = length(axis);
  if (!(size > 1e-6)) return std::nullopt;
  return ClimbPose{from.feet * (1 - part) + to.feet * part, axis * (1 / size)};
}

}  // namespace

ClimberGround::ClimberGround(const World& world, const Nodes& nodes, const path::NodeFinder& finder,
                             int32_t avatar_class)
    : nodes_(&nodes), finder_(&finder), avatar_class_(avatar_class) {
  const world::WorldData& data = *data_of(world);
  const AvatarClass& avatar = data.summary.classes[static_cast<size_t>(avatar_class)];
  origin_ = data.summary.origin;
  unit_ = data.summary.cell / world::kUnitsPerCell;
  const auto units = [](int32_t cells) {
    return static_cast<int32_t>(std::min<int64_t>(int64_t{cells} << world::kUnitBits, INT32_MAX));
  };
  width_ = units(data.width);
  depth_ = units(data.depth);
  tile_ = kTileCells * data.summary.cell;
  height_ = avatar.height;
  reach_ = path::reach_of(avatar);
  bottom_ = body_bottom(avatar);
  leaning_bottom_ = avatar.climb_slope > 0 ? avatar.step_height : bottom_;
}

std::optional<ClimbPose> ClimberGround::pose(uint32_t node1, double s, double t) const {
  if (node1 == 0 || node1 > nodes_->node_count()) return std::nullopt;
  const NodePlace place = nodes_->place(avatar_class_, node1 - 1, s, t);
  if (!place) return std::nullopt;
  return ClimbPose{place.feet, place.axis};
}

std::optional<ClimbPose> ClimberGround::pose_of_point(const Climb& climb, size_t point) const {
  const ClimbPoint& p = climb.points[point];
  if (p.node1 != 0) return pose(p.node1, p.s, p.t);
  const auto landing = pose_of_point(climb, point + 1);  // a path never ends in the air
  if (!landing) return std::nullopt;
  return ClimbPose{{landing->feet.x, p.s, landing->feet.z}, {0, 1, 0}};
}

std::optional<ClimbPose> ClimberGround::pose_of(const Climb& climb, const ClimbStance& at) const {
  if (at.in_air == 0) return pose(at.node1, at.s, at.t);
  const auto from = pose_of_point(climb, at.next - 1u), to = pose_of_point(climb, at.next);
  if (!from || !to) return std::nullopt;
  return pose_between(*from, *to, at.part);
}

// Circles around the centre: the farthest point of the leaning cylinder is on one of its rims, at
// the lowest or highest point of that, or between.
std::optional<ClimbCylinder> ClimberGround::cylinder_of(const ClimbPose& pose,
                                                        double radius) const {
  const Vec3d& axis = pose.axis;
  const double sine = std::sqrt(axis.x * axis.x + axis.z * axis.z), cosine = std::fabs(axis.y);
  const double half = height_ / 2;
  const double wide = half * cosine >= radius * sine ? half * sine + radius * cosine
                                                     : std::sqrt(half * half + radius * radius);
  const double high = half * cosine + radius * sine;
  const Vec3d middle = pose.feet + axis * half;
  const double x = (middle.x - origin_.x) / unit_, z = (middle.z - origin_.z) / unit_;
  if (!(std::fabs(x) < 2e9 && std::fabs(z) < 2e9 && std::fabs(middle.y) + high < 2e6)) {
    return std::nullopt;
  }
  // A body that leans out over the rim of the grid is enclosed from inside.
  const double in_x = std::clamp(std::floor(x), 0.0, width_ - 1.0);
  const double in_z = std::clamp(std::floor(z), 0.0, depth_ - 1.0);
  const double off_x = x - (in_x + 0.5), off_z = z - (in_z + 0.5);
  const bool inside = in_x == std::floor(x) && in_z == std::floor(z);
  const double off = inside ? 1 : std::sqrt(off_x * off_x + off_z * off_z) + 1;
  ClimbCylinder cylinder;
  cylinder.radius = static_cast<int32_t>(std::ceil(wide / unit_ + off));
  if (cylinder.radius > widest(radius)) return std::nullopt;
  cylinder.low.x = static_cast<int32_t>(in_x);
  cylinder.low.z = static_cast<int32_t>(in_z);
  cylinder.low.y = static_cast<int32_t>(std::floor((middle.y - high) * 1000));
  cylinder.height = static_cast<int32_t>(std::ceil((middle.y + high) * 1000)) - cylinder.low.y;
  return cylinder;
}

int32_t ClimberGround::widest(double radius) const {
  return static_cast<int32_t>(
      std::ceil(std::sqrt(height_ * height_ / 4 + radius * radius) / unit_ + 2));
}

int32_t ClimberGround::tallest(double radius) const {
  return static_cast<int32_t>(
      std::ceil(std::sqrt(height_ * height_ + 4 * radius * radius) * 1000 + 2));
}

double ClimberGround::travel(const ClimbPose& from, const ClimbPose& to) const {
  return length(to.feet - from.feet) + reach_ * length(to.axis - from.axis);
}

path::BodyRoom ClimberGround::body_room_of(const ClimbPose& pose, double radius) const {
  path::BodyRoom room;
  room.feet = pose.feet;
  room.axis = pose.axis;
  room.bottom = pose.axis.y > 1 - 1e-12 ? bottom_ : leaning_bottom_;
  room.top = height_;
  room.radius = radius;
  room.margin = 0;  // Paths may lead where finders kept a margin.
  return room;
}

ClimberGround::Square ClimberGround::square_of(uint32_t node1) const {
  const NodeInfo info = nodes_->node(node1 - 1);
  const double side = 1.0 / (1 << info.block_level);
  return {info.s * side, info.t * side, (info.s + 1) * side, (info.t + 1) * side,
          info.kind,     info.source,   info.cells != 0};
}

ClimberGround::Square ClimberGround::square_of(const ClimbStance& at, double s, double t) const {
  Square square = square_of(at.node1);
  if (!square.partial) return square;
  const auto known = finder_->square(at.node1 - 1, at.s, at.t, s, t);
  const path::NodeSquare free = known ? *known : path::NodeSquare{at.s, at.t, at.s, at.t};
  square.s0 = free.s0;
  square.t0 = free.t0;
  square.s1 = free.s1;
  square.t1 = free.t1;
  return square;
}

ClimberGround::Square ClimberGround::square_here(const Climb& climb) const {
  const ClimbStance& at = climb.at;
  if (climb.count == 0) return square_of(at, at.s, at.t);
  const ClimbPoint& local_target = climb.points[std::min<size_t>(at.next, climb.count - 1u)];
  return square_of(at, local_target.s, local_target.t);
}

double ClimberGround::Square::part_inside(double s, double t, double ds, double dt) const {
  double part = 1;
  const auto cut = [&](double at, double displacement, double low, double high) {
    if (displacement > 0) part = std::min(part, (high - at) / displacement);
    if (displacement < 0) part = std::min(part, (low - at) / displacement);
  };
  cut(s, ds, s0, s1);
  cut(t, dt, t0, t1);
  return std::max(part, 0.0);
}

ClimberGround::Slope ClimberGround::slope_at(const Square& square, const ClimbStance& at) const {
  if (square.kind == PatchKind::kLevelTile) return {{tile_, 0, 0}, {0, 0, tile_}};
  const auto point = [&](double ds, double dt) {
    return nodes_->point(at.node1 - 1, at.s + ds, at.t + dt);
  };
  return {(point(kEdgeStep, 0) - point(-kEdgeStep, 0)) * (0.5 / kEdgeStep),
          (point(0, kEdgeStep) - point(0, -kEdgeStep)) * (0.5 / kEdgeStep)};
}

// May a body that leaves a square along (ds, dt) continue in the next one of the path? On one
// curved patch, if it leaves it where the two touch: each is proved whole. On level tiles it may be
// unable to take the step between them, so there it goes through the point that the path has.
bool ClimberGround::enters_next(const Climb& climb, const Square& here, double ds,
                                double dt) const {
  const ClimbStance& at = climb.at;
  if (here.kind != PatchKind::kBezier || at.next + 1u >= climb.count) return false;
  const ClimbPoint &next = climb.points[at.next], &then = climb.points[at.next + 1u];
  if (next.on_surface == 0 || then.on_surface == 0 || next.node1 == 0) return false;
  const Square there = square_of(next.node1);
  if (there.kind != here.kind || there.source != here.source) return false;
  const double out = here.part_inside(at.s, at.t, ds, dt);
  return there.holds(at.s + out * ds, at.t + out * dt);
}

bool ClimberGround::stands_on(const Climb& climb, const std::optional<ClimbPose>& there) const {
  return there && travel({climb.feet, climb.axis}, *there) <= kPointRadius;
}

// A path often begins on a point where another one ended, between two parts of a node: its next
// points then lie where the body stands, up to rounding, and show no direction.
ClimberGround::Ahead ClimberGround::point_ahead(const Climb& climb) const {
  const size_t first = std::min<size_t>(climb.at.next, climb.count - 1u);
  Ahead ahead{first, pose_of_point(climb, first)};
  while (ahead.point + 1 < climb.count && stands_on(climb, ahead.pose)) {
    ahead.pose = pose_of_point(climb, ++ahead.point);
  }
  return ahead;
}

bool ClimberGround::is_at_end(const Climb& climb) const {
  if (climb.at.next >= climb.count) return true;
  if (climb.at.in_air != 0) return false;
  const Ahead ahead = point_ahead(climb);
  return ahead.point + 1 == climb.count && stands_on(climb, ahead.pose);
}

Vec3d ClimberGround::displacement_to(const Climb& climb, const ClimbPose& to) const {
  const Vec3d displacement = to.feet - climb.feet;
  if (length(displacement) > 0.05) return displacement;
  // It nearly only turns: as its centre moves.
  return displacement + (to.axis - climb.axis) * (height_ / 2);
}

Vec3d ClimberGround::path_ahead(const Climb& climb) const {
  const ClimbStance& at = climb.at;
  if (climb.count == 0) return {};
  if (at.in_air != 0) {
    const auto to = pose_of_point(climb, at.next);
    return to ? displacement_to(climb, *to) : Vec3d{};
  }
  const Square here = square_here(climb);
  const size_t next = std::min<size_t>(at.next, climb.count - 1u);
  auto [local_target, to] = point_ahead(climb);
  const auto off = [&](size_t point) {
    return std::pair{climb.points[point].s - at.s, climb.points[point].t - at.t};
  };
  if (local_target == next && next + 1 < climb.count) {
    const auto [ds, dt] = off(next + 1);
    if (enters_next(climb, here, ds, dt)) to = pose_of_point(climb, ++local_target);
  }
  if (!to) return {};
  // Beyond a segment through the air parameters are those of another patch.
  for (size_t point = next + 1; point <= local_target; ++point) {
    if (climb.points[point].on_surface == 0) return displacement_to(climb, *to);
  }
  const auto [ds, dt] = off(local_target);
  const double far = length(to->feet - climb.feet);
  const Slope slope = slope_at(here, at);
  Vec3d displacement = slope.along_s * ds + slope.along_t * dt;
  if (here.kind == PatchKind::kLevelTile) displacement.y = 0;
  const double size = length(displacement);
  return size > kMinLength ? displacement * (far / size) : to->feet - climb.feet;
}

Vec3d ClimberGround::normal_at(const Climb& climb) const {
  if (climb.at.in_air != 0) return climb.axis;
  return nodes_->place(avatar_class_, climb.at.node1 - 1, climb.at.s, climb.at.t).normal;
}

// Towards the next point, within the square that holds both. True: it is there.
bool ClimberGround::advance_on_surface(const Climb& climb, Step& step, double& max_travel) const {
  ClimbStance& at = step.at;
  const ClimbPoint& local_target = climb.points[at.next];
  const auto there = pose(at.node1, local_target.s, local_target.t);
  if (!there) return false;
  const double whole = travel(step.pose, *there);
  if (whole <= max_travel) {
    max_travel -= whole;
    step.pose = *there;
    at.s = local_target.s;
    at.t = local_target.t;
    return true;
  }
  const double ds = local_target.s - at.s, dt = local_target.t - at.t;
  double part = max_travel / whole;
  for (int n = 0; n < kMaxAttempts; ++n) {
    const auto pose_there = pose(at.node1, at.s + part * ds, at.t + part * dt);
    if (!pose_there) return false;
    const double far = travel(step.pose, *pose_there);
    if (far <= max_travel) {
      at.s += part * ds;
      at.t += part * dt;
      step.pose = *pose_there;
      break;
    }
    part *= 0.95 * max_travel / far;
  }
  max_travel = 0;
  return false;
}

bool ClimberGround::advance_through_air(const Climb& climb, Step& step, double& max_travel) const {
  ClimbStance& at = step.at;
  const auto from = pose_of_point(climb, at.next - 1u), to = pose_of_point(climb, at.next);
  if (!from || !to) {
    max_travel = 0;
    return false;
  }
  const double left = travel(step.pose, *to);
  if (left <= max_travel) {
    max_travel -= left;
    step.pose = *to;
    return true;
  }
  double part = (1 - at.part) * max_travel / left;
  for (int n = 0; n < kMaxAttempts; ++n) {
    const auto pose_there = pose_between(*from, *to, at.part + part);
    if (!pose_there) break;
    const double far = travel(step.pose, *pose_there);
    if (far <= max_travel) {
      at.part += part;
      step.pose = *pose_there;
      break;
    }
    part *= 0.95 * max_travel / far;
  }
  max_travel = 0;
  return false;
}

std::optional<ClimberGround::Step> ClimberGround::advance(const Climb& climb,
                                                          double max_travel) const {
  Step step{climb.at, {climb.feet, climb.axis}};
  ClimbStance& at = step.at;
  if (climb.count == 0) return step;
  if (at.in_air == 0 && at.next == climb.count) {  // back to where it was, if it yielded
    at.next = climb.count - 1;
    advance_on_surface(climb, step, max_travel);
    at.next = climb.count;
    return step;
  }
  // At most all that is left of the path.
  while (max_travel > kMinLength && at.next < climb.count) {
    const ClimbPoint& local_target = climb.points[at.next];
    const bool there = at.in_air != 0 ? advance_through_air(climb, step, max_travel)
                                      : advance_on_surface(climb, step, max_travel);
    if (!there) break;
    ++at.next;
    at.part = 0;
    at.in_air = at.next < climb.count && climb.points[at.next].on_surface == 0 ? 1 : 0;
    if (local_target.node1 != 0) {
      at.node1 = local_target.node1;
      at.s = local_target.s;
      at.t = local_target.t;
    }
  }
  return step;
}

std::optional<ClimberGround::Step> ClimberGround::retreat(const Climb& climb,
                                                          double max_travel) const {
  Step step{climb.at, {climb.feet, climb.axis}};
  ClimbStance& at = step.at;
  if (at.in_air == 0 || at.part == 0 || climb.points[at.next].drops != 0) return std::nullopt;
  const auto from = pose_of_point(climb, at.next - 1u);
  if (!from || climb.points[at.next - 1u].node1 == 0) return std::nullopt;
  double part = at.part;
  std::optional<ClimbPose> to;
  for (int n = 0; n < kMaxAttempts; ++n) {
    ClimbStance there = climb.at;
    there.part = at.part - part;
    if (there.part != 0 && !to) to = pose_of_point(climb, at.next);
    if (there.part != 0 && !to) return std::nullopt;
    const auto pose_there = there.part == 0 ? from : pose_between(*from, *to, there.part);
    if (!pose_there) return std::nullopt;
    const double far = travel(step.pose, *pose_there);
    if (far <= max_travel) return Step{there, *pose_there};
    part *= 0.95 * max_travel / far;
  }
  return std::nullopt;
}

std::optional<ClimberGround::Step> ClimberGround::shift(const Climb& climb, Vec3d displacement,
                                                        double max_travel) const {
  const ClimbStance& at = climb.at;
  if (at.in_air != 0) return std::nullopt;
  const Square here = square_here(climb);
  const Slope slope = slope_at(here, at);
  const double a = dot(slope.along_s, slope.along_s), b = dot(slope.along_s, slope.along_t);
  const double c = dot(slope.along_t, slope.along_t), det = a * c - b * b;
  if (!(det > 1e-6 * a * c)) return std::nullopt;
  const double u = dot(displacement, slope.along_s), v = dot(displacement, slope.along_t);
  const double ds = (c * u - b * v) / det, dt = (a * v - b * u) / det;
  const bool continues = enters_next(climb, here, ds, dt);
  const double out = here.part_inside(at.s, at.t, ds, dt);
  Square next;
  double part = out;
  if (continues && out < 1) {
    next = square_of(climb.points[at.next].node1);
    const double s = at.s + out * ds, t = at.t + out * dt;
    part = out + next.part_inside(s, t, (1 - out) * ds, (1 - out) * dt) * (1 - out);
  }
  constexpr double kMinPart = 0.1;
  for (int n = 0; n < kMaxAttempts && part > kMinPart; ++n) {
    Step step{at, {}};
    const bool is_next = part > out;
    const Square& square = is_next ? next : here;
    step.at.s = std::clamp(at.s + part * ds, square.s0, square.s1);
    step.at.t = std::clamp(at.t + part * dt, square.t0, square.t1);
    if (is_next) {
      step.at.node1 = climb.points[at.next].node1;
      step.at.next = static_cast<uint8_t>(at.next + 1);
    }
    const auto pose_there = pose(step.at.node1, step.at.s, step.at.t);
    if (!pose_there) return std::nullopt;
    const double far = travel({climb.feet, climb.axis}, *pose_there);
    if (far <= max_travel) {
      step.pose = *pose_there;
      return step;
    }
    part *= 0.95 * max_travel / far;
  }
  return std::nullopt;
}

}  // namespace throng::crowd
