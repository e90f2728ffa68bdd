// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <memory>
#include <numeric>
#include <string>
#include <vector>

#include "command.h"
#include "number_checks.h"
#include "report/caacd_figures.h"
#include "report/caacd_one_run.h"
#include "run/caacd_options.h"
#include "throng/papers.h"
#include "throng/picture.h"

// throng caacd: the experiment of [CAACD] section V, next to the paper's own numbers.
namespace throng::app {
namespace {

using namespace caacd;

struct CaacdOptions {
  StudyConfig study;
  std::vector<std::string> sets;
  std::vector<double> fields;
  std::string trigger = "near", length = "true", order = "time";
  bool grid = false;
  std::string figure10, figure11;
  OneRunFiles one_run;
};

std::vector<int32_t> paper_counts() {
  std::vector<int32_t> counts;
  for (int32_t n = 5; n <= 100; n += 5) counts.push_back(n);
  return counts;
}

template <class T>
Result<T> choose(const std::map<std::string, T>& choices, const std::string& word,
                 const char* option) {
  if (const auto found = choices.find(word); found != choices.end()) return found->second;
  std::string known;
  for (const auto& [name, value] : choices) known += (known.empty() ? "" : ", ") + name;
  return Error{Errc::kBadConfig, fmt::format("{} {}: choose from {}", option, word, known)};
}

// Fills in the options that the parser leaves as text.
Result<void> complete(CaacdOptions& options) {
  StudyConfig& study = options.study;
  if (study.avatars.empty()) study.avatars = paper_counts();
  if (!options.sets.empty()) study.sets.clear();
  for (const std::string& text : options.sets) {
    const Result<ParameterSet> set = parse_set(text);
    if (!set) return set.error();
    study.sets.push_back(*set);
  }
  if (options.grid) {
    for (const ParameterSet& set : grid_sets()) {
      if (std::ranges::find(study.sets, set) == study.sets.end()) study.sets.push_back(set);
    }
  }
  const Result<Trigger> trigger = choose<Trigger>({{"near", Trigger::kNear},
                                                   {"never", Trigger::kNever},
                                                   {"threat", Trigger::kThreat},
                                                   {"zones", Trigger::kZones}},
                                                  options.trigger, "--trigger");
  if (!trigger) return trigger.error();
  study.model.trigger = *trigger;
  const Result<Length> kind = choose<Length>(
      {{"true", Length::kTrue}, {"max-sum", Length::kMaxAndSum}}, options.length, "--length");
  if (!kind) return kind.error();
  study.model.length = *kind;
  const Result<Order> order = parse_order(options.order);
  if (!order) return order.error();
  study.model.order = *order;
  if (!options.fields.empty()) {
    study.space.fields = {options.fields[0], options.fields[1], options.fields[2]};
  }
  return {};
}

Json study_json(const CaacdOptions& options, const Study& study, double seconds) {
  Json json = {{"seeds", options.study.seeds},
               {"frames", options.study.frames},
               {"trigger", options.trigger},
               {"order", options.order},
               {"avatars", study.avatars},
               {"reported", {{"bad", Json::array()}, {"others", Json::array()}}},
               {"sets", Json::array()}};
  for (const int32_t n : study.avatars) {
    json["reported"]["bad"].push_back(reported_collisions(n).bad);
    json["reported"]["others"].push_back(reported_collisions(n).others);
  }
  for (size_t s = 0; s < study.sets.size(); ++s) {
    const ParameterSet& set = study.sets[s];
    Json row = {{"set", name_of(set)},
                {"mass", set.mass},
                {"max_speed", set.max_speed},
                {"max_force", set.max_force}};
    const auto column = [&](const char* name, auto member) {
      row[name] = Json::array();
      for (size_t i = 0; i < study.avatars.size(); ++i) row[name].push_back(study.at(s, i).*member);
    };
    column("mean", &StudyCell::mean);
    column("deviation", &StudyCell::deviation);
    column("min", &StudyCell::min_collisions);
    column("max", &StudyCell::max_collisions);
    column("obstacles", &StudyCell::obstacle_mean);
    column("arrived", &StudyCell::arrived);
    column("waiting", &StudyCell::waiting);
    column("ended_at", &StudyCell::frames);
    column("walked", &StudyCell::walked);
    json["sets"].push_back(std::move(row));
  }
  json["state_hash"] = fmt::format("{:016x}", study.hash);
  json["seconds"] = seconds;
  return json;
}

std::string cell_text(const StudyCell& cell) {
  return fmt::format("{:.1f} +- {:.1f} ({})", cell.mean, cell.deviation, cell.max_collisions);
}

// A column per set, as in the paper's figures.
std::string table_by_avatars(const Study& study) {
  std::string text = "avatars";
  for (const ParameterSet& set : study.sets) text += fmt::format(" {:>20}", name_of(set));
  text += "   [CAACD] bad  others\n";
  for (size_t i = 0; i < study.avatars.size(); ++i) {
    text += fmt::format("{:7}", study.avatars[i]);
    for (size_t s = 0; s < study.sets.size(); ++s) {
      text += fmt::format(" {:>20}", cell_text(study.at(s, i)));
    }
    const Reported paper = reported_collisions(study.avatars[i]);
    text += fmt::format("   {:>11}  {:>6}\n", fmt::format("<= {}", paper.bad),
                        fmt::format("<= {}", paper.others));
  }
  return text;
}

// A row per set, ascending by collisions.
std::string table_by_sets(const Study& study) {
  std::vector<double> sum(study.sets.size());
  for (size_t s = 0; s < sum.size(); ++s) {
    for (size_t i = 0; i < study.avatars.size(); ++i) sum[s] += study.at(s, i).mean;
  }
  std::vector<size_t> order(study.sets.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::ranges::stable_sort(order, {}, [&](size_t s) { return sum[s]; });
  std::string text = fmt::format("{:<16} {:>8}", "set", "sum");
  for (const int32_t n : study.avatars) text += fmt::format(" {:>7}", n);
  text += " avatars\n";
  for (const size_t s : order) {
    text += fmt::format("{:<16} {:8.1f}", name_of(study.sets[s]), sum[s]);
    for (size_t i = 0; i < study.avatars.size(); ++i) {
      text += fmt::format(" {:7.1f}", study.at(s, i).mean);
    }
    text += "\n";
  }
  return text;
}

Result<void> draw(const Chart& chart, const std::string& path) {
  if (path.empty()) return {};
  const Result<Image> image = draw_chart(chart);
  if (!image) return image.error();
  return write_png(*image, path);
}

// Fails if an option of the whole experiment stands beside one of a single run, or --at alone.
Result<void> check_one_run(const CLI::App& command, const OneRunFiles& files) {
  if (command.count("--at") > 0 && files.picture.empty()) {
    return Error{Errc::kBadConfig, "--at is the frame of --figure9; add that, or leave it out"};
  }
  if (!files.any()) return {};
  const char* one = files.picture.empty() ? "--record" : "--figure9";
  for (const char* name : {"--figure10", "--figure11", "--seeds"}) {
    if (command.count(name) == 0) continue;
    return Error{
        Errc::kBadConfig,
        fmt::format("{} is of many runs, and {} of one; leave one of the two out", name, one)};
  }
  return {};
}

int caacd(Session& session, const CLI::App& command, CaacdOptions& options) {
  if (auto ok = check_one_run(command, options.one_run); !ok) return fail(ok.error());
  if (auto ok = complete(options); !ok) return fail(ok.error());
  options.one_run.is_at_given = command.count("--at") > 0;
  if (options.one_run.any()) return run_once(session, options.study, options.one_run);
  if (!std::ranges::is_sorted(options.study.avatars, std::ranges::less_equal{})) {
    return fail({Errc::kBadConfig, "--avatars: write the numbers in ascending order"});
  }
  if (options.study.avatars.size() < 2 && !(options.figure10.empty() && options.figure11.empty())) {
    return fail(
        {Errc::kBadConfig, "--figure10 and --figure11 need at least two numbers of avatars"});
  }
  const auto start = std::chrono::steady_clock::now();
  const Result<Study> study = run_study(options.study, session.context);
  if (!study) return fail(study.error());
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (!options.figure10.empty()) {
    if (auto ok = draw(figure_10(*study, options.study.seeds), options.figure10); !ok) {
      return fail(ok.error());
    }
  }
  if (!options.figure11.empty()) {
    if (auto ok = draw(figure_11(*study, options.study.seeds), options.figure11); !ok) {
      return fail(ok.error());
    }
  }
  constexpr size_t kMaxColumns = 5;
  std::string text = fmt::format(
      "collisions a run over {} seeds, at most {} frames each, {:.1f} s, state {:016x}\n",
      options.study.seeds, options.study.frames, seconds, study->hash);
  if (study->sets.size() <= kMaxColumns) {
    text += "mean +- standard deviation (max), and the max that [CAACD] reports\n";
    text += table_by_avatars(*study);
  } else {
    text += "means, ascending\n" + table_by_sets(*study);
  }
  print_result(session, study_json(options, *study, seconds), text);
  return kDone;
}

}  // namespace

void add_caacd(CLI::App& parser, Session& session) {
  CLI::App* command = add_command(
      parser, session, "caacd", "Repeat the avoidance experiment of [CAACD], section V",
      "throng caacd --avatars 10,30,50 --seeds 4 --figure10 collisions.png\n"
      "throng caacd --set 2.0/0.4/0.06 --avatars 40 --figure9 plane.png --record walk.csv");
  const auto options = std::make_shared<CaacdOptions>();
  StudyConfig& study = options->study;
  Model& model = study.model;
  command
      ->add_option("--avatars", study.avatars, "How many, ascending; 5, 10, ... 100 if not given")
      ->check(between(1, 2000))
      ->delimiter(',')
      ->type_name("N,N,...");
  command->add_option("--seeds", study.seeds, "Runs of each, from different random starts")
      ->check(between(1, 100000))
      ->capture_default_str();
  command->add_option("--seed", study.space.seed, "The first of them")->capture_default_str();
  command
      ->add_option("--set", options->sets,
                   "Mass/MaxSpeed/MaxForce, may be repeated; the paper's three if not given")
      ->delimiter(',')
      ->type_name("M/V/F");
  command->add_flag("--grid", options->grid, "Also 60 sets over the paper's ranges");
  command->add_option("--frames", study.frames, "A run ends here, or when all stand")
      ->check(between(1, 10'000'000))
      ->capture_default_str();
  command
      ->add_option("--trigger", options->trigger,
                   "Avatars to avoid: threats in the alert field (near), all (threat), those whose "
                   "zones meet (zones), none (never)")
      ->capture_default_str();
  command
      ->add_option("--order", options->order,
                   "Most urgent: the threat that comes first (time), or collisions before critical "
                   "threats before alerts (state)")
      ->capture_default_str();
  command->add_option("--length", options->length, "Eq. 10: true, or max-sum as printed")
      ->capture_default_str();
  command->add_option("--t3", model.horizon, "Latest nearest approach to avoid [frames]")
      ->check(above(0))
      ->capture_default_str();
  command->add_option("--lambda1", model.lambda1, "Of eq. 10, with --length max-sum")
      ->check(between(0.5, 1))
      ->capture_default_str();
  command->add_option("--lambda3", model.lambda3, "Of eq. 12 and 13")
      ->check(between(0, 1))
      ->capture_default_str();
  command->add_option("--psi", model.deceleration, "Distance to the target to brake from [units]")
      ->check(above(0))
      ->capture_default_str();
  command
      ->add_option("--zone-time", model.probe_time,
                   "Zones extend this much beyond the precaution field [frames at speed]")
      ->check(at_least(0))
      ->capture_default_str();
  command->add_option("--fields", options->fields, "Radii: repulsive, precaution, alert [units]")
      ->expected(3)
      ->delimiter(',')
      ->type_name("R,P,A")
      ->default_str("5,7.5,12");
  command->add_option("--side", study.space.side, "Of the square of starts and targets [units]")
      ->check(above(0))
      ->capture_default_str();
  command->add_option("--obstacles", study.space.obstacles, "How many")
      ->check(between(0, 1000))
      ->capture_default_str();
  command->add_option("--dt", study.dt, "Step of time [frames]")
      ->check(above(0))
      ->capture_default_str();
  add_threads(*command, study.workers);
  add_output(*command, session, "--figure10", options->figure10,
             "Chart of the paper's bad sets and the mean")
      ->type_name("FILE.png");
  add_output(*command, session, "--figure11", options->figure11, "Chart of all other sets")
      ->type_name("FILE.png");
  add_output(*command, session, "--figure9", options->one_run.picture,
             "One run instead, of the last set and number of avatars: its picture")
      ->type_name("FILE.png");
  command
      ->add_option("--at", options->one_run.at,
                   "Frame of that picture; if not given, the last of a shorter run")
      ->check(at_least(0))
      ->capture_default_str();
  add_output(*command, session, "--record", options->one_run.record, "The same run, frame by frame")
      ->type_name("FILE.csv");
  command->callback(
      [&session, options, command] { session.exit_code = caacd(session, *command, *options); });
}

}  // namespace throng::app
