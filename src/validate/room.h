// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "throng/avatar_class.h"
#include "throng/crowd.h"
#include "throng/scene.h"
#include "throng/validation.h"
#include "throng/world.h"

/// A crowd on a plane with walls, and what is seen of it after every step.
namespace throng::validate {

/// On the plane. [m]
struct Spot {
  double x = 0, z = 0;
};

/// An avatar as seen from above.
struct Seen {
  AvatarId id;
  double x = 0, z = 0;    ///< [m]
  double vx = 0, vz = 0;  ///< Over the last step. [m/s]
};

/// Walls are kept to this. [m]
inline constexpr double kCell = 0.05;

/// Whom the tests are made with: a disc as large as a body seen from above (0.46 m x 0.25 m), so
/// that there is room for 6 on a square metre.
AvatarClass walker();

Polygon box(double x0, double z0, double x1, double z1);

class Room {
 public:
  static Result<Room> build(const PlaneConfig& plane, const AvatarClass& body, Routing ways,
                            const ValidationConfig& config, Context& context);

  /// Adds avatars at speeds of their own; nobody's id for who does not fit.
  Result<std::vector<AvatarId>> place(std::span<const Spot> spots, std::span<const double> speeds,
                                      Context& context);
  /// Adds avatars; who does not fit is left out. Returns those who were added.
  Result<std::vector<AvatarId>> stand(std::span<const Spot> spots, double speed, Context& context);
  /// Sends somebody to a spot. False if nobody of the class can stand there.
  bool send(AvatarId id, Spot goal);
  void leave(std::span<const AvatarId> ids) { crowd_.remove(ids); }
  void drive(std::span<const AvatarId> ids, std::span<const Vec3d> velocities) {
    crowd_.set_velocities(ids, velocities);
  }
  /// One step; every tenth is checked for faults.
  void step();
  /// Whoever is there, by slot.
  [[nodiscard]] const std::vector<Seen>& all() const { return seen_; }
  [[nodiscard]] std::span<const AvatarId> arrived() const { return crowd_.arrived(); }
  [[nodiscard]] uint32_t size() const { return crowd_.size(); }
  [[nodiscard]] double time() const { return static_cast<double>(steps_) * kStep; }
  /// Adds what was checked to a result.
  void report(ValidationResult& result) const;

  static constexpr double kStep = 0.1;  ///< [s]

 private:
  Room(World world, Crowd crowd) : world_(std::move(world)), crowd_(std::move(crowd)) {}
  void look(bool has_moved);

  World world_;
  Crowd crowd_;
  uint64_t steps_ = 0, looks_ = 0;
  CrowdCheck faults_;
  std::vector<AvatarId> id_of_slot_;
  std::vector<AvatarState> states_;
  std::vector<Seen> seen_;
  std::vector<Spot> last_;  // by slot
};

}  // namespace throng::validate
