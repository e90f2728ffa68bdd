// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "report/caacd_one_run.h"

#include <fmt/format.h>

#include <string>
#include <vector>

#include "output_file.h"
#include "throng/papers.h"

// One run of the experiment of [CAACD] section V, as a picture and as a table of frames.
namespace throng::app {
namespace {

using namespace caacd;

const char* word_for(Activity activity) {
  switch (activity) {
    case Activity::kTravelling:
      return "travelling";
    case Activity::kAvoiding:
      return "avoiding";
    case Activity::kArriving:
      return "arriving";
    case Activity::kWaiting:
      return "waiting";
    case Activity::kArrived:
      return "arrived";
  }
  return "";
}

const char* word_for(State state) {
  switch (state) {
    case State::kTolerable:
      return "tolerable";
    case State::kAlert:
      return "alert";
    case State::kCritical:
      return "critical";
    case State::kCollision:
      return "collision";
  }
  return "";
}

// The greatest threat: its state, and which avatar or obstacle it is.
std::string text_of(const Threat& threat) {
  if (threat.state == State::kTolerable) return std::string(word_for(threat.state)) + ",";
  return fmt::format("{},{}", word_for(threat.state),
                     threat.id == Threat::kObstacle ? "obstacle" : std::to_string(threat.id));
}

// What changed the velocity since the frame before: a_t and a_n of [CAACD] II.
Curvilinear change_of(const Body& before, const Body& now, double dt) {
  return curvilinear(before.forward, (now.velocity - before.velocity) * (1 / dt));
}

std::string rows(const Simulation& simulation, std::span<const Body> before, double dt) {
  std::string text;
  for (size_t i = 0; i < simulation.bodies().size(); ++i) {
    const Body& b = simulation.bodies()[i];
    const Curvilinear change = change_of(before[i], b, dt);
    text += fmt::format("{},{},{:.4f},{:.4f},{:.5f},{:.5f},{},{:.5f},{:.5f},{}\n",
                        simulation.counts().frames, b.id, b.position.x, b.position.z, b.velocity.x,
                        b.velocity.z, word_for(simulation.activities()[i]), change.tangential,
                        change.centripetal, text_of(simulation.threats()[i]));
  }
  return text;
}

Result<void> draw(const Simulation& simulation, const std::vector<std::vector<Vec3d>>& trails,
                  const SpaceConfig& space, const ParameterSet& set, const std::string& path) {
  const Result<Image> image = draw_simulation(
      simulation, trails,
      {.side = space.side, .title = fmt::format("{} avatars, {}", space.avatars, name_of(set))});
  if (!image) return image.error();
  return write_png(*image, path);
}

}  // namespace

int run_once(Session& session, const StudyConfig& study, const OneRunFiles& files) {
  const ParameterSet set = study.sets.back();
  SpaceConfig space = study.space;
  space.avatars = study.avatars.back();
  const Model model = with_set(study.model, set);
  Result<Space> made = random_space(space, model);
  if (!made) return fail(made.error());
  Result<Simulation> run = Simulation::create(*std::move(made), model, study.dt);
  if (!run) return fail(run.error());

  OutputFile record;
  if (!files.record.empty()) {
    if (auto ok = record.open(files.record); !ok) return fail(ok.error());
    record.write("frame,id,x,z,vx,vz,activity,tangential,centripetal,state,threat\n");
    record.write(rows(*run, run->bodies(), study.dt));
  }
  std::vector<std::vector<Vec3d>> trails(run->bodies().size());
  std::vector<Body> before;
  bool drawn = files.picture.empty();
  while (run->counts().frames < study.frames) {
    if (session.context.cancel.load()) return fail({Errc::kCancelled, "caacd: cancelled"});
    if (!drawn && run->counts().frames % 4 == 0) {
      for (size_t i = 0; i < trails.size(); ++i) trails[i].push_back(run->bodies()[i].position);
    }
    if (!drawn && run->counts().frames >= files.at) {
      if (auto ok = draw(*run, trails, space, set, files.picture); !ok) return fail(ok.error());
      drawn = true;
    }
    if (run->finished()) break;
    before.assign(run->bodies().begin(), run->bodies().end());
    run->step();
    if (record.is_open()) record.write(rows(*run, before, study.dt));
  }
  if (!drawn) {
    if (files.is_at_given && run->counts().frames < files.at) {
      return fail({Errc::kBadConfig, fmt::format("--at {}: the run ends at frame {}; name one of "
                                                 "its frames, or leave --at out",
                                                 files.at, run->counts().frames)});
    }
    if (auto ok = draw(*run, trails, space, set, files.picture); !ok) return fail(ok.error());
  }
  if (record.is_open()) {
    if (auto ok = record.finish(); !ok) return fail(ok.error());
  }
  const Counts& counts = run->counts();
  print_result(
      session,
      {{"set", name_of(set)},
       {"avatars", space.avatars},
       {"seed", space.seed},
       {"frames", counts.frames},
       {"collisions", counts.collisions},
       {"obstacle_collisions", counts.obstacle_collisions},
       {"arrived", counts.arrived},
       {"waiting", counts.waiting},
       {"walked", counts.walked},
       {"state_hash", fmt::format("{:016x}", run->state_hash())}},
      fmt::format("{}, {} avatars, seed {}: {} frames, {} collisions, {} with obstacles, "
                  "{} arrived, {} wait\n",
                  name_of(set), space.avatars, space.seed, counts.frames, counts.collisions,
                  counts.obstacle_collisions, counts.arrived, counts.waiting));
  return kDone;
}

}  // namespace throng::app
