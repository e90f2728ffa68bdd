// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "crowd/climb/climb_mode.h"
#include "crowd/crowd_check.h"
#include "crowd/fly/fly_mode.h"
#include "crowd/ground/body.h"
#include "crowd/ground/target.h"
#include "crowd/link/link_mode.h"
#include "crowd/mode/mode.h"
#include "crowd/mode/own_curves.h"
#include "crowd/mode/shared_state.h"
#include "crowd/walk/crowd_engine.h"
#include "crowd/walk/walk_mode.h"
#include "path/edits/edit_list.h"
#include "throng/crowd.h"

/// The state of a crowd: the modes in which its avatars move, and what is the same for all of them:
/// ids, slots, events, the order of a step.
namespace throng {

inline constexpr uint32_t kNoBody = UINT32_MAX;
inline constexpr std::array<int32_t, 3> kNeverChecked = {INT32_MIN / 2, 0, 0};

struct Crowd::State {
  crowd::SharedState shared;
  crowd::OwnCurves own_curves;  // before the modes, which read it
  crowd::WalkMode walk;
  crowd::LinkMode link;
  crowd::FlyMode fly;
  crowd::ClimbMode climb;
  const std::array<crowd::Mode*, 4> modes{&walk, &link, &fly, &climb};
  std::vector<crowd::Mode*> mode_of_class;  // null: not in use
  crowd::BodyExtent extent;                 // of all bodies
  float fastest = 0;                        // of all bodies [m/s]
  uint64_t scattered = 0;                   // draws of `scatter`

  mutable std::vector<uint32_t> where;  // by slot: which of the bodies; kNoBody: none
  mutable bool where_is_old = false;
  // Events: what is watched, and by slot where each avatar was.
  std::vector<crowd::Target> watched;
  std::vector<uint64_t> inside;                    // a bit for each watched area
  std::vector<std::array<int32_t, 3>> checked_at;  // [units, mm]
  std::vector<crowd::EngineDetail::View> views;
  std::vector<AreaEntry> entered;
  std::vector<AvatarId> no_progress;
  uint64_t edits_version = 0;           // that is followed
  std::vector<uint32_t> slot1_of_edit;  // by id - 1: slot of its obstacle plus one; 0: none
  std::vector<AvatarId> blockers;

  // Of a crowd that ranks share: avatars of all of them, by id; with how many its columns were
  // assigned, and in which step.
  mutable std::vector<AvatarState> everywhere;  // since the last step, once they were asked for
  size_t assigned_for = 0;
  uint64_t assigned_at = 0;
  bool is_uneven = false;     // They are assigned again.
  uint64_t near_version = 0;  // of the owners for which grounds were kept

  State(const World& world, const CrowdConfig& config, crowd::MoveConfig move)
      : shared(world, config),
        walk(shared, (move.own_curves = &own_curves, move)),
        link(shared, walk),
        fly(shared, move, walk),
        climb(shared, move, fly),
        mode_of_class(shared.classes.size(), nullptr) {}

  // crowd_share.cpp: a crowd that ranks share.
  /// All that is known of an avatar.
  struct Moved {
    crowd::MovedWalker walker;
    crowd::Orientation orientation = {};
    uint64_t inside = 0;
    std::array<int32_t, 3> checked_at = kNeverChecked;
    uint32_t has_curves = 0;
    CurvilinearTuning curves = {};
  };
  /// Of the n-th of the bodies. `next`: the number of the next sub-step, from 0.
  [[nodiscard]] Moved moved(size_t n, uint64_t next) const;
  /// Adds one to those of this rank.
  void take(const Moved& moved, uint64_t next);
  /// Those of all ranks, by name.
  [[nodiscard]] std::vector<Moved> moved_everywhere() const;
  Result<void> share_with(RankGroup& group);
  [[nodiscard]] Error share_refused(size_t avatar_class) const;
  /// Ranks share no crowd that takes off-mesh links.
  [[nodiscard]] Result<void> check_links() const;
  /// Avatars on all ranks.
  [[nodiscard]] size_t count() const {
    return shared.share ? shared.names.alive() : walk.bodies().size();
  }
  /// Is it true on any rank?
  [[nodiscard]] bool any(bool mine) const { return shared.share ? shared.share->any(mine) : mine; }
  /// Which of these would overlap an avatar of any rank?
  [[nodiscard]] std::vector<uint8_t> find_blocked(std::span<const crowd::NewAvatar> avatars,
                                                  int32_t widest) const;
  void keep_near_ground();
  /// Avatars go to the ranks that own where they are. Before a sub-step.
  void migrate();
  /// What ranks found in a step becomes what all found.
  void gather_events(crowd::EngineCounts& counts, CrowdReport& report);
  /// Calls f for each list of what happened to avatars in a step.
  template <class F>
  void for_events(F&& f) {
    f(shared.arrived);
    f(shared.goal_unreachable);
    f(no_progress);
    f(entered);
  }
  /// Is its body on this rank? Where not, it forgets what all ranks know of the avatar's path.
  [[nodiscard]] crowd::Body* commanded(AvatarId id);
  [[nodiscard]] std::vector<AvatarState> own_states() const;
  [[nodiscard]] const std::vector<AvatarState>& states_everywhere() const;
  [[nodiscard]] std::optional<AvatarState> state_everywhere(AvatarId id) const;
  /// Counts what bodies of this rank and of others do to each other, once.
  [[nodiscard]] CrowdCheck check_shared() const;
  [[nodiscard]] crowd::CheckedBody checked(const crowd::Body& body) const;

  // crowd_avatars.cpp
  [[nodiscard]] crowd::Mode& mode_of(const crowd::Body& body) const {
    return *mode_of_class[body.avatar_class];
  }
  /// The mode that places an avatar.
  [[nodiscard]] crowd::Mode& mode_of(const AvatarSpawn& spawn);
  Result<void> open_class(int32_t number, Context& context);
  /// An avatar of a class in use, nowhere yet.
  [[nodiscard]] Result<crowd::NewAvatar> avatar_of(const AvatarSpawn& spawn) const;
  /// All bodies are smaller and slower than these.
  void fit(const crowd::BodyExtent& of_body, float speed);
  /// Reserves memory for so many more avatars.
  void reserve(size_t more);
  AvatarId add(crowd::NewAvatar avatar);
  /// Names one like it that another rank has.
  AvatarId add_elsewhere(const crowd::NewAvatar& like);
  [[nodiscard]] crowd::Body* body(AvatarId id) const;
  [[nodiscard]] bool has_target(TargetId target) const {
    return target >= 1 && target <= shared.targets.size();
  }
  void find_bodies() const;
  /// A body at its feet: that of a climber encloses it, however it leans.
  [[nodiscard]] crowd::Body at_feet(const crowd::Body& body) const {
    return body.climbs ? climb.at_feet(body) : body;
  }

  // crowd_density.cpp
  /// Blocks what the density map of a class in use, if it has one, gives weight 0.
  void block_zero_cells(size_t number);
  /// Bodies that stand on such ground may leave it, in the classes that have some; no others may.
  void find_leaving_zero();
  /// Of a saved crowd. False: a class flies or goes over nodes.
  bool take_densities(std::vector<crowd::DensityClass> classes);
  /// Ends the leaving of ground of weight 0 where no body is on it any more.
  void end_leaving_zero();
  /// Bodies on ground of weight 0, with LeftCells::kZeroWeight: (index, obstacle).
  void add_on_zero(std::vector<std::pair<uint32_t, uint32_t>>& found) const;

  // crowd_edits.cpp
  /// Makes the calls that have changed the edits since it was called last.
  void follow_edits();
  /// Makes one of these, which is for an obstacle.
  void follow_call(const path::EditList::Changed& call);
  /// Where the order of the calls is unknown: brings an obstacle to the state of its edit.
  void follow_state(EditId id);

  // crowd_obstacles.cpp
  [[nodiscard]] std::vector<Prism> up_obstacles() const;
  /// Requests the obstacle of an edit at once, and returns its slot. [check_prism]
  uint32_t add_obstacle(EditId edit, const Prism& prism);
  void move_obstacle(uint32_t slot, const Prism& prism);
  void set_obstacle_active(uint32_t slot, bool active);
  void remove_obstacle(uint32_t slot);
  /// Bodies of all ranks that block an obstacle.
  struct Blocked {
    uint32_t bodies = 0, walkers = 0;
    uint32_t inside = 0;  // of those that may not enter: not 0 if some are where it closes
  };
  [[nodiscard]] std::vector<Blocked> find_blocked_obstacles(
      std::span<const uint32_t> slots, std::span<const std::pair<uint32_t, uint32_t>> found) const;
  /// Activates or moves the waiting obstacles that no avatar blocks. Returns how many still wait.
  size_t settle_obstacles(std::span<const uint32_t> slots, std::vector<AvatarId>* in_their_path);
  /// Updates the grounds to the obstacles.
  void ground_changed();
  /// Updates the path finders of a class, or of all, to the obstacle's state.
  void sync_paths(uint32_t slot, size_t number);
  void sync_paths(uint32_t slot);

  // crowd_leaving.cpp
  /// Is any of these bodies in an obstacle that is to become active?
  [[nodiscard]] bool is_occupied(uint32_t slot,
                                 std::span<const std::pair<uint32_t, uint32_t>> found) const;
  /// These (obstacle, index of the body) are in obstacles that they must leave; with `all`, no
  /// others are.
  void mark_leaving(std::span<const std::pair<uint32_t, uint32_t>> found, bool all);

  // crowd_targets.cpp, crowd_events.cpp
  void renew_flows();
  void arrive_in_targets();
  void find_events();
  void find_entries();
  void find_no_progress();
};

}  // namespace throng
