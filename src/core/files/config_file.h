// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "throng/base.h"

/// Small settings files, TOML or JSON, as one tree that remembers the line of every value, so that
/// a wrong setting can be named by file, line, key and limit.
namespace throng {

struct ConfigEntry;

struct ConfigNode {
  enum class Kind { kNone, kBool, kNumber, kString, kArray, kTable };
  Kind kind = Kind::kNone;
  int line = 0;
  bool flag = false;
  double number = 0;
  std::string text;
  std::vector<ConfigNode> items;     ///< Of an array.
  std::vector<ConfigEntry> entries;  ///< Of a table, in the file's order.

  [[nodiscard]] const ConfigNode* find(std::string_view key) const;
};

/// A key of a table and its value.
struct ConfigEntry {
  std::string name;
  ConfigNode value;
};

/// Parses TOML, or JSON where the text begins with `{` or the name ends in ".json". `name` is for
/// messages. Fails with kBadFile, the line and the reason.
[[nodiscard]] Result<ConfigNode> parse_config(const std::string& text, const std::string& name);

/// Reads typed values out of one table and collects the first error, with its place.
class ConfigReader {
 public:
  ConfigReader(std::string file, const ConfigNode& table, std::string what);

  /// Leaves `value` alone where the key is absent. Limits are inclusive.
  void number(const char* key, double& value, double low, double high);
  void text(const char* key, std::string& value);
  void flag(const char* key, bool& value);
  /// Array of tables under `key`; empty where it is absent.
  [[nodiscard]] std::vector<const ConfigNode*> tables(const char* key);
  /// A list of `count` finite numbers; false where the key is absent or wrong.
  bool numbers(const char* key, double* values, size_t count);
  void require(const char* key);
  /// Refuses every key that is not in the list: a misspelt setting must not pass in silence.
  void only(std::initializer_list<const char*> keys);
  void fail(const ConfigNode& at, const std::string& why);

  [[nodiscard]] const ConfigNode* find(const char* key) const { return table_.find(key); }
  [[nodiscard]] const ConfigNode& table() const { return table_; }
  [[nodiscard]] bool ok() const { return message_.empty(); }
  [[nodiscard]] Error error() const { return {Errc::kBadFile, message_}; }

 private:
  std::string file_;
  const ConfigNode& table_;
  std::string what_;
  std::string message_;
};

}  // namespace throng
