// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/access.h"
#include "core/check_class.h"
#include "crowd/crowd_state.h"
#include "path/edits/density_cells.h"
#include "throng/crowd.h"
#include "world/place.h"

// Avatars that follow a density map. The map makes a class of its own: the ground of a class of the
// world without the cells that touch a pixel of weight 0, and finders that know it. So no move of
// the engine can enter such a cell, however hard others push, and the step needs no rule for it.
// docs/design/018-papers.md, "Following a density map".
namespace throng {
namespace {

bool is_empty(const world::CellRows& rows) {
  return std::all_of(rows.begin(), rows.end(), [](uint64_t row) { return row == 0; });
}

}  // namespace

Result<int32_t> Crowd::add_density_class(int32_t avatar_class, const DensityGrid& map,
                                         Context& context) {
  State& s = *state_;
  const std::vector<AvatarClass>& classes = data_of(s.shared.world)->summary.classes;
  if (auto ok = check_class(classes, avatar_class, "crowd"); !ok) {
    return Error{Errc::kNotFound, ok.error().message};
  }
  const auto body = static_cast<size_t>(avatar_class);
  if (s.shared.flies(body) || s.shared.climbs(body)) {
    return Error{Errc::kBadConfig, "crowd: avatars of class " + classes[body].name +
                                       " fly or go over nodes; only walkers follow a density map"};
  }
  if (auto ok = path::check_density(map); !ok) return ok.error();
  const size_t number = s.shared.baked_classes() + s.shared.density_classes.size();
  if (number >= static_cast<size_t>(kMaxAvatarClasses)) {
    return Error{Errc::kLimit,
                 "crowd: the classes of the world and those that follow density maps are more than "
                 "16; use fewer maps or classes"};
  }
  s.shared.density_classes.push_back({body, std::make_shared<const path::DensityCells>(map)});
  s.walk.engine().copy_slope_factors(number, body);
  s.follow_edits();
  if (auto ok = s.open_class(static_cast<int32_t>(number), context); !ok) {
    s.shared.density_classes.pop_back();
    return ok.error();
  }
  return static_cast<int32_t>(number);
}

Result<void> Crowd::set_density(int32_t density_class, std::span<const uint8_t> weights) {
  State& s = *state_;
  const auto number = static_cast<size_t>(density_class);
  const size_t first = s.shared.baked_classes();
  if (density_class < 0 || number < first || number - first >= s.shared.density_classes.size()) {
    return Error{Errc::kNotFound,
                 "crowd: class " + std::to_string(density_class) + " follows no density map"};
  }
  crowd::DensityClass& of = s.shared.density_classes[number - first];
  DensityGrid map = of.cells->map();
  if (weights.size() != map.weights.size()) {
    return Error{Errc::kBadInput, "crowd: the density map of class " +
                                      std::to_string(density_class) + " has " +
                                      std::to_string(map.weights.size()) + " pixels, not " +
                                      std::to_string(weights.size())};
  }
  map.weights.assign(weights.begin(), weights.end());
  of.cells = std::make_shared<const path::DensityCells>(std::move(map));
  if (!s.shared.classes[number]) return {};
  s.block_zero_cells(number);
  s.walk.density_changed(number);
  s.ground_changed();
  s.mark_leaving({}, /*all=*/false);
  return {};
}

bool Crowd::may_stand(int32_t avatar_class, const Place& place) const {
  const State& s = *state_;
  const auto number = static_cast<size_t>(avatar_class);
  if (avatar_class < 0 || number >= s.shared.classes.size() || !s.shared.classes[number]) {
    return false;
  }
  const auto point = world::ground_point(*data_of(s.shared.world), place);
  return point &&
         s.shared.classes[number]->ground.is_legal(
             place.level1 - 1, world::in_tile(point->cell_x()), world::in_tile(point->cell_z()));
}

void Crowd::State::block_zero_cells(size_t number) {
  const auto& density = shared.density_of(number);
  if (!density) return;
  const world::WorldData& data = *data_of(shared.world);
  const crowd::CrowdGround& ground = shared.classes[number]->ground;
  const path::SquareRange tiles = density->tiles(data);
  std::vector<crowd::LevelCells> cells;
  for (int32_t z = tiles.first_z; z <= tiles.last_z; ++z) {
    for (int32_t x = tiles.first_x; x <= tiles.last_x; ++x) {
      ground.for_tile(x, z, INT32_MIN, INT32_MAX, [&](uint32_t level) {
        const world::CellRows* baked = ground.baked_legal(level);
        const uint64_t* legal = baked != nullptr ? baked->data() : ground.legal(level);
        world::CellRows zero = density->zero_cells({data.summary, ground.view(level), x, z});
        for (size_t row = 0; row < zero.size(); ++row) zero[row] &= legal[row];
        if (!is_empty(zero)) cells.push_back({level, zero});
      });
    }
  }
  shared.obstacles.set_zero_cells(number, cells, /*may_leave=*/false);
  find_leaving_zero();
  shared.obstacles.block_cells();
}

void Crowd::State::find_leaving_zero() {
  std::array<bool, kMaxAvatarClasses> some{};
  for (const crowd::Body& body : walk.bodies()) {
    if (shared.obstacles.is_on_zero(body)) some[body.avatar_class] = true;
  }
  if (shared.share) {
    const std::vector<std::array<bool, kMaxAvatarClasses>> all =
        shared.share->gather(std::span<const std::array<bool, kMaxAvatarClasses>>(&some, 1));
    for (const auto& of_rank : all) {
      for (size_t c = 0; c < some.size(); ++c) some[c] = some[c] || of_rank[c];
    }
  }
  for (size_t c = shared.baked_classes(); c < shared.classes.size(); ++c) {
    shared.obstacles.set_zero_leave(c, some[c]);
  }
  shared.obstacles.block_cells();
}

void Crowd::State::end_leaving_zero() {
  bool some = false;
  for (size_t c = shared.baked_classes(); c < shared.classes.size(); ++c) {
    some = some || shared.obstacles.may_leave_zero(c);
  }
  if (some) find_leaving_zero();
}

bool Crowd::State::take_densities(std::vector<crowd::DensityClass> classes) {
  shared.density_classes = std::move(classes);
  for (size_t i = 0; i < shared.density_classes.size(); ++i) {
    const size_t body = shared.density_classes[i].body;
    if (shared.flies(body) || shared.climbs(body)) return false;
    walk.engine().copy_slope_factors(shared.baked_classes() + i, body);
  }
  return true;
}

void Crowd::State::add_on_zero(std::vector<std::pair<uint32_t, uint32_t>>& found) const {
  bool some = false;
  for (size_t c = shared.baked_classes(); c < shared.classes.size(); ++c) {
    some = some || shared.obstacles.may_leave_zero(c);
  }
  const std::span<const crowd::Body> all = walk.bodies();
  for (uint32_t i = 0; some && i < all.size(); ++i) {
    if (shared.obstacles.is_on_zero(all[i])) {
      found.emplace_back(i, crowd::LeftCells::kZeroWeight);
    }
  }
}

}  // namespace throng
