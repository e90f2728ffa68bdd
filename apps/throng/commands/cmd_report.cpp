// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <memory>
#include <optional>
#include <string>

#include "command.h"
#include "input_file.h"
#include "output_file.h"
#include "report/report_page.h"
#include "run/rerun.h"
#include "throng/recording.h"

// throng report: a recording in numbers and pictures, on one page.
namespace throng::app {
namespace {

constexpr double kLineTolerance = 1.5;  // vertical, of --line with a height [m]

struct ReportOptions {
  std::string file;
  std::string output;
  std::string pictures;
  std::vector<std::string> lines;
  SummaryConfig config;
};

// X0,Z0,X1,Z1 or X0,Z0,X1,Z1,Y.
Result<FlowLine> parse_line(const std::string& text) {
  std::vector<double> values;
  const char* at = text.data();
  const char* const end = at + text.size();
  bool good = true;
  while (good && at != end) {
    double value = 0;
    const auto [next, error] = std::from_chars(at, end, value);
    good = error == std::errc() && (next == end || (*next == ',' && next + 1 != end));
    values.push_back(value);
    at = next == end ? end : next + 1;
  }
  if (!good || (values.size() != 4 && values.size() != 5)) {
    return Error{
        Errc::kBadConfig,
        fmt::format("--line {}: not a line; write X0,Z0,X1,Z1 or X0,Z0,X1,Z1,Y in metres", text)};
  }
  FlowLine line{.x0 = values[0], .z0 = values[1], .x1 = values[2], .z1 = values[3]};
  if (values.size() == 5) {
    line.lowest = values[4] - kLineTolerance;
    line.highest = values[4] + kLineTolerance;
  }
  return line;
}

// By name, as `throng run` prints them; empty if the recording has none.
Json obstacles_of(const Replay& replay) {
  Json found = Json::object();
  const Json outcome = Json::parse(replay.outcome(), nullptr, /*allow_exceptions=*/false);
  if (!outcome.is_object() || !outcome.contains("obstacles")) return found;
  const Json& obstacles = outcome["obstacles"];
  if (!obstacles.is_object()) return found;
  for (const auto& [name, times] : obstacles.items()) {
    if (times.is_object()) found[name] = times;
  }
  return found;
}

ReportText report_text(const ReportOptions& options, const Replay& replay,
                       const ReplaySummary& summary) {
  const RecordingInfo& info = replay.info();
  ReportText text{.title = options.file, .numbers = {}, .settings = {}};
  const auto number = [&](const std::string& name, const std::string& value) {
    text.numbers.emplace_back(name, value);
  };
  const auto setting = [&](const std::string& name, const std::string& value) {
    text.settings.emplace_back(name, value);
  };
  number("time", fmt::format("{:g} to {:g} s, {} frames", summary.time.front(), summary.time.back(),
                             summary.time.size()));
  number("avatars",
         fmt::format("{} at first, {} at most, {} at last", summary.present.front(),
                     *std::ranges::max_element(summary.present), summary.present.back()));
  number("came, left", fmt::format("{}, {}", summary.entered.back(), summary.left.back()));
  if (summary.left.back() > 0) number("last one left", fmt::format("{:g} s", summary.last_left));
  number("mean speed", fmt::format("{:.3f} m/s", summary.mean_speed));
  number("waited, in total",
         fmt::format("{:.1f} s below {:g} m/s", summary.waited, options.config.slow));
  const double seconds = summary.time.back() - summary.time.front();
  for (size_t l = 0; l < summary.lines.size(); ++l) {
    const LineFlow& flow = summary.lines[l];
    const FlowLine& line = options.config.lines[l];
    const double width = std::hypot(line.x1 - line.x0, line.z1 - line.z0);
    const auto rate = [&](uint64_t count) {
      return seconds > 0 ? static_cast<double>(count) / (seconds * width) : 0;
    };
    number(fmt::format("line {} ({})", l + 1, options.lines[l]),
           fmt::format("{} to the right ({:.3f} a metre and second), {} to the left ({:.3f})",
                       flow.total_forth, rate(flow.total_forth), flow.total_back,
                       rate(flow.total_back)));
  }
  const Json obstacles = obstacles_of(replay);
  for (const auto& [name, times] : obstacles.items()) {
    const auto words = times.find("words");
    if (words != times.end() && words->is_string() && *words != "") {
      number("obstacle " + name, words->get<std::string>());
    }
  }
  setting("world", fmt::format("{} ({:016x})", info.world, info.world_hash));
  setting("model", info.model);
  setting("step", fmt::format("{:g} s", info.dt));
  const Json settings = Json::parse(info.settings, nullptr, /*allow_exceptions=*/false);
  if (settings.is_object()) {
    for (const auto& [key, value] : settings.items()) setting(key, value.dump());
  }
  for (const RecordedClass& c : info.classes) {
    setting("class " + c.name, fmt::format("{:g} m high, radius {:g} m", c.height, c.radius));
  }
  setting("recording", replay.damage().empty() ? "complete" : replay.damage());
  return text;
}

Json run_json(const ReportOptions& options, const Replay& replay, const ReplaySummary& summary) {
  Json lines = Json::array();
  for (size_t l = 0; l < summary.lines.size(); ++l) {
    lines.push_back({{"line", options.lines[l]},
                     {"right", summary.lines[l].total_forth},
                     {"left", summary.lines[l].total_back}});
  }
  return {{"file", options.file},
          {"output", options.output},
          {"frames", summary.time.size()},
          {"first_time", summary.time.front()},
          {"last_time", summary.time.back()},
          {"positions", summary.positions},
          {"came", summary.entered.back()},
          {"left", summary.left.back()},
          {"last_left", summary.last_left},
          {"mean_speed", summary.mean_speed},
          {"waited", summary.waited},
          {"lines", lines},
          {"obstacles", obstacles_of(replay)},
          {"storeys", summary.maps.size()}};
}

int report(Session& session, ReportOptions& options) {
  for (const std::string& text : options.lines) {
    const Result<FlowLine> line = parse_line(text);
    if (!line) return fail(line.error());
    options.config.lines.push_back(*line);
  }
  Result<Replay> replay = Replay::open(options.file);
  if (!replay) return fail(replay.error());
  if (auto ok = check_has_frames(*replay, options.file); !ok) return fail(ok.error());
  const Result<ReplaySummary> summary = summarise(*replay, options.config, session.context);
  if (!summary) return fail(summary.error());
  const auto pictures = draw_report(*summary, options.config);
  if (!pictures) return fail(pictures.error());
  const Result<std::string> page = report_page(report_text(options, *replay, *summary), *pictures);
  if (!page) return fail(page.error());
  if (!options.pictures.empty()) {
    for (const ReportPicture& picture : *pictures) {
      const std::string path = options.pictures + "_" + picture.name + ".png";
      if (const auto ok = write_png(picture.image, path); !ok) return fail(ok.error());
    }
  }
  OutputFile file;
  if (const auto ok = file.open(options.output); !ok) return fail(ok.error());
  file.write(*page);
  if (const auto ok = file.finish(); !ok) return fail(ok.error());
  if (!replay->damage().empty()) note(replay->damage());
  print_result(session, run_json(options, *replay, *summary),
               fmt::format("{}: {} frames, {} pictures; mean speed {:.3f} m/s, {} left\n",
                           options.output, summary->time.size(), pictures->size(),
                           summary->mean_speed, summary->left.back()));
  return kDone;
}

}  // namespace

void add_report(CLI::App& parser, Session& session) {
  CLI::App* command =
      add_command(parser, session, "report", "Sum a recording up on one page of HTML",
                  "throng bake builtin:garage -o garage.throng\n"
                  "throng run garage.throng --avatars 200 --steps 100 --record walk.replay\n"
                  "throng report walk.replay -o report.html --line 10,20,30,20,0");
  const auto options = std::make_shared<ReportOptions>();
  SummaryConfig& config = options->config;
  command->add_option("file", options->file, "Recording")->required()->type_name("FILE.replay");
  add_output(*command, session, "-o,--output", options->output, "Page to write")
      ->required()
      ->type_name("FILE.html");
  command
      ->add_option("--line", options->lines,
                   "Count crossings of this line, near height Y if it is given; may be repeated")
      ->type_name("X0,Z0,X1,Z1[,Y]");
  command->add_option("--bin", config.bin, "Bins of the flows [s]")->capture_default_str();
  command->add_option("--cell", config.cell, "Cells of the maps [m]")->capture_default_str();
  command->add_option("--storey", config.storey, "Height of a storey: a map for each [m]")
      ->capture_default_str();
  command->add_option("--slow", config.slow, "An avatar waits if it is slower [m/s]")
      ->capture_default_str();
  command->add_option("--png", options->pictures, "Write the pictures as NAME_*.png, too")
      ->type_name("NAME");
  command->callback([&session, options] { session.exit_code = report(session, *options); });
}

}  // namespace throng::app
