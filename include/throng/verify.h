// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "throng/base.h"
#include "throng/context.h"
#include "throng/nodes.h"
#include "throng/prism.h"
#include "throng/result.h"
#include "throng/scene.h"
#include "throng/world.h"

/// Proof: an oracle that knows nothing of columns or tiles tests a baked world against the source
/// triangles, with the exact body.
namespace throng {

struct VerifyConfig {
  uint64_t samples = 100000;  ///< Sampled states; as many moves and as many surface points again.
  uint64_t seed = 1;
  int32_t avatar_class = 0;
  int32_t workers = 0;  ///< Threads to use, 0 for all cores. Never changes the result. [>= 0]
  /// Of verify_node_paths: put up before ways are looked for, and then matter like any other.
  std::vector<Prism> obstacles{};
};

/// A place where a claim failed, to look at.
struct VerifyFault {
  std::string what;       ///< "entered", "unsupported", "torn", "lost" ...
  Vec3d position;         ///< Feet. [m]
  uint32_t triangle = 0;  ///< Of the scene: the intruder, or the surface that was lost.
};

/// What the oracle found. docs/algorithms.md gives the exact meaning of each number.
struct VerifyReport {
  uint64_t states = 0;
  uint64_t moves = 0;  ///< Legal ones: those that the world let arrive.
  uint64_t surface_points = 0;
  uint64_t entered = 0;      ///< Legal states or moves whose body meets a triangle. Must be 0.
  uint64_t unsupported = 0;  ///< Legal states or moves with no surface in reach. Must be 0.
  uint64_t torn = 0;         ///< Legal moves over a point with no legal place. Must be 0.
  uint64_t no_surface_under_centre = 0;  ///< States left out of feet_error (cracks and rims).
  double feet_error_mean = 0;            ///< [m]
  double feet_error_p95 = 0;             ///< [m]
  double lost_grown = 0;        ///< Share of area where the grown body stands and the bake denies.
  double lost_grown_error = 0;  ///< One standard error of it.
  double lost_exact = 0;        ///< The same for the body as it is.
  double lost_exact_error = 0;
  double isolated_grown = 0;  ///< Share that is denied but cannot be walked to: not in `lost`.
  double isolated_exact = 0;
  double standable_area_grown = 0;  ///< [m^2]
  double standable_area_exact = 0;  ///< [m^2]
  std::vector<VerifyFault> faults;  ///< The first few of each kind.
  double seconds = 0;
};

/// What the oracle found of nodes. All counts but the first three must be 0.
struct NodeVerifyReport {
  uint64_t places = 0;
  uint64_t arcs = 0;         ///< Looked at on the way.
  uint64_t hole_links = 0;   ///< Of these, between nodes that do not touch.
  uint64_t entered = 0;      ///< Places, or leaps, whose body meets a triangle.
  uint64_t unsupported = 0;  ///< Places without a surface at the feet.
  uint64_t steeper = 0;      ///< Places on a steeper surface than a node around them promises.
  uint64_t lower = 0;        ///< Places with less free height than a node around them promises.
  uint64_t one_way = 0;      ///< Arcs without one back, and drops that are none.
  std::vector<VerifyFault> faults;  ///< The first few of each kind.
  double seconds = 0;
};

/// Tests random places of a class on nodes, and the arcs of their nodes: the body against all
/// triangles, and what the nodes around the place promise. Fails like verify_world.
[[nodiscard]] THRONG_API Result<NodeVerifyReport> verify_nodes(const Nodes& nodes,
                                                               const Scene& source,
                                                               const VerifyConfig& config,
                                                               Context& context);

/// What the oracle found of ways over nodes.
struct NodePathReport {
  uint64_t pairs = 0;     ///< Random pairs of places of the class.
  uint64_t reached = 0;   ///< Of these, with a way.
  uint64_t parted = 0;    ///< Of these, without one, and no arcs lead there.
  uint64_t segments = 0;  ///< Of the ways, point to point.
  uint64_t links = 0;     ///< Used by them.
  std::array<uint64_t, kLinkKinds> links_of_kind{};
  uint64_t hole_links = 0;   ///< Of these, between places that do not touch.
  uint64_t poses = 0;        ///< Of bodies on them, at most a quarter of a radius apart.
  uint64_t entered = 0;      ///< Legs whose body meets a triangle. Must be 0.
  uint64_t unsupported = 0;  ///< Legs with no surface at the feet, but for leaps. Must be 0.
  uint64_t torn = 0;  ///< Legs that leave their node, or do not begin where the last ended. 0.
  /// Pairs that have a way though no arcs lead there, or the reverse, if nothing was put up. 0.
  uint64_t disagree = 0;
  uint64_t blocked = 0;       ///< Pairs without a way, though arcs lead there: by what was put up.
  double length = 0;          ///< Of all ways. [m]
  double straight = 0;        ///< Of the straight lines between their ends. [m]
  double search_seconds = 0;  ///< Of all queries, one thread each.
  double make_seconds = 0;    ///< Of the finder.
  uint64_t finder_bytes = 0;
  std::vector<VerifyFault> faults;  ///< The first few of each kind.
  double seconds = 0;
};

/// Goes the ways between `config.samples` random pairs of places of a class on nodes, with its body
/// against all triangles. Fails like verify_world.
[[nodiscard]] THRONG_API Result<NodePathReport> verify_node_paths(const Nodes& nodes,
                                                                  const Scene& source,
                                                                  const VerifyConfig& config,
                                                                  Context& context);

/// Time: about samples x triangles near a body. Fails with kBadConfig, kBadInput, kCancelled.
[[nodiscard]] THRONG_API Result<VerifyReport> verify_world(const World& world, const Scene& source,
                                                           const VerifyConfig& config,
                                                           Context& context);

/// What the oracle found of ways over level tiles.
struct PathReport {
  uint64_t pairs = 0;        ///< Random pairs of places; every second that hold together, if found.
  uint64_t reached = 0;      ///< Of these, with a way.
  uint64_t parted = 0;       ///< Of these, without one, and in different components of the graph.
  uint64_t segments = 0;     ///< Of the ways, point to point.
  uint64_t bodies = 0;       ///< On them, at most half a cell and a quarter of a radius apart.
  uint64_t illegal = 0;      ///< Ways with a leg that is no legal move, or of another length. 0.
  uint64_t entered = 0;      ///< Ways on which the body meets a triangle. Must be 0.
  uint64_t unsupported = 0;  ///< Ways on which it has no surface in reach. Must be 0.
  uint64_t torn = 0;         ///< Ways over a point with no legal place. Must be 0.
  uint64_t disagree = 0;     ///< Pairs with a way between different components, or the reverse. 0.
  double length = 0;         ///< Of all ways, in the plane. [m]
  double straight = 0;       ///< Of the straight lines between their ends. [m]
  double search_seconds = 0;  ///< Of all queries, one thread each.
  double make_seconds = 0;    ///< Of the finder.
  uint64_t finder_bytes = 0;
  std::vector<VerifyFault> faults;  ///< The first few of each kind.
  double seconds = 0;
};

/// Goes the ways of PathFinder between `config.samples` random pairs of places of a class, by legal
/// moves and with its body against all triangles. Fails like verify_world.
[[nodiscard]] THRONG_API Result<PathReport> verify_paths(const World& world, const Scene& source,
                                                         const VerifyConfig& config,
                                                         Context& context);

/// What the oracle found of a class that flies.
struct FlightReport {
  uint64_t points = 0;              ///< Random points of its legal air.
  uint64_t pairs = 0;               ///< Random pairs of points of the air and places on the ground.
  uint64_t reached = 0;             ///< Of these, with a way.
  uint64_t segments = 0;            ///< Of the ways, in the air: taking off, flying, landing.
  uint64_t positions = 0;           ///< Of bodies on them, at most half a radius apart.
  uint64_t entered = 0;             ///< Points and legs whose body meets a triangle. Must be 0.
  std::vector<VerifyFault> faults;  ///< The first few.
  double seconds = 0;
};

/// Tests `config.samples` random points of the air, and the ways between a tenth as many pairs,
/// with the class's whole cylinder against the triangles. Fails with kBadConfig, kNotFound (no
/// air), kBadInput, kCancelled.
[[nodiscard]] THRONG_API Result<FlightReport> verify_flight(const World& world, const Scene& source,
                                                            const VerifyConfig& config,
                                                            Context& context);

}  // namespace throng
