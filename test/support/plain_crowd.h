// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "crowd/step_units.h"
#include "steer/lanes.h"
#include "steer/models.h"
#include "steer/sampled.h"

/// The crowd's step as plainly as it can be written: an open plane, discs with goals, one loop
/// after the other. What the engine is held against, and what settings are tried with.
namespace throng::test {

/// Of the plane. [units]
struct Spot {
  int32_t x = 0, z = 0;
  friend bool operator==(const Spot&, const Spot&) = default;
};

struct PlainBody {
  Spot at, goal;
  steer::Plane velocity;
  int32_t radius = 6144;  // [units] 0.3 m
  float speed = 1.3f;     // wished, and the most [m/s]
  float turn = 0;         // of steer::Patience
  bool keeps = false;     // to what it decided: it does what it wanted most
  bool follows = false;   // so closely that it could but crawl, when it last decided
  double arrived = -1;    // when it first was within 0.3 m of the goal [s]; not yet: -1
};

struct PlainConfig {
  StepUnits units{.unit = 0.1f / 2048, .dt = 0.1f};
  int32_t side = 0;  // the plane repeats itself after so many units; 0: it does not
  float sight = 5;   // [m]
  int32_t rounds = 3;
  bool deadlock_avoidance = true;
  float reaction = 0.2f;  // [s]
  uint64_t seed = 1;
  SteeringModel model = SteeringModel::kSampled;
  steer::SampledSettings steering;
  steer::Patience patience;
  steer::LaneSettings lanes;

  [[nodiscard]] int32_t to_units(double metres) const;
};

class PlainCrowd {
 public:
  PlainCrowd(std::vector<PlainBody> bodies, const PlainConfig& config);

  /// Sense, steer, then commit in rounds: whoever is undecided names one place, clear of all who
  /// stand; he takes it if it is also clear of what those before him in the round's order named.
  void step();

  [[nodiscard]] const std::vector<PlainBody>& bodies() const { return bodies_; }
  [[nodiscard]] std::vector<PlainBody>& bodies() { return bodies_; }
  [[nodiscard]] double time() const { return static_cast<double>(steps_) * config_.units.dt; }
  /// Speed towards the goals by the wished one, mean over all bodies, in the last step.
  [[nodiscard]] double progress() const { return progress_; }
  /// Pairs that are nearer than the sum of their radii: all pairs, one by one.
  [[nodiscard]] uint64_t overlaps() const;

 private:
  struct Near {
    uint32_t other;
    Spot at;  // from the body
  };
  [[nodiscard]] Spot between(Spot a, Spot b) const;
  [[nodiscard]] steer::Plane preferred_of(const PlainBody& body) const;
  [[nodiscard]] bool can_touch(uint32_t i, const Near& n) const;
  void sense();
  void steer_all();
  void prefer(uint32_t i);
  void commit();
  void settle(const std::vector<Spot>& now, const std::vector<uint8_t>& keeps);

  std::vector<PlainBody> bodies_;
  PlainConfig config_;
  uint64_t steps_ = 0;
  double progress_ = 0;
  int32_t widest_ = 0, longest_ = 0;     // of radii and strides [units]
  std::vector<std::vector<Near>> near_;  // nearest first
  std::vector<steer::Choices> choices_;
  std::vector<uint8_t> follows_;  // Would be PlainBody::follows, should it decide.
};

/// Bodies at random places of a square that repeats itself, `area` m2 for each, with goals within
/// 50 m along each axis. Give who has arrived another goal by `next_goal`.
std::vector<PlainBody> random_bodies(const PlainConfig& config, uint32_t count, double area,
                                     uint64_t seed, int32_t& side);
Spot next_goal(const PlainConfig& config, const PlainBody& body, uint64_t seed, uint32_t index,
               uint64_t turn);

/// Bodies on rings around `middle` from `radius` metres outward, 1.2 m apart, each bound for the
/// opposite point.
std::vector<PlainBody> ring_bodies(const PlainConfig& config, uint32_t count, double radius,
                                   Spot middle = {});

}  // namespace throng::test
