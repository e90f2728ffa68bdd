// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "core/config_file.h"

#include <fmt/format.h>
#include <toml++/impl/preprocessor.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <stdexcept>

// toml++ 3.3 asserts, and in release builds assumes, what a damaged file need not hold: that a
// table header like "[.a]" begins with a key. Make each of these an exception.
namespace throng {
[[noreturn]] static void toml_fault() { throw std::logic_error("not TOML"); }
}  // namespace throng
#undef TOML_ASSERT
#undef TOML_ASSERT_ASSUME
#define TOML_ASSERT(condition) ((condition) ? void() : throng::toml_fault())
#define TOML_ASSERT_ASSUME(condition) TOML_ASSERT(condition)
#include <toml++/toml.h>

namespace throng {
namespace {

constexpr int kMaxDepth = 64;

// The JSON parser does not say where a value stood, so its input counts the bytes taken. Only
// numbers look one byte ahead; stepping back one byte is harmless for all other tokens.
struct CountingIterator {
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;

  const char* at = nullptr;
  const char* begin = nullptr;
  size_t* taken = nullptr;

  reference operator*() const { return *at; }
  CountingIterator& operator++() {
    ++at;
    *taken = static_cast<size_t>(at - begin);
    return *this;
  }
  CountingIterator operator++(int) {
    CountingIterator old = *this;
    ++*this;
    return old;
  }
  bool operator==(const CountingIterator& other) const { return at == other.at; }
  bool operator!=(const CountingIterator& other) const { return at != other.at; }
};

class JsonTree : public nlohmann::json_sax<nlohmann::json> {
 public:
  explicit JsonTree(const std::string& text) : text_(text) { stack_.push_back(&root_); }

  size_t taken = 0;

  bool null() override { return add(ConfigNode::Kind::kNone) != nullptr; }
  bool boolean(bool value) override {
    ConfigNode* node = add(ConfigNode::Kind::kBool);
    if (node != nullptr) node->flag = value;
    return node != nullptr;
  }
  bool number_integer(number_integer_t value) override {
    return number(static_cast<double>(value));
  }
  bool number_unsigned(number_unsigned_t value) override {
    return number(static_cast<double>(value));
  }
  bool number_float(number_float_t value, const string_t&) override { return number(value); }
  bool string(string_t& value) override {
    ConfigNode* node = add(ConfigNode::Kind::kString);
    if (node != nullptr) node->text = value;
    return node != nullptr;
  }
  bool binary(binary_t&) override { return false; }
  bool start_object(size_t) override { return open(ConfigNode::Kind::kTable); }
  bool start_array(size_t) override { return open(ConfigNode::Kind::kArray); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }
  bool key(string_t& value) override {
    key_ = value;
    if (stack_.back()->find(key_) != nullptr) message = "key '" + key_ + "' stands here twice";
    return message.empty();
  }
  bool parse_error(size_t, const std::string&, const nlohmann::detail::exception& error) override {
    // The library's text reads "[json.exception...] parse error at line 1, column 2: what".
    const std::string text = error.what();
    const size_t colon = text.find(": ");
    message = colon == std::string::npos ? text : text.substr(colon + 2);
    return false;
  }

  [[nodiscard]] int line() {
    const size_t end = std::min(taken > 0 ? taken - 1 : 0, text_.size());
    for (; counted_ < end; ++counted_) lines_ += text_[counted_] == '\n' ? 1 : 0;
    return lines_;
  }
  ConfigNode take() { return root_.items.empty() ? ConfigNode{} : std::move(root_.items.front()); }

  std::string message;

 private:
  bool number(double value) {
    ConfigNode* node = add(ConfigNode::Kind::kNumber);
    if (node != nullptr) node->number = value;
    return node != nullptr;
  }
  ConfigNode* add(ConfigNode::Kind kind) {
    ConfigNode& parent = *stack_.back();
    ConfigNode* node = nullptr;
    if (parent.kind == ConfigNode::Kind::kTable) {
      parent.entries.push_back({.name = key_, .value = {}});
      node = &parent.entries.back().value;
    } else {
      node = &parent.items.emplace_back();
    }
    node->kind = kind;
    node->line = line();
    return node;
  }
  bool open(ConfigNode::Kind kind) {
    if (stack_.size() > kMaxDepth) {
      message = fmt::format("values nest more than {} deep", kMaxDepth);
      return false;
    }
    stack_.push_back(add(kind));  // A parent's list does not grow while its child is open.
    return true;
  }
  bool close() {
    stack_.pop_back();
    return true;
  }

  const std::string& text_;
  ConfigNode root_{.kind = ConfigNode::Kind::kArray,
                   .line = 0,
                   .flag = false,
                   .number = 0,
                   .text = {},
                   .items = {},
                   .entries = {}};
  std::vector<ConfigNode*> stack_;
  std::string key_;
  size_t counted_ = 0;
  int lines_ = 1;
};

Result<ConfigNode> parse_json(const std::string& text, const std::string& name) {
  JsonTree tree(text);
  const char* begin = text.data();
  const bool parsed =
      nlohmann::json::sax_parse(CountingIterator{begin, begin, &tree.taken},
                                CountingIterator{begin + text.size(), begin, &tree.taken}, &tree);
  if (!parsed) {
    return Error{Errc::kBadFile, fmt::format("{}:{}: {}", name, tree.line(),
                                             tree.message.empty() ? "not JSON" : tree.message)};
  }
  return tree.take();
}

Result<ConfigNode> from_toml(const toml::node& in, const std::string& name, int depth) {
  ConfigNode out;
  out.line = static_cast<int>(in.source().begin.line);
  if (depth > kMaxDepth) {
    return Error{Errc::kBadFile,
                 fmt::format("{}:{}: values nest more than {} deep", name, out.line, kMaxDepth)};
  }
  if (const auto* table = in.as_table()) {
    out.kind = ConfigNode::Kind::kTable;
    for (const auto& [key, value] : *table) {
      auto child = from_toml(value, name, depth + 1);
      if (!child) return child.error();
      out.entries.push_back({.name = std::string(key.str()), .value = std::move(*child)});
    }
    // The library keeps keys sorted; messages read better in the file's own order.
    std::stable_sort(out.entries.begin(), out.entries.end(),
                     [](const auto& a, const auto& b) { return a.value.line < b.value.line; });
  } else if (const auto* array = in.as_array()) {
    out.kind = ConfigNode::Kind::kArray;
    for (const auto& value : *array) {
      auto child = from_toml(value, name, depth + 1);
      if (!child) return child.error();
      out.items.push_back(std::move(*child));
    }
  } else if (const auto* text = in.as_string()) {
    out.kind = ConfigNode::Kind::kString;
    out.text = text->get();
  } else if (const auto* flag = in.as_boolean()) {
    out.kind = ConfigNode::Kind::kBool;
    out.flag = flag->get();
  } else if (in.is_number()) {
    out.kind = ConfigNode::Kind::kNumber;
    out.number = in.value<double>().value_or(0);
  }
  return out;
}

Result<ConfigNode> parse_toml(const std::string& text, const std::string& name) {
  try {
    const toml::table table = toml::parse(text, name);
    return from_toml(table, name, 0);
  } catch (const toml::parse_error& error) {
    return Error{Errc::kBadFile,
                 fmt::format("{}:{}: {}", name, error.source().begin.line, error.description())};
  } catch (const std::logic_error& error) {
    return Error{Errc::kBadFile, fmt::format("{}: {}", name, error.what())};
  }
}

}  // namespace

const ConfigNode* ConfigNode::find(std::string_view key) const {
  for (const auto& [name, value] : entries) {
    if (name == key) return &value;
  }
  return nullptr;
}

Result<ConfigNode> parse_config(const std::string& text, const std::string& name) {
  const size_t first = text.find_first_not_of(" \t\r\n");
  const bool json = name.ends_with(".json") || (first != std::string::npos && text[first] == '{');
  auto root = json ? parse_json(text, name) : parse_toml(text, name);
  if (root && root->kind != ConfigNode::Kind::kTable) {
    return Error{Errc::kBadFile, name + ":1: need a table of settings at the top"};
  }
  return root;
}

ConfigReader::ConfigReader(std::string file, const ConfigNode& table, std::string what)
    : file_(std::move(file)), table_(table), what_(std::move(what)) {
  if (table_.kind != ConfigNode::Kind::kTable) fail(table_, "need a table of settings here");
}

void ConfigReader::fail(const ConfigNode& at, const std::string& why) {
  if (!message_.empty()) return;
  message_ = fmt::format("{}:{}: {}: {}", file_, at.line, what_, why);
}

void ConfigReader::number(const char* key, double& value, double low, double high) {
  const ConfigNode* node = find(key);
  if (node == nullptr) return;
  if (node->kind != ConfigNode::Kind::kNumber) {
    fail(*node, fmt::format("{} must be a number", key));
  } else if (!(node->number >= low && node->number <= high)) {  // Catches NaN as well.
    fail(*node, fmt::format("{} = {} is outside {} to {}", key, node->number, low, high));
  } else {
    value = node->number;
  }
}

void ConfigReader::text(const char* key, std::string& value) {
  const ConfigNode* node = find(key);
  if (node == nullptr) return;
  if (node->kind != ConfigNode::Kind::kString) {
    fail(*node, fmt::format("{} must be a text in quotes", key));
  } else {
    value = node->text;
  }
}

std::vector<const ConfigNode*> ConfigReader::tables(const char* key) {
  std::vector<const ConfigNode*> out;
  const ConfigNode* node = find(key);
  if (node == nullptr) return out;
  if (node->kind != ConfigNode::Kind::kArray) {
    fail(*node, fmt::format("{0} must be a list of tables: write [[{0}]]", key));
    return out;
  }
  for (const ConfigNode& item : node->items) out.push_back(&item);
  return out;
}

bool ConfigReader::numbers(const char* key, double* values, size_t count) {
  const ConfigNode* node = find(key);
  if (node == nullptr) return false;
  bool good = node->kind == ConfigNode::Kind::kArray && node->items.size() == count;
  for (size_t i = 0; good && i < count; ++i) {
    const ConfigNode& item = node->items[i];
    good = item.kind == ConfigNode::Kind::kNumber && std::isfinite(item.number);
    values[i] = item.number;
  }
  if (!good) fail(*node, fmt::format("{} must be a list of {} numbers", key, count));
  return good;
}

void ConfigReader::require(const char* key) {
  if (find(key) == nullptr) fail(table_, fmt::format("{} is missing", key));
}

void ConfigReader::only(std::initializer_list<const char*> keys) {
  for (const auto& [name, value] : table_.entries) {
    const auto same = [&name = name](const char* key) { return name == key; };
    if (std::any_of(keys.begin(), keys.end(), same)) continue;
    std::string known;
    for (const char* key : keys) known += (known.empty() ? "" : ", ") + std::string(key);
    fail(value, fmt::format("unknown key '{}'; known are {}", name, known));
  }
}

}  // namespace throng
