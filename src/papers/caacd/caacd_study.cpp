// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>
#include <optional>
#include <utility>

#include "core/hash.h"
#include "core/parallel.h"
#include "throng/papers.h"

// Many runs of [CAACD] section V in parallel: each run writes its own slot; sums are in order.
namespace throng::caacd {
namespace {

struct Outcome {
  Counts counts;
  uint64_t hash = 0;
};

Result<void> check_study(const StudyConfig& c) {
  const bool counts = std::ranges::all_of(c.avatars, [](int32_t n) { return n >= 1 && n <= 2000; });
  if (c.sets.empty() || c.avatars.empty() || !counts || c.seeds < 1 || c.seeds > 100000 ||
      c.frames < 1 || c.frames > 10'000'000 || c.workers < 0) {
    return Error{
        Errc::kBadConfig,
        "caacd: need parameter sets, numbers of avatars from 1 to 2000, 1 to 100000 seeds, "
        "1 to 10000000 frames and workers >= 0"};
  }
  for (const ParameterSet& set : c.sets) {
    if (auto ok = check_model(with_set(c.model, set)); !ok) {
      return Error{ok.error().code, ok.error().message + ", in the set " + name_of(set)};
    }
  }
  return {};
}

Result<Outcome> run_once(const StudyConfig& config, const Model& model, int32_t avatars,
                         uint64_t seed, const Context& context) {
  SpaceConfig space = config.space;
  space.avatars = avatars;
  space.seed = seed;
  Result<Space> made = random_space(space, model);
  if (!made) return made.error();
  Result<Simulation> run = Simulation::create(*std::move(made), model, config.dt);
  if (!run) return run.error();
  while (run->counts().frames < config.frames && !run->finished() && !context.cancel) run->step();
  return Outcome{run->counts(), run->state_hash()};
}

StudyCell sum_up(std::span<const Outcome> outcomes, int32_t avatars) {
  StudyCell cell;
  const auto n = static_cast<double>(outcomes.size());
  cell.min_collisions = outcomes.front().counts.collisions;
  for (const Outcome& o : outcomes) {
    cell.mean += static_cast<double>(o.counts.collisions) / n;
    cell.min_collisions = std::min(cell.min_collisions, o.counts.collisions);
    cell.max_collisions = std::max(cell.max_collisions, o.counts.collisions);
    cell.obstacle_mean += static_cast<double>(o.counts.obstacle_collisions) / n;
    cell.arrived += static_cast<double>(o.counts.arrived) / (n * avatars);
    cell.waiting += static_cast<double>(o.counts.waiting) / (n * avatars);
    cell.frames += static_cast<double>(o.counts.frames) / n;
    cell.walked += o.counts.walked / (n * avatars);
  }
  double squares = 0;
  for (const Outcome& o : outcomes) {
    const double off = static_cast<double>(o.counts.collisions) - cell.mean;
    squares += off * off;
  }
  if (n > 1) cell.deviation = std::sqrt(squares / (n - 1));
  return cell;
}

}  // namespace

Model with_set(Model model, const ParameterSet& set) {
  model.mass = set.mass;
  model.max_speed = set.max_speed;
  model.max_force = set.max_force;
  return model;
}

std::string name_of(const ParameterSet& set) {
  // As many decimals as the paper prints, and more where a number has more.
  const auto number = [](double value, size_t decimals) {
    std::string text = fmt::format("{}", value);
    const size_t point = text.find('.');
    if (text.find('e') != std::string::npos) return text;
    if (point == std::string::npos) return text + "." + std::string(decimals, '0');
    const size_t have = text.size() - point - 1;
    return have < decimals ? text + std::string(decimals - have, '0') : text;
  };
  return number(set.mass, 1) + "/" + number(set.max_speed, 1) + "/" + number(set.max_force, 2);
}

std::vector<ParameterSet> named_sets() {
  return {{1.0, 1.0, 0.06}, {1.0, 0.8, 0.06}, {2.0, 0.4, 0.06}};
}

std::vector<ParameterSet> grid_sets() {
  std::vector<ParameterSet> sets;
  for (const double mass : {1.0, 1.5, 2.0}) {
    for (const double speed : {0.4, 0.6, 0.8, 1.0, 1.2}) {
      for (const double force : {0.02, 0.06, 0.10, 0.20}) sets.push_back({mass, speed, force});
    }
  }
  return sets;
}

Reported reported_collisions(int32_t avatars) {
  if (avatars <= 10) return {2, 2};
  if (avatars <= 30) return {4, 4};
  if (avatars <= 40) return {8, 6};
  if (avatars <= 50) return {11, 7};
  return {109, 23};
}

Result<Study> run_study(const StudyConfig& config, Context& context) {
  if (auto ok = check_study(config); !ok) return ok.error();
  const auto seeds = static_cast<size_t>(config.seeds);
  const size_t counts = config.avatars.size();
  const size_t total = config.sets.size() * counts * seeds;
  std::vector<Outcome> outcomes(total);
  std::vector<std::optional<Error>> errors(total);
  uint64_t done = 0;
  std::mutex report;
  parallel_for(total, config.workers, [&](size_t task) {
    if (context.cancel.load()) return;
    const size_t cell = task / seeds;
    const Model model = with_set(config.model, config.sets[cell / counts]);
    const auto outcome = run_once(config, model, config.avatars[cell % counts],
                                  config.space.seed + task % seeds, context);
    if (outcome) {
      outcomes[task] = *outcome;
    } else {
      errors[task] = outcome.error();
    }
    const std::lock_guard lock(report);
    ++done;
    if (context.on_progress) context.on_progress({"runs", done, total});
  });
  if (context.cancel.load()) return Error{Errc::kCancelled, "caacd: cancelled"};
  for (const auto& error : errors) {
    if (error) return *error;
  }
  Study study{.sets = config.sets, .avatars = config.avatars, .cells = {}};
  for (size_t cell = 0; cell * seeds < total; ++cell) {
    study.cells.push_back(
        sum_up(std::span(outcomes).subspan(cell * seeds, seeds), config.avatars[cell % counts]));
  }
  std::vector<uint64_t> hashes(total);
  std::transform(outcomes.begin(), outcomes.end(), hashes.begin(),
                 [](const Outcome& outcome) { return outcome.hash; });
  study.hash = hash_span(std::span<const uint64_t>(hashes));
  return study;
}

}  // namespace throng::caacd
