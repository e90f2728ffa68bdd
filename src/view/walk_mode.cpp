// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <mutex>
#include <utility>

#include "view/ground_pick.h"
#include "view/viewer_state.h"

// Walk mode: keys and sticks set the preferred velocity of one avatar of the crowd, which otherwise
// moves as all others do. The eye is behind it or in its head.
namespace throng {
namespace {

constexpr double kWalkSpeed = 1.5, kHurrySpeed = 3.0;  // [m/s]
constexpr double kFollowDistance = 4;                  // [m] From the eye to the controlled avatar.
constexpr double kAsk = 0.2;  // [s] Between two queries of the picked avatar.

Vec3d head_of(const view::TimelineFrame& now, size_t i, double share_of_height,
              const std::vector<double>& class_heights) {
  const size_t c = now.classes[i];
  const double height = c < class_heights.size() ? class_heights[c] : 1.75;
  return {now.x[i], now.y[i] + share_of_height * height, now.z[i]};
}

}  // namespace

void Viewer::State::begin_walk() {
  if (!panel.has_crowd || panel.mode == view::CameraMode::kWalk) return;
  const view::SightLine line = sight_line(0.5 * picture_width, 0.5 * picture_height);
  const double cut = panel.is_cut ? panel.cut : panel.bounds.max.y + 1;
  std::optional<Vec3d> where =
      view::ground_on(world, {line.eye + origin, line.direction}, cut, 3000);
  // No ground in the middle of the picture: beside an avatar, or anywhere.
  if (!where && crowd.now().size() > 0) {
    where = head_of(crowd.now(), 0, 0, panel.class_heights) + origin;
  }
  if (!where) where = world.random_place(0, panel.crowd.seed, 0).position;
  change_crowd([answers = answers, at = *where](view::CrowdPlayer& player, Context& context) {
    const auto id = player.add_external(at, 0, kHurrySpeed, context);
    const std::lock_guard lock(answers->lock);
    if (id) answers->joined = static_cast<int64_t>(*id);
  });
  panel.playing = true;
}

void Viewer::State::leave_walk() {
  if (panel.mode == view::CameraMode::kWalk) panel.mode = view::CameraMode::kOrbit;
  requests.grab_mouse = false;
  const int64_t id = std::exchange(panel.status.controlled, -1);
  if (id < 0) return;
  rig.distance = std::max(rig.distance, 8.0);
  change_crowd(
      [id](view::CrowdPlayer& player, Context&) { player.remove(static_cast<uint64_t>(id)); });
}

void Viewer::State::follow_external(double seconds) {
  {
    const std::lock_guard lock(answers->lock);
    if (const auto id = std::exchange(answers->joined, std::nullopt)) {
      panel.status.controlled = *id;
      panel.mode = view::CameraMode::kWalk;
      walk_distance = kFollowDistance;
      ground_query.reset();
      rig.pitch = 0.25;
      last_preferred = {};
    }
  }
  requests.grab_mouse = through_eyes();
  if (panel.status.controlled < 0) return;
  const auto id = static_cast<uint64_t>(panel.status.controlled);
  rig.turn_head(gamepad.look_x * -600 * seconds, gamepad.look_y * -600 * seconds, 600);
  const auto either = [&](Key a, Key b) { return held(a) || held(b) ? 1.0 : 0.0; };
  const double right =
      either(key_of('D'), Key::kRight) - either(key_of('A'), Key::kLeft) + gamepad.walk_x;
  const double ahead =
      either(key_of('W'), Key::kUp) - either(key_of('S'), Key::kDown) - gamepad.walk_y;
  const double size = std::hypot(right, ahead);
  const double speed = held(Key::kShift) || gamepad.hurry ? kHurrySpeed : kWalkSpeed;
  const double scale = size > 0.1 ? speed * std::min(1.0, size) / size : 0;
  const Vec3d flat{-std::sin(rig.yaw), 0, -std::cos(rig.yaw)};
  const Vec3d preferred = (flat * ahead + Vec3d{-flat.z, 0, flat.x} * right) * scale;
  if (!(preferred == last_preferred)) {
    last_preferred = preferred;
    change_crowd([id, preferred](view::CrowdPlayer& player, Context&) {
      player.set_velocity(id, preferred);
    });
  }
  const view::TimelineFrame& now = crowd.now();
  const size_t i = now.find(id);
  if (i == now.size()) return;
  if (first_person) {
    rig.distance = 1;
    rig.target = head_of(now, i, 0.93, panel.class_heights) - rig.towards_eye();
    return;
  }
  rig.target = head_of(now, i, 0.85, panel.class_heights);
  const Vec3d feet = head_of(now, i, 0, panel.class_heights) + origin;
  rig.distance = std::min(walk_distance, free_behind(feet, now.classes[i]));
}

// The distance that the eye may be behind an avatar: to the first wall on the ground behind it.
double Viewer::State::free_behind(Vec3d feet, int32_t avatar_class) {
  constexpr double kMin = 0.6;
  const Place place = world.find_place(avatar_class, feet, 0.5);
  if (!ground_query) {
    auto query = GroundQuery::create(world, avatar_class);
    if (query) ground_query.emplace(*std::move(query));
  }
  if (!place || !ground_query) return walk_distance;
  const double flat = walk_distance * std::cos(rig.pitch);
  const GroundRay ray =
      ground_query->ray(place, flat * std::sin(rig.yaw), flat * std::cos(rig.yaw));
  // An edge does not block the view.
  if (ray.arrived || ray.blocked_by == Blocker::kGap) return walk_distance;
  const double clear = std::hypot(ray.place.position.x - feet.x, ray.place.position.z - feet.z);
  return std::max(kMin, clear / std::max(0.2, std::cos(rig.pitch)));
}

void Viewer::State::look_up_picked() {
  panel.picked.reset();
  panel.picked_tuning.reset();
  if (panel.status.picked < 0) return;
  const auto id = static_cast<uint64_t>(panel.status.picked);
  const view::TimelineFrame& now = crowd.now();
  const size_t i = now.find(id);
  if (i == now.size()) {
    panel.status.picked = -1;
    return;
  }
  view::AvatarDetail detail{.id = id,
                            .avatar_class = now.classes[i],
                            .position = {},
                            .speed = 0,
                            .goal = {},
                            .goals_given = 0,
                            .controlled = false};
  if (panel.has_crowd) {
    const std::lock_guard lock(answers->lock);
    if (answers->detail && answers->detail->id == id) detail = *answers->detail;
  }
  detail.position = head_of(now, i, 0, panel.class_heights) + origin;
  panel.picked = detail;
  if (now.curved) panel.picked_tuning = now.curved->avatars[i].tuning;
  panel.picked_speed = now.speed[i];
  panel.picked_walked = now.walked[i];
  if (!panel.has_crowd || (last_asked && *last_now - *last_asked < kAsk)) return;
  last_asked = last_now;
  source->post(
      [id, answers = answers](view::TimelinePlayer& player) {
        const auto found = static_cast<view::CrowdPlayer&>(player).detail(id);
        const std::lock_guard lock(answers->lock);
        answers->detail = found;
      },
      /*at_once=*/false);
}

}  // namespace throng
