// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "command.h"
#include "input_file.h"
#include "run/rerun.h"
#include "run/trajectory_db.h"
#include "throng/bake.h"
#include "throng/recording.h"

// throng replay: prints what a recording holds, exports it, and compares it with a repeated run.
namespace throng::app {
namespace {

struct ReplayOptions {
  std::string file;
  std::string world;
  std::string csv, txt, sqlite;
  std::string avatar_class;
  std::vector<double> heights;
  std::optional<double> at;
  int32_t workers = 0;
  bool check = false;
};

struct Area {
  std::string wkt;
  std::string remark;  // which area it leaves out, or empty
};

// The largest piece of walkable area: tools of pedestrian research take one polygon.
Result<Area> area_of(Session& session, const ReplayOptions& options, const Replay& replay,
                     const ExportConfig& config) {
  const Result<World> world = world_of(replay.info(), options.world);
  if (!world) {
    // A world named by an option must exist; else the positions are exported alone.
    if (!options.world.empty()) return world.error();
    return Area{"", world.error().message + "; the file has no geometry"};
  }
  std::string name = options.avatar_class;
  if (name.empty()) name = replay.info().classes.front().name;
  const Result<int32_t> avatar_class = class_named(*world, name);
  if (!avatar_class) return avatar_class.error();
  const auto pieces =
      walkable_pieces(*world, *avatar_class, config.lowest, config.highest, session.context);
  if (!pieces) return pieces.error();
  if (pieces->empty()) return Area{"", "no avatar can stand there; the file has no geometry"};
  Area area{.wkt = to_wkt(pieces->front().polygon), .remark = {}};
  double left_out = 0;
  for (size_t i = 1; i < pieces->size(); ++i) left_out += (*pieces)[i].area;
  if (pieces->size() > 1) {
    area.remark =
        fmt::format("the geometry is the largest of {} pieces, {:.1f} m2; {:.1f} m2 are left out",
                    pieces->size(), pieces->front().area, left_out);
  }
  return area;
}

Json info_json(const ReplayOptions& options, Replay& replay, const FilmRate& film) {
  const RecordingInfo& info = replay.info();
  const uint64_t frames = replay.frame_count();
  Json classes = Json::array();
  for (const RecordedClass& c : info.classes) {
    classes.push_back({{"name", c.name}, {"height", c.height}, {"radius", c.radius}});
  }
  uint64_t positions = 0;
  uint32_t max_avatars = 0;
  double last_time = 0, first_time = 0;
  for (uint64_t f = 0; f < frames; ++f) {
    const Result<FrameInfo> frame = replay.frame_info(f);
    if (!frame) continue;
    positions += frame->avatars;
    max_avatars = std::max(max_avatars, frame->avatars);
    if (f == 0) first_time = frame->time;
    last_time = frame->time;
  }
  const Json settings = Json::parse(info.settings, nullptr, /*allow_exceptions=*/false);
  return {
      {"file", options.file},
      {"world", info.world},
      {"world_hash", fmt::format("{:016x}", info.world_hash)},
      {"model", info.model},
      {"settings", settings.is_discarded() ? Json(info.settings) : settings},
      {"dt", info.dt},
      {"leans", info.leans},
      {"origin", numbers(info.origin)},
      {"classes", classes},
      {"frames", frames},
      {"frames_per_second", film.rate},
      {"first_time", first_time},
      {"last_time", last_time},
      {"max_avatars", max_avatars},
      {"positions", positions},
      {"bytes", replay.bytes()},
      {"bytes_per_position",
       positions > 0 ? static_cast<double>(replay.bytes()) / static_cast<double>(positions) : 0},
      {"complete", replay.damage().empty()},
      {"damage", replay.damage()}};
}

std::string info_text(const Json& info) {
  return fmt::format(
      "{}: {} frames, {:.1f} to {:.1f} s, up to {} avatars, {} of {}\n{}, {:.2f} "
      "bytes a position{}\n",
      info["file"].get<std::string>(), info["frames"].get<uint64_t>(),
      info["first_time"].get<double>(), info["last_time"].get<double>(),
      info["max_avatars"].get<uint32_t>(), info["model"].get<std::string>(),
      info["world"].get<std::string>(), human_bytes(info["bytes"].get<uint64_t>()),
      info["bytes_per_position"].get<double>(),
      info["complete"].get<bool>() ? "" : "; not complete");
}

Json frame_json(const RecordingInfo& info, const RecordedFrame& frame) {
  Json avatars = Json::array();
  for (size_t i = 0; i < frame.size(); ++i) {
    avatars.push_back({{"id", frame.ids[i]},
                       {"class", info.classes[frame.classes[i]].name},
                       {"position", numbers(frame.positions[i])},
                       {"radius", frame.radii[i]},
                       {"heading", {frame.headings[i].x, frame.headings[i].z}}});
    if (!frame.up_vectors.empty()) avatars.back()["up"] = numbers(frame.up_vectors[i]);
  }
  return {{"time", frame.time},
          {"step", frame.step},
          {"state_hash", fmt::format("{:016x}", frame.state_hash)},
          {"avatars", avatars}};
}

std::string frame_text(const RecordingInfo& info, const RecordedFrame& frame) {
  std::string text = fmt::format("step {}, {:.3f} s, {} avatars, state {:016x}\n", frame.step,
                                 frame.time, frame.size(), frame.state_hash);
  for (size_t i = 0; i < frame.size(); ++i) {
    text += fmt::format("{} {} {}\n", frame.ids[i], info.classes[frame.classes[i]].name,
                        where(frame.positions[i]));
  }
  return text;
}

int show_frame(Session& session, const ReplayOptions& options, Replay& replay) {
  if (auto ok = check_has_frames(replay, options.file); !ok) return fail(ok.error());
  const Result<uint64_t> index = replay.find(*options.at);
  if (!index) return fail(index.error());
  RecordedFrame frame;
  if (const Result<void> ok = replay.read(*index, frame); !ok) return fail(ok.error());
  print_result(session, frame_json(replay.info(), frame), frame_text(replay.info(), frame));
  return kDone;
}

// Repeats the run and compares the hash of every recorded step.
int check(Session& session, const ReplayOptions& options, Replay& replay) {
  const Result<std::vector<StepHash>> hashes = replay.step_hashes();
  if (!hashes) return fail(hashes.error());
  if (hashes->empty()) {  // Of nothing, all would be the same.
    return fail(
        {Errc::kBadFile, options.file + ": holds no step to compare; record the run again"});
  }
  const Result<World> world = world_of(replay.info(), options.world);
  if (!world) return fail(world.error());
  const Result<Rerun> rerun = make_rerun(replay.info(), *world, options.workers);
  if (!rerun) return fail(rerun.error());
  uint64_t step = 0, same = 0;
  Json differs = nullptr;
  std::string text;
  for (const StepHash& recorded : *hashes) {
    for (; step < recorded.step; ++step) {
      rerun->step();
      show_progress(session, "check", step, hashes->back().step);
      if (session.context.cancel) return fail({Errc::kCancelled, "replay: interrupted"});
    }
    const uint64_t hash = rerun->state_hash();
    if (hash == recorded.state_hash) {
      ++same;
      continue;
    }
    differs = step;
    text = fmt::format("{}: step {} is the first that differs: recorded {:016x}, now {:016x}\n",
                       options.file, step, recorded.state_hash, hash);
    break;
  }
  const bool whole = replay.damage().empty();
  if (differs.is_null()) {
    text = fmt::format("{}: {}, all the same{}\n", options.file, counted(same, "step"),
                       whole ? "" : "; those after them are lost");
  }
  print_result(session,
               {{"file", options.file},
                {"hashes", hashes->size()},
                {"same", same},
                {"first_difference", differs},
                {"complete", whole}},
               text);
  return differs.is_null() ? kDone : kAnswerIsNo;
}

int replay(Session& session, const ReplayOptions& options) {
  ExportConfig config;
  if (!options.heights.empty()) config = {options.heights[0], options.heights[1]};
  if (!(config.lowest <= config.highest)) {
    return fail({Errc::kBadConfig, "--heights: the first must not be above the second"});
  }
  Result<Replay> opened = Replay::open(options.file);
  if (!opened) return fail(opened.error());
  if (!opened->damage().empty()) note(opened->damage());
  if (options.check) return check(session, options, *opened);
  if (options.at) return show_frame(session, options, *opened);

  if (!options.csv.empty() || !options.txt.empty() || !options.sqlite.empty()) {
    if (auto ok = check_has_frames(*opened, options.file); !ok) return fail(ok.error());
  }
  Json written = Json::array();
  const auto done = [&](const std::string& path, const Result<void>& ok) {
    if (ok) written.push_back(path);
    return ok ? 0 : fail(ok.error());
  };
  if (!options.csv.empty()) {
    const auto ok = export_csv(*opened, options.csv, config, session.context);
    if (const int code = done(options.csv, ok)) return code;
  }
  if (!options.txt.empty()) {
    const auto ok = export_juelich(*opened, options.txt, config, session.context);
    if (const int code = done(options.txt, ok)) return code;
  }
  if (!options.sqlite.empty()) {
    Result<Area> area = Area{};
    if (has_sqlite()) area = area_of(session, options, *opened, config);
    if (!area) return fail(area.error());
    const auto ok = export_sqlite(*opened, area->wkt, options.sqlite, config, session.context);
    if (const int code = done(options.sqlite, ok)) return code;
    if (!area->remark.empty()) note(area->remark);
  }
  const Result<FilmRate> film = film_rate(*opened);
  if (!film) return fail(film.error());
  Json json = info_json(options, *opened, *film);
  std::string text = info_text(json);
  if (!written.empty())
    text += fmt::format("wrote {}\n", fmt::join(written.get<std::vector<std::string>>(), ", "));
  json["written"] = written;
  print_result(session, json, text);
  return kDone;
}

}  // namespace

void add_replay(CLI::App& parser, Session& session) {
  CLI::App* command =
      add_command(parser, session, "replay", "Describe, check and convert a recording",
                  "throng bake builtin:garage -o garage.throng\n"
                  "throng run garage.throng --avatars 200 --steps 50 --record walk.replay\n"
                  "throng replay walk.replay --csv walk.csv --txt walk.txt\n"
                  "throng replay walk.replay --check");
  const auto options = std::make_shared<ReplayOptions>();
  command->add_option("file", options->file, "Recording")->required()->type_name("FILE.replay");
  add_output(*command, session, "--csv", options->csv,
             "Write positions as `run --trajectories` does")
      ->type_name("FILE.csv");
  add_output(*command, session, "--txt", options->txt,
             "Write positions as text of the Juelich format")
      ->type_name("FILE.txt");
  add_output(*command, session, "--sqlite", options->sqlite,
             "Write positions and walkable area for JuPedSim")
      ->type_name("FILE.sqlite");
  command->add_option("--heights", options->heights, "Only avatars and floors between these [m]")
      ->expected(2)
      ->type_name("LOW HIGH");
  command->add_option("--class", options->avatar_class,
                      "Class of the walkable area in --sqlite (the recording's first)");
  command->add_option("--at", options->at, "Print the positions at this time [s]");
  command->add_flag("--check", options->check, "Run it again and name the first step that differs");
  command->add_option("--world", options->world, "World folder, if it is not where it was")
      ->type_name("WORLD");
  add_threads(*command, options->workers, "Threads of --check, 0 for all cores");
  command->add_flag_callback(
      "--info", [] {}, "Print what the recording holds (done in any case)");
  command->callback([&session, options] { session.exit_code = replay(session, *options); });
}

}  // namespace throng::app
