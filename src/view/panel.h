// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "throng_view/viewer.h"
#include "view/camera_rig.h"
#include "view/crowd_player.h"
#include "view/curves_panel.h"
#include "view/node_pick.h"
#include "view/overlays.h"
#include "view/replay_player.h"
#include "view/view_settings.h"

namespace throng::view {

/// The tool that a click on the ground uses.
enum class Tool : uint8_t {
  kPick,
  kSpawn,
  kErase,
  kPaint,    ///< Paints density, with the brush's weight.
  kUnpaint,  ///< Paints weight 0.
};

/// The scenario that runs.
struct ScenarioPanel {
  double seconds = 0;                  ///< Duration.
  std::vector<std::string> densities;  ///< Names of its maps.
  int32_t painted = 0;                 ///< Index of the map that the brush paints.
};

/// Durations of the parts of a frame. [s]
struct FrameTimes {
  double frame = 0;  ///< From one frame to the next.
  double blend = 0, pack = 0, draw = 0, panel = 0;
};

/// What the panel shows and changes; its owner applies the changes.
struct PanelState {
  ViewSettings settings;
  CameraMode mode = CameraMode::kOrbit;
  Tool tool = Tool::kPick;
  double brush_radius = 2;  ///< [m]
  int32_t brush_count = 20;
  double brush_weight = 1;  ///< [0.05 to 1]
  bool playing = true;
  bool help = false;
  double cut = 0;  ///< Height above which nothing is drawn, if `is_cut`. [m, world]
  bool is_cut = false;
  std::array<bool, kOverlays> overlays{};
  CrowdStart crowd;                           ///< The start of the next restart.
  std::optional<ExperimentStart> experiment;  ///< The same, of the plane of [CAACD] section V.
  std::optional<CurvesPanel> curves;          ///< If [CAACD] steers the avatars.
  int32_t avatars_wanted = 0;

  // Read only.
  ViewerStatus status;
  std::string renderer;
  std::string progress_stage;
  double progress = -1;
  Box3d bounds;  ///< In the world.
  bool has_world = false;
  bool has_crowd = false;
  std::optional<ReplaySpan> replay;
  std::optional<ScenarioPanel> scenario;
  SceneFlow flow;
  std::vector<double> storeys;
  std::vector<std::string> class_names;
  std::vector<double> class_heights, class_radii;
  FrameTimes times;
  CrowdReport report;
  std::optional<AvatarDetail> picked;
  double picked_speed = 0, picked_walked = 0;
  std::optional<NodeDetail> picked_node;
  std::optional<CurvilinearTuning> picked_tuning;  ///< If [CAACD] steers it.
  std::shared_ptr<const CurvedFrame> curved;       ///< Of the frame shown, or null.

  // Requests of this frame; the owner clears them.
  bool unpaint_all = false;
  bool step = false, restart = false, frame_all = false, set_count = false, walk = false;
  std::optional<double> seek;
};

/// Draws all windows of the panel; between Ui::begin and Ui::end.
void draw_panel(PanelState& state, float scale, int32_t width, int32_t height);

/// Moves the cut a storey up (1) or down (-1).
void step_cut(PanelState& state, int32_t by);

}  // namespace throng::view
