// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "throng/avatar.h"
#include "throng/base.h"
#include "throng/crowd.h"
#include "throng/path.h"
#include "throng/picture.h"
#include "throng/scene.h"
#include "throng/world.h"

/// Scenarios: files that describe avatars, their sources and journeys; runs, trials of many runs,
/// validation.
namespace throng {

// ----
// Scenarios: which avatars enter a world, when and where, where they head to, and what they do on
// their journeys. One readable file (TOML or JSON); docs/scenarios.md lists every key.

/// A random number with a distribution, drawn for each avatar.
struct Distribution {
  /// Its shape.
  enum class Kind : uint8_t { kFixed, kUniform, kNormal, kExponential };
  Kind kind = Kind::kFixed;
  double a = 0;  ///< By kind: the value; the minimum; the mean; the mean.
  double b = 0;  ///< Of kUniform the maximum, of kNormal the standard deviation.
  /// Bounds: a number outside is drawn again. [low < high, or both the fixed value]
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();

  /// One that always gives the same number.
  static Distribution fixed(double value) { return {Kind::kFixed, value, 0, value, value}; }
};

/// The n-th number of a stream, the same on every machine. After 64 draws outside of the bounds,
/// the bound nearer to the last one.
[[nodiscard]] THRONG_API double draw(const Distribution& distribution, uint64_t seed,
                                     uint64_t stream, uint64_t n);

/// An area: a region of the ground, the union of prisms.
struct ScenarioArea {
  std::string name;
  std::vector<Prism> prisms;
  /// Speed factor: share of its desired speed at which an avatar walks inside, as on stairs or
  /// sand. [0.01 to 10]
  double speed_factor = 1;
};

/// One of several alternatives, with a weight; one is drawn at random by the weights.
struct Choice {
  int32_t index = 0;  ///< Of a profile or a journey of the scenario.
  double weight = 1;  ///< [> 0]
};

/// A kind of avatar.
struct Profile {
  std::string name;
  std::string avatar_class;  ///< Empty: the world's first.
  Distribution speed;        ///< Desired; 0: the class's. [m/s]
  Distribution radius;       ///< Of the body; 0: the class's. [m]
};

/// The weights of a density map at a time of the run.
struct DensityHour {
  double at = 0;                 ///< [s, >= 0]
  std::vector<uint8_t> weights;  ///< As DensityMap::weights. [not all 0]
};

/// A density map: a picture seen from above whose brightness is a weight.
struct DensityMap {
  std::string name;
  double x0 = 0, z0 = 0, x1 = 0, z1 = 0;  ///< Corners of the picture. [m, x0 < x1, z0 < z1]
  double low = -1e6, high = 1e6;          ///< Heights of the floors to which it applies. [m]
  int32_t width = 0, height = 0;          ///< [pixels]
  std::vector<uint8_t> weights;           ///< Row by row, Z grows downwards; 0: no avatars.
  /// Weights by time, ascending; between two times they are blended, once a second. Before the
  /// first and after the last theirs hold. None: `weights` hold.
  std::vector<DensityHour> hours{};
  /// After this time the hours begin again, and the last is blended with the first; 0: never. [s,
  /// more than the last hour]
  double period = 0;
};

/// A stage: one thing that an avatar does in a journey.
struct Stage {
  /// What the avatar does.
  enum class Kind : uint8_t {
    kGo,           ///< Walks until it is inside one of `areas`.
    kRandomPoint,  ///< Walks to a random point in one of `areas`, or drawn from `density`.
    kWait,         ///< Stands for `seconds`.
    kQueue,        ///< Stands in line at `queue` until it has been served.
    kLink,         ///< Takes the lift or escalator `link`.
    kLeave,        ///< Walks until it is inside one of `areas`, and leaves the simulation.
  };
  Kind kind = Kind::kGo;
  std::vector<int32_t> areas;  ///< kGo, kRandomPoint, kLeave.
  /// kGo, kLeave with several areas. False: the nearest one. True: the one that is likely to be
  /// reached and passed first, chosen again every few seconds.
  bool quickest = false;
  int32_t density = -1;  ///< kRandomPoint: index of a density map; -1: `areas` count.
  int32_t queue = -1;    ///< kQueue.
  int32_t link = -1;     ///< kLink.
  Distribution seconds;  ///< kWait. [s]
};

/// A journey: the stages of an avatar, in order.
struct Journey {
  std::string name;
  std::vector<Stage> stages;
  bool repeat = false;  ///< Begins again after the last stage; else the avatar stays there.
};

/// How a source distributes its avatars over time and space.
enum class SpawnPattern : uint8_t {
  kRandom,  ///< At exponential intervals (a Poisson process), at random places.
  kEven,    ///< At equal intervals, at random places.
  /// All at once, in rows over the box around the area, so that dense crowds find space. [one area,
  /// a finite count, no rates, no density]
  kRows,
};

/// Where and when avatars enter.
struct Source {
  std::string name;
  /// Where the avatars enter: at a random place in one of these areas, if `density` is -1.
  std::vector<int32_t> areas;
  int32_t density = -1;          ///< Else: at a place that is drawn from this density map.
  std::vector<Choice> profiles;  ///< Empty: the world's first class as it is.
  std::vector<Choice> journeys;  ///< Empty: the avatars stand.
  uint64_t count = UINT64_MAX;   ///< Maximum number of avatars.
  double begin = 0;              ///< [s]
  double end = HUGE_VAL;         ///< [s]
  /// Pairs of time and rate, each rate until the next time; empty: all `count` at once. [s,
  /// avatars/s]
  std::vector<std::pair<double, double>> rates;
  SpawnPattern pattern = SpawnPattern::kRandom;
  Distribution premovement;  ///< Premovement time: stands so long before its journey begins. [s]
  Distribution group;        ///< Size of a group that enters and stays together. [avatars]
};

/// A line of avatars before a counter or a gate.
struct Queue {
  std::string name;
  std::vector<Vec3d> line;  ///< From its head to its end. [m]
  double spacing = 0.6;     ///< Between neighbours in the line. [m]
  int32_t servers = 1;      ///< Avatars that are served at the same time, from the head.
  Distribution service;     ///< How long an avatar is served. [s]
};

/// A lift, an escalator, a shuttle: avatars that stand in `from` when it leaves come out in `to`
/// later.
struct Link {
  std::string name;
  int32_t from = 0, to = 0;  ///< Areas.
  double interval = 1;       ///< Between two departures. [s]
  int32_t capacity = 1;      ///< Avatars per departure.
  double seconds = 0;        ///< Of the ride. [s]
};

/// An obstacle for a time: a crate, a shut door, a barrier.
struct ScenarioObstacle {
  std::string name;
  Prism prism;
  double begin = 0, end = HUGE_VAL;                      ///< When it is requested and removed. [s]
  ObstaclePolicy policy = ObstaclePolicy::kRefuseEntry;  ///< What happens if avatars stand there.
  /// Where it moves, as a cart or a float: its prism begins at the first of these points, and moves
  /// with them to the last and back, again and again. It waits while avatars stand before it. Paths
  /// do not avoid it, avatars do. Empty: it stands. [m, at least 2 points]
  std::vector<std::array<double, 2>> line = {};
  double speed = 1;  ///< Of one that moves. [m/s, > 0 to 100]
};

/// Draws a crowd towards something that moves: around it a density map is darker. [TC00] 5.
struct Attractor {
  std::string name = {};
  int32_t density = -1;   ///< The map. Where its weight is 0, it stays 0.
  int32_t source = -1;    ///< It is fixed to each avatar of this source, as a jogger;
  int32_t obstacle = -1;  ///< or to this obstacle.
  double radius = 10;     ///< Its weight falls evenly to 0 at this distance. [m, > 0 to 1000]
  uint8_t weight = 255;   ///< In its middle. The larger one counts, of it and the map's. [1 to 255]
};

/// The name of a policy in scenario files: "shut" or "wait".
[[nodiscard]] THRONG_API const char* name_of(ObstaclePolicy policy);

/// A whole scenario. Members refer to each other by index.
struct Scenario {
  // The world: the first of these that is given.
  std::string world;          ///< A folder; relative paths start at the scenario file's folder.
  std::optional<Box3d> part;  ///< Of the folder's world: WorldConfig::part.
  std::vector<std::string> models;           ///< Files to bake.
  std::vector<BuiltinWorldConfig> builtins;  ///< Built-in worlds to bake.
  std::vector<PlaneConfig> planes;           ///< A plane with obstacles; one or none.
  double cell = 0.1;                         ///< Of a bake. [m]
  std::vector<AvatarClass> classes;          ///< Of a bake; empty: the default ones.

  double seconds = 60;  ///< Duration. [s]
  double dt = 0.1;      ///< [s]
  uint64_t seed = 1;
  PathSpeedup paths = PathSpeedup::kNone;               ///< CrowdConfig::speedup.
  uint64_t search_bytes = SearchBudget::kDefaultBytes;  ///< As in CrowdConfig.
  SteeringModel steering = SteeringModel::kSampled;     ///< CrowdConfig::model.
  bool slow_on_slopes = true;                           ///< As in CrowdConfig.
  bool avoid_jams = true;                               ///< As in CrowdConfig.
  bool pushing = false;  ///< Avatars do not queue: CrowdTuning::queues is false.
  double acceleration = CrowdTuning{}.acceleration;  ///< As in CrowdTuning. [m/s2]

  std::vector<ScenarioArea> areas;
  std::vector<DensityMap> densities;
  std::vector<Profile> profiles;
  std::vector<Journey> journeys;
  std::vector<Source> sources;
  std::vector<Queue> queues;
  std::vector<Link> links;
  std::vector<ScenarioObstacle> obstacles;
  std::vector<Attractor> attractors = {};

  /// As CrowdTuning::let_push.
  void let_push() {
    pushing = true;
    acceleration = 0;
  }
};

/// Reads a scenario file. Fails with kBadFile (missing, or the line, the key and the reason) or
/// kIo.
[[nodiscard]] THRONG_API Result<Scenario> load_scenario(const std::string& path);
/// The same for a text. `name` is used in messages; relative paths start at its folder.
[[nodiscard]] THRONG_API Result<Scenario> parse_scenario(const std::string& text,
                                                         const std::string& name);
/// Reads a density map from a PNG, a picture seen from above whose brightness is the weight. Its
/// corners are not in the file: they stay 0. Fails with kBadFile, also if all weights are 0.
[[nodiscard]] THRONG_API Result<DensityGrid> load_density(const std::string& path);
/// Opens the scenario's world, or bakes it in memory.
[[nodiscard]] THRONG_API Result<World> open_world(const Scenario& scenario, Context& context);
/// Reads the triangles that a scenario's world is baked from. Fails as load_scene does, and with
/// kBadConfig if the scenario opens a baked world, which keeps no triangles.
[[nodiscard]] THRONG_API Result<Scene> load_scene(
    const Scenario& scenario, Context& context,
    SceneMaterials materials = SceneMaterials::kLeaveOut);
/// Bakes a scenario's world from the scene that load_scene has read.
[[nodiscard]] THRONG_API Result<World> bake_world(const Scenario& scenario, const Scene& scene,
                                                  Context& context);

// ----
// A running scenario: avatars enter, do the stages of their journeys, and leave.

/// What one step of a simulation did, and its state afterwards.
struct SimulationReport {
  CrowdReport crowd;              ///< Of the crowd's step.
  double time = 0;                ///< After the step. [s]
  uint64_t entered = 0;           ///< So far.
  uint64_t left = 0;              ///< So far.
  uint64_t goal_unreachable = 0;  ///< Now: avatars that wait because no path leads to their goals.
  uint64_t outside = 0;           ///< Now: due to enter, but without free space yet.
  uint64_t in_links = 0;          ///< Now: in lifts and on escalators, so not in the crowd.
  /// In this step: places that were tried for avatars that were to enter. A full source tries few,
  /// however many wait there.
  uint64_t entry_tries = 0;
};

/// A trip: one avatar from entering to leaving.
struct Trip {
  uint64_t person = 0;   ///< From 0, in order of entering.
  int32_t source = 0;    ///< Of the scenario.
  int32_t profile = -1;  ///< -1: none.
  int32_t journey = -1;  ///< -1: none.
  double entered = -1;   ///< -1: not yet, for lack of free space. [s]
  double started = 0;    ///< After the premovement time. [s]
  double left = -1;      ///< -1: not yet. [s]
  int32_t exit = -1;     ///< Area by which it left.
  double speed = 0;      ///< Desired. [m/s]
};

/// Times of an obstacle of the scenario.
struct ObstacleTimes {
  double requested_at = -1;  ///< When it was requested; -1: not yet. [s]
  double up = -1;  ///< When it came up: no body is in it since then; -1: not yet, or never. [s]
  double removed_at = -1;  ///< When it was removed; -1: not yet. [s]
  uint32_t inside = 0;     ///< Avatars inside at the request.
  uint32_t waits_for = 0;  ///< Avatars inside now, for which it waits.
};

/// A simulation of a scenario. Movable, not copyable. One thread at a time. The same scenario gives
/// the same steps on any machine with any number of workers.
class THRONG_API Simulation {
 public:
  /// Makes a simulation. If a class climbs or drops, the nodes beside the world are opened or, for
  /// a world baked from models, made from these. Fails with kBadInput (an area in which a class
  /// cannot stand, ...), kNotFound (a class that the world does not have), and as load_scene,
  /// Nodes::create, Nodes::open, Crowd::create, add and add_target do.
  [[nodiscard]] static Result<Simulation> create(const World& world, const Scenario& scenario,
                                                 int32_t workers, Context& context);
  /// The same by all ranks that mpirun has started together, which share its crowd: see
  /// crowd_over_ranks. Every rank makes the same calls with the same arguments in the same order.
  [[nodiscard]] static Result<Simulation> create_over_ranks(const World& world,
                                                            const Scenario& scenario,
                                                            int32_t workers, Context& context);
  Simulation(Simulation&&) noexcept;
  Simulation& operator=(Simulation&&) noexcept;
  ~Simulation();

  /// Advances by the scenario's dt. Fails as Crowd::add does.
  [[nodiscard]] Result<SimulationReport> step();
  /// Have all avatars left, and will no more enter? Then none is in the crowd, outside or in a
  /// link.
  [[nodiscard]] bool is_over() const;

  /// The crowd of all avatars that are not outside or in a link.
  [[nodiscard]] const Crowd& crowd() const;
  /// Reads the avatars of the crowd in ascending order of id, which is Trip::person modulo 2^32.
  void read(std::vector<AvatarState>& out) const;
  /// XXH3 of the crowd and of the state of all journeys.
  [[nodiscard]] uint64_t state_hash() const;
  /// All trips so far, in order of entering.
  [[nodiscard]] std::span<const Trip> trips() const;

  /// The times of each obstacle of the scenario, in its order.
  [[nodiscard]] std::span<const ObstacleTimes> obstacle_times() const;

  /// Replaces the weights of a density map, from the next draw on, and ends its hours. Avatars that
  /// follow it leave what becomes 0. Fails with kNotFound, kBadInput (another number of pixels, or
  /// all are 0).
  [[nodiscard]] Result<void> set_density(const std::string& name, std::span<const uint8_t> weights);
  /// Fixes an attractor to an avatar (Trip::person) until it leaves; a second one replaces the
  /// first, and weight 0 removes it. Fails with kNotFound (no such map, or the avatar is not in the
  /// crowd) and kBadConfig (radius). [radius: m, > 0 to 1000]
  [[nodiscard]] Result<void> attract(const std::string& density, uint64_t person, double radius,
                                     uint8_t weight);

 private:
  struct State;
  explicit Simulation(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

// ----
// Validation: experiments with crowds whose outcome is known from real people or required by a
// standard. Each runs on the public `Crowd`, measures by a stated method, and judges the result by
// a range.

/// A measured value, and the bounds between which it passes.
struct ValidationMeasure {
  std::string name;
  double value = 0;       ///< In `unit`.
  std::string unit = {};  ///< As it is printed; empty: a number without a unit.
  /// It passes within these, both included.
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();

  /// Has it a bound? Without one the value is only reported.
  [[nodiscard]] bool is_judged() const {
    return low > -std::numeric_limits<double>::infinity() ||
           high < std::numeric_limits<double>::infinity();
  }
  /// Is the value within its bounds? True without bounds.
  [[nodiscard]] bool passed() const { return !is_judged() || (value >= low && value <= high); }
};

/// A chart and the name of its file, without a suffix.
struct ValidationChart {
  std::string name;
  Chart chart;
};

/// One test of the list.
struct ValidationTest {
  std::string name;    ///< The name for run_validation.
  std::string title;   ///< What is tested.
  std::string method;  ///< How it is measured, in sentences.
  std::string source;  ///< Source of the range: keys of docs/references.md.
  /// Known to be missed today. `throng validate` runs it only if it is named.
  bool in_work = false;
};

/// Settings for run_validation and run_trial.
struct ValidationConfig {
  uint64_t seed = 1;
  int32_t workers = 0;  ///< Threads, 0 for all cores. Never changes the result. [>= 0]
  bool brief = false;   ///< Fewer points and shorter runs.
  /// The steering model of the crowds. The default leaves trials the model of their scenarios.
  SteeringModel model = SteeringModel::kSampled;
  /// Avatars push instead of queueing, and nothing limits their acceleration: CrowdTuning::queues
  /// is false. False leaves trials what their scenarios say.
  bool pushing = false;
};

/// The results of a test.
struct ValidationResult {
  std::vector<ValidationMeasure> measures;
  std::vector<ValidationChart> charts;
  CrowdCheck faults;     ///< Overlaps and wall entries, over all checks.
  uint64_t checks = 0;   ///< Checks of all avatars for these.
  double simulated = 0;  ///< [s]
  double seconds = 0;    ///< Wall clock.

  /// Is every measure within its bounds, without faults?
  [[nodiscard]] THRONG_API bool passed() const;
};

/// All tests, in the order of the tables.
[[nodiscard]] THRONG_API std::vector<ValidationTest> validation_tests();

/// Runs one test. Fails with kNotFound (no such test), kCancelled.
[[nodiscard]] THRONG_API Result<ValidationResult> run_validation(const std::string& name,
                                                                 const ValidationConfig& config,
                                                                 Context& context);

/// The tests that need recordings of real people, which are not part of throng.
[[nodiscard]] THRONG_API std::vector<ValidationTest> recorded_validation_tests();

/// Runs one of these tests with a folder of recordings. Fails with kNotFound (no such test, or no
/// recording for it in the folder), kBadFile and the line, kCancelled.
[[nodiscard]] THRONG_API Result<ValidationResult> run_recorded_validation(
    const std::string& name, const std::string& folder, const ValidationConfig& config,
    Context& context);

// ----
// Trials: scenario files that state what their run must measure (tables [trial] and [[measure]],
// docs/validation.md), such as the tests of the standards.

/// The quantity that is measured.
enum class Observed : uint8_t {
  kTime,          ///< From the end of the premovement to leaving, per avatar. [s]
  kLeft,          ///< Time of leaving, per avatar. [s]
  kPremovement,   ///< From entering to the end of the premovement, per avatar. [s]
  kDelay,         ///< From the end of the premovement to the first move, per avatar. [s]
  kDesiredSpeed,  ///< Desired speed, per avatar. [m/s]
  /// Distance divided by time, per avatar, in an area or since the premovement. [m/s]
  kSpeed,
  kPeople,      ///< Number of avatars that left.
  kStayed,      ///< Number of avatars that entered and have not left.
  kDensity,     ///< Avatars in an area divided by its size, at each step. [1/m2]
  kFlow,        ///< Avatars per second over a line, or per metre of it. [p/s, p/(m s)]
  kPassed,      ///< Number of avatars that crossed a line.
  kRatio,       ///< The first of two earlier measures divided by the second.
  kDifference,  ///< The first of two earlier measures less the second.
  /// The smallest difference between an earlier measure and the one listed before it: 0 or more if
  /// they never fall.
  kRise,
};

/// How the numbers of a measure become one.
enum class Statistic : uint8_t {
  kMean,
  kMin,
  kMax,
  kRange,    ///< kMax - kMin.
  kOverall,  ///< Of kSpeed: the sum of all distances divided by that of all times.
  kFit,      ///< Likelihood that they were drawn from the scenario's distribution [Stephens70].
};

/// A measure: which quantity of which avatars, and the bounds between which it passes.
struct TrialMeasure {
  std::string name;
  Observed of = Observed::kTime;
  Statistic statistic = Statistic::kMean;
  std::vector<int32_t> sources, profiles, journeys;  ///< Only these; empty: all.
  std::vector<int32_t> exits;  ///< Only avatars that left by these areas; empty: all.
  int32_t area = -1;           ///< kSpeed, kDensity.
  std::array<std::array<double, 2>, 2> line = {};  ///< kFlow, kPassed. [x, z, m]
  bool by_width = false;                           ///< kFlow: per metre of the line.
  double from = 0;                                 ///< kSpeed, kDensity, kFlow, kPassed. [s]
  double until = std::numeric_limits<double>::infinity();  ///< [s]
  std::vector<size_t> others;                              ///< Indices of earlier measures.
  /// As in ValidationMeasure.
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
};

/// A trial: a scenario and its measures.
struct Trial {
  ValidationTest about;  ///< Its name, what it tests, how and whence.
  std::string note;      ///< What differs from the source.
  /// What the simulation cannot do yet, so that the trial does not run; empty: nothing.
  std::string lacks;
  Scenario scenario;  ///< Empty if something is lacking.
  std::vector<TrialMeasure> measures;
};

/// Reads a trial. Fails as load_scenario does, and with kBadFile if it has no measures.
[[nodiscard]] THRONG_API Result<Trial> load_trial(const std::string& path);
/// The same for a text; `name` is used in messages.
[[nodiscard]] THRONG_API Result<Trial> parse_trial(const std::string& text,
                                                   const std::string& name);
/// Reads all trials below a folder, sorted by name. Fails with kNotFound (no folder), and as
/// load_trial does.
[[nodiscard]] THRONG_API Result<std::vector<Trial>> load_trials(const std::string& folder);

/// Runs a trial's scenario until its time is over or all avatars have left, and checks every step
/// for overlaps and wall entries. config.seed 1 is the scenario's own seed, 2 the next one, and so
/// on. Fails with kBadConfig (something is lacking), and as open_world and Simulation::create do.
[[nodiscard]] THRONG_API Result<ValidationResult> run_trial(const Trial& trial,
                                                            const ValidationConfig& config,
                                                            Context& context);

}  // namespace throng
