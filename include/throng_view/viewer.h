// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "throng/base.h"
#include "throng/crowd.h"
#include "throng/impostor.h"
#include "throng/papers.h"
#include "throng/recording.h"
#include "throng/scenario.h"
#include "throng/scene.h"
#include "throng/surface.h"
#include "throng/world.h"
#include "throng_draw/draw.h"

/// The viewer without a window: what it shows, how it reacts to keys, and its panel. The owner of
/// the window passes events on and requests frames. A library of its own, throng_view.
namespace throng {

// ----
// Events of a window as plain data: from GLFW, from a browser, from a test.

/// Keys that the viewer knows. Letters and digits are their ASCII codes, also those without a name
/// here: see key_of.
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

/// The button of a mouse.
enum class MouseButton : uint8_t { kLeft, kRight, kMiddle };

/// What happened in a window, and which fields of ViewEvent say more about it.
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

/// One event of a window. Fields that its kind does not name are ignored.
struct ViewEvent {
  ViewEventKind kind = ViewEventKind::kLeave;
  Key key = Key::kNone;  ///< kNone: one that the viewer does not know.
  MouseButton button = MouseButton::kLeft;
  double x = 0, y = 0;    ///< From the picture's upper left corner. [px]
  uint32_t text = 0;      ///< A Unicode code point.
  std::string path = {};  ///< Of the dropped file; the owner of the window loads it.
};

/// Sticks of a gamepad now. Values outside the limits are clamped, NaN counts as 0. [-1 to 1, right
/// and down are positive]
struct GamepadState {
  double walk_x = 0, walk_y = 0;  ///< Moves the eye, or the avatar that the user walks as.
  double look_x = 0, look_y = 0;  ///< Turns the view.
  bool hurry = false;             ///< As Shift: faster.
};

// ----
// The viewer.

/// A crowd to start in a world.
struct CrowdStart {
  uint32_t avatars = 1000;  ///< At most; as many are added as fit.
  std::vector<double> mix;  ///< Share of each class of the world; empty: all of the first.
  double speed = 0;         ///< Desired; 0: each class's own. [m/s, >= 0]
  double near = 60;         ///< Largest distance of goals along X and Z, 0: anywhere. [m, >= 0]
  double dt = 0.1;          ///< Length of a step. [s, 0.01 to 0.5]
  uint64_t seed = 1;
  PathSpeedup speedup = PathSpeedup::kNone;  ///< CrowdConfig::speedup.
  /// Only what the eye can see within `sight`, and a band around it, is populated and simulated.
  /// The density is that of `avatars` spread over all ground that is reachable from below the eye.
  /// No avatar appears or disappears in sight. All are of the class with the largest share.
  bool only_seen = false;
  double sight = 150;  ///< [m, > 0]
  /// With only_seen: GeneratorConfig::map. Corners that are all 0 stand for those of the world.
  DensityGrid map = {};
  /// With only_seen, if not 0: ground is populated for the whole region of the eye, so far to its
  /// sides (GeneratorConfig::region). [m, >= 0]
  double region = 0;
  bool coarse_far = false;  ///< Avatars beyond 300 m are simulated in low detail.
  /// Maps from which goals are drawn by weight; empty or all 0: see `near`.
  std::vector<DensityMap> density = {};
  SteeringModel model = SteeringModel::kSampled;  ///< CrowdConfig::model.
  /// Of kCurvilinear, as avatars begin: the panel and keys change it, see docs/viewer.md.
  CurvilinearTuning curves = {};
  FlyerAxes flyer_axes = FlyerAxes::kOurs;  ///< CrowdTuning::flyer_axes.
};

/// The experiment of [CAACD] section V to show, on its plane. A frame of it is a timeline frame.
struct ExperimentStart {
  static constexpr double kUnit = 0.05;           ///< Of a length of the experiment. [m]
  static constexpr double kFramesPerSecond = 60;  ///< Of the experiment, at speed 1. [1/s]
  static constexpr double kHeight = 1.75;         ///< Of figures. [m]
  caacd::SpaceConfig space = {};
  caacd::Model model = {};
};

namespace view {
class StageJob;  // Internal.
}

/// What an avatar looks like: an atlas and, for avatars near the eye, a model with the same clips.
struct ViewFigure {
  Atlas atlas;
  std::optional<FigureModel> model = {};
};

/// Receives the parts of a stage from the function that loads it. Each part is shown at once. Set
/// the scene first: everything else refers to it. Call from one thread, any.
class THRONG_API StageParts {
 public:
  /// What to draw.
  Result<void> set_scene(const Scene& scene);
  /// The world to walk in: for overlays, levels and a crowd.
  void set_world(World world, std::optional<Nodes> nodes = {});
  /// The atlases of each class of the world or recording, in their order; the last entry serves all
  /// further classes.
  void set_atlases(std::vector<std::vector<Atlas>> of_class);
  /// The same with meshes for avatars near the eye.
  void set_figures(std::vector<std::vector<ViewFigure>> of_class);
  /// Starts a crowd in the world.
  void set_crowd(const CrowdStart& start);
  /// Runs a scenario in the world, instead of a crowd.
  void set_scenario(const Scenario& scenario);
  /// Runs the experiment of [CAACD] section V, instead of a crowd. Needs no world. The scene is its
  /// plane: y = 0, from (0, 0) on, a metre for each 20 units.
  void set_experiment(const ExperimentStart& start);
  /// Shows a recording instead of a crowd.
  void set_replay(Replay replay);
  explicit StageParts(view::StageJob& job) : job_(job) {}  ///< For the viewer.

 private:
  view::StageJob& job_;
};

/// Loads a stage; runs on a thread of the viewer.
using LoadStage = std::function<Result<void>(StageParts&, Context&)>;

/// Settings of Viewer::create.
struct ViewerConfig {
  std::string settings = {};  ///< As Viewer::settings() wrote them, or empty.
  std::string font = {};      ///< A TrueType file for the panel; empty: a small built-in font.
  double pixel_ratio = 1;     ///< Pixels per unit of the desktop: scales the panel. [> 0]
  int32_t workers = 0;        ///< Threads of a step, 0 for all cores. [>= 0]
  bool panel = true;          ///< False: no panel and no hints, for pictures and films.
};

/// What the viewer requests from the owner of the window.
struct ViewerRequests {
  bool close = false;         ///< The user wants to leave: close the window.
  bool fullscreen = false;    ///< The window should fill the screen.
  bool grab_mouse = false;    ///< Hide the pointer and report moves without limits.
  bool save_picture = false;  ///< F12 was pressed: save `Viewer::picture`.
  std::string open;           ///< A file was dropped: load it.
};

/// The state of the viewer, for titles and tests.
struct ViewerStatus {
  std::string name;          ///< Of the stage that was loaded last.
  bool loading = false;      ///< A stage is being loaded.
  std::string error;         ///< Why the last load failed, or empty.
  bool playing = false;      ///< Time passes; false: paused.
  double time = 0;           ///< That is shown. [s]
  double last_time = 0;      ///< Of a recording's last frame, or 0. [s]
  size_t avatars = 0;        ///< In the world.
  size_t drawn = 0;          ///< In the last frame.
  int64_t picked = -1;       ///< Id of the avatar that was picked, or -1.
  int64_t picked_node = -1;  ///< The node that was picked, or -1.
  int64_t controlled = -1;   ///< Id of the avatar that the user walks as, or -1.
  EyeCamera camera;          ///< In the world's coordinates.
  /// If [CAACD] steers the avatars: how many are in each caacd::State, by its number; else empty.
  std::vector<size_t> states = {};
  std::optional<caacd::Counts> experiment = {};  ///< Of the experiment of section V.
  std::optional<CurvilinearTuning> curves = {};  ///< Of the avatar picked, or of all.
};

/// The viewer: shows a stage and its crowd, and reacts to events. Movable, not copyable; one thread
/// at a time. At most one per thread: Dear ImGui has global state.
class THRONG_API Viewer {
 public:
  /// Makes a viewer that draws with `drawing`, without a stage. Fails with kBadFile if the settings
  /// are not a JSON object.
  [[nodiscard]] static Result<Viewer> create(Drawing drawing, const ViewerConfig& config);
  Viewer(Viewer&&) noexcept;
  Viewer& operator=(Viewer&&) noexcept;
  ~Viewer();  ///< Cancels all work and waits for its end.

  /// Loads another stage. The old one is shown until the new scene has been set.
  void load(const std::string& name, LoadStage load);
  /// Reacts to an event of the window, in the order of the calls.
  void handle(const ViewEvent& event);
  /// Sets the sticks of the gamepad, from the next frame on.
  void set_gamepad(const GamepadState& state);
  /// Advances to `now` and draws into the window whose context is current. `now` never decreases.
  /// Fails as Drawing::show. [s, px]
  [[nodiscard]] Result<void> frame(double now, int32_t width, int32_t height);
  /// The same as a picture. Fails as Drawing::draw.
  [[nodiscard]] Result<Image> picture(double now, int32_t width, int32_t height);
  /// Looks at `target` from `eye`, in the world's coordinates.
  void look_at(Vec3d eye, Vec3d target);
  /// Switches on one of overlay_names(). Other names are ignored.
  void show_overlay(const std::string& name);
  /// The names of all overlays.
  [[nodiscard]] static std::vector<std::string> overlay_names();
  /// Picks an avatar, as a click does; -1: none.
  void pick(int64_t id);
  /// Waits until all overlays that are on have been made, for tests and pictures.
  void wait_for_overlays();
  /// Waits until nothing is being loaded, for tests and pictures.
  void wait_until_loaded();
  /// Advances time at the set speed and waits for every step, however long that takes: the result
  /// is the same on every machine. For pictures and films. [s]
  void play_for(double seconds);
  /// Requests since the last call.
  [[nodiscard]] ViewerRequests take_requests();
  /// The state after the last frame.
  [[nodiscard]] ViewerStatus status() const;
  [[nodiscard]] std::string settings() const;  ///< To save for the next start: JSON.

 private:
  struct State;
  explicit Viewer(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace throng
