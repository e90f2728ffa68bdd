// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "throng_view/viewer.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "view/camera_rig.h"
#include "view/ground_pick.h"
#include "view/panel.h"
#include "view/stage_job.h"
#include "view/timeline_frame.h"
#include "view/timeline_source.h"
#include "view/ui.h"
#include "view/view_settings.h"
#include "view/viewer_state.h"

// A frame: take the loaded parts, move the eye, blend the crowd of the time shown, draw.
namespace throng {
namespace {

constexpr double kMemory =
    0.9;  // Weight of the old value in the running means of the panel's times.

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void mean(double& value, double now) {
  value = value == 0 ? now : kMemory * value + (1 - kMemory) * now;
}

}  // namespace

void Viewer::State::keep_error(const Result<void>& ok) {
  if (!ok) panel.status.error = ok.error().message;
}

// A new scene: nothing of the stage before remains.
void Viewer::State::take_scene(const PreparedScene& scene,
                               std::shared_ptr<const view::Occluders> new_occluders) {
  source.reset();
  world = {};
  nodes.reset();
  overlay_maker.reset();
  ordered.fill(false);
  for (size_t i = 0; i < view::kOverlays; ++i) {
    if (std::exchange(shown[i], false)) keep_error(drawing.set_marks(i, {}));
  }
  figures = {};
  drawing.clear_atlases();
  panel.has_world = panel.has_crowd = false;
  occluders = std::move(new_occluders);
  panel.replay.reset();
  panel.scenario.reset();
  panel.experiment.reset();
  panel.curves.reset();
  panel.curved.reset();
  scenario.reset();
  painted.clear();
  if (props) keep_error(drawing.set_props({}, {}));
  props.reset();
  panel.tool = view::Tool::kPick;
  panel.storeys.clear();
  panel.class_names.clear();
  panel.class_heights.clear();
  panel.class_radii.clear();
  panel.is_cut = false;
  panel.status.picked = panel.status.picked_node = panel.status.controlled = -1;
  drawn_nodes.reset();
  origin = scene.origin();
  bounds = scene.bounds();
  panel.bounds = {bounds.min + origin, bounds.max + origin};
  if (bounds.empty()) panel.bounds = {};
  keep_error(drawing.set_scene(scene));
  if (!camera_given) rig.show(bounds, aspect);
  if (camera_given) rig.look(camera_given->eye - origin, camera_given->target - origin);
  panel.cut = panel.bounds.empty() ? 0 : panel.bounds.max.y + 1;
}

void Viewer::State::take_world(const World& new_world, const std::optional<Nodes>& new_nodes) {
  world = new_world;
  panel.has_world = true;
  nodes = new_nodes;
  overlay_maker = std::make_unique<view::OverlayMaker>(world, new_nodes, origin);
  for (const AvatarClass& c : world.summary().classes) {
    panel.class_names.push_back(c.name);
    panel.class_heights.push_back(c.height);
    panel.class_radii.push_back(c.radius);
  }
}

void Viewer::State::take_figures(const std::vector<std::vector<ViewFigure>>& of_class) {
  for (const auto& row : of_class) {
    auto& numbers = figures.of_class.emplace_back();
    for (const auto& [atlas, model] : row) {
      const Result<size_t> number = drawing.add_atlas(atlas);
      if (!number) {
        keep_error(number.error());
        continue;
      }
      numbers.push_back(*number);
      if (model) keep_error(drawing.set_model(*number, *model));
      Atlas& shape = figures.shapes.emplace_back();
      shape.shape = atlas.shape;
      shape.clips = atlas.clips;
    }
    if (numbers.empty()) figures.of_class.pop_back();
  }
}

void Viewer::State::take_parts() {
  if (!job) return;
  job->run_slice();
  const bool done = job->done();  // Read first: parts that come later are taken in the next frame.
  view::StageMail mail = job->take();
  if (mail.scene) take_scene(*mail.scene, std::move(mail.occluders));
  if (mail.world) take_world(*mail.world, mail.nodes);
  if (mail.storeys) panel.storeys = *std::move(mail.storeys);
  if (mail.figures) take_figures(*mail.figures);
  if (mail.replay) {
    panel.replay = mail.replay;
    panel.class_names = std::move(mail.class_names);
  }
  if (mail.crowd) {
    panel.crowd = *mail.crowd;
    panel.avatars_wanted = static_cast<int32_t>(mail.crowd->avatars);
    panel.settings.only_seen = mail.crowd->only_seen;
    panel.settings.coarse_far = mail.crowd->coarse_far;
    painted = mail.crowd->density;
  }
  if (mail.experiment) take_experiment(*mail.experiment);
  if (mail.scenario) {
    scenario = std::move(mail.scenario);
    painted = scenario->densities;
    panel.crowd.dt = scenario->dt;
    panel.scenario = {.seconds = scenario->seconds, .densities = {}, .painted = 0};
    for (const DensityMap& map : painted) panel.scenario->densities.push_back(map.name);
    ordered[static_cast<size_t>(view::Overlay::kPainted)] = false;
  }
  if (mail.source) {
    source = std::move(mail.source);
    panel.has_crowd = !panel.replay && !panel.scenario && !panel.experiment;
    if (panel.has_crowd) begin_curves(panel.crowd.model, panel.crowd.curves);
    time = panel.replay ? panel.replay->first : 0;
    sent_eye.reset();
    send_eye();
  }
  if (done) {
    if (!job->error().empty()) panel.status.error = job->error();
    job.reset();
  }
}

// The plane has no world, so that the panel gets its one class here.
void Viewer::State::take_experiment(const ExperimentStart& start) {
  panel.experiment = start;
  panel.crowd.dt = 1 / ExperimentStart::kFramesPerSecond;
  panel.class_names = {"avatar"};
  panel.class_heights = {ExperimentStart::kHeight};
  panel.class_radii = {start.space.fields.repulsive * ExperimentStart::kUnit};
  panel.overlays[static_cast<size_t>(view::Overlay::kFields)] = true;
  const caacd::Model& model = start.model;
  begin_curves(SteeringModel::kCurvilinear, {.mass = model.mass,
                                             .max_speed = model.max_speed,
                                             .max_force = model.max_force,
                                             .by_state = model.order == caacd::Order::kState});
}

void Viewer::State::begin_curves(SteeringModel model, const CurvilinearTuning& start) {
  panel.curves.reset();
  if (model != SteeringModel::kCurvilinear) return;
  panel.curves = view::CurvesPanel{.of = -1, .shown = start, .all = start};
}

// Sends what was changed to the avatar that it is of, or to all.
void Viewer::State::send_curves() {
  if (!panel.curves || !source) return;
  view::CurvesPanel& curves = *panel.curves;
  const bool to_all = std::exchange(curves.to_all, false) || curves.of < 0;
  curves.changed = false;
  curves.edited = true;
  if (to_all) curves.all = curves.shown;
  std::optional<uint64_t> id;
  if (!to_all) id = static_cast<uint64_t>(curves.of);
  source->post(
      [id, tuning = curves.shown](view::TimelinePlayer& player) { player.set_curves(id, tuning); },
      !panel.playing);
}

void Viewer::State::reap() {
  for (const auto& old : retired) old->run_slice();
  std::erase_if(retired, [](const auto& old) { return old->done(); });
}

void Viewer::State::act_on_panel() {
  if (std::exchange(panel.frame_all, false)) rig.show(bounds, aspect);
  if (std::exchange(panel.step, false)) step_once();
  if (std::exchange(panel.set_count, false) && panel.has_crowd) {
    const auto count = static_cast<uint32_t>(std::max(0, panel.avatars_wanted));
    panel.crowd.avatars = count;
    if (panel.crowd.only_seen) {
      panel.restart = true;  // Avatars must not appear or disappear in sight.
    } else {
      change_crowd([count](view::CrowdPlayer& player, Context& context) {
        player.set_count(count, context);
      });
    }
  }
  if (std::exchange(panel.unpaint_all, false)) {
    painted.clear();
    send_painted();
  }
  if (panel.curves && (panel.curves->changed || panel.curves->to_all)) send_curves();
  if (std::exchange(panel.restart, false) &&
      (panel.has_crowd || panel.scenario || panel.experiment)) {
    panel.crowd.avatars = static_cast<uint32_t>(std::max(0, panel.avatars_wanted));
    restart_crowd();
  }
  if (panel.seek && panel.replay) {
    time = std::clamp(*panel.seek, panel.replay->first, panel.replay->last);
    if (source) source->seek(time);
  }
  panel.seek.reset();
  if (std::exchange(panel.walk, false)) begin_walk();
}

// Sends the eye to a crowd that depends on it: only_seen or coarse_far.
void Viewer::State::send_eye() {
  if (!panel.has_crowd || !(panel.crowd.only_seen || panel.crowd.coarse_far)) return;
  const view::EyePlace place{.eye = rig.eye() + origin,
                             .nearest = rig.camera(aspect).nearest,
                             .cut = panel.is_cut ? panel.cut : 1e9};
  if (sent_eye && *sent_eye == place) return;
  sent_eye = place;
  source->post(
      [place](view::TimelinePlayer& player) {
        static_cast<view::CrowdPlayer&>(player).look_from(place);
      },
      /*at_once=*/false);
}

view::StageBefore Viewer::State::stage_before() const {
  return {.origin = origin,
          .world = world,
          .nodes = nodes.value_or(Nodes()),
          .occluders = occluders,
          .only_seen = panel.settings.only_seen,
          .coarse_far = panel.settings.coarse_far};
}

void Viewer::State::change_crowd(std::function<void(view::CrowdPlayer&, Context&)> change) {
  if (!source || !panel.has_crowd) return;
  source->post(
      [change = std::move(change)](view::TimelinePlayer& player) {
        Context quiet;
        change(static_cast<view::CrowdPlayer&>(player), quiet);
      },
      !panel.playing);
}

void Viewer::State::change_scenario(std::function<Result<void>(view::ScenarioPlayer&)> change) {
  if (!source || !panel.scenario) return;
  source->post(
      [change = std::move(change), answers = answers](view::TimelinePlayer& player) {
        const Result<void> ok = change(static_cast<view::ScenarioPlayer&>(player));
        const std::lock_guard lock(answers->lock);
        answers->fault = ok ? std::string() : ok.error().message;
      },
      !panel.playing);
}

// Makes the crowd or scenario again; scene, world and figures stay.
void Viewer::State::restart_crowd() {
  leave_walk();
  CrowdStart start = panel.crowd;
  start.only_seen = panel.settings.only_seen;
  start.coarse_far = panel.settings.coarse_far;
  start.density = painted;
  if (scenario) scenario->densities = painted;
  std::optional<ExperimentStart> plane = panel.experiment;
  if (plane && panel.curves) {
    const CurvilinearTuning& all = panel.curves->all;
    plane->model = caacd::with_set(plane->model, {all.mass, all.max_speed, all.max_force});
  }
  retire_job();
  job = std::make_unique<view::StageJob>(
      panel.status.name,
      [start, again = scenario, plane](StageParts& parts, Context&) -> Result<void> {
        if (plane) {
          parts.set_experiment(*plane);
        } else if (again) {
          parts.set_scenario(*again);
        } else {
          parts.set_crowd(start);
        }
        return {};
      },
      config.workers, stage_before());
}

void Viewer::State::retire_job() {
  if (!job) return;
  job->cancel();
  retired.push_back(std::move(job));
}

void Viewer::State::step_once() {
  panel.playing = false;
  if (!source) return;
  const view::FramePair pair = source->at(time);
  // To the next frame if there is one, else by a step.
  if (pair.b) time = pair.share < 1 ? pair.b->time : pair.b->time + panel.crowd.dt;
}

void Viewer::State::advance_time(double seconds) {
  if (panel.playing) time += seconds * panel.settings.speed;
  if (panel.replay) {
    if (time >= panel.replay->last) {
      time = panel.replay->last;
      panel.playing = false;
    }
  } else if (source) {
    time = std::min(time, source->latest());  // Time waits for the steps.
  }
}

void Viewer::State::look_up_crowd() {
  panel.status.avatars = 0;
  if (!source) {
    crowd = {};
    return;
  }
  const auto start = std::chrono::steady_clock::now();
  const view::FramePair pair = source->at(time);
  source->run_slice();
  if (!pair.a) return;
  const double cut = panel.is_cut ? panel.cut - origin.y - 0.05 : 1e9;
  crowd.hide(through_eyes() ? panel.status.controlled : -1);
  crowd.blend(*pair.a, *pair.b, pair.share, figures, cut);
  panel.report = pair.b->report;
  panel.flow = pair.b->flow;
  panel.curved = pair.b->curved;
  if (!pair.b->fault.empty()) panel.status.error = pair.b->fault;
  show_props(*pair.a);
  panel.status.avatars = crowd.now().size();
  mean(panel.times.blend, seconds_since(start));
}

void Viewer::State::show_props(const view::TimelineFrame& frame) {
  if (frame.obstacles == props) return;
  props = frame.obstacles;
  Scene scene;
  for (size_t p = 0; props && p < props->size(); ++p) {
    const Prism& prism = (*props)[p];
    const auto corner = [&](size_t k, double y) {
      const auto& c = prism.corners[k % prism.corners.size()];
      return Vec3d{c[0], y, c[1]};
    };
    for (size_t k = 0; k < prism.corners.size(); ++k) {
      scene.add_quad(corner(k, prism.low), corner(k + 1, prism.low), corner(k + 1, prism.high),
                     corner(k, prism.high));
      if (k == 0 || k + 1 == prism.corners.size()) continue;
      for (const double y : {prism.low, prism.high}) {
        scene.add_triangle(corner(0, y), corner(k, y), corner(k + 1, y));
      }
    }
  }
  if (auto ok = drawing.set_props(scene, origin); !ok) panel.status.error = ok.error().message;
}

DrawingConfig Viewer::State::drawing_config(int32_t width, int32_t height) const {
  DrawingConfig out;
  out.width = width;
  out.height = height;
  out.camera = rig.camera(static_cast<double>(width) / height);
  out.samples = panel.settings.smooth ? 2 : 1;
  out.avatar_shadows = panel.settings.shadows;
  out.sun_pixels = panel.settings.smooth ? 4096 : 1024;
  out.soft_shadows = panel.settings.smooth;
  out.edges = panel.settings.edges;
  if (panel.is_cut) out.cut_height = panel.cut - origin.y;
  out.workers = config.workers;
  return out;
}

Viewer::State::Frame Viewer::State::prepare(double now, int32_t width, int32_t height) {
  const double seconds = last_now ? std::clamp(now - *last_now, 0.0, 0.25) : 0;
  if (last_now) mean(panel.times.frame, now - *last_now);
  last_now = now;
  picture_width = width;
  picture_height = height;
  aspect = static_cast<double>(width) / height;
  take_parts();
  reap();
  panel.status.loading = job != nullptr;
  if (job) std::tie(panel.progress_stage, panel.progress) = job->progress();
  rig.field_of_view = panel.settings.view_angle * 0.017453292519943295;
  move_eye(seconds);
  advance_time(seconds);
  look_up_crowd();
  {
    const std::lock_guard lock(answers->lock);
    if (!answers->fault.empty()) panel.status.error = std::exchange(answers->fault, {});
  }
  follow_external(seconds);
  if (source) send_eye();
  look_up_picked();
  if (panel.curves) view::follow_picked(panel);
  show_overlays();
  panel.status.time = time;
  panel.status.camera = rig.camera(aspect);
  panel.status.camera.eye = panel.status.camera.eye + origin;
  panel.status.camera.target = panel.status.camera.target + origin;

  Frame frame{.config = drawing_config(width, height), .panel = {}};
  const auto start = std::chrono::steady_clock::now();
  if (config.panel) {
    ui->begin(seconds, width, height);
    view::draw_panel(panel, ui->scale(), width, height);
    frame.panel = ui->end();
    act_on_panel();
  }
  mean(panel.times.panel, seconds_since(start));
  return frame;
}

void Viewer::State::note(const DrawingReport& report) {
  panel.status.drawn = report.drawn;
  mean(panel.times.pack, report.seconds_pack);
  mean(panel.times.draw, report.seconds_draw);
}

Viewer::Viewer(std::unique_ptr<State> state) : state_(std::move(state)) {}
Viewer::Viewer(Viewer&&) noexcept = default;
Viewer& Viewer::operator=(Viewer&&) noexcept = default;
Viewer::~Viewer() = default;

Result<Viewer> Viewer::create(Drawing drawing, const ViewerConfig& config) {
  auto state = std::make_unique<State>(std::move(drawing));
  state->config = config;
  state->panel.renderer = state->drawing.renderer();
  // Software renderers are too slow for four samples a pixel; stored settings override this.
  const std::string& renderer = state->panel.renderer;
  if (config.panel && (renderer.find("llvmpipe") != std::string::npos ||
                       renderer.find("SwiftShader") != std::string::npos)) {
    state->panel.settings.smooth = false;
  }
  if (!config.settings.empty()) {
    const Result<view::ViewSettings> settings = view::read_settings(config.settings);
    if (!settings) return settings.error();
    state->panel.settings = *settings;
  }
  state->ui = std::make_unique<view::Ui>(config.font, config.pixel_ratio);
  if (auto ok = state->ui->set_texture(state->drawing); !ok) return ok.error();
  if (!state->panel.settings.layout.empty()) state->ui->set_layout(state->panel.settings.layout);
  return Viewer(std::move(state));
}

void Viewer::load(const std::string& name, LoadStage load) {
  State& s = *state_;
  s.retire_job();
  s.panel.status.name = name;
  s.panel.status.error.clear();
  s.panel.status.loading = true;
  s.job =
      std::make_unique<view::StageJob>(name, std::move(load), s.config.workers, s.stage_before());
}

Result<void> Viewer::frame(double now, int32_t width, int32_t height) {
  const State::Frame frame = state_->prepare(now, width, height);
  DrawingReport report;
  auto ok = state_->drawing.show(state_->crowd.crowds(), frame.config, &report, frame.panel);
  if (ok) state_->note(report);
  return ok;
}

Result<Image> Viewer::picture(double now, int32_t width, int32_t height) {
  const State::Frame frame = state_->prepare(now, width, height);
  DrawingReport report;
  auto image = state_->drawing.draw(state_->crowd.crowds(), frame.config, &report, frame.panel);
  if (image) state_->note(report);
  return image;
}

void Viewer::look_at(Vec3d eye, Vec3d target) {
  state_->camera_given = {eye, target};
  state_->rig.look(eye - state_->origin, target - state_->origin);
}

void Viewer::show_overlay(const std::string& name) {
  for (size_t i = 0; i < view::kOverlays; ++i) {
    if (view::word_for(static_cast<view::Overlay>(i)) == name) state_->panel.overlays[i] = true;
  }
}

std::vector<std::string> Viewer::overlay_names() {
  std::vector<std::string> names;
  for (size_t i = 0; i < view::kOverlays; ++i)
    names.emplace_back(view::word_for(static_cast<view::Overlay>(i)));
  return names;
}

void Viewer::pick(int64_t id) { state_->panel.status.picked = id; }

void Viewer::wait_for_overlays() {
  State& s = *state_;
  if (!s.last_now) s.last_now = 0;
  const auto is_missing = [&](view::Overlay overlay) {
    const auto slot = static_cast<size_t>(overlay);
    if (!s.overlay_maker || !s.panel.overlays[slot] || s.ordered[slot]) return false;
    const bool is_of_frame = overlay == view::Overlay::kDensity ||
                             overlay == view::Overlay::kNeighbours ||
                             overlay == view::Overlay::kFields;
    if (is_of_frame) return false;
    return overlay != view::Overlay::kPath || (s.panel.status.picked >= 0 && s.panel.has_crowd);
  };
  // The picked avatar may have no goal, so that no path is made.
  for (int32_t tries = 0; tries < 100 || (s.overlay_maker && s.overlay_maker->is_busy()); ++tries) {
    s.look_up_crowd();
    s.look_up_picked();
    if (s.source) s.source->finish_posted();
    s.show_overlays();
    bool missing = s.overlay_maker && s.overlay_maker->is_busy();
    for (size_t i = 0; i < view::kOverlays; ++i)
      missing |= is_missing(static_cast<view::Overlay>(i));
    if (!missing) break;
    view::SideTask::sleep_briefly();
  }
  s.show_overlays();  // Takes the last one made.
}

void Viewer::wait_until_loaded() {
  while (state_->job) {
    state_->take_parts();
    if (state_->job) view::SideTask::sleep_briefly();
  }
  state_->panel.status.loading = false;
}

void Viewer::play_for(double seconds) {
  State& s = *state_;
  if (!s.source) return;
  const double max_time =
      s.panel.replay ? s.panel.replay->last : std::numeric_limits<double>::max();
  // The frames up to here were made for the old eye, on every machine.
  s.source->finish();
  s.send_eye();
  // In small increments, so that no frame is skipped.
  const double end = std::min(s.time + seconds * s.panel.settings.speed, max_time);
  while (true) {
    s.source->wait_for(s.time);
    (void)s.source->at(s.time);
    if (s.time >= end) return;
    s.time = std::min(end, s.time + 0.02);
  }
}

ViewerRequests Viewer::take_requests() {
  ViewerRequests requests = state_->requests;
  state_->requests.save_picture = false;
  state_->requests.open.clear();
  return requests;
}

ViewerStatus Viewer::status() const {
  ViewerStatus status = state_->panel.status;
  status.time = state_->time;
  status.playing = state_->panel.playing;
  status.last_time = state_->panel.replay ? state_->panel.replay->last : 0;
  if (state_->panel.curved) {
    const auto counts = state_->panel.curved->count_states();
    status.states.assign(counts.begin(), counts.end());
    status.experiment = state_->panel.curved->counts;
  }
  if (state_->panel.curves) status.curves = state_->panel.curves->shown;
  return status;
}

std::string Viewer::settings() const {
  view::ViewSettings settings = state_->panel.settings;
  settings.layout = state_->ui->layout();
  return view::settings_text(settings);
}

}  // namespace throng
