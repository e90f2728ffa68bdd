// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "throng/base.h"
#include "throng/scene.h"
#include "throng/surface.h"
#include "throng/world.h"

/// Verification: an oracle that uses neither columns nor tiles tests a baked world against the
/// source triangles, with the exact body.
namespace throng {

/// Settings for the functions below.
struct VerifyConfig {
  uint64_t samples = 100000;  ///< Sampled states; as many moves and as many surface points.
  uint64_t seed = 1;
  int32_t avatar_class = 0;
  int32_t workers = 0;  ///< Threads to use, 0 for all cores. Never changes the result. [>= 0]
  /// For verify_node_paths: put up before paths are searched, and solid like any triangle.
  std::vector<Prism> obstacles{};
};

/// A place where a test failed.
struct VerifyFault {
  std::string what;  ///< "entered", "unsupported", "broken", "lost" ...
  Vec3d position;    ///< Feet. [m]
  /// Of the scene: the triangle inside the body, or the surface that was lost.
  uint32_t triangle = 0;
};

/// Results of verify_world. docs/algorithms.md gives the exact meaning of each number.
struct VerifyReport {
  uint64_t states = 0;          ///< Places that were sampled, in which the body is tested.
  uint64_t moves = 0;           ///< Legal ones: those that the world let arrive.
  uint64_t surface_points = 0;  ///< Points of the source's surfaces, for what is lost.
  uint64_t entered = 0;         ///< Legal states or moves whose body meets a triangle. Must be 0.
  /// Legal states or moves without a surface to stand on, within a cell and a step height. Must be
  /// 0.
  uint64_t unsupported = 0;
  uint64_t broken = 0;  ///< Legal moves over a point with no legal place. Must be 0.
  uint64_t no_surface_under_centre = 0;  ///< States that feet_error excludes (cracks and rims).
  double feet_error_mean = 0;            ///< [m]
  double feet_error_p95 = 0;             ///< [m]
  /// Share of the area where the grown body can stand that the bake denies.
  double lost_grown = 0;
  double lost_grown_error = 0;  ///< Its standard error.
  double lost_exact = 0;        ///< The same for the body as it is.
  double lost_exact_error = 0;
  double isolated_grown = 0;  ///< Share that is denied and also unreachable: not in `lost`.
  double isolated_exact = 0;
  double standable_area_grown = 0;  ///< [m^2]
  double standable_area_exact = 0;  ///< [m^2]
  std::vector<VerifyFault> faults;  ///< The first few of each kind.
  double seconds = 0;
};

/// Results of verify_nodes. All counts but the first three must be 0.
struct NodeVerifyReport {
  uint64_t places = 0;       ///< Places tested.
  uint64_t arcs = 0;         ///< Arcs tested.
  uint64_t hole_links = 0;   ///< Of these, over holes.
  uint64_t entered = 0;      ///< Places, or links over holes, whose body meets a triangle.
  uint64_t unsupported = 0;  ///< Places without a surface at the feet.
  uint64_t steeper = 0;      ///< Places on a steeper surface than a node around them promises.
  uint64_t lower = 0;        ///< Places with less free height than a node around them promises.
  uint64_t one_way = 0;  ///< Arcs without an opposite one, and drop links that do not lead down.
  std::vector<VerifyFault> faults;  ///< The first few of each kind.
  double seconds = 0;
};

/// Tests random places of a class on nodes, and the arcs of their nodes: the body against all
/// triangles, and the promises of the nodes around the place. Fails as verify_world does.
[[nodiscard]] THRONG_API Result<NodeVerifyReport> verify_nodes(const Nodes& nodes,
                                                               const Scene& source,
                                                               const VerifyConfig& config,
                                                               Context& context);

/// Results of verify_air_links. All counts but the first two must be 0.
struct AirLinkReport {
  uint64_t links = 0;    ///< Links of the class that were tested.
  uint64_t places = 0;   ///< Places on nodes that were tested, from which the class takes off.
  uint64_t blocked = 0;  ///< Links at whose place the class cannot stand, or not take off.
  uint64_t entered =
      0;  ///< Links on which the body meets a triangle between the node and the leaf.
  uint64_t one_way = 0;  ///< Links that do not lead back from where the take-off ends.
  uint64_t sinks = 0;    ///< Places whose take-off ends in a leaf that has no link for the class.
  std::vector<VerifyFault> faults;  ///< The first few.
  double seconds = 0;
};

/// Tests links between the air and nodes for a class that flies: at half of `config.samples` random
/// links the exact body rises from the node into the leaf, which is its landing, too; from as many
/// random places on nodes the leaf above must lead back to the ground. Fails with kBadConfig,
/// kNotFound (no air), kBadInput, kCancelled.
[[nodiscard]] THRONG_API Result<AirLinkReport> verify_air_links(const AirLinks& links,
                                                                const Nodes& nodes,
                                                                const Scene& source,
                                                                const VerifyConfig& config,
                                                                Context& context);

/// Results of verify_node_paths.
struct NodePathReport {
  uint64_t pairs = 0;         ///< Random pairs of places of the class.
  uint64_t reached = 0;       ///< Of these, with a path.
  uint64_t disconnected = 0;  ///< Of these, without a path and not connected by arcs.
  uint64_t segments = 0;      ///< Of the paths, point to point.
  uint64_t links = 0;         ///< Links that the paths use.
  std::array<uint64_t, kLinkKinds> links_of_kind{};
  uint64_t hole_links = 0;  ///< Of these, over holes.
  uint64_t poses = 0;       ///< Tested poses of bodies, at most a quarter of a radius apart.
  uint64_t entered = 0;     ///< Segments whose body meets a triangle. Must be 0.
  /// Segments with no surface at the feet, except over holes. Must be 0.
  uint64_t unsupported = 0;
  /// Segments that leave their node, or do not begin where the last one ended. Must be 0.
  uint64_t broken = 0;
  /// Without obstacles: pairs with a path but not connected by arcs, or the reverse. Must be 0.
  uint64_t disagree = 0;
  uint64_t blocked = 0;  ///< Pairs connected by arcs but without a path, because of the obstacles.
  double length = 0;     ///< Of all paths. [m]
  double straight = 0;   ///< Of the straight lines between their ends. [m]
  double search_seconds = 0;  ///< Of all queries, one thread each.
  double make_seconds = 0;    ///< Of the finder.
  uint64_t finder_bytes = 0;
  std::vector<VerifyFault> faults;  ///< The first few of each kind.
  double seconds = 0;
};

/// Finds paths between `config.samples` random pairs of places of a class on nodes, and moves the
/// body along them against all triangles. Fails as verify_world does.
[[nodiscard]] THRONG_API Result<NodePathReport> verify_node_paths(const Nodes& nodes,
                                                                  const Scene& source,
                                                                  const VerifyConfig& config,
                                                                  Context& context);

/// Tests random states, moves and surface points of a class against the source triangles. Time:
/// about samples x triangles near a body. Fails with kBadConfig, kBadInput, kCancelled.
[[nodiscard]] THRONG_API Result<VerifyReport> verify_world(const World& world, const Scene& source,
                                                           const VerifyConfig& config,
                                                           Context& context);

/// Results of verify_paths.
struct PathReport {
  uint64_t pairs = 0;  ///< Random pairs of places; every second pair is connected, if one is found.
  uint64_t reached = 0;  ///< Of these, with a path.
  /// Of these, without a path and in different components of the graph.
  uint64_t disconnected = 0;
  uint64_t segments = 0;  ///< Of the paths, point to point.
  /// Tested bodies on the paths, at most half a cell and a quarter of a radius apart.
  uint64_t bodies = 0;
  /// Paths with a wrong length or a segment that is no legal move. Must be 0.
  uint64_t illegal = 0;
  uint64_t entered = 0;  ///< Paths on which the body meets a triangle. Must be 0.
  /// Paths on which the body is somewhere without a surface to stand on, within a cell and a step
  /// height. Must be 0.
  uint64_t unsupported = 0;
  uint64_t broken = 0;  ///< Paths over a point with no legal place. Must be 0.
  /// Pairs with a path between different components, or the reverse. Must be 0.
  uint64_t disagree = 0;
  double length = 0;          ///< Of all paths, in the plane. [m]
  double straight = 0;        ///< Of the straight lines between their ends. [m]
  double search_seconds = 0;  ///< Of all queries, one thread each.
  double make_seconds = 0;    ///< Of the finder.
  uint64_t finder_bytes = 0;
  std::vector<VerifyFault> faults;  ///< The first few of each kind.
  double seconds = 0;
};

/// Finds paths of PathFinder between `config.samples` random pairs of places of a class, and moves
/// along them by legal moves and with the body against all triangles. Fails as verify_world does.
[[nodiscard]] THRONG_API Result<PathReport> verify_paths(const World& world, const Scene& source,
                                                         const VerifyConfig& config,
                                                         Context& context);

/// Results of verify_flight.
struct FlightReport {
  uint64_t points = 0;              ///< Random points of the legal air.
  uint64_t pairs = 0;               ///< Random pairs of points of the air and places on the ground.
  uint64_t reached = 0;             ///< Of these, with a path.
  uint64_t segments = 0;            ///< Of the paths, in the air: take-off, flight, landing.
  uint64_t positions = 0;           ///< Tested bodies on the paths, at most half a radius apart.
  uint64_t entered = 0;             ///< Points and segments whose body meets a triangle. Must be 0.
  std::vector<VerifyFault> faults;  ///< The first few.
  double seconds = 0;
};

/// Tests `config.samples` random points of the air, and the paths between a tenth as many pairs,
/// with the class's whole cylinder against the triangles. Fails with kBadConfig, kNotFound (no
/// air), kBadInput, kCancelled.
[[nodiscard]] THRONG_API Result<FlightReport> verify_flight(const World& world, const Scene& source,
                                                            const VerifyConfig& config,
                                                            Context& context);

}  // namespace throng
