// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "import/scene_config.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <numbers>

#include "core/files/read_file.h"

namespace throng {
namespace {

// Either `rows`, the matrix itself, or scale, then a turn about the vertical, then a shift.
Result<Transform> read_transform(const ConfigNode& table, const std::string& name,
                                 const std::string& what) {
  Transform out;
  ConfigReader reader(name, table, what + ": transform");
  reader.only({"rows", "translate", "rotate_y", "scale"});
  if (const ConfigNode* rows = reader.find("rows"); rows != nullptr) {
    if (table.entries.size() > 1) reader.fail(*rows, "rows stand alone: drop the other keys");
    bool good = rows->kind == ConfigNode::Kind::kArray && rows->items.size() == 3;
    for (size_t i = 0; good && i < 3; ++i) {
      const ConfigNode& row = rows->items[i];
      good = row.kind == ConfigNode::Kind::kArray && row.items.size() == 4;
      for (size_t j = 0; good && j < 4; ++j) {
        good = row.items[j].kind == ConfigNode::Kind::kNumber && std::isfinite(row.items[j].number);
        out.m[i][j] = row.items[j].number;
      }
    }
    if (!good) reader.fail(*rows, "rows must be 3 lists of 4 numbers");
  } else {
    double degrees = 0;
    double scale = 1;
    double shift[3] = {0, 0, 0};
    reader.number("rotate_y", degrees, -360, 360);
    reader.number("scale", scale, 1e-6, 1e6);
    reader.numbers("translate", shift, 3);
    // Quarter turns stay exact; other angles to 12 digits, the same on every machine.
    const auto round = [](double value) { return std::round(value * 1e12) / 1e12; };
    const double c = round(std::cos(degrees * std::numbers::pi / 180)) * scale;
    const double s = round(std::sin(degrees * std::numbers::pi / 180)) * scale;
    out.m = {{{c, 0, s, shift[0]}, {0, scale, 0, shift[1]}, {-s, 0, c, shift[2]}}};
  }
  if (!reader.ok()) return reader.error();
  return out;
}

Result<SceneSource> read_source(const ConfigNode& table, const std::string& name,
                                const std::string& folder, size_t index) {
  SceneSource source;
  ConfigReader reader(name, table, fmt::format("source {}", index));
  reader.require("path");
  reader.only({"path", "up", "scale", "transform"});
  std::string up;
  double scale = 1;
  reader.text("path", source.path);
  reader.text("up", up);
  reader.number("scale", scale, 1e-6, 1e6);
  if (reader.find("scale") != nullptr) source.scale = scale;
  if (const ConfigNode* node = reader.find("up"); node != nullptr && up != "y" && up != "z") {
    reader.fail(*node, "up must be \"y\" or \"z\"");
  }
  if (!up.empty()) source.up = up.front();
  if (source.path.empty() && reader.find("path") != nullptr) {
    reader.fail(*reader.find("path"), "path is empty");
  }
  if (!reader.ok()) return reader.error();
  if (const ConfigNode* node = reader.find("transform"); node != nullptr) {
    const auto transform = read_transform(*node, name, fmt::format("source {}", index));
    if (!transform) return transform.error();
    source.transform = *transform;
  }
  source.path = (std::filesystem::path(folder) / source.path).string();
  return source;
}

// "walkable", "blocked", "ignored" or a user's number.
void read_kind(ConfigReader& reader, AreaKind& out) {
  const ConfigNode* kind = reader.find("kind");
  if (kind == nullptr) return;
  const std::string wrong = fmt::format(
      "kind must be \"walkable\", \"blocked\", \"ignored\" or a number from 2 to {}", kAreaLast);
  if (kind->kind == ConfigNode::Kind::kString) {
    if (kind->text == "walkable")
      out = kAreaWalkable;
    else if (kind->text == "blocked")
      out = kAreaBlocked;
    else if (kind->text == "ignored")
      out = kAreaIgnored;
    else
      reader.fail(*kind, wrong);
  } else if (kind->kind == ConfigNode::Kind::kNumber && kind->number >= 2 &&
             kind->number <= kAreaLast && kind->number == std::floor(kind->number)) {
    out = static_cast<AreaKind>(kind->number);
  } else {
    reader.fail(*kind, wrong);
  }
}

Result<AreaRule> read_rule(const ConfigNode& table, const std::string& name, size_t index) {
  AreaRule rule;
  ConfigReader reader(name, table, fmt::format("rule {}", index));
  reader.require("kind");
  reader.only({"material", "node", "kind"});
  reader.text("material", rule.material);
  reader.text("node", rule.node);
  read_kind(reader, rule.kind);
  if (rule.material.empty() && rule.node.empty()) {
    reader.fail(table, "needs a pattern: material or node (\"*\" for all)");
  }
  if (!reader.ok()) return reader.error();
  return rule;
}

Result<AreaVolume> read_volume(const ConfigNode& table, const std::string& name, size_t index) {
  AreaVolume volume;
  ConfigReader reader(name, table, fmt::format("volume {}", index));
  for (const char* key : {"kind", "corners", "low", "high"}) reader.require(key);
  reader.only({"kind", "corners", "low", "high"});
  read_kind(reader, volume.kind);
  reader.number("low", volume.prism.low, -1e6, 1e6);
  reader.number("high", volume.prism.high, -1e6, 1e6);
  if (const ConfigNode* corners = reader.find("corners"); corners != nullptr) {
    bool good = corners->kind == ConfigNode::Kind::kArray;
    for (size_t i = 0; good && i < corners->items.size(); ++i) {
      const ConfigNode& corner = corners->items[i];
      good = corner.kind == ConfigNode::Kind::kArray && corner.items.size() == 2 &&
             corner.items[0].kind == ConfigNode::Kind::kNumber &&
             corner.items[1].kind == ConfigNode::Kind::kNumber;
      if (good) volume.prism.corners.push_back({corner.items[0].number, corner.items[1].number});
    }
    if (!good) reader.fail(*corners, "corners must be a list of [x, z]");
  }
  if (!reader.ok()) return reader.error();
  if (const auto fine = check_prism(volume.prism); !fine) reader.fail(table, fine.error().message);
  if (!reader.ok()) return reader.error();
  return volume;
}

}  // namespace

Result<SceneConfig> importer::read_scene_config(const ConfigNode& root, const std::string& name,
                                                const std::string& folder) {
  SceneConfig config;
  ConfigReader top(name, root, "scene");
  top.only({"source", "rule", "volume", "plan_height", "curve_tolerance"});
  top.number("plan_height", config.plan_height, 0.01, 1000);
  top.number("curve_tolerance", config.curve_tolerance, 1e-4, 10);
  for (const ConfigNode* table : top.tables("source")) {
    auto source = read_source(*table, name, folder, config.sources.size() + 1);
    if (!source) return source.error();
    config.sources.push_back(*std::move(source));
  }
  for (const ConfigNode* table : top.tables("rule")) {
    auto rule = read_rule(*table, name, config.rules.size() + 1);
    if (!rule) return rule.error();
    config.rules.push_back(*std::move(rule));
  }
  for (const ConfigNode* table : top.tables("volume")) {
    auto volume = read_volume(*table, name, config.volumes.size() + 1);
    if (!volume) return volume.error();
    config.volumes.push_back(*std::move(volume));
  }
  if (!top.ok()) return top.error();
  return config;
}

Result<SceneConfig> load_scene_config(const std::string& path) {
  const auto text = read_file(path);
  if (!text) return text.error();
  const auto root = parse_config(*text, path);
  if (!root) return root.error();
  return importer::read_scene_config(*root, path,
                                     std::filesystem::path(path).parent_path().string());
}

}  // namespace throng
