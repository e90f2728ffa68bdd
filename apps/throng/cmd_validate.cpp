// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "command.h"
#include "throng/validation.h"

// throng validate: what is known of real crowds, tried on ours.
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
  return {
      {"test", test.name}, {"title", test.title}, {"method", test.method}, {"source", test.source}};
}

Json result_json(const ValidationTest& test, const ValidationResult& result) {
  Json json = test_json(test);
  json["passed"] = result.passed();
  json["measures"] = Json::array();
  for (const ValidationMeasure& m : result.measures) json["measures"].push_back(measure_json(m));
  json["charts"] = Json::array();
  for (const ValidationChart& c : result.charts) json["charts"].push_back(c.name);
  json["overlaps"] = result.faults.overlaps;
  json["wall_entries"] = result.faults.wall_entries;
  json["looks"] = result.looks;
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
      fmt::format("  {} overlaps, {} wall entries in {} looks; {:.0f} s simulated in {:.1f} s\n",
                  result.faults.overlaps, result.faults.wall_entries, result.looks,
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

void print_list(const Session& session, const std::vector<ValidationTest>& tests) {
  Json json = {{"tests", Json::array()}};
  std::string text;
  for (const ValidationTest& test : tests) {
    json["tests"].push_back(test_json(test));
    text += fmt::format("{:20} {}\n{:20} {}\n", test.name, test.title, "", test.source);
  }
  print_result(session, json, text);
}

int run(const ValidateOptions& options, Session& session) {
  const std::vector<ValidationTest> tests = validation_tests();
  if (options.list) {
    print_list(session, tests);
    return kDone;
  }
  std::vector<std::string> names = options.names;
  if (names.empty()) {
    for (const ValidationTest& test : tests) names.push_back(test.name);
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
  for (size_t i = 0; i < names.size(); ++i) {
    show_progress(session, "validate", i, names.size());
    const auto result = run_validation(names[i], options.config, session.context);
    if (!result) return fail(result.error());
    const auto test = std::ranges::find(tests, names[i], &ValidationTest::name);
    passed = passed && result->passed();
    json["tests"].push_back(result_json(*test, *result));
    text += result_text(*test, *result);
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
                                  "Try what is known of real crowds: exit code 1 if a test fails",
                                  "throng validate --list");
  command->add_option("test", options->names, "Tests to run; all if none is named");
  command->add_flag("--list", options->list, "Say what tests there are, and run none");
  command->add_flag("--brief", options->config.brief, "Fewer points and shorter runs");
  command->add_option("-o,--output", options->folder, "Folder for charts, PNG");
  command->add_option("--seed", options->config.seed)->capture_default_str();
  command->add_option("--threads", options->config.workers, "0: all cores")
      ->check(CLI::Range(0, 1024));
  command->callback([options, &session] { session.exit_code = run(*options, session); });
}

}  // namespace throng::app
