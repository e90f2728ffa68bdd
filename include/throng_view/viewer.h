// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "throng/context.h"
#include "throng/figure_model.h"
#include "throng/impostor.h"
#include "throng/nodes.h"
#include "throng/recording.h"
#include "throng/result.h"
#include "throng/scenario.h"
#include "throng/scene.h"
#include "throng/world.h"
#include "throng_draw/draw.h"
#include "throng_view/view_event.h"

/// The viewer without a window: what it shows, how it answers to keys, and its panel. Whoever owns
/// a window hands on events and asks for frames. A library of its own, throng_view.
namespace throng {

/// A crowd to start in a world.
struct CrowdStart {
  uint32_t avatars = 1000;  ///< As many of them as fit.
  std::vector<double> mix;  ///< Share of each class of the world; empty: all of the first.
  double speed = 0;         ///< Wished, 0: each class's own. [m/s, >= 0]
  double near = 60;         ///< How far goals may be along X and Z, 0: anywhere. [m, >= 0]
  double dt = 0.1;          ///< Length of a step. [s, 0.01 to 0.5]
  uint64_t seed = 1;
  bool zones = false;  ///< Ways by zones: for large worlds.
  /// Only what the eye can see within `sight`, and a band around it, is populated and simulated, as
  /// densely as `avatars` would be over the ground that is walked to from under the eye. Nobody
  /// comes or goes in sight. All are of the class with the largest share.
  bool only_seen = false;
  double sight = 150;       ///< [m, > 0]
  bool coarse_far = false;  ///< Who is too far for it to be seen takes steps more rarely.
  /// Where goals lie, as likely as the weights; empty or all 0: see `near`.
  std::vector<DensityMap> density = {};
};

class StageJob;  // Internal.

/// What somebody looks like, and near the eye, if there is a model with the clips of the atlas.
struct ViewFigure {
  Atlas atlas;
  std::optional<FigureModel> model = {};
};

/// Where whoever loads puts what he has, as soon as he has it: each part is shown at once. The
/// scene first; everything else refers to it. From one thread, any.
class THRONG_API StageParts {
 public:
  /// What to draw.
  Result<void> set_scene(const Scene& scene);
  /// Where to walk: overlays, levels, and a crowd.
  void set_world(World world, std::optional<Nodes> nodes = {});
  /// Who walks: one figure a class of the world or recording, in their order; the last serves all
  /// that are left.
  void set_atlases(std::vector<std::vector<Atlas>> of_class);
  /// The same with meshes for who is near.
  void set_figures(std::vector<std::vector<ViewFigure>> of_class);
  /// Starts a crowd in the world.
  void set_crowd(const CrowdStart& start);
  /// Runs a scenario in the world, instead of a crowd.
  void set_scenario(const Scenario& scenario);
  /// Shows a recording instead of a crowd.
  void set_replay(Replay replay);

 private:
  friend class StageJob;
  explicit StageParts(StageJob& job) : job_(job) {}
  StageJob& job_;
};

/// Loads what is to be seen; runs on a thread of the viewer's.
using LoadStage = std::function<Result<void>(StageParts&, Context&)>;

struct ViewerConfig {
  std::string settings = {};  ///< As Viewer::settings() wrote them, or empty.
  std::string font = {};      ///< A TrueType file for the panel; empty: a small built-in font.
  double pixel_ratio = 1;     ///< Pixels by units of the desktop: how large the panel is. [> 0]
  int32_t workers = 0;        ///< Threads of a step, 0 for all cores. [>= 0]
  bool panel = true;          ///< False: neither panel nor hints, for pictures and films.
};

/// What the owner of the window is to do.
struct ViewerRequests {
  bool close = false;
  bool fullscreen = false;    ///< The window should fill the screen.
  bool grab_mouse = false;    ///< The pointer should be hidden and go on for ever.
  bool save_picture = false;  ///< F12 was pressed; take `Viewer::picture` and keep it.
  std::string open;           ///< A file was dropped: load it.
};

/// What is going on, for titles and tests.
struct ViewerStatus {
  std::string name;
  bool loading = false;
  std::string error;  ///< Why the last load failed, or empty.
  bool playing = false;
  double time = 0;       ///< Of what is shown. [s]
  double last_time = 0;  ///< Of a recording's last frame, or 0. [s]
  size_t avatars = 0;    ///< That there are.
  size_t drawn = 0;      ///< In the last frame.
  int64_t picked = -1;   ///< Id of the avatar that was clicked, or -1.
  int64_t driven = -1;   ///< Id of the avatar that the user walks as, or -1.
  EyeCamera camera;      ///< In the world's coordinates.
};

/// One at a time a thread: Dear ImGui has a global state.
class THRONG_API Viewer {
 public:
  /// Fails with kBadFile: settings that are none.
  [[nodiscard]] static Result<Viewer> create(Drawing drawing, const ViewerConfig& config);
  Viewer(Viewer&&) noexcept;
  Viewer& operator=(Viewer&&) noexcept;
  ~Viewer();  ///< Cancels what is going on and waits for it.

  /// Shows something else: what was shown stays until the new scene is there.
  void load(const std::string& name, LoadStage load);
  void handle(const ViewEvent& event);
  void set_gamepad(const GamepadState& state);
  /// Draws into the window whose context is current. `now` only grows [s].
  [[nodiscard]] Result<void> frame(double now, int32_t width, int32_t height);
  /// The same as a picture.
  [[nodiscard]] Result<Image> picture(double now, int32_t width, int32_t height);
  /// Looks at `target` from `eye`, in the world's coordinates.
  void look_at(Vec3d eye, Vec3d target);
  /// Switches on one of overlay_names(). Others are left out.
  void show_overlay(const std::string& name);
  [[nodiscard]] static std::vector<std::string> overlay_names();
  /// As a click on an avatar does; -1: nobody.
  void pick(int64_t id);
  /// Waits until all overlays that are on are there, for tests and pictures.
  void wait_for_overlays();
  /// Waits until nothing is being loaded, for tests and pictures.
  void wait_until_loaded();
  /// Lets time pass at the speed that is set, with every step that belongs to it, however long that
  /// takes: the same for any machine. For pictures and films. [s]
  void play_for(double seconds);
  /// Wishes since the last call.
  [[nodiscard]] ViewerRequests take_requests();
  [[nodiscard]] ViewerStatus status() const;
  [[nodiscard]] std::string settings() const;  ///< To keep for the next time: JSON.

 private:
  struct State;
  explicit Viewer(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace throng
