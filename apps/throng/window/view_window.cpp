// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "window/view_window.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>
#include <utility>

#include "command.h"
#include "window/user_files.h"

// A window with GLFW: events in, pictures of the viewer out.
namespace throng::app {
namespace {

struct WindowCloser {
  void operator()(GLFWwindow* window) const { glfwDestroyWindow(window); }
};
using Window = std::unique_ptr<GLFWwindow, WindowCloser>;

// GLFW is global to the process.
struct Library {
  bool started = glfwInit() == GLFW_TRUE;
  Library() = default;
  Library(const Library&) = delete;
  Library& operator=(const Library&) = delete;
  ~Library() {
    if (started) glfwTerminate();
  }
};

Key key_for(int key) {
  if ((key >= GLFW_KEY_0 && key <= GLFW_KEY_9) || (key >= GLFW_KEY_A && key <= GLFW_KEY_Z)) {
    return static_cast<Key>(key);
  }
  switch (key) {
    case GLFW_KEY_SPACE:
    case GLFW_KEY_COMMA:
    case GLFW_KEY_PERIOD:
      return static_cast<Key>(key);
    case GLFW_KEY_ESCAPE:
      return Key::kEscape;
    case GLFW_KEY_ENTER:
    case GLFW_KEY_KP_ENTER:
      return Key::kEnter;
    case GLFW_KEY_TAB:
      return Key::kTab;
    case GLFW_KEY_BACKSPACE:
      return Key::kBackspace;
    case GLFW_KEY_DELETE:
      return Key::kDelete;
    case GLFW_KEY_LEFT:
      return Key::kLeft;
    case GLFW_KEY_RIGHT:
      return Key::kRight;
    case GLFW_KEY_UP:
      return Key::kUp;
    case GLFW_KEY_DOWN:
      return Key::kDown;
    case GLFW_KEY_PAGE_UP:
      return Key::kPageUp;
    case GLFW_KEY_PAGE_DOWN:
      return Key::kPageDown;
    case GLFW_KEY_HOME:
      return Key::kHome;
    case GLFW_KEY_END:
      return Key::kEnd;
    case GLFW_KEY_F1:
      return Key::kF1;
    case GLFW_KEY_F2:
      return Key::kF2;
    case GLFW_KEY_F11:
      return Key::kF11;
    case GLFW_KEY_F12:
      return Key::kF12;
    case GLFW_KEY_LEFT_SHIFT:
    case GLFW_KEY_RIGHT_SHIFT:
      return Key::kShift;
    case GLFW_KEY_LEFT_CONTROL:
    case GLFW_KEY_RIGHT_CONTROL:
      return Key::kControl;
    case GLFW_KEY_LEFT_ALT:
    case GLFW_KEY_RIGHT_ALT:
      return Key::kAlt;
    default:
      return Key::kNone;
  }
}

// The receiver of events, and the pointer at the last one. Events of buttons have no position, and
// glfwGetCursorPos returns the current one: in a fast drag, its end.
struct Listener {
  Viewer* viewer = nullptr;
  double x = 0, y = 0;
};

Listener& listener_of(GLFWwindow* window) {
  return *static_cast<Listener*>(glfwGetWindowUserPointer(window));
}

Viewer& viewer_of(GLFWwindow* window) { return *listener_of(window).viewer; }

// GLFW counts in units of the desktop, the viewer in pixels.
ViewEvent at_pointer(GLFWwindow* window, ViewEventKind kind, double x, double y) {
  int width = 0, height = 0, wide = 0, high = 0;
  glfwGetWindowSize(window, &width, &height);
  glfwGetFramebufferSize(window, &wide, &high);
  ViewEvent event{.kind = kind};
  event.x = width > 0 ? x * wide / width : x;
  event.y = height > 0 ? y * high / height : y;
  return event;
}

void listen(GLFWwindow* window) {
  glfwSetKeyCallback(window, [](GLFWwindow* w, int key, int, int action, int) {
    if (action == GLFW_REPEAT) return;
    ViewEvent event{.kind = action == GLFW_PRESS ? ViewEventKind::kKeyDown : ViewEventKind::kKeyUp};
    event.key = key_for(key);
    viewer_of(w).handle(event);
  });
  glfwSetCharCallback(window, [](GLFWwindow* w, unsigned int text) {
    ViewEvent event{.kind = ViewEventKind::kText};
    event.text = text;
    viewer_of(w).handle(event);
  });
  glfwSetCursorPosCallback(window, [](GLFWwindow* w, double x, double y) {
    listener_of(w).x = x;
    listener_of(w).y = y;
    viewer_of(w).handle(at_pointer(w, ViewEventKind::kMouseMove, x, y));
  });
  glfwSetMouseButtonCallback(window, [](GLFWwindow* w, int button, int action, int) {
    if (button > GLFW_MOUSE_BUTTON_MIDDLE) return;
    const Listener& at = listener_of(w);
    ViewEvent event = at_pointer(
        w, action == GLFW_PRESS ? ViewEventKind::kMouseDown : ViewEventKind::kMouseUp, at.x, at.y);
    event.button = static_cast<MouseButton>(button);
    viewer_of(w).handle(event);
  });
  glfwSetScrollCallback(window, [](GLFWwindow* w, double, double notches) {
    ViewEvent event{.kind = ViewEventKind::kWheel};
    event.y = notches;
    viewer_of(w).handle(event);
  });
  glfwSetWindowFocusCallback(window, [](GLFWwindow* w, int focused) {
    if (focused == GLFW_FALSE) viewer_of(w).handle({.kind = ViewEventKind::kLeave});
  });
  glfwSetDropCallback(window, [](GLFWwindow* w, int count, const char** paths) {
    if (count < 1) return;
    ViewEvent event{.kind = ViewEventKind::kDrop};
    event.path = paths[0];
    viewer_of(w).handle(event);
  });
}

GamepadState read_gamepad() {
  GLFWgamepadstate pad;
  if (glfwJoystickIsGamepad(GLFW_JOYSTICK_1) != GLFW_TRUE ||
      glfwGetGamepadState(GLFW_JOYSTICK_1, &pad) != GLFW_TRUE) {
    return {};
  }
  // Sticks do not rest at exactly 0.
  const auto stick = [&](int axis) {
    const double value = pad.axes[axis];
    return std::abs(value) < 0.15 ? 0.0 : value;
  };
  return {.walk_x = stick(GLFW_GAMEPAD_AXIS_LEFT_X),
          .walk_y = stick(GLFW_GAMEPAD_AXIS_LEFT_Y),
          .look_x = stick(GLFW_GAMEPAD_AXIS_RIGHT_X),
          .look_y = stick(GLFW_GAMEPAD_AXIS_RIGHT_Y),
          .hurry = pad.buttons[GLFW_GAMEPAD_BUTTON_RIGHT_BUMPER] == GLFW_PRESS};
}

Result<Window> open_window(const std::string& title, const WindowConfig& config) {
  glfwWindowHint(GLFW_CLIENT_API, GLFW_OPENGL_ES_API);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 0);
  glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_TRUE);
  glfwWindowHintString(GLFW_X11_CLASS_NAME, "throng");
  // If the desktop's own interface fails, EGL may work.
  for (const int api : {GLFW_NATIVE_CONTEXT_API, GLFW_EGL_CONTEXT_API}) {
    glfwWindowHint(GLFW_CONTEXT_CREATION_API, api);
    Window window(glfwCreateWindow(config.width, config.height, title.c_str(), nullptr, nullptr));
    if (window) return window;
  }
  const char* why = nullptr;
  glfwGetError(&why);
  return Error{Errc::kNotFound,
               fmt::format("view: no window with OpenGL ES 3.0 ({}); --picture FILE.png needs none",
                           why == nullptr ? "the driver says no more" : why)};
}

// The first name that is free: throng-001.png ...
std::string picture_name(const std::string& folder) {
  for (int n = 1;; ++n) {
    const auto name = std::filesystem::path(folder) / fmt::format("throng-{:03}.png", n);
    std::error_code none;
    if (!std::filesystem::exists(name, none)) return name.string();
  }
}

void set_fullscreen(GLFWwindow* window, bool on, std::array<int, 4>& place) {
  if ((glfwGetWindowMonitor(window) != nullptr) == on) return;
  GLFWmonitor* monitor = glfwGetPrimaryMonitor();
  if (on && monitor != nullptr) {
    glfwGetWindowPos(window, &place[0], &place[1]);
    glfwGetWindowSize(window, &place[2], &place[3]);
    const GLFWvidmode* mode = glfwGetVideoMode(monitor);
    glfwSetWindowMonitor(window, monitor, 0, 0, mode->width, mode->height, mode->refreshRate);
  } else {
    glfwSetWindowMonitor(window, nullptr, place[0], place[1], place[2], place[3], 0);
  }
}

}  // namespace

std::string panel_font() {
  for (const char* file : {"/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf",
                           "/usr/share/fonts/truetype/noto/NotoSans-Regular.ttf",
                           "/usr/share/fonts/truetype/liberation/LiberationSans-Regular.ttf",
                           "/usr/share/fonts/TTF/DejaVuSans.ttf",
                           "/usr/share/fonts/dejavu-sans-fonts/DejaVuSans.ttf"}) {
    std::error_code none;
    if (std::filesystem::exists(file, none)) return file;
  }
  return {};
}

Result<void> run_window(const std::string& name, const LoadStage& load,
                        const ViewerConfig& viewer_config, const WindowConfig& config) {
  const Library library;
  if (!library.started) {
    const char* why = nullptr;
    glfwGetError(&why);
    return Error{Errc::kNotFound,
                 fmt::format("view: no display ({}); --picture FILE.png needs none",
                             why == nullptr ? "GLFW does not start" : why)};
  }
  Result<Window> window = open_window("throng: " + name, config);
  if (!window) return window.error();
  GLFWwindow* const w = window->get();
  glfwMakeContextCurrent(w);
  glfwSwapInterval(1);
  Result<Drawing> drawing = Drawing::create_in_current_context();
  if (!drawing) return drawing.error();
  const std::string kept = config.remember ? user_file(UserFolder::kConfig, "view.json") : "";
  ViewerConfig with = viewer_config;
  with.settings = read_text(kept);
  float ratio = 1;
  glfwGetWindowContentScale(w, &ratio, nullptr);
  with.pixel_ratio = ratio;
  Result<Viewer> made = Viewer::create(*std::move(drawing), with);
  if (!made) return Error{made.error().code, kept + ": " + made.error().message};
  Viewer viewer = *std::move(made);
  Listener listener{.viewer = &viewer};
  glfwGetCursorPos(w, &listener.x, &listener.y);
  glfwSetWindowUserPointer(w, &listener);
  listen(w);
  viewer.load(name, load);

  std::array<int, 4> place{0, 0, config.width, config.height};
  std::string title;
  while (glfwWindowShouldClose(w) == GLFW_FALSE) {
    glfwPollEvents();
    if (config.cancel != nullptr && *config.cancel) break;
    if (config.seconds > 0 && glfwGetTime() > config.seconds) break;
    int width = 0, height = 0;
    glfwGetFramebufferSize(w, &width, &height);
    if (width < 16 || height < 16) {  // Minimised.
      glfwWaitEventsTimeout(0.1);
      continue;
    }
    viewer.set_gamepad(read_gamepad());
    if (auto ok = viewer.frame(glfwGetTime(), width, height); !ok) return ok;
    glfwSwapBuffers(w);
    const ViewerRequests requests = viewer.take_requests();
    if (requests.close) break;
    set_fullscreen(w, requests.fullscreen, place);
    glfwSetInputMode(w, GLFW_CURSOR,
                     requests.grab_mouse ? GLFW_CURSOR_DISABLED : GLFW_CURSOR_NORMAL);
    if (requests.save_picture) {
      const std::string file = picture_name(config.pictures);
      const Result<Image> image = viewer.picture(glfwGetTime(), width, height);
      const Result<void> done = image ? write_png(*image, file) : image.error();
      note(done ? "kept the picture as " + file : done.error().message);
    }
    if (!requests.open.empty() && config.open) {
      viewer.load(std::filesystem::path(requests.open).filename().string(),
                  config.open(requests.open));
    }
    const ViewerStatus status = viewer.status();
    const std::string now = fmt::format("throng: {}", status.name);
    if (now != title) glfwSetWindowTitle(w, now.c_str());
    title = now;
  }
  if (!kept.empty() && !write_text(kept, viewer.settings())) {
    note(kept + " cannot be written; the settings are not kept");
  }
  return {};
}

}  // namespace throng::app
