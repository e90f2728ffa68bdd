// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "throng/avatar_class.h"
#include "throng/base.h"
#include "throng/builtin_worlds.h"
#include "throng/context.h"
#include "throng/crowd_obstacle.h"
#include "throng/prism.h"
#include "throng/result.h"
#include "throng/scene.h"
#include "throng/search_budget.h"
#include "throng/steering_model.h"
#include "throng/world.h"

/// Scenarios: which avatars enter a world, when and where, where they head to, and what they do on
/// their journeys. One readable file (TOML or JSON); docs/scenarios.md lists every key.
namespace throng {

/// A random number with a distribution, drawn for each person.
struct Distribution {
  enum class Kind : uint8_t { kFixed, kUniform, kNormal, kExponential };
  Kind kind = Kind::kFixed;
  double a = 0;  ///< By kind: the value; the minimum; the mean; the mean.
  double b = 0;  ///< Of kUniform the maximum, of kNormal the standard deviation.
  /// Bounds: a number outside is drawn again. [low < high, or both the fixed value]
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();

  static Distribution fixed(double value) { return {Kind::kFixed, value, 0, value, value}; }
};

/// The n-th number of a stream, the same on every machine. After 64 draws outside of low to high,
/// the nearer of these.
[[nodiscard]] THRONG_API double draw(const Distribution& distribution, uint64_t seed,
                                     uint64_t stream, uint64_t n);

/// An area: a region of the ground, the union of prisms.
struct ScenarioArea {
  std::string name;
  std::vector<Prism> prisms;
  /// Speed factor: share of its desired speed at which an avatar walks inside, as on stairs or
  /// sand. [0.01 to 10]
  double pace = 1;
};

/// One of several alternatives, with a weight; one is drawn at random by the weights.
struct Choice {
  int32_t index = 0;
  double weight = 1;  ///< [> 0]
};

/// A kind of avatar.
struct Profile {
  std::string name;
  std::string avatar_class;  ///< Empty: the world's first.
  Distribution speed;        ///< Desired; 0: the class's. [m/s]
  Distribution radius;       ///< Of the body; 0: the class's. [m]
};

/// A density map: a picture seen from above whose brightness is a weight.
struct DensityMap {
  std::string name;
  double x0 = 0, z0 = 0, x1 = 0, z1 = 0;  ///< Corners of the picture. [m, x0 < x1, z0 < z1]
  double low = -1e6, high = 1e6;          ///< Heights of the floors to which it applies. [m]
  int32_t width = 0, height = 0;          ///< [pixels]
  std::vector<uint8_t> weights;           ///< Row by row, Z grows downwards; 0: no avatars.
};

/// A stage: one thing that an avatar does in a journey.
struct Stage {
  enum class Kind : uint8_t {
    kGo,     ///< Walks until it is inside one of `areas`.
    kSpot,   ///< Walks to a random point in one of `areas`, or drawn from `density`.
    kWait,   ///< Stands for `seconds`.
    kQueue,  ///< Stands in line at `queue` until it has been served.
    kLink,   ///< Takes the lift or escalator `link`.
    kLeave,  ///< Walks until it is inside one of `areas`, and leaves the simulation.
  };
  Kind kind = Kind::kGo;
  std::vector<int32_t> areas;
  /// kGo, kLeave with several areas. False: the nearest one. True: the one that is likely to be
  /// reached and passed first, chosen again every few seconds.
  bool quickest = false;
  int32_t density = -1;
  int32_t queue = -1;
  int32_t link = -1;
  Distribution seconds;
};

/// A journey: the stages of an avatar, in order.
struct Journey {
  std::string name;
  std::vector<Stage> stages;
  bool repeat = false;  ///< Begins again after the last stage; else the avatar stays there.
};

/// Where and when avatars enter.
struct Source {
  std::string name;
  std::vector<int32_t> areas;    ///< A place in one of them,
  int32_t density = -1;          ///< or drawn from this map.
  std::vector<Choice> profiles;  ///< Empty: the world's first class as it is.
  std::vector<Choice> journeys;  ///< Empty: the avatars stand.
  uint64_t count = UINT64_MAX;   ///< Maximum number of avatars.
  double begin = 0;              ///< [s]
  double end = HUGE_VAL;         ///< [s]
  /// Pairs of time and rate, each rate until the next time; empty: all `count` at once. Intervals
  /// between avatars are exponential: a Poisson process. [s, people/s]
  std::vector<std::pair<double, double>> rates;
  bool even = false;  ///< Equal intervals in place of exponential ones.
  /// In rows over the box around the area, not at random, so that dense crowds find space. [one
  /// area, a finite count, no rates, no density]
  bool in_rows = false;
  Distribution premovement;  ///< Premovement time: stands so long before its journey begins. [s]
  Distribution group;        ///< Size of a group that enters and stays together. [people]
};

/// A line of avatars before a counter or a gate.
struct Queue {
  std::string name;
  std::vector<Vec3d> line;  ///< From its head to its end. [m]
  double spacing = 0.6;     ///< Between neighbours in the line. [m]
  int32_t servers = 1;      ///< Avatars that are served at the same time, from the head.
  Distribution service;     ///< [s]
};

/// A lift, an escalator, a shuttle: avatars that stand in `from` when it leaves come out in `to`
/// later.
struct Link {
  std::string name;
  int32_t from = 0, to = 0;  ///< Areas.
  double interval = 1;       ///< Between two departures. [s]
  int32_t capacity = 1;      ///< People per departure.
  double seconds = 0;        ///< Of the ride. [s]
};

/// An obstacle for a time: a crate, a shut door, a barrier.
struct ScenarioObstacle {
  std::string name;
  Prism prism;
  double begin = 0, end = HUGE_VAL;                      ///< When it is requested and removed. [s]
  ObstaclePolicy policy = ObstaclePolicy::kRefuseEntry;  ///< What happens if avatars stand there.
};

/// The name of a policy in scenario files: "shut" or "wait".
[[nodiscard]] THRONG_API const char* name_of(ObstaclePolicy policy);

/// A whole scenario. Members refer to each other by index.
struct Scenario {
  // The world: the first of these that is given.
  std::string world;  ///< A folder; relative paths start at the scenario file's folder.
  std::vector<std::string> models;           ///< Files to bake.
  std::vector<BuiltinWorldConfig> builtins;  ///< Built-in worlds to bake.
  std::vector<PlaneConfig> planes;           ///< A plane with obstacles; one or none.
  double cell = 0.1;                         ///< Of a bake. [m]
  std::vector<AvatarClass> classes;          ///< Of a bake; empty: the default ones.

  double seconds = 60;  ///< Duration. [s]
  double dt = 0.1;      ///< [s]
  uint64_t seed = 1;
  bool labels = false, zones = false;                   ///< As in CrowdConfig.
  uint64_t search_bytes = SearchBudget::kDefaultBytes;  ///< As in CrowdConfig.
  SteeringModel steering = SteeringModel::kSampled;     ///< CrowdConfig::model.

  std::vector<ScenarioArea> areas;
  std::vector<DensityMap> densities;
  std::vector<Profile> profiles;
  std::vector<Journey> journeys;
  std::vector<Source> sources;
  std::vector<Queue> queues;
  std::vector<Link> links;
  std::vector<ScenarioObstacle> obstacles;
};

/// Reads a scenario file. Fails with kNotFound, or with kBadFile and the line, the key and the
/// reason.
[[nodiscard]] THRONG_API Result<Scenario> load_scenario(const std::string& path);
/// The same for a text. `name` is used in messages; relative paths start at its folder.
[[nodiscard]] THRONG_API Result<Scenario> parse_scenario(const std::string& text,
                                                         const std::string& name);
/// Opens the scenario's world, or bakes it in memory.
[[nodiscard]] THRONG_API Result<World> open_world(const Scenario& scenario, Context& context);
/// Reads the triangles that a scenario's world is baked from. Fails as load_scene does, and with
/// kBadConfig if the scenario opens a baked world, which keeps no triangles.
[[nodiscard]] THRONG_API Result<Scene> load_scene(const Scenario& scenario, Context& context,
                                                  SceneLooks looks = SceneLooks::kLeaveOut);
/// Bakes a scenario's world from the scene that load_scene has read.
[[nodiscard]] THRONG_API Result<World> bake_world(const Scenario& scenario, const Scene& scene,
                                                  Context& context);

}  // namespace throng
