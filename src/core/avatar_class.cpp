// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/files/classes_file.h"
#include "core/files/config_file.h"
#include "core/files/read_file.h"
#include "throng/avatar.h"

// Limits of avatar classes, the default classes, and lists of classes in TOML and JSON files.
namespace throng {
namespace {

// One row a number: the same limits serve a file (with its line) and a list made in code.
struct Limit {
  const char* key;
  double AvatarClass::*member;
  double low;
  double high;
  const char* unit;
};

constexpr std::array<Limit, 8> kLimits{{
    {"height", &AvatarClass::height, 0.1, 30, "m"},
    {"radius", &AvatarClass::radius, 0.01, 5, "m"},
    {"step", &AvatarClass::step_height, 0, 15, "m"},
    {"max_slope", &AvatarClass::max_slope, 0, 89, "degrees"},
    {"speed", &AvatarClass::speed, 1e-6, 1000, "m/s"},
    {"climb_slope", &AvatarClass::climb_slope, 0, 180, "degrees"},
    {"max_drop", &AvatarClass::max_drop, 0, 1000, "m"},
    {"turning_radius", &AvatarClass::turning_radius, 0, 100, "m"},
}};

// The limit that `avatar` breaks, as words, or nothing.
std::string broken_limit(const AvatarClass& avatar) {
  for (const Limit& limit : kLimits) {
    const double value = avatar.*limit.member;
    if (value >= limit.low && value <= limit.high) continue;  // Written so that NaN is refused.
    return fmt::format("{} = {} is outside {} to {} [{}]", limit.key, value, limit.low, limit.high,
                       limit.unit);
  }
  if (avatar.step_height > avatar.height / 2) {
    return fmt::format("step = {} is more than half the height {}", avatar.step_height,
                       avatar.height);
  }
  if (avatar.max_drop > 0 && avatar.max_drop <= avatar.step_height) {
    return fmt::format("max_drop = {} is no more than the step {}; 0 asks for no drops",
                       avatar.max_drop, avatar.step_height);
  }
  return {};
}

}  // namespace

// In whole micrometres, rounded up: the last bit of tan() differs between machines' libraries.
double body_bottom(const AvatarClass& avatar) {
  const double rise = avatar.radius * std::tan(avatar.max_slope * std::numbers::pi / 180);
  return std::max(avatar.step_height, std::ceil(rise * 1e6 - 1e-3) / 1e6);
}

std::vector<AvatarClass> default_classes() {
  // Ramps of 1 in 12, the steepest for wheelchairs, must be reached at cells of 0.1 m in any
  // direction: at their ends a bake loses what is steeper than about three quarters of the limit.
  // So the limit is a rise of 11 in 100: atan(0.11), as a literal because every machine must agree
  // on it.
  constexpr double kElevenPercent = 6.2772984895975545;
  return {
      AvatarClass{},
      AvatarClass{.name = "child",
                  .height = 1.10,
                  .radius = 0.15,
                  .step_height = 0.3,
                  .max_slope = 45,
                  .speed = 1.1},
      AvatarClass{.name = "wheelchair",
                  .height = 1.35,
                  .radius = 0.3,
                  .step_height = 0.02,
                  .max_slope = kElevenPercent,
                  .speed = 1.0},
      AvatarClass{.name = "giant",
                  .height = 3.0,
                  .radius = 0.5,
                  .step_height = 0.8,
                  .max_slope = 45,
                  .speed = 2.0},
  };
}

AvatarClass flyer_class() { return {.name = "flyer", .radius = 0.4, .speed = 5, .flies = true}; }

Result<void> check_classes(std::span<const AvatarClass> classes) {
  if (classes.empty() || classes.size() > static_cast<size_t>(kMaxAvatarClasses)) {
    return Error{Errc::kBadConfig, fmt::format("avatar classes: need 1 to {}, not {}",
                                               kMaxAvatarClasses, classes.size())};
  }
  for (size_t i = 0; i < classes.size(); ++i) {
    const AvatarClass& avatar = classes[i];
    if (avatar.name.empty()) {
      return Error{Errc::kBadConfig, fmt::format("avatar class {}: needs a name", i + 1)};
    }
    if (const std::string broken = broken_limit(avatar); !broken.empty()) {
      return Error{Errc::kBadConfig, fmt::format("avatar class '{}': {}", avatar.name, broken)};
    }
    for (size_t j = 0; j < i; ++j) {
      if (classes[j].name != avatar.name) continue;
      return Error{Errc::kBadConfig, fmt::format("avatar classes {} and {} are both named '{}'",
                                                 j + 1, i + 1, avatar.name)};
    }
  }
  return {};
}

void read_class(ConfigReader& reader, AvatarClass& avatar) {
  reader.only({"name", "height", "radius", "step", "max_slope", "speed", "climb_slope", "max_drop",
               "turning_radius", "flies"});
  reader.flag("flies", avatar.flies);
  for (const Limit& limit : kLimits) {
    reader.number(limit.key, avatar.*limit.member, limit.low, limit.high);
  }
  if (!reader.ok()) return;
  if (const std::string broken = broken_limit(avatar); !broken.empty()) {
    const bool drops = broken.starts_with("max_drop");
    const ConfigNode* step = reader.find(drops ? "max_drop" : "step");
    reader.fail(step != nullptr ? *step : reader.table(), broken);
  }
}

Result<std::vector<AvatarClass>> read_classes(const ConfigNode& root, const std::string& name) {
  ConfigReader top(name, root, "avatar classes");
  top.only({"class"});
  top.require("class");
  std::vector<AvatarClass> classes;
  for (const ConfigNode* table : top.tables("class")) {
    AvatarClass avatar;
    ConfigReader reader(name, *table, fmt::format("avatar class {}", classes.size() + 1));
    reader.require("name");
    reader.text("name", avatar.name);
    read_class(reader, avatar);
    if (!reader.ok()) return reader.error();
    classes.push_back(avatar);
  }
  if (!top.ok()) return top.error();
  if (const auto checked = check_classes(classes); !checked) {  // Count and names: the whole list.
    return Error{Errc::kBadFile, name + ": " + checked.error().message};
  }
  return classes;
}

Result<std::vector<AvatarClass>> load_classes(const std::string& path) {
  const auto text = read_file(path);
  if (!text) return text.error();
  const auto root = parse_config(*text, path);
  if (!root) return root.error();
  return read_classes(*root, path);
}

}  // namespace throng
