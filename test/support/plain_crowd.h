// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "crowd/walk/queue.h"
#include "crowd/walk/step_units.h"
#include "steer/lanes.h"
#include "steer/models.h"
#include "steer/sampled.h"

/// The crowd's step written as plainly as possible: an open plane, discs with goals, one loop after
/// the other. The oracle of the engine, and a testbed for settings.
namespace throng::test {

/// A point of the plane. [units]
struct Spot {
  int32_t x = 0, z = 0;
  friend bool operator==(const Spot&, const Spot&) = default;
};

struct PlainBody {
  Spot at, goal;
  steer::Plane velocity;
  int32_t radius = 6144;  // [units] 0.3 m
  float speed = 1.3f;     // desired, and the maximum [m/s]
  float turn = 0;         // detour angle, of steer::DeadlockAvoidance
  bool keeps = false;     // it moves by its first choice, and goes on so until it decides again
  steer::Plane choice;    // then: its velocity once it has accelerated
  bool follows = false;   // another so closely, when it last decided, that it could only crawl
  float stood = 0;        // for how long [s]
  float yields = 0;       // for how long it lets another pass [s]
  float stream = 0;       // for how long it counts as in a stream that meets another [s]
  bool asks = false;      // others to make room
  crowd::RoomRequest request;
  crowd::Rest rest = crowd::Rest::kNo;
  int nearest_cm = -1;  // to its goal so far; not near yet: -1
  float vain = 0;       // for how long it has come no nearer [s]
  double arrived = -1;  // time at which it came within 0.3 m of the goal [s]; not yet: -1
};

struct PlainConfig {
  crowd::StepUnits units{.unit = 0.1f / 2048, .dt = 0.1f};
  int32_t side = 0;  // period of the plane [units]; 0: not periodic
  float sight = 5;   // [m]
  int32_t rounds = 3;
  bool deadlock_avoidance = true;
  float reaction = 0.2f;  // [s]
  uint64_t seed = 1;
  SteeringModel model = SteeringModel::kSampled;
  steer::SampledSettings steering;
  steer::DeadlockAvoidance deadlock_settings;
  steer::LaneSettings lanes;
  bool queues = false;
  crowd::QueueSettings queue;
  float acceleration = 0;  // at most [m/s2]; 0: no limit

  [[nodiscard]] int32_t to_units(double metres) const;
};

class PlainCrowd {
 public:
  PlainCrowd(std::vector<PlainBody> bodies, const PlainConfig& config);

  /// Senses, steers, then resolves conflicts in rounds: an undecided body proposes a place that is
  /// clear of all bodies where they are now. It moves there if the place is also clear of the
  /// proposals of bodies before it in the round's order.
  void step();

  [[nodiscard]] const std::vector<PlainBody>& bodies() const { return bodies_; }
  [[nodiscard]] std::vector<PlainBody>& bodies() { return bodies_; }
  [[nodiscard]] double time() const { return static_cast<double>(steps_) * config_.units.dt; }
  /// Speed towards the goal over desired speed, mean over all bodies, in the last step.
  [[nodiscard]] double progress() const { return progress_; }
  /// Pairs that are nearer than the sum of their radii: all pairs, one by one.
  [[nodiscard]] uint64_t overlaps() const;

 private:
  struct Near {
    uint32_t other;
    Spot at;  // from the body
  };
  // What a body that decides will be after the step.
  struct Plan {
    bool follows = false, makes_room = false, asks = false, creeps = false, yields = false,
         in_stream = false;
    steer::Plane away, choice;
    std::vector<steer::Plane> room;  // if it creeps: up to 4
    crowd::RoomRequest request;
    crowd::Rest rest = crowd::Rest::kNo;
  };
  [[nodiscard]] Spot between(Spot a, Spot b) const;
  [[nodiscard]] steer::Plane preferred_of(const PlainBody& body) const;
  [[nodiscard]] bool can_touch(uint32_t i, const Near& n) const;
  void sense();
  void steer_all();
  void prefer(uint32_t i);
  // Queues and rest.
  [[nodiscard]] bool may_rest(const PlainBody& body) const;
  [[nodiscard]] bool rests(const PlainBody& body) const;
  [[nodiscard]] bool stands(const PlainBody& body) const;
  [[nodiscard]] bool is_paused(const PlainBody& body) const;
  [[nodiscard]] bool queues(const PlainBody& body) const;
  [[nodiscard]] bool is_near(uint32_t i, const Near& n) const;
  [[nodiscard]] crowd::QueueOrder order_of(uint32_t i) const;
  [[nodiscard]] steer::Plane path_ahead(const PlainBody& body) const;
  [[nodiscard]] float gap(uint32_t i, const Near& n) const;
  [[nodiscard]] bool pushes(const PlainBody& body) const;
  [[nodiscard]] bool is_in_stream(uint32_t i) const;
  [[nodiscard]] bool takes_turn(uint32_t i, uint32_t asker, const crowd::QueueOrder& first) const;
  [[nodiscard]] bool has_turn(uint32_t i) const;
  [[nodiscard]] bool can_move(uint32_t i, steer::Plane velocity) const;
  [[nodiscard]] bool is_head(uint32_t i) const;
  [[nodiscard]] bool is_goal_taken(uint32_t i) const;
  [[nodiscard]] bool touches_resting(uint32_t i) const;
  [[nodiscard]] crowd::Rest next_rest(uint32_t i) const;
  static void settle_rest(PlainBody& body, crowd::Rest next, float left, float dt);
  void queue_up(uint32_t i, Plan& plan) const;
  void make_room(uint32_t i, Plan& plan, const steer::Plane& best) const;
  [[nodiscard]] steer::Plane reachable(const PlainBody& body, steer::Plane velocity) const;
  [[nodiscard]] int32_t sight() const;
  [[nodiscard]] size_t nearest(uint32_t i) const;
  void resolve_conflicts();
  void settle(const std::vector<Spot>& now, const std::vector<uint8_t>& keeps);

  std::vector<PlainBody> bodies_;
  PlainConfig config_;
  uint64_t steps_ = 0;
  double progress_ = 0;
  int32_t max_radius_ = 0, max_stride_ = 0;  // [units]
  std::vector<std::vector<Near>> near_;      // nearest first
  std::vector<steer::Choices> choices_;
  std::vector<uint8_t> yields_, in_stream_;
  std::vector<crowd::Rest> next_rest_of_;
  std::vector<uint8_t> nears_goal_;  // and has decided in this step
  std::vector<Plan> plans_;          // of those that decide in this step
};

/// Bodies at random places of a periodic square, `area` m2 per body, with goals within 50 m along
/// each axis. Bodies that arrive get another goal from `next_goal`.
std::vector<PlainBody> random_bodies(const PlainConfig& config, uint32_t count, double area,
                                     uint64_t seed, int32_t& side);
Spot next_goal(const PlainConfig& config, const PlainBody& body, uint64_t seed, uint32_t index,
               uint64_t turn);

/// Bodies on rings around `middle` from `radius` metres outward, 1.2 m apart, each heading to the
/// opposite point.
std::vector<PlainBody> ring_bodies(const PlainConfig& config, uint32_t count, double radius,
                                   Spot middle = {});

}  // namespace throng::test
