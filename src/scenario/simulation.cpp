// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <bit>
#include <string>
#include <utility>

#include "core/hash.h"
#include "core/random.h"
#include "scenario/attractors.h"
#include "scenario/simulation_state.h"
#include "throng/scenario.h"
#include "throng/surface.h"

// A scenario as it runs: resolves its names to classes, targets and places, then steps the parts of
// the state in a fixed order. Time of a step: that of the crowd, and linear in the avatars.
namespace throng {
namespace {

constexpr size_t kMaxPlaces = 16384;    // of an area, to enter at or to stand on
constexpr double kReviewInterval = 1;   // [s]
constexpr double kGroupInterval = 0.5;  // [s]

}  // namespace

Simulation::Simulation(std::unique_ptr<State> state) : state_(std::move(state)) {}
Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(Simulation&&) noexcept = default;
Simulation::~Simulation() = default;

double Simulation::State::unit(ScenarioAvatar& p) const {
  return random_unit(scenario.seed ^ 0x706572736f6eULL, p.number, p.draws++);
}

// The nodes that profiles of climbing or dropping classes walk over: opened beside the world, or
// made from its scene. Empty if no profile needs them or the folder has none: then all walk.
Result<Nodes> Simulation::State::nodes_for(const World& world, const Scenario& scenario,
                                           int32_t workers, Context& context) {
  const std::vector<AvatarClass> classes = world.summary().classes;
  const auto needs_nodes = [](const AvatarClass& c) { return !c.flies && goes_over_nodes(c); };
  const auto is_needed = [&](const Profile& profile) {
    const int32_t named = world.find_class(profile.avatar_class).value_or(0);
    return needs_nodes(classes[static_cast<size_t>(named)]);
  };
  // An avatar without a profile is of the first class.
  const auto& profiles = scenario.profiles;
  if (!needs_nodes(classes[0]) && std::none_of(profiles.begin(), profiles.end(), is_needed)) {
    return Nodes();
  }
  if (!scenario.world.empty()) return Nodes::exist(world) ? Nodes::open(world) : Nodes();
  const Result<Scene> scene = load_scene(scenario, context);
  if (!scene) return scene.error();
  return Nodes::create(world, *scene, {.workers = workers}, context);
}

Result<Simulation> Simulation::create(const World& world, const Scenario& scenario, int32_t workers,
                                      Context& context) {
  return State::create(world, scenario, workers, Crowd::create, context);
}

Result<Simulation> Simulation::create_over_ranks(const World& world, const Scenario& scenario,
                                                 int32_t workers, Context& context) {
  return State::create(world, scenario, workers, crowd_over_ranks, context);
}

Result<Simulation> Simulation::State::create(const World& world, const Scenario& scenario,
                                             int32_t workers, MakeCrowd make_crowd,
                                             Context& context) {
  auto nodes = nodes_for(world, scenario, workers, context);
  if (!nodes) return nodes.error();
  const Edits edits;
  auto crowd = make_crowd(
      world, {.dt = scenario.dt,
              .seed = scenario.seed,
              .workers = workers,
              .model = scenario.steering,
              .speedup = scenario.paths,
              .search_bytes = scenario.search_bytes,
              .nodes = *std::move(nodes),
              .tuning = {.queues = !scenario.pushing, .acceleration = scenario.acceleration},
              .edits = edits,
              .slow_on_slopes = scenario.slow_on_slopes,
              .avoid_jams = scenario.avoid_jams});
  if (!crowd) return crowd.error();
  auto state = std::make_unique<State>(world, scenario, edits, std::move(*crowd));
  for (const ScenarioObstacle& obstacle : scenario.obstacles) {
    if (auto ok = check_prism(obstacle.prism); !ok) return ok.error();
    if (auto ok = scenario::check_line(obstacle); !ok) return ok.error();
  }
  for (const Attractor& attractor : scenario.attractors) {
    if (auto ok = scenario::check_attractor(attractor, scenario); !ok) return ok.error();
  }
  if (auto ok = state->prepare(context); !ok) return ok.error();
  return Simulation(std::move(state));
}

// One target for the union of areas.
Result<TargetId> Simulation::State::target_of(std::span<const int32_t> areas, Context& context) {
  const auto single = areas.size() == 1 ? static_cast<size_t>(areas[0]) : SIZE_MAX;
  if (single != SIZE_MAX && area_target[single] != 0) return area_target[single];
  std::vector<Prism> prisms;
  for (const int32_t a : areas) {
    const ScenarioArea& area = scenario.areas[static_cast<size_t>(a)];
    prisms.insert(prisms.end(), area.prisms.begin(), area.prisms.end());
  }
  auto target = crowd.add_target(prisms, context);
  if (target && single != SIZE_MAX) area_target[single] = *target;
  return target;
}

// Lists the places of an area for a class of the crowd. Fails if there are none.
Result<void> Simulation::State::find_places(int32_t area, int32_t crowd_class, int32_t avatar_class,
                                            const std::string& owner, Context& context) {
  const auto target = target_of({&area, 1}, context);
  if (!target) return target.error();
  auto found = crowd.places(*target, crowd_class, kMaxPlaces, context);
  if (!found) return found.error();
  if (found->empty()) {
    const std::string& name = kinds[static_cast<size_t>(avatar_class)].name;
    return Error{
        Errc::kBadInput,
        owner + ": no avatar of class '" + name + "' can stand in area '" +
            scenario.areas[static_cast<size_t>(area)].name + "'; move it onto the floor" +
            (crowd_class == avatar_class ? "" : " where the density that it follows is not 0") +
            ", or make it larger"};
  }
  places[{*target, crowd_class}] = std::move(*found);
  return {};
}

Result<void> Simulation::State::prepare_stage(const Stage& stage, std::vector<TargetId>& targets,
                                              Context& context) {
  if (stage.areas.empty()) return {};
  if (!stage.quickest) {
    const auto target = target_of(stage.areas, context);
    if (!target) return target.error();
    targets.push_back(*target);
    return {};
  }
  for (const int32_t area : stage.areas) {
    const auto target = target_of({&area, 1}, context);
    if (!target) return target.error();
    targets.push_back(*target);
  }
  return {};
}

Result<void> Simulation::State::prepare(Context& context) {
  kinds = world.summary().classes;
  find_sources_outside();
  for (const Profile& profile : scenario.profiles) {
    int32_t index = 0;
    if (!profile.avatar_class.empty()) {
      const auto found = world.find_class(profile.avatar_class);
      if (!found) {
        std::string known;
        for (const AvatarClass& c : kinds) known += (known.empty() ? "" : ", ") + c.name;
        return Error{Errc::kNotFound, "profile '" + profile.name + "': the world has no class '" +
                                          profile.avatar_class + "'; it has: " + known};
      }
      index = *found;
    }
    classes.push_back(index);
  }
  classes.push_back(0);
  area_target.assign(scenario.areas.size(), 0);
  for (const ScenarioArea& area : scenario.areas) doors.emplace_back(door_flow(area));
  lines.resize(scenario.queues.size());
  for (const Link& link : scenario.links) boarding.push_back({{}, link.interval});
  pending.resize(scenario.sources.size());
  in_transit.resize(scenario.links.size());
  for (DensityMap& map : scenario.densities) {
    if (auto ok = scenario::check_hours(map); !ok) return ok;
    map.weights = scenario::weights_at(map, 0);
    densities.emplace_back(map);
    given.push_back({map.weights, 0});
  }

  for (const Journey& journey : scenario.journeys) {
    auto& stages = stage_targets.emplace_back();
    for (const Stage& stage : journey.stages) {
      if (auto ok = prepare_stage(stage, stages.emplace_back(), context); !ok) return ok;
    }
  }
  for (size_t s = 0; s < scenario.sources.size(); ++s) {
    spawn_times.emplace_back(scenario.sources[s], scenario.seed, s);
    spawn_counts.push_back(0);
    if (auto ok = prepare_source(scenario.sources[s], context); !ok) return ok;
  }
  obstacles.resize(scenario.obstacles.size());
  obstacle_times.resize(scenario.obstacles.size());
  moved.resize(scenario.obstacles.size());
  update_obstacles();
  queue_spawns();
  return spawn_due(pending, context);
}

// Lists the places of all areas in which an avatar of this source may need one.
Result<void> Simulation::State::prepare_source(const Source& source, Context& context) {
  std::vector<int32_t> bodies;
  for (const Choice& choice : source.profiles) {
    bodies.push_back(classes[static_cast<size_t>(choice.index)]);
  }
  if (bodies.empty()) bodies.push_back(0);
  std::vector<int32_t> journeys_here;  // journeys
  for (const Choice& choice : source.journeys) journeys_here.push_back(choice.index);
  if (journeys_here.empty()) journeys_here.push_back(-1);
  for (const int32_t index : journeys_here) {
    std::vector<std::pair<int32_t, std::string>> wanted;
    for (const int32_t a : source.areas) wanted.emplace_back(a, "source '" + source.name + "'");
    if (index >= 0) {
      const Journey& journey = scenario.journeys[static_cast<size_t>(index)];
      for (const Stage& stage : journey.stages) {
        const std::string owner = "journey '" + journey.name + "'";
        for (const int32_t a : stage.areas) wanted.emplace_back(a, owner);
        if (stage.link < 0) continue;
        wanted.emplace_back(scenario.links[static_cast<size_t>(stage.link)].to, owner);
      }
    }
    std::vector<std::pair<int32_t, int32_t>> kinds_here;  // of the crowd, of the world
    for (const int32_t kind : bodies) {
      const auto of_crowd = class_that_follows(map_of(source, index), kind, context);
      if (!of_crowd) return of_crowd.error();
      kinds_here.emplace_back(*of_crowd, kind);
    }
    for (const auto& [area, owner] : wanted) {
      for (const auto& [of_crowd, kind] : kinds_here) {
        if (auto ok = find_places(area, of_crowd, kind, owner, context); !ok) return ok;
      }
    }
  }
  return {};
}

// Adds obstacles whose time begins, removes those whose time is over. The crowd follows at once:
// distances to exits and the avatars inside are those with these obstacles.
void Simulation::State::update_obstacles() {
  std::vector<size_t> begun;
  const uint64_t before = edits.version();
  for (size_t n = 0; n < obstacles.size(); ++n) {
    const ScenarioObstacle& obstacle = scenario.obstacles[n];
    const bool wanted = time() >= obstacle.begin && time() < obstacle.end;
    if (wanted && obstacles[n] == 0) {
      const auto kind = obstacle.line.empty() ? ObstacleKind::kStatic : ObstacleKind::kKinematic;
      const auto added = edits.add_obstacle(obstacle.prism, kind, obstacle.policy);
      THRONG_ASSERT(added);  // The prism was checked.
      obstacles[n] = *added;
      obstacle_times[n].requested_at = time();
      begun.push_back(n);
    } else if (!wanted && obstacles[n] != 0) {
      edits.remove(obstacles[n]);
      obstacles[n] = 0;
      obstacle_times[n].removed_at = time();
      obstacle_times[n].waits_for = 0;
      moved[n] = 0;
      has_opened = solids_are_old = true;
    } else if (wanted && !obstacle.line.empty()) {
      move_obstacle(n);
    }
  }
  if (edits.version() == before) return;
  Context context;
  const auto followed = crowd.add({}, context);
  THRONG_ASSERT(followed);  // No avatar was to be added.
  for (const size_t n : begun) {
    record_obstacle_times(n);
    obstacle_times[n].inside = obstacle_times[n].waits_for;
  }
}

void Simulation::State::record_obstacle_times() {
  for (size_t n = 0; n < obstacles.size(); ++n) record_obstacle_times(n);
}

void Simulation::State::record_obstacle_times(size_t n) {
  ObstacleTimes& times = obstacle_times[n];
  const bool is_up = times.up >= 0 && times.waits_for == 0;  // and stays so until it is removed
  if (is_up || obstacles[n] == 0) return;
  const auto state = crowd.obstacle(obstacles[n]);
  if (!state) return;
  if (state->up_at != times.up) solids_are_old = true;
  times.up = state->up_at;
  times.waits_for = state->occupants;
}

Result<SimulationReport> Simulation::step() {
  State& s = *state_;
  Context context;
  const auto is_due = [&](double every) {
    const auto steps = std::max<uint64_t>(1, static_cast<uint64_t>(every / s.scenario.dt + 0.5));
    return s.steps % steps == 0;
  };
  s.is_review = is_due(kReviewInterval);
  s.has_opened = false;
  s.update_obstacles();
  if (std::exchange(s.solids_are_old, false)) s.note_solids();
  if (s.is_review) {
    s.blend_densities();
    s.shade_densities();
  }
  s.queue_spawns();
  s.run_links();
  s.entry_tries = 0;
  if (auto ok = s.spawn_due(s.pending, context); !ok) return ok.error();
  if (auto ok = s.spawn_due(s.in_transit, context); !ok) return ok.error();
  s.end_waits();
  s.move_lines();
  if (s.is_review) {
    s.review_stages();
    s.redirect_attracted();
  }
  s.retry_goals();
  if (is_due(kGroupInterval)) s.adjust_group_speeds();
  s.apply_speed_factors();

  SimulationReport report;
  report.crowd = s.crowd.step();
  ++s.steps;
  s.record_obstacle_times();
  for (const AvatarId id : s.crowd.arrived()) {
    if (s.is_here(id.slot1 - 1)) s.arrive(s.avatars[id.slot1 - 1]);
  }
  for (const AvatarId id : s.crowd.goal_unreachable()) {
    if (!s.is_here(id.slot1 - 1)) continue;
    ScenarioAvatar& p = s.avatars[id.slot1 - 1];
    if (p.doing != Doing::kGoalUnreachable) s.walk_up(p);
  }
  report.time = s.time();
  report.entered = s.entered;
  report.left = s.left;
  report.outside = s.pending.size();
  report.in_links = s.in_transit.size();
  report.entry_tries = s.entry_tries;
  for (const ScenarioAvatar& p : s.avatars) {
    if (p.id && p.doing == Doing::kGoalUnreachable) ++report.goal_unreachable;
  }
  return report;
}

bool Simulation::is_over() const {
  const State& s = *state_;
  return s.crowd.size() == 0 && s.pending.empty() && s.in_transit.empty() &&
         std::all_of(s.spawn_times.begin(), s.spawn_times.end(),
                     [](const scenario::SpawnTimes& a) { return a.is_over(); });
}

const Crowd& Simulation::crowd() const { return state_->crowd; }
std::span<const ObstacleTimes> Simulation::obstacle_times() const { return state_->obstacle_times; }
std::span<const Trip> Simulation::trips() const { return state_->trips; }

void Simulation::read(std::vector<AvatarState>& out) const {
  state_->crowd.read(out);
  for (AvatarState& avatar : out) {
    avatar.id = static_cast<uint32_t>(state_->avatars[avatar.id].number);
  }
  std::sort(out.begin(), out.end(),
            [](const AvatarState& a, const AvatarState& b) { return a.id < b.id; });
}

uint64_t Simulation::state_hash() const {
  const State& s = *state_;
  std::vector<uint64_t> words{s.crowd.state_hash(), s.steps, s.entered, s.left, s.pending.size(),
                              s.in_transit.size()};
  const auto add = [&](const ScenarioAvatar& p) {
    words.insert(words.end(), {p.number, uint64_t{p.stage} << 8 | static_cast<uint64_t>(p.doing),
                               std::bit_cast<uint64_t>(p.until), p.draws});
  };
  for (const ScenarioAvatar& p : s.avatars) {
    if (p.id) add(p);
  }
  s.pending.for_each([&](const PendingSpawn& c) { add(c.avatar); });
  s.in_transit.for_each([&](const PendingSpawn& c) { add(c.avatar); });
  for (const WaitingLine& line : s.lines) {
    words.insert(words.end(), line.members.begin(), line.members.end());
    for (const double until : line.served) words.push_back(std::bit_cast<uint64_t>(until));
  }
  return hash_bytes(words.data(), words.size() * sizeof(uint64_t));
}

Result<void> Simulation::set_density(const std::string& name, std::span<const uint8_t> weights) {
  State& s = *state_;
  for (size_t d = 0; d < s.scenario.densities.size(); ++d) {
    DensityMap& map = s.scenario.densities[d];
    if (map.name != name) continue;
    if (weights.size() != map.weights.size()) {
      return Error{Errc::kBadInput, "density '" + name + "': it has " +
                                        std::to_string(map.weights.size()) + " pixels, not " +
                                        std::to_string(weights.size())};
    }
    if (std::all_of(weights.begin(), weights.end(), [](uint8_t w) { return w == 0; })) {
      return Error{Errc::kBadInput,
                   "density '" + name + "': all weights are 0; give at least one pixel a weight"};
    }
    map.weights.assign(weights.begin(), weights.end());
    map.hours.clear();
    s.densities[d] = scenario::DensityDraw(map);
    s.shade(d);
    s.give_density(d);
    return {};
  }
  return Error{Errc::kNotFound, "there is no density '" + name + "'"};
}

}  // namespace throng
