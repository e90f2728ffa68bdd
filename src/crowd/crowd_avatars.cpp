// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>

#include "core/access.h"
#include "core/check_class.h"
#include "crowd/crowd_state.h"
#include "crowd/standing_map.h"
#include "throng/crowd.h"
#include "world/place.h"

// Avatars of a crowd: how they are added, found by their ids, and removed, and what they are to do.
// The mode of their class decides where they may be and what a goal is.
namespace throng {
namespace {

constexpr double kMaxSpeed = 100;      // [m/s]
constexpr double kMaxRadius = 100;     // [m]
constexpr double kMaxBodyHeight = 65;  // [m]
constexpr int32_t kMaxSubSteps = 1000;
constexpr size_t kFirstCapacity = 1024;  // avatars

Error bad_config(const std::string& what) { return {Errc::kBadConfig, "crowd: " + what}; }

// Can a body have it? A step has a limited number of parts, and a body keeps it as a float, of
// which the smallest doubles are 0.
bool is_speed(double speed, double radius, double dt) {
  return static_cast<float>(speed) > 0 && speed <= kMaxSpeed && speed * dt <= kMaxSubSteps * radius;
}

// Before it is given another.
void forget_goal(crowd::Body& body) {
  body.target = 0;
  body.detour_angle = 0;
}

}  // namespace

void Crowd::State::find_bodies() const {
  if (!where_is_old) return;
  std::fill(where.begin(), where.end(), kNoBody);
  const std::span<const crowd::Body> bodies = walk.bodies();
  for (size_t i = 0; i < bodies.size(); ++i) where[bodies[i].slot] = static_cast<uint32_t>(i);
  where_is_old = false;
}

crowd::Body* Crowd::State::body(AvatarId id) const {
  if (!shared.names.is_known(id)) return nullptr;
  const uint32_t slot = shared.names.slot_of(id.slot1 - 1);
  if (slot >= shared.names.slots()) return nullptr;  // Another rank moves it, or none does.
  find_bodies();
  const uint32_t i = where[slot];
  return i == kNoBody ? nullptr : &walk.bodies()[i];
}

crowd::Mode& Crowd::State::mode_of(const AvatarSpawn& spawn) {
  if (spawn.place.level1 == kAirLevel1) return fly;
  return *mode_of_class[static_cast<size_t>(spawn.avatar_class)];
}

Result<void> Crowd::State::open_class(int32_t number, Context& context) {
  const world::WorldData& data = *data_of(shared.world);
  const auto c = static_cast<size_t>(number);
  const bool follows_density = number >= 0 && c >= shared.baked_classes() &&
                               c - shared.baked_classes() < shared.density_classes.size();
  if (auto ok = check_class(data.summary.classes, number, "crowd"); !ok && !follows_density) {
    return Error{Errc::kNotFound, ok.error().message};
  }
  if (mode_of_class[c] != nullptr) return {};
  if (shared.share && (shared.flies(c) || shared.climbs(c))) return share_refused(c);
  const auto is_near = [&](int32_t x, int32_t z) { return shared.share->owners().is_near(x, z); };
  const crowd::CrowdGround::IsNear near(is_near);
  auto ground = crowd::CrowdGround::create(data, static_cast<int32_t>(shared.baked_class(c)),
                                           world::step_mm(shared.body_class(c)),
                                           shared.share ? &near : nullptr);
  if (!ground) return ground.error();
  shared.classes[c] = std::make_unique<crowd::SharedClass>();
  shared.classes[c]->ground = std::move(*ground);
  Result<void> ok;
  for (crowd::Mode* mode : modes) {
    if (ok) ok = mode->open_class(c, context);
  }
  if (ok) {
    shared.obstacles.open_class(c, shared.classes[c]->ground, shared.baked_class(c));
    block_zero_cells(c);
    for (uint32_t slot = 0; slot < shared.obstacles.all().size(); ++slot) sync_paths(slot, c);
    ok = walk.find_flows(c, context);
    if (!ok) shared.obstacles.close_class(c);
  }
  if (!ok) {
    for (crowd::Mode* mode : modes) mode->close_class(c);
    shared.classes[c].reset();
    return ok;
  }
  mode_of_class[c] = &link;
  if (shared.flies(c)) mode_of_class[c] = &fly;
  if (shared.climbs(c)) mode_of_class[c] = &climb;
  return {};
}

Result<crowd::NewAvatar> Crowd::State::avatar_of(const AvatarSpawn& spawn) const {
  const AvatarClass& avatar = shared.body_class(static_cast<size_t>(spawn.avatar_class));
  const double radius = spawn.radius > 0 ? spawn.radius : avatar.radius;
  const double speed = spawn.speed > 0 ? spawn.speed : avatar.speed;
  if (!(spawn.radius >= 0 && radius <= std::min(kMaxRadius, 4000 * 2048 * shared.unit / 2))) {
    return bad_config("radius must be 0 (the class's) to 100 m, and at most 4000 cells");
  }
  if (!(spawn.speed >= 0 && static_cast<float>(speed) > 0 && speed <= kMaxSpeed)) {
    return bad_config("speed must be 0 (the class's) to 100 m/s");
  }
  if (avatar.height > kMaxBodyHeight) {
    return bad_config("class " + avatar.name + " is higher than 65 m");
  }
  crowd::NewAvatar made;
  made.radius = radius;
  made.body.speed = static_cast<float>(speed);
  made.body.radius = static_cast<int32_t>(std::ceil(radius / shared.unit - 1e-9));
  made.body.height = static_cast<uint16_t>(std::ceil(avatar.height * 1000 - 1e-6));
  made.body.avatar_class = static_cast<uint8_t>(spawn.avatar_class) & (kMaxAvatarClasses - 1);
  if (!is_speed(speed, radius, shared.config.dt)) {
    return bad_config("speed times dt is over 1000 radii; take shorter steps");
  }
  return made;
}

// No body moves further than the smallest radius at a time, so none passes through another.
void Crowd::State::fit(const crowd::BodyExtent& of_body, float speed) {
  if (of_body.widest <= extent.widest && speed <= fastest &&
      of_body.narrowest >= extent.narrowest && of_body.tallest <= extent.tallest) {
    return;
  }
  extent = {std::max(extent.widest, of_body.widest), std::min(extent.narrowest, of_body.narrowest),
            std::max(extent.tallest, of_body.tallest)};
  fastest = std::max(fastest, speed);
  const double displacement = fastest * shared.config.dt / shared.unit;
  const double max_displacement =
      std::min(extent.narrowest, crowd::CrowdEngine::kLongestStep - 16);  // and what is rounded
  shared.sub_steps = std::clamp(
      static_cast<int32_t>(std::ceil(displacement / max_displacement - 1e-9)), 1, 1 << 20);
  for (crowd::Mode* mode : modes) mode->fit(extent, fastest);
}

void Crowd::State::reserve(size_t more) {
  crowd::AvatarNames& names = shared.names;
  if (shared.share) {  // What a rank needs, it knows only as avatars come.
    walk.reserve(walk.bodies().size() + more, 0);
    return;
  }
  const size_t slots = names.names() + more - std::min(more, names.names() - names.alive());
  const size_t room = crowd::grown(names.generations().capacity(), slots);
  names.reserve(room);
  shared.orientations.reserve(room);
  where.reserve(room);
  walk.reserve(walk.bodies().size() + more, room);
}

AvatarId Crowd::State::add(crowd::NewAvatar avatar) {
  find_bodies();
  crowd::Body& body = avatar.body;
  if (shared.share && !shared.share->is_own(body)) return add_elsewhere(avatar);
  body.slot = shared.names.take_slot(shared.names.add());
  shared.orientations.resize(shared.names.slots());
  where.resize(shared.names.slots(), kNoBody);
  shared.orientations[body.slot] = {};
  for (crowd::Mode* mode : modes) mode->add(avatar);
  where[body.slot] = static_cast<uint32_t>(walk.bodies().size());
  if (body.slot < inside.size()) inside[body.slot] = 0;
  if (body.slot < checked_at.size()) checked_at[body.slot] = kNeverChecked;
  fit(mode_of(body).extent_of(body, avatar.radius), body.speed);
  walk.engine().add(body);
  return shared.id_of(body.slot);
}

AvatarId Crowd::State::add_elsewhere(const crowd::NewAvatar& like) {
  fit(mode_of(like.body).extent_of(like.body, like.radius), like.body.speed);
  return shared.names.id_of_name(shared.names.add());
}

Result<std::vector<AvatarId>> Crowd::add(std::span<const AvatarSpawn> spawns, Context& context) {
  State& s = *state_;
  s.everywhere.clear();
  s.follow_edits();
  if (auto ok = s.check_links(); !ok) return ok.error();
  if (spawns.empty()) return std::vector<AvatarId>();
  std::vector<crowd::NewAvatar> avatars;
  int32_t widest = s.extent.widest;
  for (const AvatarSpawn& spawn : spawns) {
    if (auto ok = s.open_class(spawn.avatar_class, context); !ok) return ok.error();
    auto avatar = s.avatar_of(spawn);
    if (!avatar) return avatar.error();
    avatars.push_back(*avatar);
    const crowd::Body& body = avatar->body;
    widest = std::max(widest, s.mode_of(body).extent_of(body, avatar->radius).widest);
  }
  std::vector<uint8_t> is_there(spawns.size());
  for (size_t i = 0; i < spawns.size(); ++i) {
    is_there[i] = s.mode_of(spawns[i]).put(avatars[i], spawns[i]) ? 1 : 0;
  }
  const auto blocked = s.find_blocked(avatars, widest);
  crowd::StandingMap map({}, widest, spawns.size());
  s.reserve(spawns.size());
  std::vector<AvatarId> ids(spawns.size());
  for (size_t i = 0; i < spawns.size(); ++i) {
    if (is_there[i] == 0 || blocked[i] != 0) continue;
    if (map.add_if_clear(avatars[i].body)) ids[i] = s.add(avatars[i]);
  }
  return ids;
}

Result<std::vector<AvatarId>> Crowd::scatter(uint32_t count, const AvatarSpawn& like,
                                             Context& context) {
  State& s = *state_;
  s.everywhere.clear();
  s.follow_edits();
  if (auto ok = s.check_links(); !ok) return ok.error();
  if (auto ok = s.open_class(like.avatar_class, context); !ok) return ok.error();
  const auto avatar = s.avatar_of(like);
  if (!avatar) return avatar.error();
  crowd::Mode& mode = s.mode_of(like);
  const auto has_places = mode.begin_draws(like);
  if (!has_places) return has_places.error();
  const crowd::Body& body = avatar->body;
  const int32_t widest = s.mode_of(body).extent_of(body, avatar->radius).widest;
  // A count can be far beyond what fits: memory follows those that find room.
  const size_t capacity = std::min<size_t>(count, kFirstCapacity);
  const bool is_apart = s.shared.share && s.count() > 0;  // Other ranks have avatars already.
  crowd::StandingMap map(is_apart ? std::span<const crowd::Body>() : s.walk.bodies(),
                         std::max(s.extent.widest, widest), capacity);
  std::vector<crowd::NewAvatar> placed;  // of this rank
  std::vector<bool> is_own;              // by number: is it this rank's?
  placed.reserve(capacity);
  // Until nine draws of ten fail over a while.
  constexpr size_t kWhile = 4096;
  std::vector<crowd::NewAvatar> draws;
  std::vector<uint8_t> is_there, blocked;
  size_t failed = 0, drawn = 0;
  while (is_own.size() < count && *has_places) {
    // One by one; but ranks ask each other for many at once.
    const size_t many =
        is_apart ? std::min(kWhile - drawn % kWhile, 4 * (count - is_own.size()) + 16) : size_t{1};
    draws.assign(many, *avatar);
    is_there.resize(many);
    for (size_t n = 0; n < many; ++n) {
      is_there[n] = mode.draw(draws[n], like, s.scattered + n) ? 1 : 0;
    }
    if (is_apart) blocked = s.find_blocked(draws, map.widest());
    for (size_t n = 0; n < many && is_own.size() < count; ++n, ++drawn) {
      ++s.scattered;
      const bool is_free = is_there[n] != 0 && !(is_apart && blocked[n] != 0);
      if (is_free && map.add_if_clear(draws[n].body)) {
        is_own.push_back(!s.shared.share || s.shared.share->is_own(draws[n].body));
        if (is_own.back()) placed.push_back(draws[n]);
      } else {
        ++failed;
      }
    }
    if (drawn % kWhile != 0) continue;
    if (failed > kWhile * 99 / 100) break;
    failed = 0;
  }
  if (is_own.size() < count) {
    return Error{Errc::kLimit, "crowd: " + std::to_string(is_own.size()) + " avatars of class " +
                                   s.shared.body_class(body.avatar_class).name +
                                   " find room at random places, " + std::to_string(count) +
                                   " were asked for; ask for fewer or take a larger world"};
  }
  s.reserve(placed.size());
  std::vector<AvatarId> ids;
  ids.reserve(count);
  auto next = placed.begin();
  for (const bool own : is_own) ids.push_back(own ? s.add(*next++) : s.add_elsewhere(*avatar));
  return ids;
}

void Crowd::remove(std::span<const AvatarId> ids) {
  State& s = *state_;
  s.everywhere.clear();
  for (const AvatarId id : ids) {
    crowd::Body* body = s.commanded(id);
    if (body == nullptr) {
      if (s.shared.share && s.shared.names.is_alive(id)) s.shared.names.remove(id.slot1 - 1);
      continue;
    }
    crowd::Body& last = s.walk.bodies().back();
    s.where[last.slot] = s.where[body->slot];
    s.where[body->slot] = kNoBody;
    s.own_curves.forget(body->slot);
    s.shared.names.give_slot_back(body->slot);
    s.shared.names.remove(id.slot1 - 1);
    *body = last;
    s.walk.engine().shrink(s.walk.bodies().size() - 1);
  }
}

void Crowd::set_goals(std::span<const AvatarId> ids, std::span<const Place> goals) {
  THRONG_ASSERT(ids.size() == goals.size());
  State& s = *state_;
  for (size_t i = 0; i < ids.size(); ++i) {
    crowd::Body* body = s.commanded(ids[i]);
    if (body == nullptr) continue;
    forget_goal(*body);
    s.mode_of(*body).set_goal(*body, goals[i]);
  }
}

void Crowd::set_goals(std::span<const AvatarId> ids, std::span<const NodePlace> goals) {
  THRONG_ASSERT(ids.size() == goals.size());
  State& s = *state_;
  for (size_t i = 0; i < ids.size(); ++i) {
    crowd::Body* body = s.commanded(ids[i]);
    if (body == nullptr || !body->climbs) continue;
    forget_goal(*body);
    s.climb.set_goal(*body, goals[i]);
  }
}

void Crowd::set_targets(std::span<const AvatarId> ids, TargetId target) {
  State& s = *state_;
  if (!s.has_target(target)) return;
  for (const AvatarId id : ids) {
    crowd::Body* body = s.commanded(id);
    if (body == nullptr) continue;
    body->detour_angle = 0;
    body->target = target;
    for (crowd::Mode* mode : s.modes) mode->set_target(*body);
    body->flags = (body->flags & crowd::Body::kMovedElsewhere) | crowd::Body::kHasGoal |
                  crowd::Body::kNeedsPath;
  }
}

void Crowd::set_velocities(std::span<const AvatarId> ids, std::span<const Vec3d> velocities) {
  THRONG_ASSERT(ids.size() == velocities.size());
  State& s = *state_;
  for (size_t i = 0; i < ids.size(); ++i) {
    crowd::Body* body = s.commanded(ids[i]);
    if (body == nullptr) continue;
    forget_goal(*body);
    s.walk.engine().end_slowing(*body);
    s.mode_of(*body).set_velocity(*body, velocities[i]);
  }
}

void Crowd::set_speeds(std::span<const AvatarId> ids, std::span<const double> speeds) {
  THRONG_ASSERT(ids.size() == speeds.size());
  State& s = *state_;
  for (size_t i = 0; i < ids.size(); ++i) {
    crowd::Body* body = s.commanded(ids[i]);
    if (body == nullptr) continue;
    const double radius = s.mode_of(*body).state_of(*body).radius;
    if (!is_speed(speeds[i], radius, s.shared.config.dt)) continue;
    const auto speed = static_cast<float>(speeds[i]);
    s.walk.engine().set_level_speed(*body, speed);
    s.fit({}, speed);  // Its size is known.
  }
  if (s.shared.share) s.fit({}, s.shared.share->largest(s.fastest));
}

void Crowd::set_curvilinear(std::span<const AvatarId> ids,
                            std::span<const CurvilinearTuning> tunings) {
  THRONG_ASSERT(ids.size() == tunings.size());
  State& s = *state_;
  for (size_t i = 0; i < ids.size(); ++i) {
    const crowd::Body* body = s.commanded(ids[i]);
    if (body != nullptr && crowd::is_tuning(tunings[i])) s.own_curves.set(body->slot, tunings[i]);
  }
}

std::optional<CurvilinearTuning> Crowd::curvilinear(AvatarId id) const {
  const State& s = *state_;
  const crowd::Body* body = s.body(id);
  std::optional<CurvilinearTuning> found;
  if (body != nullptr) {
    const CurvilinearTuning* own = s.own_curves.find(body->slot);
    found = own != nullptr ? *own : s.shared.config.tuning.curvilinear;
  }
  return s.shared.share ? s.shared.share->find_on_any(found) : found;
}

}  // namespace throng
