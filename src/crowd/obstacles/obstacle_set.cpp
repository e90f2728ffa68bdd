// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "crowd/obstacles/obstacle_set.h"

#include <algorithm>
#include <mutex>
#include <utility>

#include "core/access.h"
#include "core/math/plan_point.h"
#include "core/parallel.h"
#include "crowd/ground/leaving_ground.h"
#include "path/edits/blocked_cells.h"
#include "world/place.h"
#include "world/tile_grid.h"

// What obstacles block in the grounds of all classes: the union of their cells by level, so that
// they overlap and are removed in any order. An update is linear in the cells of the levels that
// changed.
namespace throng::crowd {
namespace {

bool has(const world::CellRows& rows, int32_t x, int32_t z) {
  return ((rows[static_cast<size_t>(world::in_tile(z))] >> world::in_tile(x)) & 1) != 0;
}

// Andrew's monotone chain: lower side, then upper.
std::vector<PlanPoint> convex_hull(std::vector<PlanPoint> points) {
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end()), points.end());
  std::vector<PlanPoint> hull;
  const auto add = [&](const PlanPoint& p, size_t first) {
    while (hull.size() >= first + 2 && turn(hull[hull.size() - 2], hull.back(), p) <= 0) {
      hull.pop_back();
    }
    hull.push_back(p);
  };
  for (const PlanPoint& p : points) add(p, 0);
  const size_t upper = hull.size() - 1;
  for (size_t i = points.size() - 1; i-- > 0;) add(points[i], upper);
  hull.pop_back();
  return hull;
}

}  // namespace

Prism hull_of(const Prism& a, const Prism& b) {
  std::vector<PlanPoint> corners = a.corners;
  corners.insert(corners.end(), b.corners.begin(), b.corners.end());
  return {convex_hull(std::move(corners)), std::min(a.low, b.low), std::max(a.high, b.high)};
}

ObstacleSet::ObstacleSet(World world, size_t classes)
    : world_(std::move(world)), classes_(classes) {}

void ObstacleSet::open_class(size_t number, CrowdGround& ground, size_t body) {
  classes_[number].ground = &ground;
  classes_[number].body = body;
  for (uint32_t slot = 0; slot < obstacles_.size(); ++slot) {
    if (!obstacles_[slot].exists) continue;
    if (obstacles_[slot].has_cells) put_up(slot, number);
    if (obstacles_[slot].waits() || obstacles_[slot].is_exit_only) find_swept(slot);
  }
  block_cells();
}

void ObstacleSet::close_class(size_t number) {
  classes_[number] = {};
  for (CrowdObstacle& obstacle : obstacles_) {
    if (obstacle.exists) obstacle.of_class[number] = {};
  }
}

uint32_t ObstacleSet::add(const Prism& prism, ObstacleKind kind, bool wanted_up,
                          ObstaclePolicy policy) {
  uint32_t slot = 0;
  if (free_slots_.empty()) {
    slot = static_cast<uint32_t>(obstacles_.size());
    obstacles_.emplace_back();
  } else {
    slot = free_slots_.back();
    free_slots_.pop_back();
  }
  CrowdObstacle& obstacle = obstacles_[slot];
  obstacle = {};
  obstacle.exists = true;
  obstacle.kind = kind;
  obstacle.policy = policy;
  obstacle.place = obstacle.wanted = prism;
  obstacle.of_class.resize(classes_.size());
  if (wanted_up) request_active(slot, true);
  note(slot);
  return slot;
}

void ObstacleSet::request_move(uint32_t slot, const Prism& prism) {
  CrowdObstacle& obstacle = obstacles_[slot];
  obstacle.wanted = prism;
  obstacle.is_elsewhere = obstacle.is_up;
  if (!obstacle.is_up) {
    unblock(slot);  // It closes there instead.
    obstacle.place = prism;
    ++obstacle.version;
  }
  find_swept(slot);
  note(slot);
}

// After any change: is it one that waits now?
void ObstacleSet::note(uint32_t slot) {
  const CrowdObstacle& obstacle = obstacles_[slot];
  const auto at = std::lower_bound(waiting_.begin(), waiting_.end(), slot);
  const bool is_known = at != waiting_.end() && *at == slot;
  const bool waits = obstacle.waits() || obstacle.is_exit_only;
  if (waits && !is_known) waiting_.insert(at, slot);
  if (!waits && is_known) waiting_.erase(at);
  if (is_changed_.size() < obstacles_.size()) is_changed_.resize(obstacles_.size(), false);
  if (!is_changed_[slot]) changed_.push_back(slot);
  is_changed_[slot] = true;
}

std::vector<uint32_t> ObstacleSet::take_changed() {
  std::sort(changed_.begin(), changed_.end());
  for (const uint32_t slot : changed_) is_changed_[slot] = false;
  return std::exchange(changed_, {});
}

void ObstacleSet::request_active(uint32_t slot, bool up) {
  CrowdObstacle& obstacle = obstacles_[slot];
  obstacle.wanted_up = up;
  if (up) {
    if (!obstacle.is_up) find_swept(slot);
    note(slot);
    return;
  }
  unblock(slot);
  if (obstacle.is_elsewhere) ++obstacle.version;
  obstacle.is_up = obstacle.is_elsewhere = false;
  obstacle.requested_step = obstacle.up_step = CrowdObstacle::kNever;
  obstacle.occupants = 0;
  obstacle.place = obstacle.wanted;
  for (auto& of_class : obstacle.of_class) of_class.swept.clear();
  note(slot);
}

void ObstacleSet::remove(uint32_t slot) {
  request_active(slot, false);
  obstacles_[slot] = {};
  free_slots_.push_back(slot);
  note(slot);
}

std::vector<std::pair<uint32_t, uint32_t>> ObstacleSet::blockers(std::span<const uint32_t> slots,
                                                                 std::span<const Body> bodies,
                                                                 int32_t workers) const {
  struct Asked {
    uint32_t slot;
    const world::CellRows* rows;
  };
  // By class and level; looked up only.
  std::unordered_map<uint64_t, std::vector<Asked>> lists;
  const auto key = [](size_t number, uint32_t level) { return uint64_t{number} << 32 | level; };
  uint32_t first = UINT32_MAX, last = 0;  // levels: most bodies are on none of them
  for (const uint32_t slot : slots) {
    for (size_t c = 0; c < classes_.size(); ++c) {
      for (const LevelCells& cells : obstacles_[slot].of_class[c].swept) {
        first = std::min(first, cells.level);
        last = std::max(last, cells.level);
        lists[key(c, cells.level)].push_back({slot, &cells.rows});
      }
    }
  }
  std::vector<std::pair<uint32_t, uint32_t>> found;
  if (lists.empty()) return found;
  std::mutex adding;
  parallel_ranges(bodies.size(), 4096, workers, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      const Body& body = bodies[i];
      if (body.level < first || body.level > last || body.has(Body::kMovedElsewhere)) continue;
      const auto list = lists.find(key(body.avatar_class, body.level));
      if (list == lists.end()) continue;
      for (const Asked& asked : list->second) {
        if (!has(*asked.rows, body.point().cell_x(), body.point().cell_z())) continue;
        const std::lock_guard lock(adding);
        found.emplace_back(asked.slot, static_cast<uint32_t>(i));
      }
    }
  });
  std::sort(found.begin(), found.end());
  return found;
}

void ObstacleSet::settle(uint32_t slot) {
  CrowdObstacle& obstacle = obstacles_[slot];
  if (obstacle.is_elsewhere) {
    unblock(slot);
    ++obstacle.version;
  }
  obstacle.place = obstacle.wanted;
  obstacle.is_up = true;
  obstacle.is_elsewhere = false;
  if (!obstacle.is_exit_only) {
    for (auto& of_class : obstacle.of_class) of_class.swept.clear();
  }
  take(slot);
  note(slot);
}

void ObstacleSet::close(uint32_t slot) {
  take(slot);
  note(slot);
}

void ObstacleSet::set_exit_only(uint32_t slot, bool lets) {
  CrowdObstacle& obstacle = obstacles_[slot];
  if (obstacle.is_exit_only == lets) return;
  obstacle.is_exit_only = lets;
  for (size_t c = 0; c < classes_.size(); ++c) {
    CrowdObstacle::OfClass& of = obstacle.of_class[c];
    classes_[c].touched.insert(classes_[c].touched.end(), of.levels.begin(), of.levels.end());
    if (!lets && !obstacle.waits()) of.swept.clear();
  }
  note(slot);
}

void ObstacleSet::take(uint32_t slot) {
  if (obstacles_[slot].has_cells) return;
  obstacles_[slot].has_cells = true;
  path_cutters_ += obstacles_[slot].kind == ObstacleKind::kStatic ? 1 : 0;
  for (size_t c = 0; c < classes_.size(); ++c) put_up(slot, c);
}

void ObstacleSet::unblock(uint32_t slot) {
  CrowdObstacle& obstacle = obstacles_[slot];
  if (obstacle.has_cells) {
    path_cutters_ -= obstacle.kind == ObstacleKind::kStatic ? 1 : 0;
    for (size_t c = 0; c < classes_.size(); ++c) unblock_class(slot, c);
  }
  obstacle.has_cells = obstacle.is_exit_only = false;
}

std::vector<LevelCells> ObstacleSet::cells_under(size_t number, const Prism& prism) const {
  std::vector<LevelCells> found;
  const CrowdGround* ground = classes_[number].ground;
  if (ground == nullptr) return found;
  const world::WorldData& world = *data_of(world_);
  const AvatarClass& avatar = world.summary.classes[classes_[number].body];
  const path::SquareRange tiles =
      path::tiles_near(world, prism.corners, path::taking_reach(avatar));
  for (int32_t z = tiles.first_z; z <= tiles.last_z; ++z) {
    for (int32_t x = tiles.first_x; x <= tiles.last_x; ++x) {
      ground->for_tile(x, z, INT32_MIN, INT32_MAX, [&](uint32_t level) {
        const world::CellRows* baked = ground->baked_legal(level);
        const uint64_t* legal = baked != nullptr ? baked->data() : ground->legal(level);
        const path::TileFloor floor{world.summary, ground->view(level), x, z};
        const world::CellRows blocked = path::blocked_cells(floor, avatar, prism, {}, legal);
        const bool any =
            std::any_of(blocked.begin(), blocked.end(), [](uint64_t row) { return row != 0; });
        if (any) found.push_back({level, blocked});
      });
    }
  }
  return found;
}

void ObstacleSet::find_swept(uint32_t slot) {
  CrowdObstacle& obstacle = obstacles_[slot];
  const Prism swept = obstacle.is_up ? hull_of(obstacle.place, obstacle.wanted) : obstacle.wanted;
  for (size_t c = 0; c < classes_.size(); ++c) {
    obstacle.of_class[c].swept = obstacle.waits() || obstacle.is_exit_only
                                     ? cells_under(c, swept)
                                     : std::vector<LevelCells>();
  }
}

void ObstacleSet::put_up(uint32_t slot, size_t number) {
  CrowdObstacle& obstacle = obstacles_[slot];
  ClassGround& of = classes_[number];
  for (LevelCells& cells : cells_under(number, obstacle.place)) {
    obstacle.of_class[number].levels.push_back(cells.level);
    of.cell_blockers[cells.level].push_back({slot, cells.rows});
    of.touched.push_back(cells.level);
  }
}

void ObstacleSet::unblock_class(uint32_t slot, size_t number) {
  CrowdObstacle& obstacle = obstacles_[slot];
  ClassGround& of = classes_[number];
  for (const uint32_t level : obstacle.of_class[number].levels) {
    const auto here = of.cell_blockers.find(level);
    std::erase_if(here->second,
                  [&](const CellBlocker& cell_blocker) { return cell_blocker.slot == slot; });
    if (here->second.empty()) of.cell_blockers.erase(here);
    of.touched.push_back(level);
  }
  obstacle.of_class[number].levels.clear();
}

void ObstacleSet::block_cells() {
  for (size_t c = 0; c < classes_.size(); ++c) {
    ClassGround& of = classes_[c];
    if (of.touched.empty()) continue;
    std::sort(of.touched.begin(), of.touched.end());
    of.touched.erase(std::unique(of.touched.begin(), of.touched.end()), of.touched.end());
    block_levels(of);
    of.touched.clear();
  }
}

void ObstacleSet::set_zero_cells(size_t number, std::span<const LevelCells> cells, bool may_leave) {
  ClassGround& of = classes_[number];
  for (const auto& [level, rows] : of.zero_cells) of.touched.push_back(level);
  of.zero_cells.clear();
  for (const LevelCells& here : cells) {
    of.zero_cells[here.level] = here.rows;
    of.touched.push_back(here.level);
  }
  of.may_leave_zero = may_leave;
}

void ObstacleSet::set_zero_leave(size_t number, bool may_leave) {
  ClassGround& of = classes_[number];
  if (of.may_leave_zero == may_leave) return;
  of.may_leave_zero = may_leave;
  for (const auto& [level, rows] : of.zero_cells) of.touched.push_back(level);
}

bool ObstacleSet::is_on_zero(const Body& body) const {
  if (body.has(Body::kMovedElsewhere)) return false;
  const auto& zero_cells = classes_[body.avatar_class].zero_cells;
  const auto here = zero_cells.find(body.level);
  return here != zero_cells.end() &&
         has(here->second, body.point().cell_x(), body.point().cell_z());
}

void ObstacleSet::block_levels(ClassGround& of) {
  std::vector<std::pair<int32_t, int32_t>> tiles;
  const WorldSummary& summary = data_of(world_)->summary;
  LeftCells& left = of.ground->left();
  const AvatarClass& avatar = summary.classes[of.body];
  left.begin(summary, avatar);
  for (const uint32_t level : of.touched) {
    world::CellRows blocked{}, kept{};
    std::vector<LeftCells::Part> parts;
    const auto cell_blockers = of.cell_blockers.find(level);
    if (cell_blockers != of.cell_blockers.end()) {
      for (const CellBlocker& cell_blocker : cell_blockers->second) {
        for (size_t z = 0; z < blocked.size(); ++z) blocked[z] |= cell_blocker.rows[z];
        const CrowdObstacle& obstacle = obstacles_[cell_blocker.slot];
        if (obstacle.is_exit_only) {
          parts.push_back(left.part(cell_blocker.slot, obstacle.place, cell_blocker.rows));
        } else {
          for (size_t z = 0; z < kept.size(); ++z) kept[z] |= cell_blocker.rows[z];
        }
      }
    }
    if (const auto zero = of.zero_cells.find(level); zero != of.zero_cells.end()) {
      for (size_t z = 0; z < blocked.size(); ++z) blocked[z] |= zero->second[z];
      if (of.may_leave_zero) {
        parts.push_back({.obstacle = LeftCells::kZeroWeight, .rows = zero->second});
      } else {
        for (size_t z = 0; z < kept.size(); ++z) kept[z] |= zero->second[z];
      }
    }
    of.ground->set_blocked(level, blocked);
    left.set_level(level, std::move(parts), kept);
    const CrowdGround::Record& record = of.ground->records()[level];
    tiles.emplace_back(record.tile_x, record.tile_z);
  }
  std::sort(tiles.begin(), tiles.end());
  tiles.erase(std::unique(tiles.begin(), tiles.end()), tiles.end());
  for (const auto& [x, z] : tiles) of.ground->join_tile(x, z);
  find_exits(*of.ground, world::step_mm(avatar), of.touched);
}

bool ObstacleSet::restore(std::vector<CrowdObstacle> obstacles, std::vector<uint32_t> free_slots) {
  std::vector<bool> is_free(obstacles.size(), false);
  for (const uint32_t slot : free_slots) {
    if (slot >= obstacles.size() || obstacles[slot].exists || is_free[slot]) return false;
    is_free[slot] = true;
  }
  for (size_t slot = 0; slot < obstacles.size(); ++slot) {
    CrowdObstacle& obstacle = obstacles[slot];
    if (obstacle.exists == is_free[slot]) return false;
    if (!obstacle.exists && (obstacle.has_cells || obstacle.is_exit_only)) return false;
    if (!obstacle.exists) continue;
    if (!check_prism(obstacle.place) || !check_prism(obstacle.wanted)) return false;
    const bool may_close = obstacle.wanted_up && obstacle.policy == ObstaclePolicy::kRefuseEntry;
    if (obstacle.is_up ? !obstacle.has_cells : obstacle.has_cells && !may_close) return false;
    if (obstacle.is_exit_only && !obstacle.has_cells) return false;
    obstacle.of_class.resize(classes_.size());
  }
  obstacles_ = std::move(obstacles);
  free_slots_ = std::move(free_slots);
  waiting_.clear();
  path_cutters_ = 0;
  for (uint32_t slot = 0; slot < obstacles_.size(); ++slot) {
    const CrowdObstacle& obstacle = obstacles_[slot];
    path_cutters_ += obstacle.has_cells && obstacle.kind == ObstacleKind::kStatic ? 1 : 0;
    note(slot);
  }
  return true;
}

uint64_t ObstacleSet::bytes() const {
  uint64_t bytes = obstacles_.capacity() * sizeof(CrowdObstacle) +
                   (waiting_.capacity() + changed_.capacity()) * sizeof(uint32_t);
  for (const ClassGround& of : classes_) {
    for (const auto& [level, cell_blockers] : of.cell_blockers)
      bytes += cell_blockers.capacity() * sizeof(CellBlocker);
  }
  return bytes;
}

}  // namespace throng::crowd
