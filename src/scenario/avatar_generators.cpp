// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
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
// sight. Time of an update: linear in the members, plus the cells of each classification.
namespace throng {
namespace {

constexpr int32_t kStride = 4;  // Every fourth cell along X and Z represents 16.
constexpr double kAdjust = 0.01, kMinFull = 0.3,
                 kMaxFull = 1.5;     // Fullness of the band: change a step, limits.
constexpr double kBodyMargin = 0.5;  // No body extends further from its axis. [m]
enum Stream : uint64_t { kWant = 1, kSpawn, kGoal };

// A level tile's part of the ground.
struct GroundCell {
  Box3d box;  // Includes bodies that stand on it.
  double area = 0;
  int32_t tile_x = 0, tile_z = 0;
};

enum class CellState : uint8_t { kIdle, kBand, kSeen };

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
  [[nodiscard]] uint32_t cell_of(Vec3d feet) const;
  [[nodiscard]] Place random_place(uint32_t in, Stream stream);
  [[nodiscard]] uint32_t wanted(uint32_t in) const;
  [[nodiscard]] double missing() const;
  [[nodiscard]] Place random_goal();
  void give_goals(Crowd& crowd, const std::vector<AvatarId>& to);
  Result<uint32_t> fill(Crowd& crowd, uint32_t in, const Sight* can_see, Context& context);
  uint32_t remove_surplus(Crowd& crowd, const Sight& can_see);
  [[nodiscard]] GeneratorReport report() const;
};

Box3d AvatarGenerators::State::body(Vec3d feet) const {
  return {{feet.x - kBodyMargin, feet.y - 0.1, feet.z - kBodyMargin},
          {feet.x + kBodyMargin, feet.y + height + 0.1, feet.z + kBodyMargin}};
}

uint32_t AvatarGenerators::State::cell_of(Vec3d feet) const {
  const Place place = world.find_place(config.avatar_class, feet, 1.0);
  return place.level1 - 1;  // No place: an index beyond all cells.
}

// Marks cells as seen, as the band beside them, or as idle.
void AvatarGenerators::State::classify(Vec3d eye, const Sight& can_see) {
  states.assign(cells.size(), CellState::kIdle);
  active.clear();
  std::vector<uint32_t> near, seen;
  for (uint32_t i = 0; i < cells.size(); ++i) {
    if (cells[i].area > 0 && flat_distance(cells[i].box, eye) <= config.radius) near.push_back(i);
  }
  for (const uint32_t i : near) {
    if (!can_see(cells[i].box)) continue;
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
Place AvatarGenerators::State::random_place(uint32_t in, Stream stream) {
  const GroundCell& c = cells[in];
  const double side = cell * kTileCells;
  const Vec3d low = world.summary().origin + Vec3d{c.tile_x * side, 0, c.tile_z * side};
  for (int32_t tries = 0; tries < 200; ++tries, ++drawn) {
    const Vec3d at{low.x + side * random_unit(config.seed, stream, 2 * drawn),
                   0.5 * (c.box.min.y + c.box.max.y - height),
                   low.z + side * random_unit(config.seed, stream, 2 * drawn + 1)};
    const Place place = world.find_place(config.avatar_class, at, c.box.max.y - c.box.min.y + 1);
    if (place.level1 != in + 1) continue;
    if (graph.component_at(config.avatar_class, place) != component) continue;
    ++drawn;
    return place;
  }
  return {};
}

// Rounded at random, so that the mean over cells is the required density.
uint32_t AvatarGenerators::State::wanted(uint32_t in) const {
  return static_cast<uint32_t>(fullness * config.density * cells[in].area +
                               random_unit(config.seed, kWant, in));
}

// The share of the avatars required in sight that is missing.
double AvatarGenerators::State::missing() const {
  double area_seen = 0, there = 0;
  for (const uint32_t i : active) {
    if (states[i] != CellState::kSeen) continue;
    area_seen += cells[i].area;
    there += counts[i];
  }
  return 1 - there / std::max(config.density * area_seen, 1.0);
}

Place AvatarGenerators::State::random_goal() {
  const double seen_weight = std::clamp(1 + 4 * missing(), 0.1, 5.0);
  const auto weight = [&](uint32_t i) {
    return cells[i].area * (states[i] == CellState::kSeen ? seen_weight : 1);
  };
  double sum = 0;
  for (const uint32_t i : active) sum += weight(i);
  double which = sum * random_unit(config.seed, kGoal, drawn++);
  for (const uint32_t i : active) {
    which -= weight(i);
    if (which < 0) return random_place(i, kGoal);
  }
  return {};
}

void AvatarGenerators::State::give_goals(Crowd& crowd, const std::vector<AvatarId>& to) {
  std::vector<Place> goals(to.size());
  for (Place& goal : goals) goal = random_goal();
  crowd.set_goals(to, goals);
}

// Adds the avatars missing on a cell; with `can_see`, only out of sight.
Result<uint32_t> AvatarGenerators::State::fill(Crowd& crowd, uint32_t in, const Sight* can_see,
                                               Context& context) {
  const uint32_t want = wanted(in);
  std::vector<AvatarSpawn> spawns;
  for (uint32_t n = counts[in]; n < want; ++n) {
    const Place place = random_place(in, kSpawn);
    if (!place || (can_see != nullptr && (*can_see)(body(place.position)))) continue;
    spawns.push_back({.place = place, .avatar_class = config.avatar_class});
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
    const uint32_t at = cell_of(state->position);
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

AvatarGenerators::AvatarGenerators(std::unique_ptr<State> state) : state_(std::move(state)) {}
AvatarGenerators::AvatarGenerators(AvatarGenerators&&) noexcept = default;
AvatarGenerators& AvatarGenerators::operator=(AvatarGenerators&&) noexcept = default;
AvatarGenerators::~AvatarGenerators() = default;

Result<AvatarGenerators> AvatarGenerators::create(const World& world, const GeneratorConfig& config,
                                                  Context& context) {
  const bool sound = config.density > 0 && config.density <= 1 && config.radius > 0 &&
                     config.band > 0 && config.steps_per_query > 0 && config.workers >= 0 &&
                     config.people >= 0 && std::isfinite(config.people);
  if (!sound) {
    return Error{Errc::kBadConfig,
                 "generators: need a density over 0 and up to 1, people not below 0, and "
                 "radius, band and steps_per_query over 0"};
  }
  const WorldSummary summary = world.summary();
  if (config.avatar_class < 0 ||
      config.avatar_class >= static_cast<int32_t>(summary.classes.size())) {
    return Error{Errc::kNotFound,
                 "generators: the world has no class " + std::to_string(config.avatar_class)};
  }
  auto state = std::make_unique<State>();
  State& s = *state;
  s.world = world;
  s.config = config;
  s.cell = summary.cell;
  const auto of_class = static_cast<size_t>(config.avatar_class);
  s.height = summary.classes[of_class].height;
  Result<Graph> graph = Graph::create(world, {.workers = config.workers}, context);
  if (!graph) return graph.error();
  s.graph = *std::move(graph);
  s.component = s.graph.component_at(config.avatar_class, config.home);
  if (s.component < 0) {
    return Error{Errc::kBadInput, "generators: no avatar of this class can stand at home"};
  }
  s.cells.resize(world.level_tile_count());
  parallel_for(s.cells.size(), config.workers, [&](size_t i) {
    const LevelTileContent tile = world.level_tile(static_cast<uint32_t>(i));
    GroundCell& out = s.cells[i];
    out.tile_x = tile.tile_x, out.tile_z = tile.tile_z;
    for (int32_t z = kStride / 2; z < kTileCells; z += kStride) {
      for (int32_t x = kStride / 2; x < kTileCells; x += kStride) {
        const auto at = static_cast<size_t>(z * kTileCells + x);
        if (tile.floor[at] == kNoFloor || tile.clearance[of_class][at] == 0) continue;
        Place place;
        place.level1 = static_cast<uint32_t>(i) + 1;
        place.position = summary.origin + Vec3d{(tile.tile_x * kTileCells + x + 0.5) * s.cell,
                                                tile.floor[at] * 1e-3,
                                                (tile.tile_z * kTileCells + z + 0.5) * s.cell};
        if (s.graph.component_at(config.avatar_class, place) != s.component) continue;
        const Box3d around = s.body(place.position);
        const Vec3d stride = Vec3d{1, 0, 1} * (kStride * s.cell);  // The cells it represents.
        out.box.add(around.min - stride);
        out.box.add(around.max + stride);
        out.area += kStride * kStride * s.cell * s.cell;
      }
    }
  });
  for (const GroundCell& cell : s.cells) s.area += cell.area;
  if (config.people > 0) {
    s.config.density = std::clamp(config.people / std::max(1.0, s.area), 1e-6, 1.0);
  }
  s.counts.assign(s.cells.size(), 0);
  return AvatarGenerators(std::move(state));
}

std::span<const AvatarId> AvatarGenerators::members() const { return state_->members; }

double AvatarGenerators::area() const { return state_->area; }

Result<GeneratorReport> AvatarGenerators::populate(Crowd& crowd, Vec3d eye, const Sight& can_see,
                                                   Context& context) {
  State& s = *state_;
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
  if (s.steps_since_classified >= s.config.steps_per_query || length(eye - s.classified_from) > 2) {
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
