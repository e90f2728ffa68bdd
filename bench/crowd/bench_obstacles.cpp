// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
// A crowd with goals in a baked world, first alone, then with crates that are added and removed and
// carts that move: measures both and counts avatars inside obstacles. Prints a JSON object.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/random.h"
#include "throng/crowd.h"

namespace {

using namespace throng;
using Json = nlohmann::ordered_json;

struct Options {
  std::string world;
  uint32_t avatars = 10000;
  uint32_t crates = 200, carts = 50;
  uint64_t warm = 50, steps = 200;
  uint64_t check_every = 10;
  uint64_t seed = 1;
  int32_t threads = 0;
};

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values.empty() ? 0 : values[values.size() / 2];
}

template <class Do>
void time_of(std::vector<double>& us, Do act) {
  const auto start = std::chrono::steady_clock::now();
  act();
  us.push_back(
      std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - start).count());
}

struct Cart {
  EditId id = 0;
  Prism prism;
  double dx = 0, dz = 0;  // Per step. [m]
};

class Run {
 public:
  Run(const World& world, const Edits& edits, Crowd& crowd, const Options& options)
      : world_(world), edits_(edits), crowd_(crowd), o_(options) {}

  void give_goals(std::span<const AvatarId> to) {
    std::vector<Place> goals;
    for (size_t i = 0; i < to.size(); ++i) {
      goals.push_back(world_.random_place(0, o_.seed, drawn_++));
    }
    crowd_.set_goals(to, goals);
  }

  // Runs the steps of one kind and returns their measures.
  Json steps(bool with_obstacles) {
    std::vector<double> ns, plan_ns;
    CrowdCheck found;
    uint64_t moved = 0, waited = 0, stood = 0, goal_unreachable = 0, planned = 0, checks = 0;
    double progress = 0;
    for (uint64_t step = 1; step <= o_.steps; ++step) {
      if (with_obstacles) {
        swap_crate();
        drive(moved);
      }
      const CrowdReport r = crowd_.step();
      give_goals(crowd_.arrived());
      give_goals(crowd_.goal_unreachable());
      ns.push_back(r.seconds_total * 1e9 / o_.avatars);
      plan_ns.push_back(r.seconds_plan * 1e9 / o_.avatars);
      waited += r.waiting;
      stood += r.stood;
      goal_unreachable += r.no_path;
      planned += r.planned;
      progress += r.progress;
      if (step % o_.check_every != 0) continue;
      const CrowdCheck check = crowd_.check();
      found.wall_entries += check.wall_entries;
      found.overlaps += check.overlaps;
      found.obstacle_entries += check.obstacle_entries;
      ++checks;
    }
    const auto steps = static_cast<double>(o_.steps);
    return {{"ns", median(ns)},
            {"ns_plan", median(plan_ns)},
            {"progress", progress / steps},
            {"stood", static_cast<double>(stood) / steps / o_.avatars},
            {"planned", planned},
            {"goal_unreachable", goal_unreachable},
            {"carts_moved", moved},
            {"waited", waited},
            {"avatar_steps", o_.steps * o_.avatars},
            {"checks", checks},
            {"wall_entries", found.wall_entries},
            {"overlaps", found.overlaps},
            {"obstacle_entries", found.obstacle_entries}};
  }

  void put_up_all() {
    for (uint32_t i = 0; i < o_.crates; ++i) add_crate();
    for (uint32_t i = 0; i < o_.carts; ++i) {
      Cart cart;
      const Vec3d at = somewhere();
      cart.prism = Prism::circle({at.x, at.y, at.z}, 0.6, 1.5);
      const auto id = edits_.add_obstacle(cart.prism, ObstacleKind::kKinematic);
      if (!id) continue;
      follow();
      cart.id = *id;
      cart.dx = 0.2 * draw() - 0.1;
      cart.dz = 0.2 * draw() - 0.1;
      carts_.push_back(std::move(cart));
    }
  }

  [[nodiscard]] Json costs() const {
    return {{"add_us", median(add_us_)},
            {"remove_us", median(remove_us_)},
            {"move_us", median(move_us_)}};
  }

 private:
  double draw() { return random_unit(o_.seed, 9, drawn_++); }
  // The crowd's part of a change of its edits.
  void follow() {
    Context context;
    (void)crowd_.add({}, context);
  }
  Vec3d somewhere() { return world_.random_place(0, o_.seed + 1, drawn_++).position; }

  void add_crate() {
    const Vec3d at = somewhere();
    const double half = 0.3 + 0.7 * draw();
    const Prism box =
        Prism::box({at.x - half, at.y, at.z - half}, {at.x + half, at.y + 1, at.z + half});
    time_of(add_us_, [&] {
      if (const auto id = edits_.add_obstacle(box)) crates_.push_back(*id);
      follow();
    });
  }
  void swap_crate() {
    if (crates_.empty()) return;
    const auto i = static_cast<size_t>(draw() * static_cast<double>(crates_.size()));
    time_of(remove_us_, [&] {
      edits_.remove(crates_[i]);
      follow();
    });
    crates_.erase(crates_.begin() + static_cast<ptrdiff_t>(i));
    add_crate();
  }
  void drive(uint64_t& moved) {
    for (Cart& cart : carts_) {
      const auto state = crowd_.obstacle(cart.id);
      if (!state || state->waits()) continue;
      if (draw() < 0.02) {
        cart.dx = 0.2 * draw() - 0.1;
        cart.dz = 0.2 * draw() - 0.1;
      }
      cart.prism = state->prism;
      for (auto& [x, z] : cart.prism.corners) {
        x += cart.dx;
        z += cart.dz;
      }
      time_of(move_us_, [&] {
        if (edits_.move_obstacle(cart.id, cart.prism)) ++moved;
        follow();
      });
    }
  }

  const World& world_;
  Edits edits_;
  Crowd& crowd_;
  const Options& o_;
  uint64_t drawn_ = 0;
  std::vector<EditId> crates_;
  std::vector<Cart> carts_;
  std::vector<double> add_us_, remove_us_, move_us_;
};

Json fail(const Error& error) { return {{"error", error.message}}; }

Json run(const Options& o) {
  Context context;
  const auto world = World::open(o.world);
  if (!world) return fail(world.error());
  const Edits edits;
  auto crowd = Crowd::create(*world, {.seed = o.seed, .workers = o.threads, .edits = edits});
  if (!crowd) return fail(crowd.error());
  const auto ids = crowd->scatter(o.avatars, {}, context);
  if (!ids) return fail(ids.error());
  Run run(*world, edits, *crowd, o);
  run.give_goals(*ids);
  for (uint64_t step = 0; step < o.warm; ++step) crowd->step();
  Json alone = run.steps(false);
  run.put_up_all();
  Json with = run.steps(true);
  return {{"avatars", o.avatars},
          {"crates", o.crates},
          {"carts", o.carts},
          {"threads", o.threads},
          {"steps", o.steps},
          {"alone", alone},
          {"with", with},
          {"costs", run.costs()},
          {"up", crowd->obstacles().size()},
          {"state_hash", crowd->state_hash()}};
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App parser{"A crowd with obstacles that are added, moved and removed"};
  Options options;
  parser.add_option("world", options.world, "baked world")->required();
  parser.add_option("--avatars", options.avatars)->check(CLI::Range(1, 10000000));
  parser.add_option("--crates", options.crates);
  parser.add_option("--carts", options.carts);
  parser.add_option("--warm", options.warm);
  parser.add_option("--steps", options.steps)->check(CLI::PositiveNumber);
  parser.add_option("--check-every", options.check_every)->check(CLI::PositiveNumber);
  parser.add_option("--seed", options.seed);
  parser.add_option("--threads", options.threads)->check(CLI::Range(0, 1024));
  CLI11_PARSE(parser, argc, argv);
  const Json result = run(options);
  std::puts(result.dump().c_str());
  return result.contains("error") ? 2 : 0;
}
