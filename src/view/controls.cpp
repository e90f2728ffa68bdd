// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <limits>

#include "view/ground_pick.h"
#include "view/viewer_state.h"

// Keys and mouse: left drag turns, right and middle drag move sideways, the wheel goes nearer,
// W A S D moves, as in other 3D programs.
namespace throng {
namespace {

constexpr double kClick = 5;            // [px] A pointer that moves less makes a click.
constexpr double kFarthestPick = 3000;  // [m] From the eye to the picked avatar.
constexpr double kSpeedStep = 1.4142135623730951;

}  // namespace

view::SightLine Viewer::State::sight_line(double x, double y) const {
  const EyeCamera camera = rig.camera(aspect);
  return {camera.eye, view::pixel_ray(camera, x, y, picture_width, picture_height)};
}

void Viewer::handle(const ViewEvent& event) {
  State& s = *state_;
  const bool is_for_panel = s.ui->handle(event);
  const auto key = static_cast<size_t>(event.key);
  const auto button = static_cast<size_t>(event.button);
  switch (event.kind) {
    case ViewEventKind::kKeyDown:
      if (is_for_panel) return;
      s.keys[key] = true;
      s.press(event.key);
      return;
    case ViewEventKind::kKeyUp:
      s.keys[key] = false;
      return;
    case ViewEventKind::kMouseDown:
      s.move_pointer(event.x, event.y);
      if (is_for_panel && !s.requests.grab_mouse) return;
      s.buttons[button] = true;
      s.pressed_x = event.x;
      s.pressed_y = event.y;
      s.dragged = false;
      s.paints = event.button == MouseButton::kLeft && s.brush_paints() &&
                 s.panel.mode != view::CameraMode::kWalk && !s.held(Key::kShift);
      if (s.paints) s.paint_to(event.x, event.y);
      return;
    case ViewEventKind::kMouseUp:
      // The button may come up at a point that no move event has reported.
      s.move_pointer(event.x, event.y);
      if (!std::exchange(s.buttons[button], false)) return;
      if (event.button != MouseButton::kLeft) return;
      if (std::exchange(s.paints, false)) {
        s.send_painted();
      } else if (!s.dragged) {
        s.click();
      }
      return;
    case ViewEventKind::kMouseMove:
      s.move_pointer(event.x, event.y);
      s.show_brush(event.x, event.y);
      return;
    case ViewEventKind::kWheel:
      if (is_for_panel) return;
      if (s.panel.mode == view::CameraMode::kWalk) {
        s.walk_distance = std::clamp(s.walk_distance * std::pow(0.85, event.y), 0.6, 30.0);
        return;
      }
      s.rig.zoom(event.y, s.mouse_x, s.mouse_y, s.picture_width, s.picture_height);
      return;
    case ViewEventKind::kLeave:
      s.keys.fill(false);
      s.buttons.fill(false);
      if (std::exchange(s.paints, false)) s.send_painted();
      return;
    case ViewEventKind::kDrop:
      s.requests.open = event.path;
      return;
    case ViewEventKind::kText:
      return;
  }
}

void Viewer::State::move_pointer(double x, double y) {
  const double dx = x - mouse_x, dy = y - mouse_y;
  if (dx == 0 && dy == 0) return;
  if (paints) paint_to(x, y);
  mouse_x = x;
  mouse_y = y;
  if (std::hypot(x - pressed_x, y - pressed_y) > kClick) dragged = true;
  drag(dx, dy);
}

void Viewer::set_gamepad(const GamepadState& state) {
  const auto stick = [](double value) {
    return std::isnan(value) ? 0 : std::clamp(value, -1.0, 1.0);
  };
  state_->gamepad = {stick(state.walk_x), stick(state.walk_y), stick(state.look_x),
                     stick(state.look_y), state.hurry};
}

void Viewer::State::press(Key key) {
  const auto letter = [key](char upper) { return key == key_of(upper); };
  if (letter('Q') && held(Key::kControl)) requests.close = true;
  if (key == Key::kF1) panel.help = !panel.help;
  if (key == Key::kF11) requests.fullscreen = !requests.fullscreen;
  if (key == Key::kF12) requests.save_picture = true;
  if (key == Key::kTab) panel.settings.panel = !panel.settings.panel;
  if (key == Key::kSpace) {
    panel.playing = !panel.playing;
    // At its end, a recording starts again.
    if (panel.playing && panel.replay && time >= panel.replay->last) {
      panel.seek = panel.replay->first;
    }
  }
  if (key == Key::kPeriod) step_once();
  if (key == Key::kComma || letter('M')) {
    const double by = letter('M') ? kSpeedStep : 1 / kSpeedStep;
    panel.settings.speed = std::clamp(panel.settings.speed * by, 0.05, 16.0);
  }
  if (key == Key::kHome) rig.show(bounds, aspect);
  if (key == Key::kPageUp) view::step_cut(panel, 1);
  if (key == Key::kPageDown) view::step_cut(panel, -1);
  if (key == Key::kEnd) panel.is_cut = false;
  if (letter('1') || letter('2')) {
    leave_walk();
    panel.mode = letter('1') ? view::CameraMode::kOrbit : view::CameraMode::kFly;
  }
  if (letter('3')) begin_walk();
  for (int32_t k = 0; k < 6 && panel.curves; ++k) {
    if (!letter(static_cast<char>('4' + k))) continue;
    view::follow_picked(panel);
    view::step_curve(*panel.curves, static_cast<view::CurveValue>(k / 2), k % 2 == 0 ? -1 : 1);
    send_curves();
  }
  constexpr char kOverlayKeys[] = "CLNKXHPBOGYU";  // In the order of Overlay.
  for (size_t i = 0; i < view::kOverlays; ++i) {
    if (letter(kOverlayKeys[i])) panel.overlays[i] = !panel.overlays[i];
  }
  if (letter('T') && (panel.has_crowd || panel.scenario)) {
    panel.tool = panel.tool == view::Tool::kPaint     ? view::Tool::kUnpaint
                 : panel.tool == view::Tool::kUnpaint ? view::Tool::kPick
                                                      : view::Tool::kPaint;
    if (panel.tool == view::Tool::kPaint)
      panel.overlays[static_cast<size_t>(view::Overlay::kPainted)] = true;
    show_brush(mouse_x, mouse_y);
  }
  if (letter('V')) first_person = !first_person;
  if (letter('F') && panel.status.picked >= 0) {
    const size_t i = crowd.now().find(static_cast<uint64_t>(panel.status.picked));
    if (i < crowd.now().size()) {
      rig.target = Vec3d{crowd.now().x[i], crowd.now().y[i] + 1.0, crowd.now().z[i]};
      rig.distance = std::min(rig.distance, 6.0);
    }
  }
  if (key == Key::kEscape) {
    if (panel.help) {
      panel.help = false;
    } else if (panel.mode == view::CameraMode::kWalk) {
      leave_walk();
    } else {
      panel.status.picked = panel.status.picked_node = -1;
    }
  }
}

void Viewer::State::drag(double dx, double dy) {
  const double height = std::max(1, picture_height);
  const bool left = buttons[0], right = buttons[1], middle = buttons[2];
  if (panel.mode == view::CameraMode::kWalk) {
    if (requests.grab_mouse) {
      rig.turn_head(-dx, -dy, height);
    } else if (left || right) {
      rig.orbit(dx, dy, height);
    }
    return;
  }
  if (paints || (!left && !right && !middle)) return;
  if (panel.mode == view::CameraMode::kFly && (left || right) && !held(Key::kShift)) {
    rig.turn_head(-dx, -dy, height);
  } else if (left && !held(Key::kShift)) {
    rig.orbit(dx, dy, height);
  } else {
    rig.pan(dx, dy, height);
  }
}

void Viewer::State::click() {
  if (panel.mode == view::CameraMode::kWalk) return;
  const view::SightLine line = sight_line(pressed_x, pressed_y);
  const double cut = panel.is_cut ? panel.cut - origin.y : std::numeric_limits<double>::infinity();
  const std::optional<Vec3d> ground = ground_under(pressed_x, pressed_y);
  if (panel.tool != view::Tool::kPick) {
    if (!ground || !panel.has_crowd) return;
    const double radius = panel.brush_radius;
    const auto count = static_cast<uint32_t>(panel.brush_count);
    const bool erases = panel.tool == view::Tool::kErase;
    change_crowd(
        [where = *ground, radius, count, erases](view::CrowdPlayer& player, Context& context) {
          if (erases) {
            player.erase(where, radius);
          } else {
            player.spawn(where, radius, count, context);
          }
        });
    return;
  }
  // Avatars behind the ground at the pointer are hidden.
  const double farthest = ground ? length(*ground - origin - line.eye) + 1 : kFarthestPick;
  const size_t i = view::avatar_on(crowd.now(), panel.class_heights, line, cut, farthest);
  panel.status.picked =
      i < crowd.now().size() ? static_cast<int64_t>(crowd.now().ids[i]) : int64_t{-1};
  // An avatar stands before the node that it stands on.
  panel.status.picked_node = -1;
  if (panel.status.picked >= 0 || !drawn_nodes || !nodes) return;
  const view::SightLine in_world{line.eye + origin, line.direction};
  const auto node = drawn_nodes->first_on(*nodes, in_world, cut + origin.y, kFarthestPick);
  if (node) panel.status.picked_node = *node;
}

void Viewer::State::move_eye(double seconds) {
  if (panel.mode == view::CameraMode::kWalk) return;
  const auto axis = [&](Key more, Key other_more, Key less, Key other_less) {
    return (held(more) || held(other_more) ? 1.0 : 0.0) -
           (held(less) || held(other_less) ? 1.0 : 0.0);
  };
  if (held(Key::kControl)) return;
  double right = axis(key_of('D'), Key::kRight, key_of('A'), Key::kLeft) + gamepad.walk_x;
  double ahead = axis(key_of('W'), Key::kUp, key_of('S'), Key::kDown) - gamepad.walk_y;
  double up = axis(key_of('E'), Key::kNone, key_of('Q'), Key::kNone);
  rig.turn_head(gamepad.look_x * -800 * seconds, gamepad.look_y * -800 * seconds, 800);
  // Faster where the eye is far from its target.
  double speed = panel.mode == view::CameraMode::kFly ? panel.settings.fly_speed
                                                      : std::max(2.0, 0.6 * rig.distance);
  if (held(Key::kShift) || gamepad.hurry) speed *= 3;
  const double by = speed * seconds;
  if (panel.mode == view::CameraMode::kFly) {
    up -= ahead * std::sin(rig.pitch);  // Ahead is the direction of view.
    ahead *= std::cos(rig.pitch);
  }
  rig.go(right * by, up * by, ahead * by);
}

}  // namespace throng
