// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <DetourCrowd.h>
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <unordered_map>
#include <vector>

#include "crowd_judge.h"
#include "detour_mesh.h"
#include "throng/bake.h"
#include "throng/crowd.h"
#include "throng/world.h"

// Our crowd beside DetourCrowd in one world: the same bodies at the same places, heading to the
// same far goals at the same speed, one thread each, alternating every simulated second. An
// update's time is the whole of it: paths, avoidance, moves.
namespace throng::bench {
namespace {

using Json = nlohmann::ordered_json;
constexpr int kUpdates = 20;  // a second, as Recast's demo makes them
constexpr double kDt = 1.0 / kUpdates;
constexpr uint32_t kMaxOfDetour = 16000;  // Its grid holds 65536 / 4, then it hangs.

struct Options {
  std::string file;
  double cell = 0.1;  // ours; Detour's are 0.3 and 0.2 as usual
  uint32_t avatars = 10000;
  int seconds = 60;
  double speed = 3.5;  // Recast's demo's
  double far = 200;
  uint64_t seed = 1;
};

[[noreturn]] void stop(const std::string& message) {
  fmt::print(stderr, "bench_detour_crowd: {}\n", message);
  std::exit(2);
}

double seconds_of(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// The ends of a trip, and Detour's polygons there.
struct Trip {
  Place from, to;
  dtPolyRef from_polygon = 0, to_polygon = 0;
};

std::array<float, 3> floats(const Vec3d& p) {
  return {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
}

// Places of both worlds; the ends of each trip are far apart, and of the largest component. No two
// avatars touch at the start.
std::vector<Trip> draw_trips(const World& world, const dtNavMesh& mesh, const Options& o) {
  Context context;
  const auto graph = Graph::create(world, {}, context);
  if (!graph) stop(graph.error().message);
  dtNavMeshQuery query;
  const dtQueryFilter filter;
  if (dtStatusFailed(query.init(&mesh, 2048))) stop("Detour's query cannot be made");
  const double apart = 2 * AvatarClass{}.radius + 1e-3;
  uint64_t drawn = 0;
  const auto draw = [&](dtPolyRef& polygon) {
    for (;;) {
      if (++drawn > 2000 * uint64_t{o.avatars}) stop("too few places to stand; ask for fewer");
      const Place place = world.random_place(0, o.seed, drawn);
      if (graph->component_at(0, place) != 0) continue;
      const auto at = floats(place.position);
      const float around[3] = {0.02f, 0.5f, 0.02f};
      query.findNearestPoly(at.data(), around, &filter, &polygon, nullptr);
      if (polygon != 0) return place;
    }
  };
  std::vector<Trip> trips;
  std::unordered_map<int64_t, std::vector<Vec3d>> standing;  // by squares as wide as two bodies
  const auto square = [&](double x, double z) {
    return (static_cast<int64_t>(std::floor(x / apart)) << 32) +
           static_cast<int64_t>(std::floor(z / apart));
  };
  while (trips.size() < o.avatars) {
    Trip trip;
    trip.from = draw(trip.from_polygon);
    const Vec3d at = trip.from.position;
    bool clear = true;
    for (int n = 0; n < 9; ++n) {
      const auto found =
          standing.find(square(at.x + (n % 3 - 1) * apart, at.z + (n / 3 - 1) * apart));
      if (found == standing.end()) continue;
      for (const Vec3d& other : found->second) {
        clear = clear && (std::hypot(other.x - at.x, other.z - at.z) > apart ||
                          std::abs(other.y - at.y) > 2);
      }
    }
    if (!clear) continue;
    standing[square(at.x, at.z)].push_back(at);
    do {
      trip.to = draw(trip.to_polygon);
    } while (std::hypot(trip.to.position.x - at.x, trip.to.position.z - at.z) < o.far);
    trips.push_back(trip);
  }
  return trips;
}

// What is reported of a crowd.
struct Account {
  std::vector<double> seconds;  // that each simulated one takes
  uint64_t with_path = 0;       // after the first
  uint64_t partial = 0;         // of these, leading elsewhere
  uint64_t overlaps = 0, deep = 0;
  double deepest = 0;
  double walked = 0;  // by all, in the last second [m]
  std::vector<Stander> bodies;

  void walk_on(std::vector<Stander>&& now) {
    for (size_t i = 0; i < bodies.size(); ++i) {
      walked += std::hypot(now[i].x - bodies[i].x, now[i].z - bodies[i].z);
    }
    bodies = std::move(now);
  }
  void judge() {
    const Overlaps found = count_overlaps(bodies);
    overlaps += found.pairs;
    deep += found.deep;
    deepest = std::max(deepest, found.deepest);
  }
  [[nodiscard]] Json json(const Options& o) const {
    double sum = 0;
    for (const double s : seconds) sum += s;
    std::vector<double> sorted = seconds;
    std::sort(sorted.begin(), sorted.end());
    const double each = 1e6 / (double{kUpdates} * o.avatars);
    return {{"us_an_update", sum / static_cast<double>(seconds.size()) * each},
            {"us_median", sorted[sorted.size() / 2] * each},
            {"first_second", seconds.front()},
            {"with_path_after_1_s", with_path},
            {"partial", partial},
            {"speed_at_end", walked / o.avatars / o.speed},
            {"overlaps", overlaps},
            {"deep_overlaps", deep},
            {"deepest", deepest}};
  }
};

// A crowd as the comparison needs it: `update` once, and where all avatars stand.
class Ours {
 public:
  Ours(const World& world, const std::vector<Trip>& trips, const Options& o)
      : crowd_(make(world, o)) {
    std::vector<AvatarSpawn> spawns;
    for (const Trip& trip : trips) {
      spawns.push_back({.place = trip.from, .radius = AvatarClass{}.radius, .speed = o.speed});
      goals_.push_back(trip.to);
    }
    auto ids = crowd_.add(spawns, context_);
    if (!ids) stop(ids.error().message);
    ids_ = std::move(*ids);
    for (const AvatarId id : ids_) {
      if (!id) stop("an avatar of ours cannot stand at its place");
    }
  }
  void give_goals() { crowd_.set_goals(ids_, goals_); }
  void update() {
    const CrowdReport report = crowd_.step();
    // All avatars query in their first step; a later query is answered within its step.
    if (report.step == 1) with_path_ = report.planned - report.no_path;
    planned_ += report.planned;
    progress_ = report.progress;
    contested_ += report.contested;
    const double parts[] = {report.seconds_plan, report.seconds_sort, report.seconds_steer,
                            report.seconds_commit, report.seconds_settle};
    for (size_t i = 0; i < phases_.size(); ++i) phases_[i] += parts[i];
  }
  [[nodiscard]] std::vector<Stander> look() {
    crowd_.read(states_);
    std::vector<Stander> all;
    const AvatarClass adult;
    for (const AvatarState& s : states_) {
      all.push_back({s.position.x, s.position.y, s.position.z, adult.radius, adult.height});
    }
    return all;
  }
  void count_paths(Account& account) const { account.with_path = with_path_; }
  [[nodiscard]] uint64_t wall_entries() const { return crowd_.check().wall_entries; }
  // Where the time goes, of an update. [us]
  [[nodiscard]] Json phases(const Options& o) const {
    const double each = 1e6 / (double{kUpdates} * o.avatars * o.seconds);
    return {{"plan", phases_[0] * each},
            {"sort", phases_[1] * each},
            {"steer", phases_[2] * each},
            {"commit", phases_[3] * each},
            {"settle", phases_[4] * each},
            {"planned", planned_},
            {"progress_at_end", progress_},
            {"contested", static_cast<double>(contested_) * each * 1e-6}};
  }

 private:
  static Crowd make(const World& world, const Options& o) {
    auto crowd = Crowd::create(
        world, {.dt = kDt, .seed = o.seed, .workers = 1, .speedup = PathSpeedup::kLabels});
    if (!crowd) stop(crowd.error().message);
    return std::move(*crowd);
  }
  Context context_;
  Crowd crowd_;
  std::vector<AvatarId> ids_;
  std::vector<Place> goals_;
  std::vector<AvatarState> states_;
  uint64_t with_path_ = 0, planned_ = 0, contested_ = 0;
  double progress_ = 0;
  std::array<double, 5> phases_{};
};

struct FreeCrowd {
  void operator()(dtCrowd* crowd) const { dtFreeCrowd(crowd); }
};

// With the settings of Recast's demo.
class Theirs {
 public:
  Theirs(dtNavMesh& mesh, const std::vector<Trip>& trips, const Options& o)
      : trips_(trips), crowd_(dtAllocCrowd()) {
    const AvatarClass adult;
    const auto radius = static_cast<float>(adult.radius);
    if (!crowd_->init(static_cast<int>(trips.size()), radius, &mesh)) stop("no crowd of Detour's");
    dtCrowdAgentParams params{};
    params.radius = radius;
    params.height = static_cast<float>(adult.height);
    params.maxAcceleration = 8;
    params.maxSpeed = static_cast<float>(o.speed);
    params.collisionQueryRange = radius * 12;
    params.pathOptimizationRange = radius * 30;
    params.updateFlags = DT_CROWD_ANTICIPATE_TURNS | DT_CROWD_OBSTACLE_AVOIDANCE |
                         DT_CROWD_OPTIMIZE_VIS | DT_CROWD_OPTIMIZE_TOPO;
    for (const Trip& trip : trips) {
      if (crowd_->addAgent(floats(trip.from.position).data(), &params) < 0) stop("Detour is full");
    }
  }
  void give_goals() {
    for (size_t i = 0; i < trips_.size(); ++i) {
      crowd_->requestMoveTarget(static_cast<int>(i), trips_[i].to_polygon,
                                floats(trips_[i].to.position).data());
    }
  }
  void update() { crowd_->update(static_cast<float>(kDt), nullptr); }
  [[nodiscard]] std::vector<Stander> look() const {
    std::vector<Stander> all;
    for (size_t i = 0; i < trips_.size(); ++i) {
      const dtCrowdAgent& a = agent(i);
      all.push_back({a.npos[0], a.npos[1], a.npos[2], a.params.radius, a.params.height});
    }
    return all;
  }
  void count_paths(Account& account) const {
    for (size_t i = 0; i < trips_.size(); ++i) {
      const bool has = agent(i).targetState == DT_CROWDAGENT_TARGET_VALID;
      account.with_path += has;
      account.partial += has && agent(i).partial;
    }
  }

 private:
  [[nodiscard]] const dtCrowdAgent& agent(size_t i) const {
    return *crowd_->getAgent(static_cast<int>(i));
  }
  const std::vector<Trip>& trips_;
  std::unique_ptr<dtCrowd, FreeCrowd> crowd_;
};

template <class SomeCrowd>
void go_on(SomeCrowd& crowd, int second, const Options& o, Account& account) {
  const bool last = second + 1 == o.seconds;
  if (last) account.bodies = crowd.look();
  double spent = second == 0 ? seconds_of([&] { crowd.give_goals(); }) : 0;
  for (int n = 0; n < kUpdates; ++n) {
    spent += seconds_of([&] { crowd.update(); });
    if (last) account.walk_on(crowd.look());
  }
  account.seconds.push_back(spent);
  if (second == 0) crowd.count_paths(account);
  if (!last) account.bodies = crowd.look();
  account.judge();
}

Json compare(const Scene& scene, const Options& o) {
  const RecastInput input = make_recast_input(scene);
  const RecastConfig config{.cell = 0.3f, .cell_height = 0.2f, .avatar = AvatarClass{}, .tile = 64};
  DetourSummary summary;
  const NavMesh mesh = make_detour_mesh(input, config, sort_into_tiles(input, config), summary);
  if (mesh == nullptr) stop("Detour's mesh cannot be made");
  Context context;
  const auto world =
      bake_world(scene, {.cell = o.cell, .resolution = 0.1, .classes = {AvatarClass{}}}, context);
  if (!world) stop(world.error().message);

  const std::vector<Trip> trips = draw_trips(*world, *mesh, o);
  Ours ours(*world, trips, o);
  Account our_account, their_account;
  std::unique_ptr<Theirs> theirs;
  if (o.avatars <= kMaxOfDetour) theirs = std::make_unique<Theirs>(*mesh, trips, o);
  uint64_t wall_entries = 0;
  for (int second = 0; second < o.seconds; ++second) {
    go_on(ours, second, o, our_account);
    wall_entries += ours.wall_entries();
    if (theirs) go_on(*theirs, second, o, their_account);
  }
  Json json = {{"file", o.file},
               {"avatars", o.avatars},
               {"seconds", o.seconds},
               {"throng", our_account.json(o)}};
  json["throng"]["wall_entries"] = wall_entries;
  json["throng"].update(ours.phases(o));
  if (theirs) {
    json["detour"] = their_account.json(o);
    json["ratio"] =
        json["detour"]["us_an_update"].get<double>() / json["throng"]["us_an_update"].get<double>();
  }
  return json;
}

}  // namespace
}  // namespace throng::bench

int main(int argc, char** argv) {
  using namespace throng;
  using namespace throng::bench;
  CLI::App parser{"Our crowd beside DetourCrowd", "bench_detour_crowd"};
  Options options;
  parser.add_option("file", options.file, "Model")->required();
  parser.add_option("--cell", options.cell, "Side of our cells [m]")->capture_default_str();
  parser.add_option("--avatars", options.avatars, "Above 16000 ours alone")->capture_default_str();
  parser.add_option("--seconds", options.seconds, "Simulated")->capture_default_str();
  parser.add_option("--speed", options.speed, "Desired speed [m/s]")->capture_default_str();
  parser.add_option("--far", options.far, "Goals are at least as far off [m]")
      ->capture_default_str();
  parser.add_option("--seed", options.seed)->capture_default_str();
  CLI11_PARSE(parser, argc, argv);
  Context context;
  SceneConfig config;
  config.sources.push_back({.path = options.file, .up = {}, .scale = {}, .transform = {}});
  const Result<Scene> scene = load_scene(config, context);
  if (!scene) stop(scene.error().message);
  fmt::print("{}\n", compare(*scene, options).dump());
  return 0;
}
