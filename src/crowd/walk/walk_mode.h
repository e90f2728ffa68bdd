// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "crowd/ground/standing_draw.h"
#include "crowd/ground/stride_ground.h"
#include "crowd/mode/mode.h"
#include "crowd/obstacles/path_repair.h"
#include "crowd/walk/crowd_engine.h"
#include "crowd/walk/delay_map.h"
#include "crowd/walk/routes.h"
#include "crowd/walk/walk_share.h"
#include "crowd/walk/yielding.h"
#include "path/edits/flow_points.h"
#include "path/edits/ground_finder.h"
#include "path/overlay/mesh_finder.h"

/// Avatars on foot: paths over the ground and flow fields to targets. docs/design/008-engine.md.
namespace throng::crowd {

/// What avatars of classes that fly do on foot beside walking: FlyMode.
class TakesOff {
 public:
  virtual ~TakesOff() = default;
  /// Called for each of them, before it walks. True: it needs no path to walk, or waits for one. On
  /// any worker.
  virtual bool plan_on_foot(Body& body) = 0;
  /// False: a solid blocks it.
  virtual bool take_off(Body& body) = 0;
  /// Has an avatar of any class that reached the end of its path on foot only come to where it can
  /// take off?
  [[nodiscard]] virtual bool is_at_link(uint32_t slot) const = 0;
};

/// What avatars of classes that only walk do at the starts of off-mesh links: LinkMode.
class TakesLinks {
 public:
  virtual ~TakesLinks() = default;
  /// To be called before a step. False: none of the following need be called in it.
  virtual bool begin_step() = 0;
  /// Called for each of them before it follows its path. True: it waits, and does not follow it.
  /// `nth` as for follow(). On any worker.
  virtual bool plan_at_start(Body& body, const Route& route, const StrideGround& ground,
                             uint64_t nth) = 0;
  /// Called before one of them searches for another path, and then with the path, or null: there is
  /// none. On any worker.
  virtual void begin_search(Body& body) = 0;
  virtual void end_search(Body& body, const Route* found) = 0;
  /// Does one of them wait for a link, or give room to others that use one? On any worker.
  [[nodiscard]] virtual bool uses_link(const Body& body) const = 0;
};

class WalkMode final : public Mode {
 public:
  /// Of a route, a speed on level ground and what is known of its progress.
  static constexpr size_t kRowBytes = sizeof(Route) + sizeof(float) + sizeof(PathProgress);

  WalkMode(SharedState& shared, const MoveConfig& config);
  /// What decides for classes that fly; it outlives all steps.
  void set_takes_off(TakesOff& flyers) { takes_off_ = &flyers; }
  /// The same for classes that only walk.
  void set_takes_links(TakesLinks& links) { takes_links_ = &links; }

  // The bodies of all modes.
  [[nodiscard]] CrowdEngine& engine() { return engine_; }
  [[nodiscard]] const CrowdEngine& engine() const { return engine_; }
  [[nodiscard]] std::span<Body> bodies() const { return engine_.bodies(); }
  /// Reserves memory for so many bodies and rows.
  void reserve(size_t bodies, size_t rows);

  [[nodiscard]] Route& route(uint32_t slot) { return routes_[slot]; }

  /// The density map that a class in use follows has changed: all its avatars search again.
  void density_changed(size_t number);

  // Flow fields to targets, and places of these for those that land or climb there.
  /// Makes those that a class lacks. Fails with kCancelled.
  Result<void> find_flows(size_t number, Context& context);
  /// Forgets those of targets that are no more.
  void drop_flows();
  /// Makes all again if the ground has changed. True: it had.
  bool renew_flows();
  /// Length of the path of a body on foot to a target. [m]
  [[nodiscard]] double distance(const Body& body, TargetId target);
  /// Where avatars get on slowly; null if CrowdConfig::avoid_jams is off. Saved apart from rows.
  [[nodiscard]] DelayMap* delays() const { return delays_.get(); }
  [[nodiscard]] bool flows_are_old() const { return flows_are_old_; }
  void set_flows_old(bool old) { flows_are_old_ = old; }
  /// Those that stand aside, by name. Saved apart from rows.
  [[nodiscard]] std::vector<StandsAside>& standing_aside() { return yielding_.all; }
  [[nodiscard]] const std::vector<StandsAside>& standing_aside() const { return yielding_.all; }
  /// Could a crowd have saved them?
  [[nodiscard]] bool aside_is_sound() const;

  // walk_share.cpp: a crowd that ranks share.
  /// From now on they do. There is no body left, and rows are forgotten.
  void share();
  /// What another rank needs to go on with the n-th of bodies(). `next`: of the engine's steps.
  [[nodiscard]] MovedWalker moved(size_t n, uint64_t next) const;
  /// Goes on with it, in a slot of its own.
  void take_over(const MovedWalker& walker, uint32_t slot, uint64_t next);
  /// What all ranks know of those that stand aside becomes the same. Of a crowd that they share.
  [[nodiscard]] std::vector<StandsAside> standing_aside_everywhere() const;
  /// Another rank has the body: what all ranks know of its path is out of date.
  void forget_path(uint32_t name) { yielding_.erase(name); }

  Result<void> open_class(size_t number, Context& context) override;
  void close_class(size_t number) override;
  [[nodiscard]] bool put(NewAvatar& avatar, const AvatarSpawn& spawn) const override;
  Result<bool> begin_draws(const AvatarSpawn& like) override;
  [[nodiscard]] bool draw(NewAvatar& avatar, const AvatarSpawn& like, uint64_t n) const override;
  void add(const NewAvatar& avatar) override;
  void fit(const BodyExtent& all, float fastest) override;
  void set_goal(Body& body, const Place& goal) override;
  void set_target(Body& body) override;
  void set_velocity(Body& body, const Vec3d& velocity) override;
  void step(std::span<Body> bodies, EngineCounts& counts, EngineTimes& times) override;
  void ground_changed() override;
  void areas_changed(std::span<Body> bodies) override;
  void sync_obstacle(CrowdObstacle& obstacle, size_t number, bool is_new) override;
  void forget_obstacle(const CrowdObstacle& obstacle) override;
  void cut_paths(std::span<const uint32_t> slots, std::span<Body> bodies) override;
  void add_blockers(std::span<const uint32_t> slots, std::span<const Body> bodies,
                    BlockerPairs& found) const override;
  [[nodiscard]] bool is_inside(const Body& body, const ObstacleGrid::Item& obstacle) const override;
  [[nodiscard]] bool leads_out(const Body& body, std::span<const uint32_t> slots) const override;
  void end_leaving(Body& body) override;
  [[nodiscard]] AvatarState state_of(const Body& body) const override;
  void add_memory(CrowdMemory& memory) const override;
  [[nodiscard]] size_t row_count() const override { return routes_.size(); }
  void save(std::vector<uint8_t>& out) const override;
  const uint8_t* restore(const uint8_t* saved, size_t rows) override;
  [[nodiscard]] bool is_sound(const Body& body) const override;

 private:
  struct OfClass {
    bool flies = false;                     // too: asks takes_off_
    bool takes_links = false;               // asks takes_links_
    bool follows_density = false;           // only its `lives` know its map
    std::vector<path::MeshFinder> finders;  // one a worker
    std::vector<path::GroundFinder> lives;  // one a worker, once paths avoid obstacles or lead to
                                            // targets
    std::vector<path::AppliedEdits> areas;  // of `lives`
    std::vector<Path> paths;
    std::vector<Path> compared;  // with `paths`, where one leads around a jam
    std::vector<RepairScratch> repairs;
    std::vector<path::FlowPoints> flows;   // by target
    std::optional<StandingDraw> standing;  // none: the ground has changed since
  };
  [[nodiscard]] StrideGround stride_ground(const Body& body) const;
  /// Do paths on foot need a search that knows costs and off-mesh links, or a density map?
  [[nodiscard]] bool plans_by_cost(const OfClass& parts) const {
    if (parts.follows_density) return true;
    const uint64_t kinds = parts.finders.empty() ? 0 : parts.finders[0].mesh().kinds;
    return shared_.has_costs(kinds) || (parts.takes_links && shared_.has_links());
  }
  /// Creates the live grounds of a class, if there are none yet.
  void make_lives(size_t number);

  // walk_plan.cpp
  void plan(std::span<Body> bodies, int32_t worker);
  [[nodiscard]] Following following() const {
    return {static_cast<float>(1 / shared_.unit), engine_.queues()};
  }
  void note_onward(const Body& body, const Route& route);
  void follow_path(Body& body, Route& route, const StrideGround& ground, uint64_t nth);
  bool plan_path(Body& body, Route& route, const StrideGround& ground, int32_t worker);
  bool take_whole_path(Body& body, Route& route, const StrideGround& ground, const Path& path);
  void find_path(const Body& body, const PathPoint& from, const PathPoint& to,
                 const StrideGround& ground, size_t worker, Path& path);

  // walk_congestion.cpp
  void begin_watching();
  void watch_routes(std::span<Body> bodies, int32_t worker);
  void watch_route(Body& body, size_t worker);
  void note_ahead(const Body& body, int32_t dx, int32_t dz, int share);
  [[nodiscard]] float path_left(const Body& body) const;
  [[nodiscard]] bool may_change_route(const Body& body, const Route& route) const;
  [[nodiscard]] bool leads_into_jam(const Body& body, const Route& route) const;
  struct RouteCost {
    size_t end = 0;              // the corner up to which it was measured
    float length = 0, cost = 0;  // up to there, without and with delays [m]
  };
  [[nodiscard]] RouteCost measure_route(const Body& body, const Route& route,
                                        path::GroundFinder& live) const;
  [[nodiscard]] bool is_same_route(const Body& body, const Route& route, size_t end, bool to_goal,
                                   const Path& path, path::GroundFinder& live) const;
  void avoid_jam(Body& body, size_t worker);
  [[nodiscard]] size_t find_via(const Body& body, const StrideGround& ground, size_t worker,
                                const Path& path);
  bool plan_to_via(Body& body, Route& route, const StrideGround& ground, size_t worker);
  void take_path(Body& body, Route& route, const StrideGround& ground, const Path& path,
                 size_t end);

  // walk_yielding.cpp
  void order_aside();
  [[nodiscard]] std::pair<uint32_t, int> precedence_of(uint32_t name);
  [[nodiscard]] std::pair<std::pair<uint32_t, int>, uint32_t> precedence_and_name(
      const Body& body) {
    return {precedence_of(shared_.name_of(body)), shared_.name_of(body)};
  }
  [[nodiscard]] bool may_stand_aside(const Body& body) const;
  void write_line(const Body& body, PathLine& line) const;
  void end_standing_aside(std::span<Body> bodies);
  void find_on_line(std::span<const Body> bodies, uint32_t asker);
  [[nodiscard]] bool block_each_other(const Body& asker, const Body& body);
  void sort_on_line(std::span<const Body> bodies, uint32_t asker);
  void order_aside_among(std::span<Body> bodies);
  [[nodiscard]] static bool is_slow(const Body& body);
  void find_blocked(std::span<const Body> bodies);
  [[nodiscard]] bool is_in_crowd(std::span<const Body> bodies, const Body& body) const;
  void ask_aside(std::span<Body> bodies, uint32_t asker, int& searches);
  bool send_aside(std::span<Body> bodies, uint32_t which, uint32_t asker, size_t lines);
  bool plan_aside(Body& body, Route& route, const StrideGround& ground, size_t worker);

  // walk_leaving.cpp
  /// Along its path, or to the nearest exit.
  void plan_exit(Body& body);
  [[nodiscard]] bool tries_path_again(Body& body);

  // walk_share.cpp
  /// The number of the engine's step that is being made.
  [[nodiscard]] uint64_t this_step() const { return shared_.sub_step - 1; }
  /// Makes rows for all slots.
  void fit_rows();
  /// Adds the bodies of other ranks that matter to those which stand aside, behind its own.
  /// Returns how many are its own.
  size_t gather_aside();
  void drop_gathered(size_t own);

  CrowdEngine engine_;
  std::unique_ptr<RankExchange> exchange_;  // null: no rank shares the crowd
  TakesOff* takes_off_ = nullptr;
  TakesLinks* takes_links_ = nullptr;
  bool links_are_used_ = false;                    // in this step
  std::vector<std::unique_ptr<OfClass>> classes_;  // null: not in use
  std::vector<Route> routes_;                      // by slot
  std::vector<PathProgress> progress_;             // by slot
  Yielding yielding_;
  std::unique_ptr<DelayMap> delays_;  // null: avatars take no notice of jams
  bool some_fly_ = false;             // OfClass::flies, of some
  bool flows_are_old_ = false;        // the ground has changed since
};

}  // namespace throng::crowd
