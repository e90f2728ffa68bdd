// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "command.h"
#include "throng/scenario.h"
#include "trials_folder.h"

// throng validate: tests the crowd against measured and standard behaviour of people.
namespace throng::app {
namespace {

struct ValidateOptions {
  std::vector<std::string> names;
  bool list = false;
  std::string folder;
  ValidationConfig config;
};

Json measure_json(const ValidationMeasure& m) {
  Json json = {{"name", m.name}, {"value", m.value}, {"unit", m.unit}};
  if (std::isfinite(m.low)) json["low"] = m.low;
  if (std::isfinite(m.high)) json["high"] = m.high;
  if (m.is_judged()) json["passed"] = m.passed();
  return json;
}

Json test_json(const ValidationTest& test) {
  Json json = {
      {"test", test.name}, {"title", test.title}, {"method", test.method}, {"source", test.source}};
  if (test.in_work) json["in_work"] = true;
  return json;
}

// One thing to run: a test in code, or a scenario file.
struct Item {
  ValidationTest about;
  std::optional<Trial> trial = {};
  std::string recordings = {};  // Folder; empty: the test needs none.
};

Json item_json(const Item& item) {
  Json json = test_json(item.about);
  if (item.trial && !item.trial->note.empty()) json["note"] = item.trial->note;
  if (item.trial && !item.trial->lacks.empty()) json["lacks"] = item.trial->lacks;
  return json;
}

Json result_json(const Item& item, const ValidationResult& result) {
  Json json = item_json(item);
  json["passed"] = result.passed();
  json["measures"] = Json::array();
  for (const ValidationMeasure& m : result.measures) json["measures"].push_back(measure_json(m));
  json["charts"] = Json::array();
  for (const ValidationChart& c : result.charts) json["charts"].push_back(c.name);
  json["overlaps"] = result.faults.overlaps;
  json["wall_entries"] = result.faults.wall_entries;
  json["obstacle_entries"] = result.faults.obstacle_entries;
  json["checks"] = result.checks;
  json["simulated"] = result.simulated;
  json["seconds"] = result.seconds;
  return json;
}

std::string range_text(const ValidationMeasure& m) {
  if (!m.is_judged()) return "";
  const std::string verdict = m.passed() ? "  ok" : "  MISSED";
  if (!std::isfinite(m.low)) return fmt::format("  at most {:g}{}", m.high, verdict);
  if (!std::isfinite(m.high)) return fmt::format("  at least {:g}{}", m.low, verdict);
  return fmt::format("  {:g} to {:g}{}", m.low, m.high, verdict);
}

std::string result_text(const ValidationTest& test, const ValidationResult& result) {
  std::string text = fmt::format("{}: {}\n", test.name, test.title);
  for (const ValidationMeasure& m : result.measures) {
    text += fmt::format("  {:48} {:9.3f} {:8}{}\n", m.name, m.value, m.unit, range_text(m));
  }
  text +=
      fmt::format("  {} overlaps, {} wall entries in {} checks; {:.0f} s simulated in {:.1f} s\n",
                  result.faults.overlaps, result.faults.wall_entries, result.checks,
                  result.simulated, result.seconds);
  return text + (result.passed() ? "  passed\n" : "  FAILED\n");
}

Result<void> write_charts(const std::string& folder, const ValidationResult& result) {
  for (const ValidationChart& chart : result.charts) {
    const auto picture = draw_chart(chart.chart);
    if (!picture) return picture.error();
    const std::string path = (std::filesystem::path(folder) / (chart.name + ".png")).string();
    if (auto done = write_png(*picture, path); !done) return done.error();
  }
  return {};
}

void print_list(const Session& session, const std::vector<Item>& items) {
  Json json = {{"tests", Json::array()}};
  std::string text;
  for (const Item& item : items) {
    json["tests"].push_back(item_json(item));
    const bool lacks = item.trial && !item.trial->lacks.empty();
    text += fmt::format("{:20} {}\n{:20} {}{}\n", item.about.name, item.about.title, "",
                        lacks ? "not modelled" : item.about.source,
                        item.about.in_work ? "; in work: runs only if it is named" : "");
  }
  print_result(session, json, text);
}

Result<std::vector<Item>> all_items() {
  std::vector<Item> items;
  for (ValidationTest& test : validation_tests()) items.push_back({.about = std::move(test)});
  auto trials = load_trials(trials_folder());
  if (!trials) return trials.error();
  for (Trial& trial : *trials) {
    ValidationTest about = trial.about;
    items.push_back({.about = std::move(about), .trial = std::move(trial)});
  }
  return items;
}

std::optional<ValidationTest> recorded_test(const std::string& word) {
  for (ValidationTest& test : recorded_validation_tests()) {
    if (test.name == word) return std::move(test);
  }
  return {};
}

Result<ValidationResult> run_item(const Item& item, const ValidationConfig& config,
                                  Context& context) {
  if (item.trial) return run_trial(*item.trial, config, context);
  if (item.recordings.empty()) return run_validation(item.about.name, config, context);
  return run_recorded_validation(item.about.name, item.recordings, config, context);
}

// The tests that a word on the command line names: a test, a standard, or a file.
Result<std::vector<Item>> items_named(const std::string& word, const std::vector<Item>& all) {
  if (word.ends_with(".toml") || word.ends_with(".json")) {
    auto trial = load_trial(word);
    if (!trial) return trial.error();
    ValidationTest about = trial->about;
    return std::vector<Item>{{.about = std::move(about), .trial = *std::move(trial)}};
  }
  std::vector<Item> items;
  std::string known;
  for (const Item& item : all) {
    const std::string& name = item.about.name;
    if (name == word || name.starts_with(word + ".")) items.push_back(item);
    known += (known.empty() ? "" : ", ") + name;
  }
  if (items.empty()) {
    return Error{Errc::kNotFound,
                 fmt::format("validate: no test is called {}; name a standard (rimea, nist), a "
                             "scenario file, or one of {}",
                             word, known)};
  }
  return items;
}

int run(const ValidateOptions& options, Session& session) {
  const auto all = all_items();
  if (!all) return fail(all.error());
  if (options.list) {
    std::vector<Item> listed = *all;
    for (ValidationTest& test : recorded_validation_tests()) {
      listed.push_back({.about = std::move(test)});
    }
    print_list(session, listed);
    return kDone;
  }
  std::vector<Item> items;
  if (options.names.empty()) {
    items = *all;
    std::erase_if(items, [](const Item& item) { return item.about.in_work; });
  }
  for (size_t i = 0; i < options.names.size(); ++i) {
    const std::string& word = options.names[i];
    if (const auto test = recorded_test(word)) {
      if (i + 1 == options.names.size()) {
        return fail({Errc::kBadConfig,
                     fmt::format("validate: {0} needs a folder of recordings: throng validate {0} "
                                 "FOLDER",
                                 word)});
      }
      items.push_back({.about = *test, .recordings = options.names[++i]});
      continue;
    }
    const auto named = items_named(word, *all);
    if (!named) return fail(named.error());
    items.insert(items.end(), named->begin(), named->end());
  }
  if (!options.folder.empty()) {
    std::error_code failed;
    std::filesystem::create_directories(options.folder, failed);
    if (failed) {
      return fail(
          {Errc::kIo, fmt::format("{}: cannot be made: {}", options.folder, failed.message())});
    }
  }
  Json json = {{"tests", Json::array()}};
  std::string text;
  bool passed = true;
  for (size_t i = 0; i < items.size(); ++i) {
    const Item& item = items[i];
    show_progress(session, "validate", i, items.size());
    if (item.trial && !item.trial->lacks.empty()) {
      json["tests"].push_back(item_json(item));
      text += fmt::format("{}: {}\n  not modelled: {}\n", item.about.name, item.about.title,
                          item.trial->lacks);
      continue;
    }
    const auto result = run_item(item, options.config, session.context);
    if (!result) return fail(result.error());
    passed = passed && result->passed();
    json["tests"].push_back(result_json(item, *result));
    text += result_text(item.about, *result);
    if (options.folder.empty()) continue;
    if (auto done = write_charts(options.folder, *result); !done) return fail(done.error());
  }
  json["passed"] = passed;
  print_result(session, json, text);
  return passed ? kDone : kAnswerIsNo;
}

}  // namespace

void add_validate(CLI::App& parser, Session& session) {
  auto options = std::make_shared<ValidateOptions>();
  CLI::App* command = add_command(parser, session, "validate",
                                  "Test the crowd against real ones: exit code 1 if a test fails",
                                  "throng validate --list\n"
                                  "throng validate rimea.1 nist.2.1");
  command->add_option(
      "test", options->names,
      "Tests, standards (rimea, nist), scenario files, or a test of recordings and "
      "their folder; all that need no recordings and are not in work if none is named");
  add_model(*command, options->config.model);
  command->add_flag("--list", options->list, "List the tests, and run none");
  command->add_flag("--brief", options->config.brief,
                    "Fewer points and shorter runs; not of scenario files");
  command->add_flag("--pushing", options->config.pushing,
                    "Avatars push instead of queueing, and nothing limits their acceleration");
  add_image_folder(*command, session, "-o,--output", options->folder, "", "Folder for charts, PNG");
  command->add_option("--seed", options->config.seed)->capture_default_str();
  add_threads(*command, options->config.workers);
  command->callback([options, &session] { session.exit_code = run(*options, session); });
}

}  // namespace throng::app
