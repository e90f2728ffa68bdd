// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "core/files/config_file.h"
#include "core/files/read_file.h"
#include "throng/scenario.h"

// Reads the tables [trial] and [[measure]] of a scenario file, which takes time linear in the text.
// Keys and names of former versions are accepted.
namespace throng {
namespace {

using Kind = ConfigNode::Kind;

struct ObservedName {
  const char* name;
  Observed of;
};
constexpr ObservedName kObserved[] = {
    {"time", Observed::kTime},
    {"left", Observed::kLeft},
    {"premovement", Observed::kPremovement},
    {"delay", Observed::kDelay},
    {"desired_speed", Observed::kDesiredSpeed},
    {"speed", Observed::kSpeed},
    {"people", Observed::kPeople},
    {"stayed", Observed::kStayed},
    {"density", Observed::kDensity},
    {"flow", Observed::kFlow},
    {"passed", Observed::kPassed},
    {"ratio", Observed::kRatio},
    {"difference", Observed::kDifference},
    {"rise", Observed::kRise},
};

struct StatisticName {
  const char* name;
  Statistic statistic;
};
constexpr StatisticName kStatistics[] = {
    {"mean", Statistic::kMean},   {"min", Statistic::kMin},         {"max", Statistic::kMax},
    {"range", Statistic::kRange}, {"overall", Statistic::kOverall}, {"fit", Statistic::kFit}};

// Names of former versions, and what they are called now.
struct FormerName {
  const char* former;
  const char* name;
};
constexpr FormerName kFormerNames[] = {
    {"wish", "desired_speed"}, {"least", "min"}, {"most", "max"}, {"spread", "range"}};

// A measure's table with the present key `statistic`, where it has the former key `take` alone.
ConfigNode with_present_keys(const ConfigNode& table) {
  ConfigNode out = table;
  if (out.find("statistic") != nullptr) return out;
  for (ConfigEntry& entry : out.entries) {
    if (entry.name == "take") entry.name = "statistic";
  }
  return out;
}

// The index of a text among names; fails with all of them.
template <class Names>
size_t pick(ConfigReader& r, const char* key, const Names& names) {
  std::string text = names[0].name, known;
  r.text(key, text);
  for (const FormerName& known_as : kFormerNames) {
    if (text == known_as.former) text = known_as.name;
  }
  for (size_t i = 0; i < std::size(names); ++i) {
    if (text == names[i].name) return i;
    known += (i == 0 ? "" : ", ") + std::string(names[i].name);
  }
  if (r.ok()) r.fail(*r.find(key), fmt::format("{} must be one of: {}", key, known));
  return 0;
}

// The indices of a name, or of a list of names, among things of a scenario.
template <class Thing>
void names_of(ConfigReader& r, const char* key, const std::vector<Thing>& things,
              std::vector<int32_t>& out) {
  const ConfigNode* node = r.find(key);
  if (node == nullptr) return;
  std::vector<const ConfigNode*> given;
  if (node->kind == Kind::kArray) {
    for (const ConfigNode& item : node->items) given.push_back(&item);
  } else {
    given.push_back(node);
  }
  if (given.empty()) return r.fail(*node, fmt::format("{}: the list of names is empty", key));
  for (const ConfigNode* item : given) {
    const auto found = std::ranges::find_if(things, [&](const Thing& thing) {
      return item->kind == Kind::kString && thing.name == item->text;
    });
    if (found == things.end()) {
      std::string known;
      for (const Thing& thing : things) known += (known.empty() ? "" : ", ") + thing.name;
      return r.fail(*item, fmt::format("{}: there is no '{}'; there are: {}", key, item->text,
                                       known.empty() ? "none" : known));
    }
    out.push_back(static_cast<int32_t>(found - things.begin()));
  }
}

bool is_per_person(Observed of) {
  return of == Observed::kTime || of == Observed::kLeft || of == Observed::kPremovement ||
         of == Observed::kDelay || of == Observed::kDesiredSpeed || of == Observed::kSpeed;
}
bool is_of_others(Observed of) {
  return of == Observed::kRatio || of == Observed::kDifference || of == Observed::kRise;
}

void read_line(ConfigReader& r, TrialMeasure& m) {
  const ConfigNode* node = r.find("line");
  if (node == nullptr) return r.fail(r.table(), "give it a line = [[x, z], [x, z]]");
  bool good = node->kind == Kind::kArray && node->items.size() == 2;
  for (size_t i = 0; good && i < 2; ++i) {
    const ConfigNode& p = node->items[i];
    good = p.kind == Kind::kArray && p.items.size() == 2;
    for (size_t k = 0; good && k < 2; ++k) {
      good = p.items[k].kind == Kind::kNumber && std::isfinite(p.items[k].number);
      m.line[i][k] = p.items[k].number;
    }
  }
  if (!good || m.line[0] == m.line[1]) r.fail(*node, "line must be two different [x, z]");
}

// The indices of the measures before this one that are named.
void read_others(ConfigReader& r, const Trial& trial, TrialMeasure& m) {
  std::vector<int32_t> others;
  r.require("others");
  names_of(r, "others", trial.measures, others);
  m.others.assign(others.begin(), others.end());
  if (!r.ok()) return;
  if (m.of == Observed::kRise ? m.others.size() < 2 : m.others.size() != 2) {
    r.fail(*r.find("others"), "name two measures that stand before this one");
  }
}

void read_measure(ConfigReader& r, Trial& trial) {
  TrialMeasure m;
  const Scenario& s = trial.scenario;
  r.only({"name", "of", "statistic", "source", "profile", "journey", "exit", "area", "line", "by",
          "from", "until", "others", "low", "high"});
  r.require("name");
  r.require("of");
  r.text("name", m.name);
  m.of = kObserved[pick(r, "of", kObserved)].of;
  m.statistic = kStatistics[pick(r, "statistic", kStatistics)].statistic;
  names_of(r, "source", s.sources, m.sources);
  names_of(r, "profile", s.profiles, m.profiles);
  names_of(r, "journey", s.journeys, m.journeys);
  names_of(r, "exit", s.areas, m.exits);
  std::vector<int32_t> area;
  names_of(r, "area", s.areas, area);
  if (!area.empty()) m.area = area.front();
  r.number("from", m.from, 0, 1e9);
  r.number("until", m.until, 0, 1e9);
  r.number("low", m.low, -1e9, 1e9);
  r.number("high", m.high, -1e9, 1e9);
  std::string by;
  r.text("by", by);
  m.by_width = by == "width";
  if (!r.ok()) return;
  const auto refuse = [&](const char* key, const std::string& why) {
    if (r.ok() && r.find(key) != nullptr) r.fail(*r.find(key), why);
  };
  if (!by.empty() && (!m.by_width || m.of != Observed::kFlow)) {
    refuse("by", "only a flow is by \"width\"");
  }
  if (m.low > m.high) refuse("low", "low must not be above high");
  if (!(m.from < m.until)) refuse("until", "until must be after from");
  if (std::ranges::any_of(trial.measures, [&](const auto& o) { return o.name == m.name; })) {
    refuse("name", "the name stands here twice");
  }
  if (m.statistic == Statistic::kOverall && m.of != Observed::kSpeed) {
    refuse("statistic", "only a speed has an overall value");
  }
  if (m.statistic == Statistic::kFit && m.of != Observed::kPremovement &&
      m.of != Observed::kDesiredSpeed && m.of != Observed::kSpeed) {
    refuse("statistic", "only what the scenario draws can fit: premovement, desired_speed, speed");
  }
  const bool has_distribution =
      m.of == Observed::kPremovement ? m.sources.size() == 1 : m.profiles.size() == 1;
  if (m.statistic == Statistic::kFit && !has_distribution) {
    refuse("statistic", "a fit needs one source for premovement, or one profile for a speed");
  }
  if (!is_per_person(m.of) && m.of != Observed::kDensity) {
    refuse("statistic", "there is one number only, and no statistic of it");
  }
  const bool has_area = m.of == Observed::kSpeed || m.of == Observed::kDensity;
  if (!has_area) refuse("area", "only a speed or a density is of an area");
  if (m.of == Observed::kDensity && m.area < 0) r.fail(r.table(), "a density needs an area");
  if (m.of == Observed::kFlow || m.of == Observed::kPassed) {
    if (r.ok()) read_line(r, m);
  } else {
    refuse("line", "only flow and passed are over a line");
  }
  if (is_of_others(m.of)) {
    if (r.ok()) read_others(r, trial, m);
  } else {
    refuse("others", "only ratio, difference and rise are of other measures");
  }
  trial.measures.push_back(std::move(m));
}

}  // namespace

Result<Trial> parse_trial(const std::string& text, const std::string& name) {
  const auto root = parse_config(text, name);
  if (!root) return root.error();
  Trial trial;
  trial.about.name = std::filesystem::path(name).stem().string();
  trial.about.title = trial.about.name;
  trial.about.method = "";
  if (const ConfigNode* table = root->find("trial"); table != nullptr) {
    ConfigReader r(name, *table, "trial");
    r.only({"name", "title", "source", "method", "note", "lacks"});
    r.text("name", trial.about.name);
    r.text("title", trial.about.title);
    r.text("method", trial.about.method);
    r.text("source", trial.about.source);
    r.text("note", trial.note);
    r.text("lacks", trial.lacks);
    if (!r.ok()) return r.error();
  }
  if (!trial.lacks.empty()) return trial;
  auto scenario = parse_scenario(text, name);
  if (!scenario) return scenario.error();
  trial.scenario = *std::move(scenario);
  ConfigReader top(name, *root, "trial");
  for (const ConfigNode* node : top.tables("measure")) {
    const ConfigNode table = with_present_keys(*node);
    const ConfigNode* called = table.find("name");
    ConfigReader r(name, table,
                   called != nullptr && called->kind == Kind::kString
                       ? fmt::format("measure '{}'", called->text)
                       : "measure");
    read_measure(r, trial);
    if (!r.ok()) return r.error();
  }
  if (!top.ok()) return top.error();
  if (trial.measures.empty()) {
    return Error{Errc::kBadFile,
                 fmt::format("{}: nothing is measured; add a table [[measure]]", name)};
  }
  return trial;
}

Result<Trial> load_trial(const std::string& path) {
  const auto text = read_file(path);
  if (!text) return text.error();
  return parse_trial(*text, path);
}

Result<std::vector<Trial>> load_trials(const std::string& folder) {
  namespace fs = std::filesystem;
  std::error_code failed;
  std::vector<std::string> paths;
  for (fs::recursive_directory_iterator it(folder, failed), end; !failed && it != end;
       it.increment(failed)) {
    if (it->path().extension() == ".toml") paths.push_back(it->path().string());
  }
  if (failed) {
    return Error{Errc::kNotFound, fmt::format("{}: cannot be read: {}", folder, failed.message())};
  }
  std::sort(paths.begin(), paths.end());
  std::vector<Trial> trials;
  for (const std::string& path : paths) {
    auto trial = load_trial(path);
    if (!trial) return trial.error();
    trials.push_back(*std::move(trial));
  }
  return trials;
}

}  // namespace throng
