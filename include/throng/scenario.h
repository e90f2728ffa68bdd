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

/// Scenarios: who comes into a world, when, where from, where to, and what he does on the way. One
/// readable file (TOML or JSON); docs/scenarios.md has every key.
namespace throng {

/// A number that is drawn, for each person anew.
struct Distribution {
  enum class Kind : uint8_t { kFixed, kUniform, kNormal, kExponential };
  Kind kind = Kind::kFixed;
  double a = 0;  ///< The value; the lowest; the mean; the mean.
  double b = 0;  ///< Of kUniform the highest, of kNormal the standard deviation.
  /// What is drawn outside these is drawn again. [low < high, or both the fixed value]
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();

  static Distribution fixed(double value) { return {Kind::kFixed, value, 0, value, value}; }
};

/// The n-th number of a stream, the same on every machine. After 64 draws outside low to high the
/// nearer of them.
[[nodiscard]] THRONG_API double draw(const Distribution& distribution, uint64_t seed,
                                     uint64_t stream, uint64_t n);

/// A region of the ground, the union of prisms.
struct ScenarioArea {
  std::string name;
  std::vector<Prism> prisms;
  double pace = 1;  ///< Of his speed that somebody walks at inside: stairs, sand. [0.01 to 10]
};

/// What weighs how much; a choice among them is drawn.
struct Choice {
  int32_t index = 0;
  double weight = 1;  ///< [> 0]
};

/// A kind of person.
struct Profile {
  std::string name;
  std::string avatar_class;  ///< Empty: the world's first.
  Distribution speed;        ///< Wished; 0: the class's. [m/s]
  Distribution radius;       ///< Of the body; 0: the class's. [m]
};

/// How many may be where: a picture, looked at from above, whose brightness is a weight.
struct DensityMap {
  std::string name;
  double x0 = 0, z0 = 0, x1 = 0, z1 = 0;  ///< Corners of the picture. [m, x0 < x1, z0 < z1]
  double low = -1e6, high = 1e6;          ///< Heights of the floors that it is for. [m]
  int32_t width = 0, height = 0;          ///< [pixels]
  std::vector<uint8_t> weights;           ///< Row by row, Z grows downwards; 0: nobody.
};

/// One thing after the other that a person does.
struct Stage {
  enum class Kind : uint8_t {
    kGo,     ///< Walks until inside one of `areas`.
    kSpot,   ///< Walks to a place of his own in one of `areas`, or where `density` says.
    kWait,   ///< Stands for `seconds`.
    kQueue,  ///< Lines up at `queue`, until served.
    kLink,   ///< Takes the lift or escalator `link`.
    kLeave,  ///< Walks until inside one of `areas`, and is gone.
  };
  Kind kind = Kind::kGo;
  std::vector<int32_t> areas;
  /// kGo, kLeave, of several areas: the nearest, or that which is likely to be reached and passed
  /// first, looked at again every few seconds.
  bool quickest = false;
  int32_t density = -1;
  int32_t queue = -1;
  int32_t link = -1;
  Distribution seconds;
};

struct Journey {
  std::string name;
  std::vector<Stage> stages;
  bool repeat = false;  ///< Begins again after its last stage; else one stays there.
};

/// Where people come from.
struct Source {
  std::string name;
  std::vector<int32_t> areas;    ///< A place in one of them,
  int32_t density = -1;          ///< or where this map says.
  std::vector<Choice> profiles;  ///< Empty: the world's first class as it is.
  std::vector<Choice> journeys;  ///< Empty: they stand.
  uint64_t count = UINT64_MAX;   ///< At most so many.
  double begin = 0;              ///< [s]
  double end = HUGE_VAL;         ///< [s]
  /// People a second from a time on, each until the next; empty: all `count` at once. The gaps
  /// between them are exponential: a Poisson process.
  std::vector<std::pair<double, double>> rates;
  bool even = false;  ///< Gaps are all alike instead.
  /// In rows over the box around its area instead of by chance: so that dense crowds find room.
  /// [one area, a finite count, no rates, no density]
  bool in_rows = false;
  Distribution premovement;  ///< Stands so long before his journey begins. [s]
  Distribution group;        ///< So many come together and stay together. [people]
};

/// A line of people before a counter or a gate.
struct Queue {
  std::string name;
  std::vector<Vec3d> line;  ///< From its head backwards. [m]
  double spacing = 0.6;     ///< Between those in line. [m]
  int32_t servers = 1;      ///< The first so many are served.
  Distribution service;     ///< [s]
};

/// A lift, an escalator, a shuttle: who stands in `from` when it leaves comes out in `to` later.
struct Link {
  std::string name;
  int32_t from = 0, to = 0;  ///< Areas.
  double interval = 1;       ///< From leaving to leaving. [s]
  int32_t capacity = 1;      ///< People each time.
  double seconds = 0;        ///< On the way.
};

/// Something that is in the way for a time: a crate, a shut door, a barrier.
struct ScenarioObstacle {
  std::string name;
  Prism prism;
  double begin = 0, end = HUGE_VAL;                      ///< When it is to come, and goes. [s]
  ObstaclePolicy policy = ObstaclePolicy::kRefuseEntry;  ///< What is done about who stands there.
};

/// "shut" or "wait", as in scenario files.
[[nodiscard]] THRONG_API const char* name_of(ObstaclePolicy policy);

struct Scenario {
  // Where: one of these, in this order.
  std::string world;                         ///< A folder; relative paths are the file's.
  std::vector<std::string> models;           ///< Files to bake.
  std::vector<BuiltinWorldConfig> builtins;  ///< The same.
  std::vector<PlaneConfig> planes;           ///< A plane with obstacles; one or none.
  double cell = 0.1;                         ///< Of a bake. [m]
  std::vector<AvatarClass> classes;          ///< Of a bake; empty: the default ones.

  double seconds = 60;  ///< How long. [s]
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

/// Reads a scenario file. Fails with kNotFound, or kBadFile with the line, the key and what is
/// wrong.
[[nodiscard]] THRONG_API Result<Scenario> load_scenario(const std::string& path);
/// The same for a text; `name` stands in messages, its folder is where relative paths begin.
[[nodiscard]] THRONG_API Result<Scenario> parse_scenario(const std::string& text,
                                                         const std::string& name);
/// Opens the scenario's world, or bakes it in memory.
[[nodiscard]] THRONG_API Result<World> open_world(const Scenario& scenario, Context& context);
/// What a scenario's world is baked of. Fails as load_scene does, and with kBadConfig for one that
/// opens a baked world: it keeps no triangles.
[[nodiscard]] THRONG_API Result<Scene> load_scene(const Scenario& scenario, Context& context,
                                                  SceneLooks looks = SceneLooks::kLeaveOut);
/// Bakes a scenario's world of what load_scene has read.
[[nodiscard]] THRONG_API Result<World> bake_world(const Scenario& scenario, const Scene& scene,
                                                  Context& context);

}  // namespace throng
