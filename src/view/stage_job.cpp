// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "view/stage_job.h"

#include <cmath>
#include <new>
#include <utility>

#include "view/levels.h"

// Runs a LoadStage on a task and passes what it sets to the window through StageMail.
namespace throng {

view::StageJob::StageJob(std::string name, LoadStage load, int32_t workers,
                         view::StageBefore before)
    : name_(std::move(name)), workers_(workers), before_(std::move(before)) {
  context_.on_progress = [this](const Progress& progress) {
    {
      const std::lock_guard lock(mutex_);
      stage_ = progress.stage;
      share_ = progress.total > 0
                   ? static_cast<double>(progress.done) / static_cast<double>(progress.total)
                   : -1;
    }
    view::SideTask::pause_if_due();
  };
  task_.emplace([this, load = std::move(load)] { run(load); });
}

view::StageJob::~StageJob() {
  cancel();
  task_.reset();
}

void view::StageJob::run(const LoadStage& load) {
  Result<void> ok;
  try {
    StageParts parts(*this);
    ok = load(parts, context_);
    if (ok) ok = start_player();
  } catch (const std::bad_alloc&) {
    ok = Error{Errc::kLimit, name_ + ": out of memory; use larger cells or a smaller world"};
  }
  const std::lock_guard lock(mutex_);
  if (!ok && ok.error().code != Errc::kCancelled) error_ = ok.error().message;
  done_ = true;
}

Result<void> view::StageJob::start_player() {
  if (!crowd_ && !scenario_ && !experiment_) return {};
  context_.on_progress({"paths", 0, 0});
  std::unique_ptr<view::TimelinePlayer> player;
  if (experiment_) {
    auto made = view::PlanePlayer::create(*experiment_, before_.origin);
    if (!made) return made.error();
    player = *std::move(made);
  } else if (scenario_) {
    auto made =
        view::ScenarioPlayer::create(before_.world, *scenario_, workers_, before_.origin, context_);
    if (!made) return made.error();
    player = *std::move(made);
  } else {
    auto made = view::CrowdPlayer::create(before_.world, before_.nodes, *crowd_, workers_,
                                          before_.origin, before_.occluders, context_);
    if (!made) return made.error();
    player = *std::move(made);
  }
  auto source = std::make_unique<view::TimelineSource>(std::move(player));
  const std::lock_guard lock(mutex_);
  mail_.source = std::move(source);
  return {};
}

view::StageMail view::StageJob::take() {
  const std::lock_guard lock(mutex_);
  return std::exchange(mail_, {});
}

std::string view::StageJob::error() const {
  const std::lock_guard lock(mutex_);
  return error_;
}

std::pair<std::string, double> view::StageJob::progress() const {
  const std::lock_guard lock(mutex_);
  return {stage_, share_};
}

Result<void> StageParts::set_scene(const Scene& scene) {
  view::StageJob& job = job_;
  const Box3d bounds = scene.bounds();
  const Vec3d middle = bounds.empty() ? Vec3d{} : (bounds.min + bounds.max) * 0.5;
  // Whole metres: relative positions then keep the decimals of the world's.
  job.before_.origin = {std::round(middle.x), std::round(bounds.empty() ? 0 : bounds.min.y),
                        std::round(middle.z)};
  Result<PreparedScene> prepared = PreparedScene::create(scene, job.before_.origin);
  if (!prepared) return prepared.error();
  job.before_.occluders = view::occluders_of(scene, job.before_.origin);
  const std::lock_guard lock(job.mutex_);
  job.mail_.occluders = job.before_.occluders;
  job.mail_.scene = *std::move(prepared);
  return {};
}

void StageParts::set_world(World world, std::optional<Nodes> nodes) {
  view::StageJob& job = job_;
  job.before_.world = world;
  job.before_.nodes = nodes ? *nodes : Nodes();
  {
    const std::lock_guard lock(job.mutex_);
    job.mail_.world = world;
    job.mail_.nodes = std::move(nodes);
  }
  std::vector<double> storeys = view::storey_heights(world, job.context_);
  const std::lock_guard lock(job.mutex_);
  job.mail_.storeys = std::move(storeys);
}

void StageParts::set_atlases(std::vector<std::vector<Atlas>> of_class) {
  std::vector<std::vector<ViewFigure>> figures;
  for (auto& row : of_class) {
    auto& out = figures.emplace_back();
    for (Atlas& atlas : row) out.push_back({.atlas = std::move(atlas)});
  }
  set_figures(std::move(figures));
}

void StageParts::set_figures(std::vector<std::vector<ViewFigure>> of_class) {
  for (auto& row : of_class) {
    for (auto& [atlas, model] : row) {
      // The drawing does not read this format; it unpacks block formats if the card cannot.
      if (atlas.format == AtlasFormat::kRgb5a1) atlas = convert_atlas(atlas, AtlasFormat::kRgba8);
    }
  }
  const std::lock_guard lock(job_.mutex_);
  job_.mail_.figures = std::move(of_class);
}

void StageParts::set_crowd(const CrowdStart& start) {
  const std::lock_guard lock(job_.mutex_);
  job_.crowd_ = start;
  job_.crowd_->only_seen |= job_.before_.only_seen;
  job_.crowd_->coarse_far |= job_.before_.coarse_far;
  job_.mail_.crowd = job_.crowd_;
}

void StageParts::set_scenario(const Scenario& scenario) {
  const std::lock_guard lock(job_.mutex_);
  job_.scenario_ = scenario;
  job_.mail_.scenario = scenario;
}

void StageParts::set_experiment(const ExperimentStart& start) {
  const std::lock_guard lock(job_.mutex_);
  job_.experiment_ = start;
  job_.mail_.experiment = start;
}

void StageParts::set_replay(Replay replay) {
  view::StageJob& job = job_;
  const view::ReplaySpan span = view::replay_span(replay);
  std::vector<std::string> names;
  for (const RecordedClass& c : replay.info().classes) names.push_back(c.name);
  auto source = std::make_unique<view::TimelineSource>(
      std::make_unique<view::ReplayPlayer>(std::move(replay), job.before_.origin));
  const std::lock_guard lock(job.mutex_);
  job.mail_.replay = span;
  job.mail_.class_names = std::move(names);
  job.mail_.source = std::move(source);
}

}  // namespace throng
