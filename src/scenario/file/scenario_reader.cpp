// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "scenario/file/scenario_reader.h"

#include <numbers>

// Values of a table that are more than a number, a text or a flag.
namespace throng::scenario {
namespace {

using Kind = ConfigNode::Kind;

// The percentage of draws that lie within the limits of a distribution.
double percent_within(const Distribution& d) {
  const auto below = [&](double x) {
    if (d.kind == Distribution::Kind::kExponential) return x > 0 ? 1 - std::exp(-x / d.a) : 0.0;
    return d.b > 0 ? 0.5 * std::erfc((d.a - x) / (d.b * std::numbers::sqrt2))
                   : (x >= d.a ? 1 : 0.0);
  };
  return 100 * (below(d.high) - below(d.low));
}

}  // namespace

void Reader::distribution(const char* key, Distribution& out, double low, double high) {
  if (const ConfigNode* node = find(key); node != nullptr)
    distribution_of(*node, key, out, low, high);
}

// A number, or { uniform = [a, b] }, { normal = [mean, deviation] }, { exponential = mean }, the
// last two with within = [low, high].
void Reader::distribution_of(const ConfigNode& node, const std::string& key, Distribution& out,
                             double low, double high) {
  const auto in_limits = [&](double value) { return value >= low && value <= high; };
  const auto limits = [&] { return fmt::format("{} must be within {} to {}", key, low, high); };
  if (is_number(node)) {
    out = Distribution::fixed(node.number);
    if (!in_limits(node.number)) fail(node, limits());
    return;
  }
  const std::string wrong = fmt::format(
      "{} must be a number, {{ uniform = [low, high] }}, {{ normal = [mean, deviation] }} or "
      "{{ exponential = mean }}",
      key);
  if (node.kind != Kind::kTable || node.entries.empty()) return fail(node, wrong);
  const auto pair = [&](const ConfigNode& list, double& a, double& b) {
    const bool good = list.kind == Kind::kArray && list.items.size() == 2 &&
                      is_number(list.items[0]) && is_number(list.items[1]);
    if (!good) return fail(list, fmt::format("{}: give two numbers", key));
    a = list.items[0].number;
    b = list.items[1].number;
  };
  out.low = low;
  out.high = high;
  bool has_kind = false, has_within = false;
  for (const auto& [name, value] : node.entries) {
    if (name == "within") {
      has_within = true;
      pair(value, out.low, out.high);
      if (!(out.low < out.high) || !in_limits(out.low) || !in_limits(out.high)) {
        fail(value, limits());
      }
      continue;
    }
    if (has_kind) return fail(value, wrong);
    has_kind = true;
    if (name == "uniform") {
      out.kind = Distribution::Kind::kUniform;
      pair(value, out.a, out.b);
      if (!(out.a <= out.b) || !in_limits(out.a) || !in_limits(out.b)) fail(value, limits());
    } else if (name == "normal") {
      out.kind = Distribution::Kind::kNormal;
      pair(value, out.a, out.b);
      if (!in_limits(out.a)) fail(value, limits());
      if (!(out.b >= 0)) fail(value, fmt::format("{}: a deviation is not below 0", key));
    } else if (name == "exponential" && is_number(value)) {
      out.kind = Distribution::Kind::kExponential;
      out.a = value.number;
      if (!in_limits(out.a) || !(out.a > 0)) fail(value, limits());
    } else {
      return fail(value, wrong);
    }
  }
  if (!has_kind) return fail(node, wrong);
  if (has_within && out.kind == Distribution::Kind::kUniform) {
    fail(node, fmt::format("{}: a uniform number has its limits already", key));
  }
  // Draws outside are repeated, but a limited number of times; then they are set to a limit.
  constexpr double kMinPercent = 5;
  if (has_within && out.kind != Distribution::Kind::kUniform && percent_within(out) < kMinPercent) {
    fail(node,
         fmt::format("{}: under {} % of what is drawn lies within {} to {}; give wider limits "
                     "or another mean",
                     key, kMinPercent, out.low, out.high));
  }
}

bool Reader::corners(const ConfigNode& node, const char* key,
                     std::vector<std::array<double, 2>>& out) {
  bool good = node.kind == Kind::kArray;
  for (size_t i = 0; good && i < node.items.size(); ++i) {
    const ConfigNode& p = node.items[i];
    good = p.kind == Kind::kArray && p.items.size() == 2 && is_number(p.items[0]) &&
           is_number(p.items[1]) && std::fabs(p.items[0].number) <= kMaxCoordinate &&
           std::fabs(p.items[1].number) <= kMaxCoordinate;
    if (good) out.push_back({p.items[0].number, p.items[1].number});
  }
  if (!good) fail(node, fmt::format("{} must be a list of [x, z]", key));
  return good;
}

void Reader::count(const char* key, uint64_t& value, double low, double high) {
  const ConfigNode* node = find(key);
  double number = 0;
  this->number(key, number, low, high);
  if (node == nullptr || !ok()) return;
  if (number != std::floor(number)) fail(*node, fmt::format("{} must be a whole number", key));
  value = static_cast<uint64_t>(number);
}

const char* Reader::spelling(const char* key, const char* old) {
  const ConfigNode* node = find(old);
  if (node == nullptr) return key;
  if (find(key) != nullptr) fail(*node, fmt::format("{} is the old name of {}; drop it", old, key));
  return old;
}

}  // namespace throng::scenario
