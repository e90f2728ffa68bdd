// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <span>
#include <utility>
#include <vector>

#include "crowd/link/link_line.h"
#include "crowd/link/link_use.h"
#include "crowd/link/near_bodies.h"
#include "crowd/mode/mode.h"
#include "crowd/walk/walk_mode.h"

/// Avatars of classes that only walk: on the off-mesh links of Edits this moves them, on foot
/// WalkMode does. docs/design/014-layout.md, "Links of walkers".
namespace throng::crowd {

class LinkMode final : public Mode, public TakesLinks {
 public:
  static constexpr size_t kRowBytes = sizeof(LinkUse);
  static constexpr double kEntryRadius = 0.15;  ///< From a link's start, where one leaves the
                                                ///< ground. [m]

  /// `walk` outlives it.
  LinkMode(SharedState& shared, WalkMode& walk);

  /// No avatar that takes links is, or was, wider or taller. [units, mm]
  [[nodiscard]] const BodyExtent& taking() const { return taking_; }
  void fit_taking(const BodyExtent& body);
  /// How many avatars are on links.
  [[nodiscard]] uint64_t count_riding() const;
  /// Does an avatar wait for its turn at the start of a link?
  [[nodiscard]] bool waits(uint32_t slot) const {
    return !uses_.empty() && uses_[slot].state == LinkUse::kWaits;
  }

  bool begin_step() override;
  bool plan_at_start(Body& body, const Route& route, const StrideGround& ground,
                     uint64_t nth) override;
  void begin_search(Body& body) override;
  void end_search(Body& body, const Route* found) override;
  [[nodiscard]] bool uses_link(const Body& body) const override {
    return !uses_.empty() && uses_[body.slot].state != LinkUse::kNone;
  }

  Result<void> open_class(size_t number, Context& context) override;
  void close_class(size_t /*number*/) override {}
  [[nodiscard]] bool put(NewAvatar& avatar, const AvatarSpawn& spawn) const override;
  Result<bool> begin_draws(const AvatarSpawn& like) override;
  [[nodiscard]] bool draw(NewAvatar& avatar, const AvatarSpawn& like, uint64_t n) const override;
  void add(const NewAvatar& avatar) override;
  void fit(const BodyExtent& all, float /*fastest*/) override { widest_ = all.widest; }
  void set_goal(Body& body, const Place& goal) override;
  void set_target(Body& body) override;
  void set_velocity(Body& body, const Vec3d& velocity) override;
  void step(std::span<Body> bodies, EngineCounts& counts, EngineTimes& times) override;
  void areas_changed(std::span<Body> bodies) override;
  void sync_obstacle(CrowdObstacle& /*obstacle*/, size_t /*number*/, bool /*is_new*/) override {}
  void forget_obstacle(const CrowdObstacle& /*obstacle*/) override {}
  void cut_paths(std::span<const uint32_t> /*slots*/, std::span<Body> /*bodies*/) override {}
  void add_blockers(std::span<const uint32_t> slots, std::span<const Body> bodies,
                    BlockerPairs& found) const override;
  [[nodiscard]] bool is_inside(const Body& body, const ObstacleGrid::Item& obstacle) const override;
  [[nodiscard]] bool must_leave(const Body& body, const Prism& obstacle) const override;
  [[nodiscard]] bool leads_out(const Body& body, std::span<const uint32_t> slots) const override;
  void end_leaving(Body& body) override;
  [[nodiscard]] AvatarState state_of(const Body& body) const override;
  void check(std::span<const Body> bodies, CrowdCheck& found) const override;
  [[nodiscard]] uint64_t hash(const Body& body, uint64_t hash) const override;
  void add_memory(CrowdMemory& memory) const override;
  [[nodiscard]] size_t row_count() const override { return uses_.size(); }
  void save(std::vector<uint8_t>& out) const override;
  const uint8_t* restore(const uint8_t* saved, size_t rows) override;
  [[nodiscard]] bool is_sound(const Body& body) const override;
  [[nodiscard]] bool is_in_place(const Body& body) const override;

 private:
  /// A link in force.
  struct Link {
    EditId edit = 0;
    Stand from, to;
    double cost = 0;  // [m]
    bool two_way = false;
    uint32_t corridor = 0;
    std::array<uint32_t, 2> waiting{};  // to go there, and back
    std::array<bool, 2> is_used{};      // so, by any that wait, enter or are on it
  };
  /// Links on whose lines two avatars could touch: of these one is used at a time, in one
  /// direction.
  struct Corridor {
    EditId link = 0;  // that is used; 0: none
    bool back = false, is_entered = false, is_closed = false;
  };
  void read_links();
  /// Links that share a corridor get the same number.
  void find_corridors();
  /// Null: it is not in force.
  [[nodiscard]] const Link* find_link(EditId edit) const;
  [[nodiscard]] Vec3d point_of(const Stand& stand) const;
  void head_to_end(Body& body) const;
  /// Where an avatar is on its link after that part of the line. [0 to 1]
  static Stand stand_at(const LinkUse& use, double part);
  [[nodiscard]] double part_of(const LinkUse& use) const;
  /// The rest of the line of a body that is on a link.
  [[nodiscard]] LinkLine rest_of_line(const Body& body) const;
  [[nodiscard]] LinkLine line_of(const Body& body, const Stand& from, const Stand& to) const;
  /// Does an obstacle that waits block the cell where a body on a link lands?
  [[nodiscard]] bool lands_on(const Body& body, const CrowdObstacle& obstacle) const;

  // link_turns.cpp
  [[nodiscard]] int32_t room_of(int32_t radius) const;
  bool begin_to_wait(Body& body, const PathPoint& start, const PathPoint& end);
  [[nodiscard]] bool is_beside_a_link(const Body& body, const Stand& at) const;
  void stand_aside(Body& body, LinkUse& use) const;
  void stand_aside_again(Body& body, LinkUse& use) const;
  void stop_standing(Body& body, const LinkUse& use) const;
  void give_turn(Body& body, LinkUse& use) const;
  void end_use(Body& body, LinkUse& use) const;
  /// Is a body so near to an end that another cannot land or start there?
  [[nodiscard]] bool blocks_end(const Body& other, const Body& body, const Stand& end) const;
  [[nodiscard]] bool end_is_free(std::span<const Body> bodies, const Body& body,
                                 const LinkUse& use) const;
  [[nodiscard]] bool is_obstructed(const Body& body, const Stand& from, const Stand& to) const;
  /// Could the body, on its line from there, touch one that is on another link?
  [[nodiscard]] bool is_crossed(std::span<const Body> bodies, const Body& body,
                                const Stand& from) const;
  void begin_turns();
  void take_turns(std::span<Body> bodies);

  // link_room.cpp
  [[nodiscard]] bool may_give_room(const Body& body) const;
  void give_room(Body& body, const LinkUse& to, const Stand& at);
  void ask_again(Body& body, const Body& user, const Stand& end);
  void ask_for_room(std::span<Body> bodies);
  void end_giving_room(std::span<Body> bodies);
  /// Of one that gets another goal.
  void stop_giving_room(const Body& body);

  // link_step.cpp
  void add_users();
  void find_users(std::span<Body> bodies);
  void enter(std::span<const Body> bodies, Body& body, LinkUse& use) const;
  void ride(std::span<Body> bodies, uint32_t index, EngineCounts& counts);
  void land(Body& body, LinkUse& use) const;

  WalkMode& walk_;
  std::vector<Link> links_;          // in force, by edit
  std::vector<Corridor> corridors_;  // of these
  std::vector<LinkUse> uses_;        // by slot; empty, if no link was ever in force in a step
  int32_t widest_ = 0;               // of all bodies [units]
  BodyExtent taking_;
  int32_t lowest_ = 0;                          // of all classes [mm]
  std::vector<std::pair<Stand, Stand>> lines_;  // of bodies on links that are not in force
  std::vector<uint32_t> users_;                 // slots with another state than kNone, rising
  std::vector<uint32_t> bodies_;                // of these, indices; of the step
  std::mutex adding_;
  std::vector<uint32_t> came_;    // slots that have begun to wait or to give room in this sub-step,
                                  // in no order
  std::vector<uint32_t> merged_;  // scratch: the old and the new users
  std::vector<bool> is_user_;     // by slot
  std::vector<uint32_t> order_;   // those that wait, as they take turns
  NearBodies near_;
};

}  // namespace throng::crowd
