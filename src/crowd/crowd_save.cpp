// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <optional>
#include <string>

#include "core/access.h"
#include "core/hash.h"
#include "crowd/crowd_state.h"
#include "crowd/mode/saved_rows.h"
#include "crowd/saved_density.h"
#include "path/edits/edit_list.h"
#include "path/edits/saved_edits.h"
#include "throng/crowd.h"
#include "world/place.h"

// A crowd as bytes: a header, arrays as they are, and a checksum over all of it. Linear in the
// crowd.
namespace throng {
namespace {

using crowd::put_rows;
using crowd::take_rows;

constexpr uint64_t kMagic = 0x38315744574f5243;  // "CROWDW18"

struct Head {
  uint64_t magic = kMagic;
  uint64_t world = 0;  // hash_of
  uint64_t seed = 0;
  double dt = 0, sight = 0, reaction = 0;
  uint64_t step = 0, sub_step = 0, scattered = 0;
  uint64_t bodies = 0, slots = 0, free_slots = 0;
  uint64_t obstacles = 0, corners = 0, free_obstacles = 0;
  uint64_t target_values = 0;  // doubles
  uint64_t flights = 0;        // by slot, or none
  uint64_t searches = 0;       // for paths of flyers, that go on
  uint64_t climbs = 0;         // by slot, or none
  uint64_t link_uses = 0;      // by slot, or none
  int32_t rounds = 0, routing = 0, deadlock_avoidance = 0, flows_are_old = 0;
  int32_t model = 0, low_detail_steps = 0;
  uint64_t views = 0;
  double low_detail_reaction = 0, slope_cost = 0;
  uint64_t slopes = 0;  // hash_of_slopes
  double acceleration = 0;
  uint64_t queues = 0;                      // 1: CrowdTuning::queues
  uint64_t edit_bytes = 0, call_bytes = 0;  // of path::save_edits and save_calls
  uint64_t edits_version = 0;               // that the crowd has followed
  // What avatars are, or were: also of those that were removed.
  crowd::BodyExtent extent;
  float fastest = 0;  // [m/s]
  int32_t taking_widest = 0, taking_tallest = 0;
  // (Together as wide as avoids_jams was alone: a crowd without own curves keeps its bytes.)
  uint32_t avoids_jams = 0, own_curves = 0;
  uint64_t curves = 0;       // hash_of_curves
  uint64_t aside = 0;        // bodies that stand aside
  uint64_t slow_levels = 0;  // of the delay map
  crowd::DelayMap::SavedQuestions questions;
  uint64_t density_bytes = 0;  // of save_densities
};
static_assert(sizeof(Head) == 42 * 8 && std::is_trivially_copyable_v<Head>);

// An obstacle without its corners: those of `place`, then those of `wanted`; and without what its
// edit holds.
struct SavedObstacle {
  double low = 0, high = 0, wanted_low = 0, wanted_high = 0;
  uint32_t edit = 0;  // 0: the slot is free
  uint32_t corners = 0, wanted_corners = 0;
  uint8_t is_up = 0, wanted_up = 0, is_elsewhere = 0, has_cells = 0;
  uint32_t is_exit_only = 0, occupants = 0;
  uint64_t requested_step = 0, up_step = 0;
};
static_assert(sizeof(SavedObstacle) == 72 && std::is_trivially_copyable_v<SavedObstacle>);

std::vector<SavedObstacle> saved_obstacles(std::span<const crowd::CrowdObstacle> all,
                                           std::vector<std::array<double, 2>>& corners) {
  std::vector<SavedObstacle> saved;
  for (const crowd::CrowdObstacle& o : all) {
    saved.push_back({.low = o.place.low,
                     .high = o.place.high,
                     .wanted_low = o.wanted.low,
                     .wanted_high = o.wanted.high,
                     .edit = o.edit,
                     .corners = static_cast<uint32_t>(o.place.corners.size()),
                     .wanted_corners = static_cast<uint32_t>(o.wanted.corners.size()),
                     .is_up = o.is_up,
                     .wanted_up = o.wanted_up,
                     .is_elsewhere = o.is_elsewhere,
                     .has_cells = o.has_cells,
                     .is_exit_only = o.is_exit_only,
                     .occupants = o.occupants,
                     .requested_step = o.requested_step,
                     .up_step = o.up_step});
    for (const Prism* prism : {&o.place, &o.wanted}) {
      corners.insert(corners.end(), prism->corners.begin(), prism->corners.end());
    }
  }
  return saved;
}

// None if they are not as an ObstacleSet holds them, each for another edit. `slot1_of_edit` has a
// place for each edit.
std::optional<std::vector<crowd::CrowdObstacle>> obstacles_of(
    std::span<const SavedObstacle> saved, std::span<const std::array<double, 2>> corners,
    const path::EditList& list, std::vector<uint32_t>& slot1_of_edit) {
  std::vector<crowd::CrowdObstacle> obstacles;
  size_t at = 0;
  for (const SavedObstacle& s : saved) {
    if (corners.size() - at < size_t{s.corners} + s.wanted_corners) return {};
    crowd::CrowdObstacle& o = obstacles.emplace_back();
    const auto take = [&](size_t count) {
      const auto first = corners.begin() + static_cast<ptrdiff_t>(at);
      at += count;
      return std::vector(first, first + static_cast<ptrdiff_t>(count));
    };
    o.place.corners = take(s.corners);
    o.wanted.corners = take(s.wanted_corners);
    o.place.low = s.low;
    o.place.high = s.high;
    o.wanted.low = s.wanted_low;
    o.wanted.high = s.wanted_high;
    o.exists = s.edit != 0;
    o.is_up = s.is_up != 0;
    o.wanted_up = s.wanted_up != 0;
    o.is_elsewhere = s.is_elsewhere != 0;
    o.has_cells = s.has_cells != 0;
    o.is_exit_only = s.is_exit_only != 0;
    o.occupants = s.occupants;
    o.requested_step = s.requested_step;
    o.up_step = s.up_step;
    if ((o.is_up && !o.wanted_up) || (o.is_elsewhere && !o.is_up)) return {};
    if (!o.exists) continue;
    if (s.edit > list.edits.size() || slot1_of_edit[s.edit - 1] != 0) return {};
    const path::EditList::Edit& edit = list.edits[s.edit - 1];
    if (!edit.is_obstacle()) return {};
    slot1_of_edit[s.edit - 1] = static_cast<uint32_t>(obstacles.size());
    o.edit = s.edit;
    o.kind = edit.obstacle_kind;
    o.policy = edit.policy;
  }
  return at == corners.size() ? std::optional(std::move(obstacles)) : std::nullopt;
}

// Size in bytes of a crowd with the numbers of this header.
uint64_t size_of(const Head& head) {
  return sizeof head + head.bodies * sizeof(crowd::Body) +
         head.slots * (crowd::WalkMode::kRowBytes + 4 + sizeof(crowd::Orientation)) +
         head.slots * crowd::CrowdEngine::row_bytes(head.queues != 0) +
         (head.free_slots + head.free_obstacles) * 4 + head.obstacles * sizeof(SavedObstacle) +
         head.corners * sizeof(std::array<double, 2>) + head.target_values * 8 +
         head.flights * crowd::FlyMode::kRowBytes + head.searches * sizeof(crowd::LongSearch) +
         head.climbs * crowd::ClimbMode::kRowBytes + head.link_uses * crowd::LinkMode::kRowBytes +
         head.views * sizeof(crowd::EngineDetail::View) + head.edit_bytes + head.call_bytes +
         head.slow_levels * sizeof(crowd::DelayMap::Saved) +
         head.aside * sizeof(crowd::StandsAside) + head.density_bytes +
         head.own_curves * sizeof(crowd::OwnCurves::Saved) + 8;
}

// A world that was never written has no hash of its own.
uint64_t hash_of(const World& world) {
  const world::WorldData& data = *data_of(world);
  const Vec3d& origin = data.summary.origin;
  const double facts[] = {data.summary.cell,
                          origin.x,
                          origin.y,
                          origin.z,
                          static_cast<double>(data.width),
                          static_cast<double>(data.depth),
                          static_cast<double>(data.level_count)};
  return hash_bytes(facts, sizeof facts, world.summary().hash);
}

// How stairs and slopes slow avatars.
uint64_t hash_of_slopes(const CrowdConfig& config) {
  if (!config.slow_on_slopes) return 0;
  const std::vector<SlopeFactors>& factors = config.slope_factors;
  return hash_bytes(factors.data(), factors.size() * sizeof(SlopeFactors), /*seed=*/1);
}

// The settings of a curvilinear crowd.
uint64_t hash_of_curves(const CrowdConfig& config) {
  if (config.model != SteeringModel::kCurvilinear) return 0;
  const CurvilinearTuning& t = config.tuning.curvilinear;
  const std::array<double, 4> values = {t.mass, t.max_speed, t.max_force, t.by_state ? 1.0 : 0.0};
  return hash_bytes(values.data(), sizeof values, static_cast<uint64_t>(config.tuning.flyer_axes));
}

Head head_of(const World& world, const CrowdConfig& config) {
  Head head;
  head.world = hash_of(world);
  head.seed = config.seed;
  head.dt = config.dt;
  head.sight = config.tuning.sight;
  head.reaction = config.tuning.reaction;
  head.rounds = config.tuning.rounds;
  head.routing = static_cast<int32_t>(config.routing);
  head.deadlock_avoidance = config.tuning.deadlock_avoidance ? 1 : 0;
  head.model = static_cast<int32_t>(config.model);
  head.low_detail_steps = config.tuning.low_detail_steps;
  head.low_detail_reaction = config.tuning.low_detail_reaction;
  head.slope_cost = config.slope_cost;
  head.slopes = hash_of_slopes(config);
  head.acceleration = config.tuning.acceleration;
  head.queues = config.tuning.queues && config.model == SteeringModel::kSampled ? 1 : 0;
  head.avoids_jams = config.avoid_jams ? 1 : 0;
  head.curves = hash_of_curves(config);
  return head;
}

Error bad(const std::string& what) { return {Errc::kBadFile, "crowd: what was saved " + what}; }

// Can a step use it without reading out of bounds? What its modes have of it, they test.
// No body is so large, and sums of a few such sizes fit. [units, mm]
constexpr int32_t kMaxExtent = 1 << 28;

bool is_sound(const crowd::Body& b, const world::WorldData& data, size_t classes) {
  const bool finite =
      std::isfinite(b.velocity.x + b.velocity.z + b.preferred.x + b.preferred.z + b.detour_angle) &&
      std::isfinite(b.speed);
  if (!finite || !(b.speed > 0) || b.radius <= 0 || b.radius > kMaxExtent ||
      b.avatar_class >= classes) {
    return false;
  }
  if (b.x < 0 || b.z < 0 || !world::in_grid(data, b.point())) return false;
  constexpr int32_t kMaxHeight = 1'000'000'000;  // [mm]
  if (b.y < -kMaxHeight || b.y > kMaxHeight) return false;
  // Differences to where it heads must not overflow. Of one that is controlled they are rests.
  const int32_t least = b.has(crowd::Body::kExternal) ? -(1 << 29) : 0;
  if (b.local_target_x < least || b.local_target_z < least) return false;
  if (b.climbs) return b.has(crowd::Body::kMovedElsewhere) && b.level == 0;
  if (b.level >= data.level_count) return false;
  if (b.has(crowd::Body::kMovedElsewhere)) return true;  // it has no level
  const auto tile = data.tile_levels(b.x >> (world::kUnitBits + 6), b.z >> (world::kUnitBits + 6));
  return b.level >= tile.first && b.level < tile.last;
}

// Targets as numbers: how many prisms, of each the number of corners, low, high and the corners.
std::vector<double> values_of(const std::vector<crowd::Target>& targets) {
  std::vector<double> out;
  for (const crowd::Target& target : targets) {
    out.push_back(static_cast<double>(target.prisms.size()));
    for (const Prism& prism : target.prisms) {
      out.insert(out.end(), {static_cast<double>(prism.corners.size()), prism.low, prism.high});
      for (const auto& corner : prism.corners) out.insert(out.end(), corner.begin(), corner.end());
    }
  }
  return out;
}

// False: they are not what values_of writes.
bool add_targets(Crowd& crowd, std::span<const double> values, Context& context) {
  const auto count = [&](size_t at, double least, double most) {
    return at < values.size() && values[at] >= least && values[at] <= most;
  };
  for (size_t at = 0; at < values.size();) {
    if (!count(at, 1, 1e6)) return false;
    std::vector<Prism> prisms(std::min(static_cast<size_t>(values[at++]), values.size()));
    for (Prism& prism : prisms) {
      if (!count(at, 3, 64)) return false;
      const auto corners = static_cast<size_t>(values[at]);
      if (values.size() - at < 3 + 2 * corners) return false;
      prism.low = values[at + 1];
      prism.high = values[at + 2];
      at += 3;
      for (size_t c = 0; c < corners; ++c, at += 2) {
        prism.corners.push_back({values[at], values[at + 1]});
      }
    }
    if (!crowd.add_target(prisms, context)) return false;
  }
  return true;
}

// Reads the head of a saved crowd. Fails with the reason why it is not one of this world and these
// settings, or not whole.
Result<Head> read_head(const World& world, const CrowdConfig& config,
                       std::span<const uint8_t> saved) {
  Head head;
  if (saved.size() < sizeof head + 8) return bad("is cut short; save the crowd again");
  std::memcpy(&head, saved.data(), sizeof head);
  if (head.magic != kMagic) {
    return bad("is no crowd of this version; restore it with the program that saved it");
  }
  Head expected = head_of(world, config);
  if (head.world != expected.world) return bad("is of another world; open that one");
  if (head.seed != expected.seed || head.dt != expected.dt || head.sight != expected.sight ||
      head.reaction != expected.reaction || head.rounds != expected.rounds ||
      head.routing != expected.routing || head.deadlock_avoidance != expected.deadlock_avoidance ||
      head.model != expected.model || head.low_detail_steps != expected.low_detail_steps ||
      head.low_detail_reaction != expected.low_detail_reaction ||
      head.slope_cost != expected.slope_cost || head.slopes != expected.slopes ||
      head.acceleration != expected.acceleration || head.queues != expected.queues ||
      head.avoids_jams != expected.avoids_jams || head.curves != expected.curves) {
    return bad("has other settings; give those that it was made with");
  }
  constexpr uint64_t kMax = uint64_t{1} << 32;
  if (head.bodies >= kMax || head.slots >= kMax || head.free_slots >= kMax ||
      head.obstacles >= kMax || head.corners >= kMax || head.free_obstacles >= kMax ||
      head.target_values >= kMax || head.searches > head.flights || head.views >= kMax ||
      head.edit_bytes >= kMax || head.call_bytes >= kMax || head.slow_levels >= kMax ||
      head.aside >= kMax || head.density_bytes >= kMax ||
      (head.flights != 0 && head.flights != head.slots) ||
      (head.climbs != 0 && head.climbs != head.slots) ||
      (head.link_uses != 0 && head.link_uses != head.slots) || saved.size() != size_of(head)) {
    return bad("is cut short; save the crowd again");
  }
  uint64_t sum = 0;
  std::memcpy(&sum, saved.data() + saved.size() - 8, 8);
  if (sum != hash_bytes(saved.data(), saved.size() - 8)) {
    return bad("is corrupt; save the crowd again");
  }
  // Times, of which a step has many units, do not wrap while the crowd goes on.
  constexpr uint64_t kMaxStep = UINT64_MAX / 2 / crowd::SharedState::kTimeUnits;
  const auto may_be = [](int32_t widest, int32_t tallest) {
    return widest >= 0 && widest <= kMaxExtent && tallest >= 0 && tallest <= kMaxExtent;
  };
  if (!may_be(head.extent.widest, head.extent.tallest) || head.extent.narrowest <= 0 ||
      !may_be(head.taking_widest, head.taking_tallest) ||
      !(head.fastest >= 0 && head.fastest <= 100) || head.step > kMaxStep) {
    return bad("is not sound; save the crowd again");
  }
  return head;
}

// The arrays behind the head that are not the state's own.
struct SavedArrays {
  std::vector<crowd::Body> bodies;
  std::vector<SavedObstacle> obstacles;
  std::vector<std::array<double, 2>> corners;
  std::vector<uint32_t> free_obstacles;
  std::vector<double> targets;
  std::vector<crowd::LongSearch> searches;
  std::vector<uint8_t> edits, calls, densities;
  std::vector<crowd::DelayMap::Saved> delays;
  std::vector<crowd::OwnCurves::Saved> own_curves;
};

// Reads all arrays, in the order of Crowd::save.
template <class State>
SavedArrays read_arrays(const Head& head, const uint8_t* at, State& s) {
  SavedArrays saved;
  at = take_rows(at, head.bodies, saved.bodies);
  at = take_rows(at, head.slots, s.shared.names.generations());
  at = take_rows(at, head.slots, s.shared.orientations);
  at = s.walk.restore(at, head.slots);
  at = take_rows(at, head.free_slots, s.shared.names.free_names());
  at = take_rows(at, head.obstacles, saved.obstacles);
  at = take_rows(at, head.corners, saved.corners);
  at = take_rows(at, head.free_obstacles, saved.free_obstacles);
  at = take_rows(at, head.target_values, saved.targets);
  at = s.fly.restore(at, head.flights);
  at = take_rows(at, head.searches, saved.searches);
  at = s.climb.restore(at, head.climbs);
  at = s.link.restore(at, head.link_uses);
  at = take_rows(at, head.views, s.views);
  at = take_rows(at, head.edit_bytes, saved.edits);
  at = take_rows(at, head.call_bytes, saved.calls);
  at = take_rows(at, head.slow_levels, saved.delays);
  at = take_rows(at, head.aside, s.walk.standing_aside());
  at = take_rows(at, head.density_bytes, saved.densities);
  take_rows(at, head.own_curves, saved.own_curves);
  return saved;
}

// The edits of a saved crowd: those that are given or, if nothing was ever changed in these, new
// ones. Fails if others are given.
Result<Edits> edits_of(const Head& head, const SavedArrays& saved, const Edits& given) {
  auto list = path::restore_edits(saved.edits, saved.calls);
  if (!list || head.edits_version > list->version()) {
    return bad("is not sound; save the crowd again");
  }
  if (given.version() == 0) {
    Edits made;
    *Access::state(made) = *std::move(list);
    return made;
  }
  if (path::save_edits(*Access::state(given)) == saved.edits) return given;
  return bad(
      "has other edits; give edits that the same calls have made, or new ones, which become those "
      "that were saved");
}

// Does each slot belong to one body or to the free ones, and is what each body holds possible?
template <class State>
bool are_sound(std::span<const crowd::Body> bodies, const Head& head, const State& s) {
  std::vector<bool> taken(head.slots, false);
  const auto use_slot = [&](uint32_t slot) {
    const bool is_new = slot < head.slots && !taken[slot];
    if (is_new) taken[slot] = true;
    return is_new;
  };
  const world::WorldData& data = *data_of(s.shared.world);
  const size_t classes = s.shared.baked_classes() + s.shared.density_classes.size();
  bool sound = head.bodies + head.free_slots == head.slots;
  for (const uint32_t slot : s.shared.names.free_names()) {
    sound = sound && use_slot(slot) && s.own_curves.find(slot) == nullptr;
  }
  for (const crowd::Body& body : bodies) {
    sound = sound && is_sound(body, data, classes) && use_slot(body.slot);
    for (const crowd::Mode* mode : s.modes) sound = sound && mode->is_sound(body);
  }
  return sound;
}

// What of a saved crowd is of avatars: rows by name.
struct SavedAvatars {
  std::vector<crowd::Body> bodies;
  std::vector<crowd::Orientation> orientations;
  std::vector<uint8_t> walk;
  std::vector<crowd::OwnCurves::Saved> own_curves;
};

template <class State>
SavedAvatars saved_avatars(const State& s) {
  SavedAvatars saved;
  if (!s.shared.share) {
    const std::span<const crowd::Body> bodies = s.walk.bodies();
    saved.bodies.assign(bodies.begin(), bodies.end());
    saved.orientations = s.shared.orientations;
    s.walk.save(saved.walk);
    saved.own_curves = s.own_curves.saved();
    return saved;
  }
  const size_t names = s.shared.names.names();
  saved.orientations.resize(names);
  crowd::SavedWalkers walkers(names);
  crowd::OwnCurves own_curves;
  for (const auto& moved : s.moved_everywhere()) {
    const crowd::Body& body = moved.walker.ghost.body;
    saved.bodies.push_back(body);
    saved.orientations[body.slot] = moved.orientation;
    walkers.add(moved.walker);
    if (moved.has_curves != 0) own_curves.set(body.slot, moved.curves);
  }
  walkers.save(s.walk.engine().queues(), saved.walk);
  saved.own_curves = own_curves.saved();
  return saved;
}

}  // namespace

std::vector<uint8_t> Crowd::save() const {
  const State& s = *state_;
  const SavedAvatars avatars = saved_avatars(s);
  crowd::RankShare* const share = s.shared.share.get();
  Head head = head_of(s.shared.world, s.shared.config);
  head.step = s.shared.step;
  head.flows_are_old = s.walk.flows_are_old() ? 1 : 0;
  head.sub_step = s.shared.sub_step;
  head.scattered = s.scattered;
  head.bodies = avatars.bodies.size();
  head.slots = s.shared.names.names();
  head.free_slots = s.shared.names.free_names().size();
  std::vector<std::array<double, 2>> corners;
  const std::vector<SavedObstacle> obstacles = saved_obstacles(s.shared.obstacles.all(), corners);
  head.obstacles = obstacles.size();
  head.corners = corners.size();
  head.free_obstacles = s.shared.obstacles.free_slots().size();
  const std::vector<double> targets = values_of(s.shared.targets);
  head.target_values = targets.size();
  head.flights = s.fly.row_count();
  head.searches = s.fly.searches().size();
  head.climbs = s.climb.row_count();
  head.link_uses = s.link.row_count();
  head.views = s.views.size();
  const std::vector<uint8_t> edits = path::save_edits(s.shared.edits());
  const std::vector<uint8_t> calls = path::save_calls(s.shared.edits(), s.edits_version);
  head.edit_bytes = edits.size();
  head.call_bytes = calls.size();
  head.edits_version = s.edits_version;
  head.extent = s.extent;
  head.fastest = s.fastest;
  head.taking_widest = s.link.taking().widest;
  head.taking_tallest = s.link.taking().tallest;
  std::vector<crowd::DelayMap::Saved> delays;
  if (const crowd::DelayMap* map = s.walk.delays(); map != nullptr) {
    delays = map->saved(share);
    head.questions = map->saved_questions(share);
  }
  head.slow_levels = delays.size();
  const std::vector<crowd::StandsAside> aside =
      share != nullptr ? s.walk.standing_aside_everywhere() : s.walk.standing_aside();
  head.aside = aside.size();
  const std::vector<uint8_t> densities = crowd::save_densities(s.shared.density_classes);
  head.density_bytes = densities.size();
  head.own_curves = static_cast<uint32_t>(avatars.own_curves.size());
  std::vector<uint8_t> out;
  out.reserve(size_of(head));
  put_rows(out, &head, 1);
  put_rows(out, avatars.bodies.data(), head.bodies);
  put_rows(out, s.shared.names.generations().data(), head.slots);
  put_rows(out, avatars.orientations.data(), head.slots);
  put_rows(out, avatars.walk.data(), avatars.walk.size());
  put_rows(out, s.shared.names.free_names().data(), head.free_slots);
  put_rows(out, obstacles.data(), head.obstacles);
  put_rows(out, corners.data(), head.corners);
  put_rows(out, s.shared.obstacles.free_slots().data(), head.free_obstacles);
  put_rows(out, targets.data(), targets.size());
  s.fly.save(out);
  put_rows(out, s.fly.searches().data(), head.searches);
  s.climb.save(out);
  s.link.save(out);
  put_rows(out, s.views.data(), s.views.size());
  put_rows(out, edits.data(), edits.size());
  put_rows(out, calls.data(), calls.size());
  put_rows(out, delays.data(), delays.size());
  put_rows(out, aside.data(), head.aside);
  put_rows(out, densities.data(), densities.size());
  put_rows(out, avatars.own_curves.data(), avatars.own_curves.size());
  const uint64_t sum = hash_bytes(out.data(), out.size());
  put_rows(out, &sum, 1);
  return out;
}

Result<Crowd> Crowd::restore(const World& world, const CrowdConfig& config,
                             std::span<const uint8_t> saved, Context& context) {
  auto made = create(world, config);
  if (!made) return made;
  State& s = *made->state_;
  const Result<Head> read = read_head(world, config, saved);
  if (!read) return read.error();
  const Head& head = *read;
  SavedArrays arrays = read_arrays(head, saved.data() + sizeof head, s);
  const std::vector<crowd::Body>& bodies = arrays.bodies;
  // The caller's edits are filled at the end, so that they stay as they are if something fails.
  auto edits = edits_of(head, arrays, config.edits);
  if (!edits) return edits.error();
  s.shared.config.edits = *edits;
  s.edits_version = head.edits_version;
  s.slot1_of_edit.assign(s.shared.edits().edits.size(), 0);
  s.where.assign(head.slots, kNoBody);
  s.shared.step = head.step;
  auto densities = crowd::restore_densities(arrays.densities, s.shared.baked_classes());
  bool sound = densities && s.take_densities(*std::move(densities)) &&
               s.own_curves.restore(arrays.own_curves, head.slots) && are_sound(bodies, head, s);
  auto all = obstacles_of(arrays.obstacles, arrays.corners, s.shared.edits(), s.slot1_of_edit);
  sound =
      sound && all && s.shared.obstacles.restore(std::move(*all), std::move(arrays.free_obstacles));
  if (crowd::DelayMap* map = s.walk.delays(); map != nullptr) {
    sound = sound && map->restore(arrays.delays, head.questions);
  }
  sound = sound && add_targets(*made, arrays.targets, context);
  for (const crowd::Body& body : bodies) sound = sound && body.target <= s.shared.targets.size();
  sound = sound && s.walk.aside_is_sound();
  if (!sound) return bad("is not sound; save the crowd again");
  s.ground_changed();
  s.walk.engine().reserve(bodies.size());
  for (const crowd::Body& body : bodies) {
    if (auto ok = s.open_class(body.avatar_class, context); !ok) return ok.error();
    if (body.climbs != s.shared.climbs(body.avatar_class)) {
      return bad("has other settings; give the nodes that it was made with");
    }
  }
  for (size_t i = 0; i < s.shared.density_classes.size(); ++i) {
    const auto number = static_cast<int32_t>(s.shared.baked_classes() + i);
    if (auto ok = s.open_class(number, context); !ok) return ok.error();
  }
  s.fit(head.extent, head.fastest);
  s.link.fit_taking({.widest = head.taking_widest, .tallest = head.taking_tallest});
  for (const crowd::Body& body : bodies) {
    for (const crowd::Mode* mode : s.modes) sound = sound && mode->is_in_place(body);
    if (!sound) return bad("is not sound; save the crowd again");
    const crowd::Mode& mode = s.mode_of(body);
    const crowd::BodyExtent extent = mode.extent_of(body, mode.state_of(body).radius);
    s.fit(extent, s.walk.engine().level_speed(body));
    if (&mode == &s.link) s.link.fit_taking(extent);
    s.walk.engine().add(body);
  }
  s.where_is_old = true;
  s.find_leaving_zero();
  s.shared.some_leave =
      std::any_of(bodies.begin(), bodies.end(), [](const crowd::Body& b) { return b.leaves; });
  // (Opening a class made them from the current ground.)
  s.walk.set_flows_old(head.flows_are_old != 0);
  s.shared.sub_step = head.sub_step;
  s.scattered = head.scattered;
  s.fly.restore_searches(std::move(arrays.searches));
  if (config.edits.version() == 0) {
    *Access::state(config.edits) = s.shared.edits();
    s.shared.config.edits = config.edits;
  }
  return made;
}

}  // namespace throng
