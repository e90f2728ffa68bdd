// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "view/view_settings.h"

#include <nlohmann/json.hpp>

// Settings as a JSON object.
namespace throng::view {
namespace {

using Json = nlohmann::ordered_json;

void take(const Json& json, const char* name, bool& value) {
  if (json.contains(name) && json[name].is_boolean()) value = json[name].get<bool>();
}

void take(const Json& json, const char* name, double& value, double low, double high) {
  if (!json.contains(name) || !json[name].is_number()) return;
  const auto given = json[name].get<double>();
  if (given >= low && given <= high) value = given;
}

}  // namespace

std::string settings_text(const ViewSettings& s) {
  const Json json = {{"panel", s.panel}, {"shadows", s.shadows},       {"smooth", s.smooth},
                     {"hints", s.hints}, {"only_seen", s.only_seen},   {"coarse_far", s.coarse_far},
                     {"edges", s.edges}, {"view_angle", s.view_angle}, {"fly_speed", s.fly_speed},
                     {"speed", s.speed}, {"layout", s.layout}};
  return json.dump(2) + "\n";
}

Result<ViewSettings> read_settings(const std::string& text) {
  const Json json = Json::parse(text, nullptr, /*allow_exceptions=*/false);
  if (!json.is_object()) {
    return Error{Errc::kBadFile, "the viewer's settings are no JSON object; delete the file"};
  }
  ViewSettings s;
  take(json, "panel", s.panel);
  take(json, "shadows", s.shadows);
  take(json, "smooth", s.smooth);
  take(json, "hints", s.hints);
  take(json, "only_seen", s.only_seen);
  take(json, "coarse_far", s.coarse_far);
  take(json, "edges", s.edges, 0, 1);
  take(json, "view_angle", s.view_angle, 10, 120);
  take(json, "fly_speed", s.fly_speed, 0.1, 1000);
  take(json, "speed", s.speed, 0.05, 16);
  if (json.contains("layout") && json["layout"].is_string()) {
    s.layout = json["layout"].get<std::string>();
  }
  return s;
}

}  // namespace throng::view
