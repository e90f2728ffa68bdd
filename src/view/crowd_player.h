// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "throng/base.h"
#include "throng/crowd.h"
#include "throng/world.h"
#include "throng_view/viewer.h"
#include "view/density_brush.h"
#include "view/eye_sight.h"
#include "view/timeline_source.h"

namespace throng::view {

/// Details of one avatar, for the panel.
struct AvatarDetail {
  uint64_t id = 0;
  int32_t avatar_class = 0;
  Vec3d position;             ///< In the world. [m]
  double speed = 0;           ///< Desired. [m/s]
  std::optional<Vec3d> goal;  ///< [m]
  uint32_t goals_given = 0;
  bool controlled = false;
};

/// The state of CrowdStart::only_seen.
struct SeenOnly {
  std::vector<EyeSight> sights;  // From where the eye is, was, and may be soon; `used` are valid.
  size_t used = 0;
  std::optional<AvatarGenerators> generators;
  std::optional<EyePlace> looked;
  std::string fault;
  // From the points of CrowdStart::region: the oldest is replaced.
  struct RegionSight {
    EyePlace place;
    EyeSight sight;
  };
  std::vector<RegionSight> region;
  size_t oldest = 0;
};

/// Steps a crowd in which each avatar gets one goal after the other. The same start gives the same
/// steps, unless a caller changes the crowd.
class CrowdPlayer final : public TimelinePlayer {
 public:
  /// Fails as Crowd::create and Crowd::scatter do, except that a world too small for all gets as
  /// many as fit in a few tries. With CrowdStart::only_seen there are no avatars, and next()
  /// returns nothing, before look_from(). [nodes: CrowdConfig::nodes]
  [[nodiscard]] static Result<std::unique_ptr<CrowdPlayer>> create(
      World world, Nodes nodes, const CrowdStart& start, int32_t workers, Vec3d origin,
      std::shared_ptr<const Occluders> occluders, Context& context);
  /// Sets the eye, from the next step on.
  void look_from(const EyePlace& place) { place_ = place; }
  std::shared_ptr<const TimelineFrame> next() override;
  std::shared_ptr<const TimelineFrame> seek(double) override {
    return nullptr;
  }  // Time only goes on.

  std::shared_ptr<const TimelineFrame> again() override;
  /// Adds or removes avatars until there are so many, or no more fit.
  void set_count(uint32_t avatars, Context& context);
  /// Adds `count` avatars within `radius` of a point where they fit. Returns how many.
  uint32_t spawn(Vec3d where, double radius, uint32_t count, Context& context);
  /// Removes the avatars within `radius` of a point, at its height. Returns how many.
  uint32_t erase(Vec3d where, double radius);
  /// From now on, goals are drawn from the maps, or anywhere if all weights are 0. An avatar whose
  /// goal has weight 0 gets another one.
  void set_density(const std::vector<DensityMap>& maps);
  [[nodiscard]] std::optional<AvatarDetail> detail(uint64_t id) const;
  /// All: those that are added later, too. An avatar's speed changes with its MaxSpeed.
  void set_curves(std::optional<uint64_t> id, const CurvilinearTuning& tuning) override;

  /// Adds an externally controlled avatar at a free place near `where`, if there is one.
  std::optional<uint64_t> add_external(Vec3d where, int32_t avatar_class, double speed,
                                       Context& context);
  /// Sets its preferred velocity until the next call. [m/s along X and Z]
  void set_velocity(uint64_t id, Vec3d velocity);
  void remove(uint64_t id);
  [[nodiscard]] uint32_t size() const { return crowd_.size(); }
  [[nodiscard]] const World& world() const { return world_; }

 private:
  // By slot.
  struct Played {
    AvatarId id = {};
    int32_t avatar_class = 0;
    double speed = 0;
    Place goal = {};
    uint32_t goals_given = 0;
    bool controlled = false;
    bool generated = false;  // By SeenOnly::generators, which give it goals.
  };

  CrowdPlayer(World world, const CrowdStart& start, Vec3d origin, Crowd&& crowd);
  Result<uint32_t> scatter(uint32_t count, Context& context);
  Result<uint32_t> scatter_batch(uint32_t count, Context& context);
  Place place_of(int32_t avatar_class, uint64_t seed, uint64_t stream) const;
  uint32_t add_avatars(const std::vector<AvatarId>& ids, const std::vector<AvatarSpawn>& spawns);
  void give_goals(std::span<const AvatarId> ids);
  [[nodiscard]] Place goal_of(uint32_t slot, uint64_t nth, const Vec3d& from) const;
  [[nodiscard]] AvatarSpawn spawn_like(uint64_t number) const;
  [[nodiscard]] int32_t commonest_class() const;
  [[nodiscard]] std::vector<GeneratorShare> mix_at(const Place& home) const;
  [[nodiscard]] Place place_under(Vec3d eye, int32_t avatar_class) const;
  [[nodiscard]] bool is_on_large_ground(int32_t avatar_class, Place place) const;
  Result<void> keep_populated();
  Result<void> make_generators(const EyePlace& now);
  bool sees_in_region(const Vec3d& eye, const Box3d& box);
  void set_views();
  void set_curves_of(uint32_t slot, const CurvilinearTuning& tuning);
  [[nodiscard]] std::shared_ptr<const CurvedFrame> curved() const;

  World world_;
  Graph graph_;
  CrowdStart start_;
  Vec3d origin_;
  Crowd crowd_;
  WeightedPlaces painted_;
  std::vector<AvatarClass> classes_;
  std::vector<double> mix_up_to_;  // Running sums of the mix, the last is 1.
  std::vector<Played> avatars_;    // By slot.
  CurvilinearTuning curves_;       // That all were given last.
  bool curves_changed_ = false;    // They are not those of the start.
  std::vector<AvatarState> states_;
  std::vector<Place> goals_;
  uint64_t added_ = 0;
  double time_ = 0;
  CrowdReport report_;
  std::optional<EyePlace> place_;
  std::optional<SeenOnly> seen_only_;
  int32_t workers_ = 0;
  std::shared_ptr<const TimelineFrame> last_;
};

}  // namespace throng::view
