// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
// How well avatars flow without overlaps: the scenes of the quality table, by the tests' plain
// version of the crowd's step. Prints a JSON object.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "plain_crowd.h"

namespace {

using namespace throng;
using Json = nlohmann::ordered_json;

struct Options {
  std::string scene = "sparse";
  uint32_t bodies = 2000;
  double seconds = 60;
  uint64_t seed = 1;
  test::PlainConfig config;
};

Json run(const Options& options) {
  test::PlainConfig config = options.config;
  config.seed = options.seed;
  if (config.model != SteeringModel::kSampled) {  // As in Crowd.
    config.deadlock_avoidance = false;
    config.reaction = 0;
    config.steering.neighbours = steer::kMaxNear;
  }
  const bool circle = options.scene == "circle";
  std::vector<test::PlainBody> bodies =
      circle ? test::ring_bodies(config, options.bodies, 60)
             : test::random_bodies(config, options.bodies, options.scene == "dense" ? 1 : 4,
                                   options.seed, config.side);
  test::PlainCrowd crowd(std::move(bodies), config);
  double progress = 0, last = 0;
  uint64_t steps = 0, counted = 0, overlaps = 0, arrived = 0;
  std::vector<uint64_t> goals(crowd.bodies().size(), 0);
  while (crowd.time() < options.seconds - 1e-9 &&
         arrived < (circle ? options.bodies : UINT64_MAX)) {
    crowd.step();
    ++steps;
    if (crowd.time() > 10) {
      progress += crowd.progress();
      ++counted;
    }
    if (steps % 10 == 0) overlaps += crowd.overlaps();
    arrived = 0;
    for (uint32_t i = 0; i < crowd.bodies().size(); ++i) {
      test::PlainBody& body = crowd.bodies()[i];
      if (body.arrived < 0) continue;
      ++arrived;
      last = std::max(last, body.arrived);
      if (circle) continue;
      body.goal = test::next_goal(config, body, options.seed, i, ++goals[i]);
      body.arrived = -1;
    }
  }
  Json json = {{"scene", options.scene},   {"model", name_of(config.model)},
               {"bodies", options.bodies}, {"seed", options.seed},
               {"seconds", crowd.time()},  {"overlaps", overlaps}};
  json["progress"] = counted > 0 ? progress / static_cast<double>(counted) : 0;
  if (circle) {
    json["arrived"] = arrived;
    json["last"] = last;
  }
  return json;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App parser{"How well avatars flow without overlaps"};
  Options options;
  parser.add_option("--scene", options.scene)
      ->check(CLI::IsMember({"sparse", "dense", "circle"}))
      ->capture_default_str();
  parser.add_option("--bodies", options.bodies)
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  parser.add_option("--seconds", options.seconds)
      ->check(CLI::Range(1.0, 10000.0))
      ->capture_default_str();
  parser.add_option("--seed", options.seed)->capture_default_str();
  parser.add_option("--rounds", options.config.rounds)
      ->check(CLI::Range(1, 20))
      ->capture_default_str();
  steer::SampledSettings& steering = options.config.steering;
  parser.add_option("--threat", steering.threat)->capture_default_str();
  parser.add_option("--horizon", steering.horizon)->capture_default_str();
  parser.add_option("--keep", steering.keep)->capture_default_str();
  parser.add_option("--straightness", steering.straightness)->capture_default_str();
  parser.add_option("--right", steering.right)->capture_default_str();
  parser.add_option("--gap", steering.gap)->capture_default_str();
  parser.add_option("--neighbours", steering.neighbours)
      ->check(CLI::Range(size_t{1}, steer::kMaxNear))
      ->capture_default_str();
  parser
      .add_option("--reaction", options.config.reaction,
                  "Time after which an avatar that moves as preferred decides again [s]")
      ->capture_default_str();
  parser
      .add_option_function<std::string>("--model",
                                        [&](const std::string& name) {
                                          const auto model = find_steering_model(name);
                                          if (!model)
                                            throw CLI::ValidationError("--model",
                                                                       steering_model_names());
                                          options.config.model = *model;
                                        })
      ->type_name("MODEL");
  parser.add_flag("!--no-deadlock-avoidance", options.config.deadlock_avoidance);
  CLI11_PARSE(parser, argc, argv);
  std::puts(run(options).dump().c_str());
}
