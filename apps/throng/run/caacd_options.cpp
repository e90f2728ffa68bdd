// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "run/caacd_options.h"

#include <fmt/format.h>

#include <array>
#include <charconv>

// Reads them; nothing is guessed.
namespace throng::app {

// "2.0/0.4/0.06"
Result<caacd::ParameterSet> parse_set(const std::string& text) {
  std::array<double, 3> values{};
  const char* at = text.data();
  const char* const end = text.data() + text.size();
  for (size_t i = 0; i < values.size(); ++i) {
    const auto [next, error] = std::from_chars(at, end, values[i]);
    const bool last = i + 1 == values.size();
    if (error != std::errc() || (last ? next != end : next == end || *next != '/')) {
      return Error{Errc::kBadConfig,
                   fmt::format("--set {}: write MASS/SPEED/FORCE, as in 2.0/0.4/0.06", text)};
    }
    at = next + 1;
  }
  return caacd::ParameterSet{values[0], values[1], values[2]};
}

Result<caacd::Order> parse_order(const std::string& word) {
  if (word == "time") return caacd::Order::kTime;
  if (word == "state") return caacd::Order::kState;
  return Error{Errc::kBadConfig, fmt::format("--order {}: choose from state, time", word)};
}

Result<FlyerAxes> parse_axes(const std::string& word) {
  for (const FlyerAxes axes : {FlyerAxes::kOurs, FlyerAxes::kSide, FlyerAxes::kSideAndUp}) {
    if (word == word_for(axes)) return axes;
  }
  return Error{Errc::kBadConfig,
               fmt::format("--axes {}: choose from ours, side, side-and-up", word)};
}

const char* word_for(FlyerAxes axes) {
  switch (axes) {
    case FlyerAxes::kOurs:
      return "ours";
    case FlyerAxes::kSide:
      return "side";
    case FlyerAxes::kSideAndUp:
      return "side-and-up";
  }
  return "";
}

Result<SetChange> parse_set_change(const std::string& text) {
  const Error bad{Errc::kBadConfig,
                  fmt::format("--set-at {}: write STEP:MASS/SPEED/FORCE, or "
                              "STEP:AVATAR:MASS/SPEED/FORCE, as in 100:17:2.0/0.4/0.06",
                              text)};
  SetChange change;
  const size_t first = text.find(':'), last = text.rfind(':');
  if (first == std::string::npos) return bad;
  const auto read = [&text](size_t from, size_t to, auto& value) {
    const auto [next, error] = std::from_chars(text.data() + from, text.data() + to, value);
    return error == std::errc() && next == text.data() + to;
  };
  if (!read(0, first, change.step)) return bad;
  if (last > first && !read(first + 1, last, change.avatar.emplace())) return bad;
  const auto set = parse_set(text.substr(last + 1));
  if (!set) return bad;
  change.set = *set;
  return change;
}

void add_curve_options(CLI::App& command, CurveWords& words) {
  command
      .add_option("--set", words.set,
                  "Of the model caacd: its Mass/MaxSpeed/MaxForce (2.0/0.4/0.06, its best)")
      ->type_name("M/V/F");
  command
      .add_option("--order", words.order,
                  "Of the model caacd, most urgent: the threat that comes first (time), or "
                  "collisions before critical threats before alerts (state)")
      ->type_name("time|state");
  command
      .add_option("--axes", words.axes,
                  "Of the model caacd, avatars in the air: avoid to a side, to a side and up or "
                  "down, or as with other models (ours, if not given)")
      ->type_name("ours|side|side-and-up");
}

Result<void> read_curves(const CurveWords& words, SteeringModel model, CrowdTuning& tuning) {
  if (words.set.empty() && words.order.empty() && words.axes.empty()) return {};
  if (model != SteeringModel::kCurvilinear) {
    return Error{Errc::kBadConfig, "--set, --order and --axes are of [CAACD]; add --model caacd"};
  }
  if (!words.set.empty()) {
    const auto set = parse_set(words.set);
    if (!set) return set.error();
    tuning.curvilinear.mass = set->mass;
    tuning.curvilinear.max_speed = set->max_speed;
    tuning.curvilinear.max_force = set->max_force;
  }
  if (!words.order.empty()) {
    const auto order = parse_order(words.order);
    if (!order) return order.error();
    tuning.curvilinear.by_state = *order == caacd::Order::kState;
  }
  if (words.axes.empty()) return {};
  const auto axes = parse_axes(words.axes);
  if (!axes) return axes.error();
  tuning.flyer_axes = *axes;
  return {};
}

}  // namespace throng::app
