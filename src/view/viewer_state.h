// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "throng/world.h"
#include "throng_view/viewer.h"
#include "view/camera_rig.h"
#include "view/ground_pick.h"
#include "view/overlay_view.h"
#include "view/panel.h"
#include "view/scenario_player.h"
#include "view/stage_job.h"
#include "view/timeline_frame.h"
#include "view/timeline_source.h"
#include "view/ui.h"

namespace throng {

inline constexpr size_t kBrushSlot = kMarkSlots - 1;  // Of the drawing's marks.
inline constexpr size_t kPickedNodeSlot = kMarkSlots - 2;

/// The state of a viewer. Frames are in viewer.cpp, keys and mouse in controls.cpp, the controlled
/// avatar in walk_mode.cpp, brushes in brush_mode.cpp, overlays in overlay_view.cpp.
struct Viewer::State {
  explicit State(Drawing given) : drawing(std::move(given)) {}

  struct Frame {
    DrawingConfig config;
    PanelView panel;
  };
  struct GivenCamera {
    Vec3d eye, target;
  };

  Drawing drawing;
  ViewerConfig config;
  std::unique_ptr<view::Ui> ui;
  view::PanelState panel;
  ViewerRequests requests;

  // The stage.
  Vec3d origin;
  Box3d bounds;  // Relative to the origin.
  World world;
  view::Figures figures;
  std::unique_ptr<view::StageJob> job;
  std::vector<std::unique_ptr<view::StageJob>> retired;  // Cancelled, still running.
  std::unique_ptr<view::TimelineSource> source;
  std::shared_ptr<const view::Occluders> occluders;
  std::optional<view::EyePlace> sent_eye;  // The last one sent to the crowd.
  view::BlendedCrowd crowd;
  std::optional<Nodes> nodes;
  std::unique_ptr<view::OverlayMaker> overlay_maker;
  std::array<bool, view::kOverlays> shown{},
      ordered{};  // In the drawing; ordered since switched on.
  double air_height = 0;
  std::shared_ptr<const view::DrawnNodes> drawn_nodes;  // While their overlay is on.
  int64_t shown_node = -1;                              // In the drawing.
  std::shared_ptr<const std::vector<Prism>> props;      // In the drawing.
  std::optional<Scenario> scenario;
  std::vector<DensityMap> painted;        // Of the scenario, or by the brush for the crowd.
  bool paints = false;                    // The brush is down.
  bool brush_shown = false;               // In the drawing.
  std::optional<double> path_ordered_at;  // [s]

  // The eye.
  view::CameraRig rig;
  std::optional<GivenCamera> camera_given;
  double aspect = 16.0 / 9;
  int32_t picture_width = 0, picture_height = 0;

  // Time.
  std::optional<double> last_now;
  double time = 0;

  // Input.
  std::array<bool, 256> keys{};
  std::array<bool, 3> buttons{};
  double mouse_x = 0, mouse_y = 0, pressed_x = 0, pressed_y = 0;
  bool dragged = false;  // Since a button went down: then it is no click.
  GamepadState gamepad;

  // The controlled avatar.
  bool first_person = false;
  double walk_distance = 4;  // From the eye to the avatar, if nothing is between. [m]
  std::optional<GroundQuery> ground_query;
  Vec3d last_preferred;
  // Results from the crowd's task.
  struct Answers {
    std::mutex lock;
    std::optional<int64_t> joined;
    std::optional<view::AvatarDetail> detail;
    std::string fault;
  };
  std::shared_ptr<Answers> answers = std::make_shared<Answers>();
  std::optional<double> last_asked;

  void take_parts();
  void take_scene(const PreparedScene& scene, std::shared_ptr<const view::Occluders> new_occluders);
  void take_world(const World& new_world, const std::optional<Nodes>& new_nodes);
  void take_figures(const std::vector<std::vector<ViewFigure>>& of_class);
  void take_experiment(const ExperimentStart& start);
  void begin_curves(SteeringModel model, const CurvilinearTuning& start);
  void keep_error(const Result<void>& ok);  // in the panel's status
  void reap();
  void retire_job();
  void restart_crowd();
  void change_scenario(std::function<Result<void>(view::ScenarioPlayer&)> change);
  void show_props(const view::TimelineFrame& frame);
  void send_painted();
  void change_crowd(std::function<void(view::CrowdPlayer&, Context&)> change);
  void act_on_panel();
  void send_curves();
  void send_eye();
  [[nodiscard]] view::StageBefore stage_before() const;
  void advance_time(double seconds);
  void step_once();
  void look_up_crowd();
  void look_up_picked();
  void show_overlays();
  void show_picked_node();
  [[nodiscard]] DrawingConfig drawing_config(int32_t width, int32_t height) const;
  Frame prepare(double now, int32_t width, int32_t height);
  void note(const DrawingReport& report);

  void press(Key key);
  void click();
  void drag(double dx, double dy);
  void move_pointer(double x, double y);
  void paint_to(double x, double y);
  void show_brush(double x, double y);
  [[nodiscard]] bool brush_paints() const {
    return panel.tool == view::Tool::kPaint || panel.tool == view::Tool::kUnpaint;
  }
  [[nodiscard]] std::optional<Vec3d> ground_under(double x, double y) const;  // In the world.
  void move_eye(double seconds);
  [[nodiscard]] bool held(Key key) const { return keys[static_cast<size_t>(key)]; }
  [[nodiscard]] view::SightLine sight_line(double x, double y) const;  // Relative to the origin.

  void begin_walk();
  void leave_walk();
  void follow_external(double seconds);
  [[nodiscard]] double free_behind(Vec3d feet, int32_t avatar_class);
  [[nodiscard]] bool through_eyes() const {
    return panel.mode == view::CameraMode::kWalk && first_person && panel.status.controlled >= 0;
  }
};

}  // namespace throng
