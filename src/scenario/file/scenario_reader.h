// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "core/files/config_file.h"
#include "throng/scenario.h"

/// What the readers of all tables of a scenario file use.
namespace throng::scenario {

inline constexpr double kMaxCoordinate = 1e9;  // [m] as for models

inline bool is_number(const ConfigNode& node) {
  return node.kind == ConfigNode::Kind::kNumber && std::isfinite(node.number);
}

/// Reads one table of the file and resolves the names in it.
class Reader : public ConfigReader {
 public:
  Reader(const std::string& file, const ConfigNode& table, const std::string& what)
      : ConfigReader(file, table, what) {}

  void distribution(const char* key, Distribution& out, double low, double high);
  void distribution_of(const ConfigNode& node, const std::string& key, Distribution& out,
                       double low, double high);
  template <class Thing>
  int32_t named(const ConfigNode& node, const std::vector<Thing>& things, const char* what);
  /// A name or a list of names.
  template <class Thing>
  void names(const ConfigNode& node, const std::vector<Thing>& things, const char* what,
             std::vector<int32_t>& out);
  /// A name, or a table of weights by name.
  template <class Thing>
  void choices(const char* key, const std::vector<Thing>& things, std::vector<Choice>& out);
  bool corners(const ConfigNode& node, const char* key, std::vector<std::array<double, 2>>& out);
  void count(const char* key, uint64_t& value, double low, double high);
  /// The spelling of `key` in this table: `key` itself or `old`, its name in older versions.
  const char* spelling(const char* key, const char* old);
};

template <class Thing>
int32_t Reader::named(const ConfigNode& node, const std::vector<Thing>& things, const char* what) {
  if (node.kind != ConfigNode::Kind::kString) {
    fail(node, fmt::format("give the name of {} in quotes", what));
    return 0;
  }
  for (size_t i = 0; i < things.size(); ++i) {
    if (things[i].name == node.text) return static_cast<int32_t>(i);
  }
  std::string known;
  for (const Thing& thing : things) known += (known.empty() ? "" : ", ") + thing.name;
  fail(node, fmt::format("there is no {} named '{}'; there are: {}", what, node.text,
                         known.empty() ? "none" : known));
  return 0;
}

template <class Thing>
void Reader::names(const ConfigNode& node, const std::vector<Thing>& things, const char* what,
                   std::vector<int32_t>& out) {
  if (node.kind != ConfigNode::Kind::kArray) {
    out.push_back(named(node, things, what));
    return;
  }
  for (const ConfigNode& item : node.items) out.push_back(named(item, things, what));
  if (out.empty())
    fail(node, fmt::format("the list of names is empty; name at least one {}", what));
}

template <class Thing>
void Reader::choices(const char* key, const std::vector<Thing>& things, std::vector<Choice>& out) {
  const ConfigNode* node = find(key);
  if (node == nullptr) return;
  if (node->kind != ConfigNode::Kind::kTable) {
    out.push_back({named(*node, things, key), 1});
    return;
  }
  for (const auto& [name, value] : node->entries) {
    ConfigNode text;
    text.kind = ConfigNode::Kind::kString;
    text.line = value.line;
    text.text = name;
    if (!is_number(value) || !(value.number > 0)) {
      fail(value, fmt::format("{}: the weight of '{}' must be a number above 0", key, name));
    }
    out.push_back({named(text, things, key), value.number});
  }
  if (out.empty()) fail(*node, fmt::format("{}: the table is empty", key));
}

}  // namespace throng::scenario
