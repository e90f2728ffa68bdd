// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "bake/surface/patch_links.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/access.h"
#include "core/parallel.h"
#include "graph/node_data.h"
#include "graph/patch_pairs.h"
#include "world/place.h"
#include "world/tile_grid.h"

// Links between cells of Bezier patches: over shared edges where bodies pass, over a hole from a
// cell to those near that a body can move to. Every link is proved by body_motion.
namespace throng::bake {
namespace {

constexpr double kCreaseCosine = 0.9962;  // cosine of 5 degrees: no crease
constexpr double kWalkSpacing = 0.1;      // between the tested points of a walker's move [m]
constexpr size_t kMaxCandidates = 6;      // cells of a patch that are tried for one link
constexpr size_t kBoxedCells = 8;         // of a patch, found to be far away together

Vec3d middle_of(const PatchLinkInput& input, uint32_t patch, uint32_t cell) {
  return input.cells[patch].shape[cell].middle(input.cells[patch].origin);
}

// The part of the edges that a pair touches along, as a door of its own or the end of the last one.
void add_door(const graph::EdgePair& pair, uint16_t classes, std::vector<PatchDoor>& doors) {
  const auto along = [](double at) {
    return static_cast<uint16_t>(std::lround(at * graph::kEdgeUnits));
  };
  const PatchDoor door{.patch = pair.side_a.patch,
                       .to_patch = pair.side_b.patch,
                       .edge = static_cast<uint8_t>(pair.side_a.edge),
                       .to_edge = static_cast<uint8_t>(pair.side_b.edge),
                       .classes = classes,
                       .first = along(pair.at_a - pair.half_a),
                       .last = along(pair.at_a + pair.half_a),
                       .to_first = along(pair.at_b + pair.half_b),
                       .to_last = along(pair.at_b - pair.half_b)};
  if (!doors.empty()) {
    PatchDoor& last = doors.back();
    if (last.to_patch == door.to_patch && last.edge == door.edge && last.to_edge == door.to_edge &&
        last.classes == classes && last.first == door.last && last.to_first == door.to_last) {
      last.first = door.first;
      last.to_first = door.to_first;
      return;
    }
  }
  doors.push_back(door);
}

std::vector<graph::CellPair> merged(std::vector<std::vector<graph::CellPair>>& lists) {
  std::vector<graph::CellPair> all;
  for (auto& list : lists) all.insert(all.end(), list.begin(), list.end());
  graph::merge_cell_pairs(all);
  return all;
}

}  // namespace

BodyPose pose_on(const PatchLinkInput& input, const PatchBody& body, uint32_t patch,
                 uint32_t cell) {
  const int32_t depth = input.cells[patch].promise.depth;
  const double side = 1 << depth;
  const double s = ((cell & ((1u << depth) - 1)) + 0.5) / side, t = ((cell >> depth) + 0.5) / side;
  const BezierPatch& surface = input.triangles->scene().patches.patches[patch];
  return {surface.at(s, t), body.climbs ? surface.normal(s, t) : Vec3d{0, 1, 0}};
}

bool goes_straight(MotionJudge& judge, const PatchBody& body, const BodyPose& from,
                   const BodyPose& to, double step) {
  if (!body.climbs && !judge.is_supported(from.feet, to.feet, step, kWalkSpacing)) return false;
  return judge.is_free(body, from, to);
}

EdgeLinks link_edges(const PatchLinkInput& input, int32_t workers) {
  const PatchSet& set = input.triangles->scene().patches;
  const std::vector<PatchBody> bodies = patch_bodies(input.classes);
  std::vector<int32_t> depth;
  for (const BezierCells& cells : input.cells) depth.push_back(cells.promise.depth);
  std::vector<std::vector<graph::CellPair>> lists(set.size());
  std::vector<std::vector<PatchDoor>> doors(set.size());
  parallel_for(set.size(), workers, [&](size_t p) {
    if (!input.is_judged(static_cast<uint32_t>(p))) return;
    MotionJudge judge(*input.triangles);
    for (const graph::EdgePair& pair : graph::edge_pairs(set, depth, static_cast<uint32_t>(p))) {
      graph::CellPair cells = pair.cells;
      if (!input.is_judged(cells.patch_b)) continue;
      if (!input.links(cells.patch_a) && !input.links(cells.patch_b)) continue;
      const uint16_t both = input.cells[cells.patch_a].promise.cells[cells.cell_a].classes &
                            input.cells[cells.patch_b].promise.cells[cells.cell_b].classes;
      if (both == 0) continue;
      const auto at = [&](PatchSide side, double along) {
        const auto [s, t] = graph::edge_parameters(side.edge, along);
        const BezierPatch& patch = set.patches[side.patch];
        return BodyPose{patch.at(s, t), patch.normal(s, t)};
      };
      const BodyPose a = at(pair.side_a, pair.at_a), b = at(pair.side_b, pair.at_b);
      const bool creased = dot(a.axis, b.axis) < kCreaseCosine;
      for (const PatchBody& body : bodies) {
        if ((both & body.bit) == 0) continue;
        if (body.climbs && creased && !judge.is_free(body, a, b)) continue;
        cells.classes |= body.bit;
      }
      if (cells.classes == 0) continue;
      lists[p].push_back(cells);
      add_door(pair, cells.classes, doors[p]);
    }
  });
  EdgeLinks links;
  links.pairs = merged(lists);
  for (const auto& list : doors) links.doors.insert(links.doors.end(), list.begin(), list.end());
  return links;
}

namespace {

// Cells of a patch on which a class may stand.
std::vector<uint32_t> cells_of(const BezierCells& cells, uint16_t bit) {
  std::vector<uint32_t> found;
  for (uint32_t i = 0; i < cells.promise.cells.size(); ++i) {
    if ((cells.promise.cells[i].classes & bit) != 0) found.push_back(i);
  }
  return found;
}

double distance2(const Box3d& box, Vec3d p) {
  const auto out = [](double low, double high, double at) {
    return std::max({low - at, at - high, 0.0});
  };
  const Vec3d d{out(box.min.x, box.max.x, p.x), out(box.min.y, box.max.y, p.y),
                out(box.min.z, box.max.z, p.z)};
  return dot(d, d);
}

// Does a neighbour within the patch, or whatever lies over its border, lack the class?
bool lacks_neighbour(const graph::PatchCells& cells, uint32_t cell, uint16_t bit) {
  const int32_t side = cells.side(), s = static_cast<int32_t>(cell) % side,
                t = static_cast<int32_t>(cell) / side;
  constexpr std::array<std::array<int32_t, 2>, 4> kBeside = {{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};
  return std::any_of(kBeside.begin(), kBeside.end(), [&](const auto& d) {
    const int32_t i = s + d[0], j = t + d[1];
    if (i < 0 || j < 0 || i >= side || j >= side) return true;
    return (cells.cells[cells.index(i, j)].classes & bit) == 0;
  });
}

// How far from a cell's middle the motions of a link over a hole test triangles. [m]
double motion_reach(const PatchBody& body, double size) {
  constexpr double kRounded = 0.01;  // cells' middles are kept in floats
  return hole_link_reach(body.radius, size) + MotionJudge::reach_of(body) + kRounded;
}

// Hole links from one patch.
class HoleLinker {
 public:
  HoleLinker(const PatchLinkInput& input, const std::vector<PatchBody>& bodies, uint32_t patch)
      : input_(input),
        bodies_(bodies),
        patch_(patch),
        here_(input.cells[patch]),
        judge_(*input.triangles) {
    for (const PatchBody& body : bodies) {
      farthest_ = std::max(farthest_, motion_reach(body, input.size));
    }
    for (size_t c = 0; c < bodies.size(); ++c) {
      for (const uint32_t maker : here_.makers) {
        if (input.links(patch) || input.links(maker)) add_target(c, maker);
      }
    }
    Box3d box;
    for (const graph::CellShape& cell : here_.shape) box.add(cell.middle(here_.origin));
    judge_.look_around({.min = box.min - Vec3d{farthest_, farthest_, farthest_},
                        .max = box.max + Vec3d{farthest_, farthest_, farthest_}});
  }

  std::vector<graph::CellPair> link() {
    for (uint32_t a = 0; a < here_.promise.cells.size(); ++a) {
      looked_closer_ = false;
      for (const Target& target : targets_) link_cell(a, target);
    }
    return std::move(pairs_);
  }

 private:
  // The cells of a maker on which a class may stand.
  struct Target {
    size_t avatar_class = 0;
    uint32_t maker = 0;
    std::vector<uint32_t> cells;
    std::vector<Box3d> boxes;  // of so many cells each
    Box3d whole;
  };

  void add_target(size_t c, uint32_t maker) {
    Target target{.avatar_class = c, .maker = maker, .cells = {}, .boxes = {}, .whole = {}};
    target.cells = cells_of(input_.cells[maker], bodies_[c].bit);
    if (target.cells.empty()) return;
    target.boxes.resize((target.cells.size() + kBoxedCells - 1) / kBoxedCells);
    for (size_t k = 0; k < target.cells.size(); ++k) {
      const Vec3d middle = middle_of(input_, maker, target.cells[k]);
      target.boxes[k / kBoxedCells].add(middle);
      target.whole.add(middle);
    }
    targets_.push_back(std::move(target));
  }

  // Fills `nearest_` with the target's cells in reach, the nearest first.
  void find_nearest(Vec3d middle, const Target& target, double widest) {
    nearest_.clear();
    for (size_t run = 0; run < target.boxes.size(); ++run) {
      if (distance2(target.boxes[run], middle) > widest * widest) continue;
      const size_t end = std::min(target.cells.size(), (run + 1) * kBoxedCells);
      for (size_t k = run * kBoxedCells; k < end; ++k) {
        const Vec3d d = middle_of(input_, target.maker, target.cells[k]) - middle;
        if (const double far = dot(d, d); far <= widest * widest) {
          nearest_.push_back({far, target.cells[k]});
        }
      }
    }
    std::sort(nearest_.begin(), nearest_.end());
  }

  void link_cell(uint32_t a, const Target& target) {
    const PatchBody& body = bodies_[target.avatar_class];
    if ((here_.promise.cells[a].classes & body.bit) == 0) return;
    const Vec3d middle = middle_of(input_, patch_, a);
    const double widest = hole_link_reach(body.radius, input_.size);
    if (distance2(target.whole, middle) > widest * widest) return;
    if (!lacks_neighbour(here_.promise, a, body.bit)) return;
    find_nearest(middle, target, widest);
    if (nearest_.empty()) return;
    if (!looked_closer_) {
      judge_.look_closer({.min = middle - Vec3d{farthest_, farthest_, farthest_},
                          .max = middle + Vec3d{farthest_, farthest_, farthest_}});
      looked_closer_ = true;
    }
    const BodyPose start = pose_on(input_, body, patch_, a);
    for (size_t k = 0; k < std::min(kMaxCandidates, nearest_.size()); ++k) {
      const uint32_t b = nearest_[k].second;
      if (!goes_straight(judge_, body, start, pose_on(input_, body, target.maker, b),
                         input_.classes[target.avatar_class].step_height)) {
        continue;
      }
      pairs_.push_back({.patch_a = patch_,
                        .cell_a = a,
                        .patch_b = target.maker,
                        .cell_b = b,
                        .classes = body.bit,
                        .kind = LinkKind::kClimb});
      return;
    }
  }

  const PatchLinkInput& input_;
  const std::vector<PatchBody>& bodies_;
  uint32_t patch_;
  const BezierCells& here_;
  MotionJudge judge_;
  double farthest_ = 0;  // from a cell's middle, that any such link tests triangles [m]
  std::vector<Target> targets_;
  std::vector<std::pair<double, uint32_t>> nearest_;
  bool looked_closer_ = false;  // at the cell whose hole links are tried
  std::vector<graph::CellPair> pairs_;
};

}  // namespace

std::vector<graph::CellPair> link_holes(const PatchLinkInput& input, int32_t workers) {
  const std::vector<PatchBody> bodies = patch_bodies(input.classes);
  std::vector<std::vector<graph::CellPair>> lists(input.cells.size());
  parallel_for(input.cells.size(), workers, [&](size_t p) {
    const auto patch = static_cast<uint32_t>(p);
    const auto& makers = input.cells[p].makers;
    const auto is_linked = [&](uint32_t maker) { return input.links(patch) || input.links(maker); };
    if (!std::any_of(makers.begin(), makers.end(), is_linked)) return;
    lists[p] = HoleLinker(input, bodies, patch).link();
  });
  return merged(lists);
}

std::vector<graph::CellPair> link_tiles(const PatchLinkInput& input,
                                        const std::function<bool(const Place&)>& carries,
                                        int32_t workers) {
  const std::vector<PatchBody> bodies = patch_bodies(input.classes);
  const world::WorldData& data = *data_of(*input.world);
  std::vector<std::vector<graph::CellPair>> lists(input.cells.size());
  parallel_for(input.cells.size(), workers, [&](size_t p) {
    if (!input.links(static_cast<uint32_t>(p))) return;
    MotionJudge judge(*input.triangles);
    for (size_t c = 0; c < bodies.size(); ++c) {
      const PatchBody& body = bodies[c];
      if (!body.climbs) continue;
      for (const uint32_t a : cells_of(input.cells[p], body.bit)) {
        const BodyPose on = pose_on(input, body, static_cast<uint32_t>(p), a);
        const double step = input.classes[c].step_height;
        const Place place = input.world->find_place(static_cast<int32_t>(c), on.feet, step);
        if (!place || !carries(place)) continue;
        if (!judge.is_free(body, {place.position, {0, 1, 0}}, on)) continue;
        const world::GroundPoint at = world::to_ground(data, place.position.x, place.position.z);
        lists[p].push_back({.patch_a = static_cast<uint32_t>(p),
                            .cell_a = a,
                            .patch_b = place.level1 - 1,
                            .cell_b = static_cast<uint32_t>(world::cell_index(
                                world::in_tile(at.cell_x()), world::in_tile(at.cell_z()))),
                            .classes = body.bit,
                            .kind = LinkKind::kClimb});
      }
    }
  });
  return merged(lists);
}

}  // namespace throng::bake
