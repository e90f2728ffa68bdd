// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

/// Events of a window as plain data: from GLFW, from a browser, from a test.
namespace throng {

/// Keys that the viewer knows. Letters and digits are their ASCII codes.
enum class Key : uint8_t {
  kNone = 0,
  kSpace = ' ',
  kComma = ',',
  kPeriod = '.',
  k0 = '0',
  kA = 'A',
  kZ = 'Z',
  kEscape = 128,
  kEnter,
  kTab,
  kBackspace,
  kDelete,
  kLeft,
  kRight,
  kUp,
  kDown,
  kPageUp,
  kPageDown,
  kHome,
  kEnd,
  kF1,
  kF2,
  kF11,
  kF12,
  kShift,
  kControl,
  kAlt,
};
/// The key of a letter or digit: key_of('W').
[[nodiscard]] constexpr Key key_of(char upper) { return static_cast<Key>(upper); }

enum class MouseButton : uint8_t { kLeft, kRight, kMiddle };

enum class ViewEventKind : uint8_t {
  kKeyDown,    ///< `key`. Not for repeats.
  kKeyUp,      ///< `key`.
  kText,       ///< `text`: a character that was typed.
  kMouseMove,  ///< `x`, `y`.
  kMouseDown,  ///< `button` at `x`, `y`.
  kMouseUp,    ///< `button` at `x`, `y`.
  kWheel,      ///< `y`: notches away from the user.
  kLeave,      ///< The window lost the keyboard: no key or button is down any more.
  kDrop,       ///< `path`: a file was dropped on the window.
};

struct ViewEvent {
  ViewEventKind kind = ViewEventKind::kLeave;
  Key key = Key::kNone;
  MouseButton button = MouseButton::kLeft;
  double x = 0, y = 0;  ///< From the picture's upper left corner. [px]
  uint32_t text = 0;    ///< Unicode.
  std::string path = {};
};

/// Sticks of a gamepad now. [-1 to 1, right and down are positive]
struct GamepadState {
  double walk_x = 0, walk_y = 0;
  double look_x = 0, look_y = 0;
  bool hurry = false;
};

}  // namespace throng
