// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "core/parallel.h"
#include "core/random.h"
#include "throng/crowd.h"
#include "throng/world.h"

// Source: [TC00] 5. A seen area that is simulated alone drains: avatars walk out and none enter. So
// a band of unseen cells beside the seen ones is kept at the required density, as a reservoir, and
// goals lead avatars from it into sight and out again. The choice of goals corrects the density in
// sight. A density map says on both sides of the border how many each cell is to have. Time of an
// update: linear in the members, plus the cells of each classification.
namespace throng {
namespace {

constexpr int32_t kStride = 4;  // Every fourth cell along X and Z represents 16.
constexpr double kAdjust = 0.01, kMinFull = 0.3,
                 kMaxFull = 1.5;     // Fullness of the band: change a step, limits.
constexpr double kBodyMargin = 0.5;  // No body extends further from its axis. [m]
enum Stream : uint64_t { kWant = 1, kSpawn, kGoal, kClass, kWeight };

// A level tile's part of the ground.
struct GroundCell {
  Box3d box;  // Includes bodies that stand on it.
  double area = 0;
  double mass = 0;  // area times weight, by the mean weight; without a map, the area
  uint8_t heaviest = 0;
  int32_t tile_x = 0, tile_z = 0;
};

// A class that is added.
struct OfMix {
  int32_t avatar_class = 0, of_crowd = 0;
  int32_t component = -1;
  double until = 1;  // of the shares, summed up
};

enum class CellState : uint8_t { kIdle, kBand, kSeen };

bool has_map(const GeneratorConfig& config) { return !config.map.weights.empty(); }

double flat_distance(const Box3d& box, Vec3d p) {
  const auto beyond = [](double v, double low, double high) {
    return std::max({low - v, v - high, 0.0});
  };
  return std::hypot(beyond(p.x, box.min.x, box.max.x), beyond(p.z, box.min.z, box.max.z));
}

double flat_distance(const Box3d& a, const Box3d& b) {
  const auto between = [](double a_low, double a_high, double b_low, double b_high) {
    return std::max({a_low - b_high, b_low - a_high, 0.0});
  };
  return std::hypot(between(a.min.x, a.max.x, b.min.x, b.max.x),
                    between(a.min.z, a.max.z, b.min.z, b.max.z));
}

}  // namespace

struct AvatarGenerators::State {
  World world;
  Graph graph;
  GeneratorConfig config;
  int32_t component = -1;
  double height = 0, cell = 0;
  std::vector<OfMix> mix;  // At least one.
  bool knows_crowd = false;
  SightFrom can_see_from;
  std::vector<GroundCell> cells;  // By level tile; area 0: not of this component.
  double area = 0;

  std::vector<CellState> states;
  std::vector<uint32_t> active;  // Cells that are not idle.
  Vec3d classified_from;
  int32_t steps_since_classified = -1;  // -1: never classified.

  std::vector<AvatarId> members;
  std::vector<uint32_t> counts;  // Of members, by cell.
  double fullness = 1;           // Of the band, as a share of the required density.
  uint64_t drawn = 0;            // Random numbers used so far.

  void classify(Vec3d eye, const Sight& can_see);
  [[nodiscard]] Box3d body(Vec3d feet) const;
  Result<void> begin(const WorldSummary& summary, Context& context);
  void measure(GroundCell& out, uint32_t number, const WorldSummary& summary) const;
  void normalise();
  Result<void> meet(Crowd& crowd, Context& context);
  [[nodiscard]] uint8_t weight_at(Vec3d feet) const;
  [[nodiscard]] const OfMix& mix_of(int32_t avatar_class) const;
  [[nodiscard]] const OfMix& random_class();
  [[nodiscard]] uint32_t cell_of(const AvatarState& avatar) const;
  [[nodiscard]] Place random_place(uint32_t in, Stream stream, const OfMix& of);
  [[nodiscard]] uint32_t wanted(uint32_t in) const;
  [[nodiscard]] double missing() const;
  [[nodiscard]] Place random_goal(const Crowd& crowd, const OfMix& of);
  void give_goals(Crowd& crowd, const std::vector<AvatarId>& to);
  Result<uint32_t> fill(Crowd& crowd, uint32_t in, const Sight* can_see, Context& context);
  uint32_t remove_surplus(Crowd& crowd, const Sight& can_see);
  [[nodiscard]] GeneratorReport report() const;
};

Box3d AvatarGenerators::State::body(Vec3d feet) const {
  return {{feet.x - kBodyMargin, feet.y - 0.1, feet.z - kBodyMargin},
          {feet.x + kBodyMargin, feet.y + height + 0.1, feet.z + kBodyMargin}};
}

// 0 beyond the picture.
uint8_t AvatarGenerators::State::weight_at(Vec3d feet) const {
  const DensityGrid& map = config.map;
  const double column = std::floor((feet.x - map.x0) / (map.x1 - map.x0) * map.width),
               row = std::floor((feet.z - map.z0) / (map.z1 - map.z0) * map.height);
  const bool inside = column >= 0 && row >= 0 && column < map.width && row < map.height &&
                      feet.y >= map.low && feet.y <= map.high;
  if (!inside) return 0;
  return map.weights[static_cast<size_t>(row) * static_cast<size_t>(map.width) +
                     static_cast<size_t>(column)];
}

const OfMix& AvatarGenerators::State::mix_of(int32_t avatar_class) const {
  for (const OfMix& of : mix) {
    if (of.avatar_class == avatar_class) return of;
  }
  return mix.front();
}

const OfMix& AvatarGenerators::State::random_class() {
  if (mix.size() == 1) return mix.front();
  const double which = mix.back().until * random_unit(config.seed, kClass, drawn++);
  for (const OfMix& of : mix) {
    if (which < of.until) return of;
  }
  return mix.back();
}

uint32_t AvatarGenerators::State::cell_of(const AvatarState& avatar) const {
  const Place place = world.find_place(avatar.avatar_class, avatar.position, 1.0);
  return place.level1 - 1;  // No place: an index beyond all cells.
}

// Marks cells as seen, as the band beside them, or as idle.
void AvatarGenerators::State::classify(Vec3d eye, const Sight& can_see) {
  states.assign(cells.size(), CellState::kIdle);
  active.clear();
  const auto is_seen = [&](const Box3d& box) {
    if (!can_see_from) return can_see(box);
    const double r = config.region;
    const std::array<Vec3d, 5> eyes = {{eye, eye + Vec3d{r, 0, 0}, eye - Vec3d{r, 0, 0},
                                        eye + Vec3d{0, 0, r}, eye - Vec3d{0, 0, r}}};
    return std::any_of(eyes.begin(), eyes.end(),
                       [&](const Vec3d& from) { return can_see_from(from, box); });
  };
  std::vector<uint32_t> near, seen;
  for (uint32_t i = 0; i < cells.size(); ++i) {
    if (cells[i].area > 0 && flat_distance(cells[i].box, eye) <= config.radius) near.push_back(i);
  }
  for (const uint32_t i : near) {
    if (!is_seen(cells[i].box)) continue;
    states[i] = CellState::kSeen;
    seen.push_back(i);
  }
  for (const uint32_t i : near) {
    if (states[i] != CellState::kIdle) continue;
    const bool beside = std::any_of(seen.begin(), seen.end(), [&](uint32_t s) {
      return flat_distance(cells[i].box, cells[s].box) <= config.band;
    });
    if (beside) states[i] = CellState::kBand;
  }
  for (const uint32_t i : near) {
    if (states[i] != CellState::kIdle) active.push_back(i);
  }
  classified_from = eye;
  steps_since_classified = 0;
}

// Uniform over the cell's ground: draws until a point has a place of the component.
Place AvatarGenerators::State::random_place(uint32_t in, Stream stream, const OfMix& of) {
  const GroundCell& c = cells[in];
  const double side = cell * kTileCells;
  const Vec3d low = world.summary().origin + Vec3d{c.tile_x * side, 0, c.tile_z * side};
  for (int32_t tries = 0; tries < 200; ++tries, ++drawn) {
    const Vec3d at{low.x + side * random_unit(config.seed, stream, 2 * drawn),
                   0.5 * (c.box.min.y + c.box.max.y - height),
                   low.z + side * random_unit(config.seed, stream, 2 * drawn + 1)};
    const Place place = world.find_place(of.avatar_class, at, c.box.max.y - c.box.min.y + 1);
    if (place.level1 != in + 1) continue;
    if (graph.component_at(of.avatar_class, place) != of.component) continue;
    if (has_map(config) &&
        !(c.heaviest * random_unit(config.seed, kWeight, drawn) < weight_at(place.position))) {
      continue;
    }
    ++drawn;
    return place;
  }
  return {};
}

// Rounded at random, so that the mean over cells is the required density.
uint32_t AvatarGenerators::State::wanted(uint32_t in) const {
  return static_cast<uint32_t>(fullness * config.density * cells[in].mass +
                               random_unit(config.seed, kWant, in));
}

// The share of the avatars required in sight that is missing.
double AvatarGenerators::State::missing() const {
  double mass_seen = 0, there = 0;
  for (const uint32_t i : active) {
    if (states[i] != CellState::kSeen) continue;
    mass_seen += cells[i].mass;
    there += counts[i];
  }
  return 1 - there / std::max(config.density * mass_seen, 1.0);
}

Place AvatarGenerators::State::random_goal(const Crowd& crowd, const OfMix& of) {
  const double seen_weight = std::clamp(1 + 4 * missing(), 0.1, 5.0);
  const auto weight = [&](uint32_t i) {
    return cells[i].mass * (states[i] == CellState::kSeen ? seen_weight : 1);
  };
  double sum = 0;
  for (const uint32_t i : active) sum += weight(i);
  double which = sum * random_unit(config.seed, kGoal, drawn++);
  for (const uint32_t i : active) {
    which -= weight(i);
    if (which >= 0) continue;
    const Place place = random_place(i, kGoal, of);
    return !has_map(config) || crowd.may_stand(of.of_crowd, place) ? place : Place();
  }
  return {};
}

void AvatarGenerators::State::give_goals(Crowd& crowd, const std::vector<AvatarId>& to) {
  constexpr int kMaxGoals = 8;  // drawn, where a map leaves some out
  std::vector<Place> goals(to.size());
  for (size_t i = 0; i < to.size(); ++i) {
    const auto state = crowd.read(to[i]);
    const OfMix& of = state ? mix_of(state->avatar_class) : mix.front();
    for (int k = 0; k < (has_map(config) ? kMaxGoals : 1) && !goals[i]; ++k) {
      goals[i] = random_goal(crowd, of);
    }
  }
  crowd.set_goals(to, goals);
}

// Adds the avatars missing on a cell; with `can_see`, only out of sight.
Result<uint32_t> AvatarGenerators::State::fill(Crowd& crowd, uint32_t in, const Sight* can_see,
                                               Context& context) {
  const uint32_t want = wanted(in);
  std::vector<AvatarSpawn> spawns;
  for (uint32_t n = counts[in]; n < want; ++n) {
    const OfMix& of = random_class();
    const Place place = random_place(in, kSpawn, of);
    if (!place || (can_see != nullptr && (*can_see)(body(place.position)))) continue;
    spawns.push_back({.place = place, .avatar_class = of.of_crowd});
  }
  if (spawns.empty()) return 0U;
  const Result<std::vector<AvatarId>> added = crowd.add(spawns, context);
  if (!added) return added.error();
  std::vector<AvatarId> here;
  for (const AvatarId id : *added) {
    if (id) here.push_back(id);
  }
  members.insert(members.end(), here.begin(), here.end());
  counts[in] += static_cast<uint32_t>(here.size());
  give_goals(crowd, here);
  return static_cast<uint32_t>(here.size());
}

// Counts members by cell. Removes members out of sight that left the band or are surplus on it.
uint32_t AvatarGenerators::State::remove_surplus(Crowd& crowd, const Sight& can_see) {
  counts.assign(cells.size(), 0);
  std::vector<AvatarId> removed;
  size_t kept = 0;
  for (const AvatarId id : members) {
    const auto state = crowd.read(id);
    if (!state) continue;  // Removed by other code.
    const uint32_t at = cell_of(*state);
    const bool known = at < cells.size();
    const CellState where = known ? states[at] : CellState::kIdle;
    const bool surplus =
        where == CellState::kIdle || (where == CellState::kBand && counts[at] >= wanted(at));
    if (surplus && !can_see(body(state->position))) {
      removed.push_back(id);
      continue;
    }
    if (known) ++counts[at];
    members[kept++] = id;
  }
  members.resize(kept);
  crowd.remove(removed);
  return static_cast<uint32_t>(removed.size());
}

GeneratorReport AvatarGenerators::State::report() const {
  GeneratorReport out;
  for (const uint32_t i : active) {
    const bool seen = states[i] == CellState::kSeen;
    (seen ? out.seen_area : out.band_area) += cells[i].area;
    (seen ? out.seen_avatars : out.band_avatars) += counts[i];
  }
  return out;
}

namespace {

Result<void> check_generators(const GeneratorConfig& config, const WorldSummary& summary) {
  const DensityGrid& map = config.map;
  const bool sound = config.density > 0 && config.density <= 1 && config.radius > 0 &&
                     config.band > 0 && config.steps_per_query > 0 && config.workers >= 0 &&
                     config.people >= 0 && std::isfinite(config.people) && config.region >= 0 &&
                     std::isfinite(config.region);
  if (!sound) {
    return Error{Errc::kBadConfig,
                 "generators: need a density over 0 and up to 1, people and region not below 0, "
                 "and radius, band and steps_per_query over 0"};
  }
  std::vector<int32_t> classes{config.avatar_class};
  for (const GeneratorShare& share : config.mix) {
    classes.push_back(share.avatar_class);
    const auto same = std::count_if(
        config.mix.begin(), config.mix.end(),
        [&](const GeneratorShare& other) { return other.avatar_class == share.avatar_class; });
    if (!(share.share > 0 && std::isfinite(share.share)) || same > 1) {
      return Error{Errc::kBadConfig,
                   "generators: each class of the mix needs one share, which is above 0"};
    }
  }
  for (const int32_t number : classes) {
    if (number >= 0 && number < static_cast<int32_t>(summary.classes.size())) continue;
    return Error{Errc::kNotFound, "generators: the world has no class " + std::to_string(number)};
  }
  if (map.weights.empty()) return {};
  const bool has_pixels =
      map.width > 0 && map.height > 0 && map.x0 < map.x1 && map.z0 < map.z1 &&
      map.weights.size() == static_cast<size_t>(map.width) * static_cast<size_t>(map.height) &&
      std::any_of(map.weights.begin(), map.weights.end(), [](uint8_t w) { return w > 0; });
  if (has_pixels) return {};
  return Error{Errc::kBadConfig,
               "generators: the map needs a box, a weight for each pixel, and one that is not 0"};
}

}  // namespace

AvatarGenerators::AvatarGenerators(std::unique_ptr<State> state) : state_(std::move(state)) {}
AvatarGenerators::AvatarGenerators(AvatarGenerators&&) noexcept = default;
AvatarGenerators& AvatarGenerators::operator=(AvatarGenerators&&) noexcept = default;
AvatarGenerators::~AvatarGenerators() = default;

Result<AvatarGenerators> AvatarGenerators::create(const World& world, const GeneratorConfig& config,
                                                  Context& context) {
  const WorldSummary summary = world.summary();
  if (auto ok = check_generators(config, summary); !ok) return ok.error();
  auto state = std::make_unique<State>();
  State& s = *state;
  s.world = world;
  s.config = config;
  s.cell = summary.cell;
  const auto of_class = static_cast<size_t>(config.avatar_class);
  s.height = summary.classes[of_class].height;
  if (auto ok = s.begin(summary, context); !ok) return ok.error();
  s.cells.resize(world.level_tile_count());
  parallel_for(s.cells.size(), config.workers,
               [&](size_t i) { s.measure(s.cells[i], static_cast<uint32_t>(i), summary); });
  s.normalise();
  if (config.people > 0) {
    s.config.density = std::clamp(config.people / std::max(1.0, s.area), 1e-6, 1.0);
  }
  s.counts.assign(s.cells.size(), 0);
  return AvatarGenerators(std::move(state));
}

// The ground that is reachable from home, by class.
Result<void> AvatarGenerators::State::begin(const WorldSummary& summary, Context& context) {
  Result<Graph> made = Graph::create(world, {.workers = config.workers}, context);
  if (!made) return made.error();
  graph = *std::move(made);
  component = graph.component_at(config.avatar_class, config.home);
  if (component < 0) {
    return Error{Errc::kBadInput, "generators: no avatar of this class can stand at home"};
  }
  mix = {{.avatar_class = config.avatar_class,
          .of_crowd = config.avatar_class,
          .component = component}};
  if (config.mix.empty()) return {};
  mix.clear();
  double sum = 0;
  for (const GeneratorShare& share : config.mix) {
    sum += share.share;
    const int32_t number = share.avatar_class;
    const Place home = number == config.avatar_class
                           ? config.home
                           : world.find_place(number, config.home.position, 1.0);
    const int32_t there = home ? graph.component_at(number, home) : -1;
    if (there < 0) {
      return Error{Errc::kBadInput, "generators: no avatar of class " +
                                        summary.classes[static_cast<size_t>(number)].name +
                                        " can stand at home"};
    }
    mix.push_back({.avatar_class = number, .of_crowd = number, .component = there, .until = sum});
  }
  return {};
}

// By every fourth cell along X and Z.
void AvatarGenerators::State::measure(GroundCell& out, uint32_t number,
                                      const WorldSummary& summary) const {
  const LevelTileContent tile = world.level_tile(number);
  const auto of_class = static_cast<size_t>(config.avatar_class);
  out.tile_x = tile.tile_x, out.tile_z = tile.tile_z;
  for (int32_t z = kStride / 2; z < kTileCells; z += kStride) {
    for (int32_t x = kStride / 2; x < kTileCells; x += kStride) {
      const auto at = static_cast<size_t>(z * kTileCells + x);
      if (tile.floor[at] == kNoFloor || tile.clearance[of_class][at] == 0) continue;
      Place place;
      place.level1 = number + 1;
      place.position =
          summary.origin + Vec3d{(tile.tile_x * kTileCells + x + 0.5) * cell, tile.floor[at] * 1e-3,
                                 (tile.tile_z * kTileCells + z + 0.5) * cell};
      if (graph.component_at(config.avatar_class, place) != component) continue;
      const uint8_t weight = has_map(config) ? weight_at(place.position) : uint8_t{1};
      if (weight == 0) continue;
      const Box3d around = body(place.position);
      const Vec3d stride = Vec3d{1, 0, 1} * (kStride * cell);  // The cells it represents.
      out.box.add(around.min - stride);
      out.box.add(around.max + stride);
      out.area += kStride * kStride * cell * cell;
      out.mass += kStride * kStride * cell * cell * weight;
      out.heaviest = std::max(out.heaviest, weight);
    }
  }
}

// So that the mean over all ground is the required density.
void AvatarGenerators::State::normalise() {
  double mass = 0;
  for (const GroundCell& c : cells) {
    area += c.area;
    mass += c.mass;
  }
  for (GroundCell& c : cells)
    c.mass = has_map(config) ? c.mass * area / std::max(mass, 1e-9) : c.area;
}

// The classes of the crowd that follow the map.
Result<void> AvatarGenerators::State::meet(Crowd& crowd, Context& context) {
  if (std::exchange(knows_crowd, true) || !has_map(config)) return {};
  for (OfMix& of : mix) {
    const auto made = crowd.add_density_class(of.avatar_class, config.map, context);
    if (!made) return made.error();
    of.of_crowd = *made;
  }
  return {};
}

void AvatarGenerators::set_region_sight(SightFrom can_see_from) {
  state_->can_see_from = std::move(can_see_from);
}

std::span<const AvatarId> AvatarGenerators::members() const { return state_->members; }

double AvatarGenerators::area() const { return state_->area; }

Result<GeneratorReport> AvatarGenerators::populate(Crowd& crowd, Vec3d eye, const Sight& can_see,
                                                   Context& context) {
  State& s = *state_;
  if (auto ok = s.meet(crowd, context); !ok) return ok.error();
  crowd.remove(s.members);
  const auto removed = static_cast<uint32_t>(s.members.size());
  s.members.clear();
  s.fullness = 1;
  s.counts.assign(s.cells.size(), 0);
  s.classify(eye, can_see);
  uint32_t added = 0;
  for (const uint32_t i : s.active) {
    const Result<uint32_t> here = s.fill(crowd, i, nullptr, context);
    if (!here) return here.error();
    added += *here;
  }
  GeneratorReport report = s.report();
  report.added = added, report.removed = removed;
  return report;
}

Result<GeneratorReport> AvatarGenerators::update(Crowd& crowd, Vec3d eye, const Sight& can_see,
                                                 Context& context) {
  State& s = *state_;
  if (s.steps_since_classified < 0) return populate(crowd, eye, can_see, context);
  ++s.steps_since_classified;
  if (s.steps_since_classified >= s.config.steps_per_query ||
      length(eye - s.classified_from) > s.config.region) {
    s.classify(eye, can_see);
  }
  const uint32_t removed = s.remove_surplus(crowd, can_see);
  // Paths cross in the middle, so its density exceeds that of the goals. The correction is slow, as
  // avatars need time to get there.
  s.fullness = std::clamp(s.fullness + kAdjust * s.missing(), kMinFull, kMaxFull);
  uint32_t added = 0;
  for (const uint32_t i : s.active) {
    if (s.states[i] != CellState::kBand) continue;
    const Result<uint32_t> here = s.fill(crowd, i, &can_see, context);
    if (!here) return here.error();
    added += *here;
  }
  // Members at their goal get another. The lists contain other avatars of the crowd too.
  std::vector<AvatarId> idle;
  const auto is_member = [&](AvatarId id) {
    return std::find(s.members.begin(), s.members.end(), id) != s.members.end();
  };
  for (const auto ids : {crowd.arrived(), crowd.goal_unreachable()}) {
    std::copy_if(ids.begin(), ids.end(), std::back_inserter(idle), is_member);
  }
  s.give_goals(crowd, idle);
  GeneratorReport report = s.report();
  report.added = added, report.removed = removed;
  return report;
}

}  // namespace throng
