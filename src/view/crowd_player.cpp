// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "view/crowd_player.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/random.h"

// Adds avatars and gives them goals, all drawn from (seed, number), so that the same start gives
// the same steps. With only_seen, generators add and remove avatars outside the eye's sight.
namespace throng::view {
namespace {

constexpr double kGoalTolerance = 4;  // [m] Vertical tolerance of goals.
constexpr uint64_t kMaxDraws = 24;    // To find a place.
constexpr uint32_t kBatch = 65536;    // Avatars added at once.
constexpr double kNearGround = 1;     // [m] Vertical tolerance of places on the ground.
constexpr double kLookMargin = 10;    // [m] Beyond sight: bodies and tiles that begin within it.

}  // namespace

CrowdPlayer::CrowdPlayer(World world, const CrowdStart& start, Vec3d origin, Crowd&& crowd)
    : world_(std::move(world)),
      start_(start),
      origin_(origin),
      crowd_(std::move(crowd)),
      painted_(start.density),
      classes_(world_.summary().classes),
      curves_(start.curves) {
  double sum = 0;
  std::vector<double> mix = start.mix;
  mix.resize(classes_.size(), 0.0);
  for (const double share : mix) mix_up_to_.push_back(sum += std::max(0.0, share));
  if (!(sum > 0)) mix_up_to_.assign(classes_.size(), sum = 1);
  for (double& up_to : mix_up_to_) up_to /= sum;
}

Result<std::unique_ptr<CrowdPlayer>> CrowdPlayer::create(World world, Nodes nodes,
                                                         const CrowdStart& start, int32_t workers,
                                                         Vec3d origin,
                                                         std::shared_ptr<const Occluders> occluders,
                                                         Context& context) {
  CrowdConfig config{.dt = start.dt,
                     .seed = start.seed,
                     .workers = workers,
                     .model = start.model,
                     .speedup = start.speedup,
                     .nodes = std::move(nodes)};
  config.tuning.curvilinear = start.curves;
  config.tuning.flyer_axes = start.flyer_axes;
  Result<Crowd> crowd = Crowd::create(world, config);
  if (!crowd) return crowd.error();
  std::unique_ptr<CrowdPlayer> player(
      new CrowdPlayer(std::move(world), start, origin, *std::move(crowd)));
  Result<Graph> graph = Graph::create(player->world_, {.workers = workers}, context);
  if (!graph) return graph.error();
  player->graph_ = *std::move(graph);
  player->workers_ = workers;
  if (start.only_seen && start.avatars > 0 && occluders) {
    if (context.on_progress) context.on_progress({"visibility", 0, 0});
    SeenOnly& seen_only = player->seen_only_.emplace();
    seen_only.sights.assign(3, EyeSight(std::move(occluders)));
    return player;
  }
  const Result<uint32_t> added = player->scatter(start.avatars, context);
  if (!added) return added.error();
  return player;
}

AvatarSpawn CrowdPlayer::spawn_like(uint64_t number) const {
  const double at = random_unit(start_.seed, 11, number);
  const auto found = std::upper_bound(mix_up_to_.begin(), mix_up_to_.end(), at);
  const auto index = std::min<ptrdiff_t>(found - mix_up_to_.begin(),
                                         static_cast<ptrdiff_t>(mix_up_to_.size()) - 1);
  const auto avatar_class = static_cast<int32_t>(index);
  const double base = start_.speed > 0 ? start_.speed : classes_[static_cast<size_t>(index)].speed;
  // Speeds vary by a fifth to both sides, as those of walkers in a street.
  const double speed = base * (0.8 + 0.4 * random_unit(start_.seed, 12, number));
  return {.place = {}, .avatar_class = avatar_class, .radius = 0, .speed = speed};
}

// Draws a place for each avatar; draws again, a few times, for those that do not fit. In batches,
// and until almost none of a batch fits: a count can be any number.
Result<uint32_t> CrowdPlayer::scatter(uint32_t count, Context& context) {
  uint32_t added = 0;
  for (int32_t round = 0; round < 8 && added < count; ++round) {
    for (uint32_t left = count - added; left > 0;) {
      const uint32_t batch = std::min(left, kBatch);
      const Result<uint32_t> placed = scatter_batch(batch, context);
      if (!placed) return placed.error();
      added += *placed;
      left -= batch;
      if (batch == kBatch && *placed < kBatch / 64) return added;
    }
  }
  return added;
}

Result<uint32_t> CrowdPlayer::scatter_batch(uint32_t count, Context& context) {
  std::vector<AvatarSpawn> spawns;
  for (uint32_t i = 0; i < count; ++i) {
    const uint64_t number = added_++;
    AvatarSpawn spawn = spawn_like(number);
    spawn.place = place_of(spawn.avatar_class, start_.seed + 17, number);
    if (spawn.place) spawns.push_back(spawn);
  }
  const auto ids = crowd_.add(spawns, context);
  if (!ids) return ids.error();
  return add_avatars(*ids, spawns);
}

// An avatar that did not fit has no id.
uint32_t CrowdPlayer::add_avatars(const std::vector<AvatarId>& ids,
                                  const std::vector<AvatarSpawn>& spawns) {
  std::vector<AvatarId> there;
  for (size_t i = 0; i < ids.size(); ++i) {
    if (!ids[i]) continue;
    const uint32_t slot = ids[i].slot1 - 1;
    if (avatars_.size() <= slot) avatars_.resize(slot + size_t{1});
    avatars_[slot] = {
        .id = ids[i], .avatar_class = spawns[i].avatar_class, .speed = spawns[i].speed};
    there.push_back(ids[i]);
    if (curves_changed_) set_curves_of(slot, curves_);
  }
  give_goals(there);
  return static_cast<uint32_t>(there.size());
}

bool CrowdPlayer::is_on_large_ground(int32_t avatar_class, Place place) const {
  constexpr double kShare = 0.1;
  const std::span<const Component> grounds = graph_.components(avatar_class);
  const int32_t ground = place ? graph_.component_at(avatar_class, place) : -1;
  return ground >= 0 && grounds[static_cast<size_t>(ground)].area >= kShare * grounds[0].area;
}

// Not on an isolated roof: in a component of at least a tenth of the largest one's area.
Place CrowdPlayer::place_of(int32_t avatar_class, uint64_t seed, uint64_t stream) const {
  for (uint64_t n = 0; n < kMaxDraws; ++n) {
    const Place place = world_.random_place(avatar_class, seed, stream + (n << 48));
    if (is_on_large_ground(avatar_class, place)) return place;
  }
  return world_.random_place(avatar_class, seed, stream);
}

Place CrowdPlayer::goal_of(uint32_t slot, uint64_t nth, const Vec3d& from) const {
  const int32_t avatar_class = avatars_[slot].avatar_class;
  const uint64_t stream = uint64_t{slot} << 32 | nth;
  for (uint64_t n = 0; n < kMaxDraws && !painted_.empty(); ++n) {
    const auto unit = [&](uint64_t k) { return random_unit(start_.seed + 1, stream, 3 * n + k); };
    const WeightedPlaces::Point point = painted_.draw(unit(0), unit(1), unit(2));
    const Place place = world_.find_place(avatar_class, point.at, point.vertical_tolerance);
    if (place) return place;
  }
  if (start_.near <= 0) return place_of(avatar_class, start_.seed, stream);
  for (uint64_t n = 0; n < kMaxDraws; ++n) {
    const auto offset = [&](uint64_t axis) {
      return start_.near * (2 * random_unit(start_.seed, stream, 2 * n + axis) - 1);
    };
    const Place place = world_.find_place(
        avatar_class, {from.x + offset(0), from.y, from.z + offset(1)}, kGoalTolerance);
    if (place) return place;
  }
  return world_.find_place(avatar_class, from, kNearGround);
}

void CrowdPlayer::give_goals(std::span<const AvatarId> ids) {
  if (ids.empty()) return;
  crowd_.read(states_);
  std::vector<AvatarId> receivers;
  goals_.clear();
  for (const AvatarId id : ids) {
    const uint32_t slot = id.slot1 - 1;
    Played& avatar = avatars_[slot];
    if (avatar.controlled || avatar.generated) continue;
    const auto at = std::lower_bound(states_.begin(), states_.end(), slot,
                                     [](const AvatarState& s, uint32_t i) { return s.id < i; });
    if (at == states_.end() || at->id != slot) continue;
    avatar.goal = goal_of(slot, avatar.goals_given++, at->position);
    receivers.push_back(id);
    goals_.push_back(avatar.goal);
  }
  crowd_.set_goals(receivers, goals_);
}

void CrowdPlayer::set_density(const std::vector<DensityMap>& maps) {
  start_.density = maps;
  painted_ = WeightedPlaces(maps);
  if (painted_.empty()) return;
  std::vector<AvatarId> elsewhere;
  crowd_.read(states_);
  for (const AvatarState& s : states_) {
    const Played& avatar = avatars_[s.id];
    if (avatar.generated) continue;
    if (!avatar.goal || painted_.weight_at(avatar.goal.position) == 0) {
      elsewhere.push_back(avatar.id);
    }
  }
  give_goals(elsewhere);
}

std::shared_ptr<const TimelineFrame> CrowdPlayer::next() {
  if (seen_only_ && (!place_ || !seen_only_->fault.empty())) return nullptr;
  set_views();
  if (last_) {
    report_ = crowd_.step();
    time_ += start_.dt;
  }
  if (seen_only_) {
    if (const Result<void> ok = keep_populated(); !ok) seen_only_->fault = ok.error().message;
  }
  if (!last_) return again();
  give_goals(crowd_.goal_unreachable());
  give_goals(crowd_.arrived());
  return again();
}

std::shared_ptr<const TimelineFrame> CrowdPlayer::again() {
  crowd_.read(states_);
  const auto frame = std::make_shared<TimelineFrame>();
  frame->time = time_;
  frame->report = report_;
  put_states(states_, origin_, *frame);
  if (start_.model == SteeringModel::kCurvilinear) frame->curved = curved();
  if (seen_only_) {
    frame->fault = seen_only_->fault;
    for (const AvatarState& s : states_) frame->generations.push_back(avatars_[s.id].id.generation);
  }
  follow(last_ ? *last_ : TimelineFrame{}, *frame);
  last_ = frame;
  return frame;
}

void CrowdPlayer::set_count(uint32_t avatars, Context& context) {
  if (crowd_.size() < avatars) {
    // In a full world this fails; the next frame shows how many avatars there are.
    (void)scatter(avatars - crowd_.size(), context);
    return;
  }
  std::vector<AvatarId> removed;
  crowd_.read(states_);
  for (size_t i = states_.size(); i-- > 0 && crowd_.size() - removed.size() > avatars;) {
    if (!avatars_[states_[i].id].controlled) removed.push_back(avatars_[states_[i].id].id);
  }
  crowd_.remove(removed);
}

uint32_t CrowdPlayer::spawn(Vec3d where, double radius, uint32_t count, Context& context) {
  std::vector<AvatarSpawn> spawns;
  for (uint32_t i = 0; i < count; ++i) {
    const uint64_t number = added_++;
    AvatarSpawn spawn = spawn_like(number);
    const double angle = 2 * std::numbers::pi * random_unit(start_.seed, 13, number);
    const double far = radius * std::sqrt(random_unit(start_.seed, 14, number));
    const Vec3d at = where + Vec3d{far * std::cos(angle), 0, far * std::sin(angle)};
    spawn.place = world_.find_place(spawn.avatar_class, at, kNearGround);
    if (spawn.place) spawns.push_back(spawn);
  }
  const auto ids = crowd_.add(spawns, context);
  return ids ? add_avatars(*ids, spawns) : 0;
}

uint32_t CrowdPlayer::erase(Vec3d where, double radius) {
  crowd_.read(states_);
  std::vector<AvatarId> removed;
  for (const AvatarState& s : states_) {
    const double away = std::hypot(s.position.x - where.x, s.position.z - where.z);
    if (away > radius || std::abs(s.position.y - where.y) > 2) continue;
    if (!avatars_[s.id].controlled) removed.push_back(avatars_[s.id].id);
  }
  crowd_.remove(removed);
  return static_cast<uint32_t>(removed.size());
}

std::optional<AvatarDetail> CrowdPlayer::detail(uint64_t id) const {
  if (id >= avatars_.size() || !crowd_.is_alive(avatars_[id].id)) return std::nullopt;
  const Played& avatar = avatars_[id];
  AvatarDetail detail{.id = id,
                      .avatar_class = avatar.avatar_class,
                      .position = {},
                      .speed = avatar.speed,
                      .goal = {},
                      .goals_given = avatar.goals_given,
                      .controlled = avatar.controlled};
  if (avatar.goal) detail.goal = avatar.goal.position;
  return detail;
}

int32_t CrowdPlayer::commonest_class() const {
  size_t best = 0;
  const auto share = [&](size_t i) { return mix_up_to_[i] - (i > 0 ? mix_up_to_[i - 1] : 0); };
  for (size_t i = 1; i < mix_up_to_.size(); ++i) {
    if (share(i) > share(best)) best = i;
  }
  return static_cast<int32_t>(best);
}

// A place on large ground: below the eye, else near it, else anywhere.
Place CrowdPlayer::place_under(Vec3d eye, int32_t avatar_class) const {
  constexpr double kMaxDepth = 60, kDepthStep = 0.5, kHalfSide = 40;  // [m]
  for (uint64_t n = 0; n < 4 * kMaxDraws; ++n) {
    const auto offset = [&](uint64_t axis) {
      return n == 0 ? 0 : kHalfSide * (2 * random_unit(start_.seed, 21, 2 * n + axis) - 1);
    };
    for (double down = -kGoalTolerance; down < kMaxDepth; down += kDepthStep) {
      const Vec3d at{eye.x + offset(0), eye.y - down, eye.z + offset(1)};
      const Place place = world_.find_place(avatar_class, at, 0.6 * kDepthStep);
      if (place && is_on_large_ground(avatar_class, place)) return place;
    }
  }
  return place_of(avatar_class, start_.seed, 0);
}

// The eye moves on before this step is shown: an avatar that is added must be hidden from where the
// eye was, is, and may be by then.
// All classes of the mix that can walk about from a place; none if that is one alone.
std::vector<GeneratorShare> CrowdPlayer::mix_at(const Place& home) const {
  std::vector<GeneratorShare> mix;
  for (size_t i = 0; i < mix_up_to_.size(); ++i) {
    const double share = mix_up_to_[i] - (i > 0 ? mix_up_to_[i - 1] : 0);
    const auto number = static_cast<int32_t>(i);
    if (!(share > 0) || classes_[i].flies || goes_over_nodes(classes_[i])) continue;
    const Place place = world_.find_place(number, home.position, 1.0);
    if (place && graph_.component_at(number, place) >= 0) mix.push_back({number, share});
  }
  return mix.size() > 1 ? mix : std::vector<GeneratorShare>();
}

Result<void> CrowdPlayer::make_generators(const EyePlace& now) {
  GeneratorConfig config;
  config.avatar_class = commonest_class();
  config.home = place_under(now.eye, config.avatar_class);
  config.radius = start_.sight;
  config.seed = start_.seed;
  config.workers = workers_;
  config.people = start_.avatars;
  config.mix = mix_at(config.home);
  config.map = start_.map;
  DensityGrid& map = config.map;
  if (map.x0 == 0 && map.z0 == 0 && map.x1 == 0 && map.z1 == 0) {
    const Box3d bounds = world_.summary().bounds;
    map.x0 = bounds.min.x, map.z0 = bounds.min.z;
    map.x1 = bounds.max.x, map.z1 = bounds.max.z;
  }
  if (start_.region > 0) config.region = start_.region;
  Context quiet;
  Result<AvatarGenerators> made = AvatarGenerators::create(world_, config, quiet);
  if (!made) return made.error();
  SeenOnly& s = *seen_only_;
  s.generators = *std::move(made);
  if (start_.region > 0) {
    s.generators->set_region_sight(
        [this](const Vec3d& eye, const Box3d& box) { return sees_in_region(eye, box); });
  }
  return {};
}

// The generators ask box by box from each of five points, so a few depth images serve them all.
bool CrowdPlayer::sees_in_region(const Vec3d& eye, const Box3d& box) {
  constexpr size_t kPoints = 5;
  SeenOnly& s = *seen_only_;
  EyePlace place = *place_;
  place.eye = eye;
  for (const SeenOnly::RegionSight& known : s.region) {
    if (known.place == place) return known.sight.sees(box);
  }
  if (s.region.size() < kPoints) {
    s.region.push_back({place, s.sights[0]});
    s.oldest = s.region.size() - 1;
  } else {
    s.oldest = (s.oldest + 1) % kPoints;
  }
  SeenOnly::RegionSight& made = s.region[s.oldest];
  made.place = place;
  made.sight.look_from(place, start_.sight + kLookMargin);
  return made.sight.sees(box);
}

Result<void> CrowdPlayer::keep_populated() {
  constexpr double kMaxEyeMove = 10;  // [m] After a larger one the crowd is populated again.
  constexpr double kLookAhead = 3;    // [steps]
  SeenOnly& s = *seen_only_;
  Context quiet;
  const EyePlace now = *place_;
  const bool jumped =
      !s.looked || length(now.eye - s.looked->eye) > kMaxEyeMove || now.cut != s.looked->cut;
  if (jumped || !(now == *s.looked)) {
    if (!jumped) std::swap(s.sights[0], s.sights[1]);
    s.sights[0].look_from(now, start_.sight + kLookMargin);
    s.used = jumped ? 1 : 2;
    if (!jumped && now.eye != s.looked->eye) {
      EyePlace soon = now;
      soon.eye = now.eye + (now.eye - s.looked->eye) * kLookAhead;
      s.sights[s.used++].look_from(soon, start_.sight + kLookMargin);
    }
  } else {
    s.used = 1;
  }
  const Sight can_see = [&s](const Box3d& box) {
    return std::any_of(s.sights.begin(), s.sights.begin() + static_cast<ptrdiff_t>(s.used),
                       [&box](const EyeSight& sight) { return sight.sees(box); });
  };
  if (!s.generators) {
    if (auto ok = make_generators(now); !ok) return ok;
  }
  const Result<GeneratorReport> done = jumped
                                           ? s.generators->populate(crowd_, now.eye, can_see, quiet)
                                           : s.generators->update(crowd_, now.eye, can_see, quiet);
  if (!done) return done.error();
  s.looked = now;
  std::vector<AvatarId> new_ids;
  std::vector<double> speeds;
  for (const AvatarId id : s.generators->members()) {
    const uint32_t slot = id.slot1 - 1;
    if (avatars_.size() <= slot) avatars_.resize(slot + size_t{1});
    if (avatars_[slot].id == id) continue;
    AvatarSpawn like = spawn_like(added_++);
    const auto state = crowd_.read(id);
    const int32_t avatar_class = state ? state->avatar_class : commonest_class();
    like.speed *= start_.speed > 0 ? 1
                                   : classes_[static_cast<size_t>(avatar_class)].speed /
                                         classes_[static_cast<size_t>(like.avatar_class)].speed;
    avatars_[slot] = {.id = id,
                      .avatar_class = avatar_class,
                      .speed = like.speed,
                      .goal = {},
                      .goals_given = 0,
                      .controlled = false,
                      .generated = true};
    new_ids.push_back(id);
    speeds.push_back(like.speed);
  }
  crowd_.set_speeds(new_ids, speeds);
  if (!curves_changed_) return {};
  for (const AvatarId id : new_ids) set_curves_of(id.slot1 - 1, curves_);
  return {};
}

// MaxSpeed is a speed: the avatar's own is as many times as large as what it began with.
void CrowdPlayer::set_curves_of(uint32_t slot, const CurvilinearTuning& tuning) {
  const Played& avatar = avatars_[slot];
  if (avatar.controlled) return;  // Its speed is the user's.
  const double speed = avatar.speed * tuning.max_speed / start_.curves.max_speed;
  crowd_.set_curvilinear({&avatar.id, 1}, {&tuning, 1});
  crowd_.set_speeds({&avatar.id, 1}, {&speed, 1});
}

void CrowdPlayer::set_curves(std::optional<uint64_t> id, const CurvilinearTuning& tuning) {
  if (start_.model != SteeringModel::kCurvilinear) return;
  if (id) {
    if (*id < avatars_.size()) set_curves_of(static_cast<uint32_t>(*id), tuning);
    return;
  }
  curves_ = tuning;
  curves_changed_ = true;
  crowd_.read(states_);
  for (const AvatarState& s : states_) set_curves_of(s.id, tuning);
}

std::shared_ptr<const CurvedFrame> CrowdPlayer::curved() const {
  std::vector<CurvedWalker> walkers;
  for (const AvatarState& s : states_) {
    const Played& avatar = avatars_[s.id];
    const CurvilinearTuning tuning = crowd_.curvilinear(avatar.id).value_or(start_.curves);
    walkers.push_back({.position = s.position,
                       .velocity = s.velocity,
                       .radius = s.radius,
                       .speed = avatar.speed * tuning.max_speed / start_.curves.max_speed,
                       .tuning = tuning});
  }
  return curved_frame(walkers);
}

// An avatar in low detail moves by up to half a metre at once: beyond this distance, 1.5 pixels of
// a picture 720 high.
void CrowdPlayer::set_views() {
  if (!start_.coarse_far || !place_) return;
  constexpr double kDetailRadius = 300;  // [m]
  const CrowdView view{.position = place_->eye, .radius = kDetailRadius};
  crowd_.set_views({&view, 1});
}

std::optional<uint64_t> CrowdPlayer::add_external(Vec3d where, int32_t avatar_class, double speed,
                                                  Context& context) {
  // The first free place of 64 on a spiral around the point.
  for (uint64_t n = 0; n < 64; ++n) {
    const double angle = 2.4 * static_cast<double>(n),
                 far = 0.25 * std::sqrt(static_cast<double>(n));
    AvatarSpawn spawn{.place = {}, .avatar_class = avatar_class, .radius = 0, .speed = speed};
    const Vec3d at = where + Vec3d{far * std::cos(angle), 0, far * std::sin(angle)};
    spawn.place = world_.find_place(avatar_class, at, kNearGround);
    if (!spawn.place) continue;
    const auto ids = crowd_.add({&spawn, 1}, context);
    if (!ids) return std::nullopt;
    if (!ids->front()) continue;
    const uint32_t slot = ids->front().slot1 - 1;
    if (avatars_.size() <= slot) avatars_.resize(slot + size_t{1});
    avatars_[slot] = {.id = ids->front(),
                      .avatar_class = avatar_class,
                      .speed = speed,
                      .goal = {},
                      .goals_given = 0,
                      .controlled = true};
    set_velocity(slot, {});
    return slot;
  }
  return std::nullopt;
}

void CrowdPlayer::set_velocity(uint64_t id, Vec3d velocity) {
  if (id < avatars_.size()) crowd_.set_velocities({&avatars_[id].id, 1}, {&velocity, 1});
}

void CrowdPlayer::remove(uint64_t id) {
  if (id < avatars_.size()) crowd_.remove({&avatars_[id].id, 1});
}

}  // namespace throng::view
