// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "throng/base.h"
#include "throng/world.h"

/// Surfaces: the nodes on which bodies stand on Bezier patches, overhangs included, and on level
/// tiles, and their links to the air.
namespace throng {

// ----
// Nodes: where bodies can stand on Bezier patches, overhangs included, and on level tiles, as one
// graph for all avatar classes. Source: [PACS00] 1.2.3; docs/design/006-nodes.md.

struct Scene;
class SceneRegions;
namespace graph {
struct NodeData;      // Internal: zones of nodes.
struct LeafLinkData;  // Internal: zones of links to the air.
}  // namespace graph

/// How a body moves from one node to another.
enum class LinkKind : uint8_t {
  kWalk = 0,  ///< None of the kinds below.
  kStep,      ///< Over a step of the floor, not a slope, that some class of the world cannot climb.
  kClimb,     ///< One end is steeper than any walker's limit, or there is a gap between patches.
  kDrop,      ///< A drop link, one-way: out over an edge and down. For classes with a `max_drop`.
  kOffMesh,   ///< An off-mesh link; may be one-way.
};
/// Number of LinkKind values.
inline constexpr uint8_t kLinkKinds = 5;

/// What a node is a part of.
enum class PatchKind : uint8_t {
  kBezier = 0,     ///< A Bezier patch of the scene.
  kLevelTile = 1,  ///< A level tile of the baked world.
};

/// An off-mesh link, given by hand: a ditch to jump, a ladder, a lift. The body is not tested on
/// it.
struct NodeOffMeshLink {
  Vec3d from, to;            ///< Within a metre of places of the class. [m]
  int32_t avatar_class = 0;  ///< The only class that can use it.
  bool two_way = false;      ///< Also from `to` to `from`.
};

/// Settings for Nodes::create.
struct NodeConfig {
  /// Sub-patches of Bezier patches are halved down to this size. [m, 0.05 to 100]
  double size = 1.0;
  uint16_t classes = 0xffff;  ///< Bit per class: the classes to make nodes for.
  std::vector<NodeOffMeshLink> off_mesh_links = {};
  int32_t workers = 0;  ///< Threads, 0 for all cores. Never changes the result. [>= 0]
  /// Rebuild all zones, also those whose nodes in the world's folder are up to date.
  bool rebuild = false;
  /// Approximate memory limit while nodes are made, without the scene if it is in memory: zones are
  /// made in as many batches as it takes, each with its surroundings. Never changes the result.
  /// [bytes]
  uint64_t working_bytes = uint64_t{1} << 30;
};

/// Checks the settings, whatever the world. Fails with kBadConfig.
[[nodiscard]] THRONG_API Result<void> check_node_config(const NodeConfig& config);

/// Edges of the bins that codes of nodes stand for. A code k of inclination means "at most
/// inclination[k] degrees" (180 beyond the last); a code k > 0 of a length means "at least edge[k -
/// 1] metres", 0 promises nothing. The limits of every class are edges.
struct THRONG_API NodeBins {
  std::vector<double> inclination;  ///< Ascending, at most 15. [degrees]
  std::vector<double> height;       ///< Also of headroom. [m]
  std::vector<double> width;        ///< [m]

  /// What a code promises: at most this inclination, at least this height or width. [degrees, m]
  [[nodiscard]] double inclination_of(uint8_t code) const {
    return code < inclination.size() ? inclination[code] : 180;
  }
  [[nodiscard]] double height_of(uint8_t code) const { return length_of(height, code); }
  [[nodiscard]] double width_of(uint8_t code) const { return length_of(width, code); }
  /// The best code that holds for a value, rounded to the safe side.
  [[nodiscard]] uint8_t inclination_code(double degrees) const;
  [[nodiscard]] uint8_t height_code(double metres) const;
  [[nodiscard]] uint8_t width_code(double metres) const;

 private:
  static double length_of(const std::vector<double>& edges, size_t code) {
    return code == 0 || edges.empty() ? 0
                                      : edges[code < edges.size() ? code - 1 : edges.size() - 1];
  }
};

/// A node: a sub-patch, and what bodies may rely on everywhere in it. Level tiles have *partial*
/// nodes along walls: some of a block's 8 x 8 cells. Each class of a partial node stands on some of
/// these, which are connected (Nodes::partial_cells).
struct NodeInfo {
  /// Bit per class: its body may stand anywhere in the sub-patch, or somewhere in a partial node.
  uint16_t classes = 0;
  uint8_t inclination = 0;  ///< Steepest surface. [code]
  /// Free height along the normal, above what any class steps over (level tiles: straight up from
  /// the floor). [code]
  uint8_t height = 0;
  uint8_t headroom = 0;  ///< The same straight up; 0 where it is too steep to walk. [code]
  /// Distance from the middle within which no ground is steeper, lower or closed to a class of the
  /// node. [code]
  uint8_t width = 0;
  bool terminal = true;  ///< No smaller node lies in it.
  PatchKind kind = PatchKind::kLevelTile;
  uint32_t source = 0;      ///< Bezier patch of the scene, or level tile of the world.
  uint8_t depth = 0;        ///< The patch is cut into 2^depth x 2^depth finest sub-patches.
  uint8_t block_level = 0;  ///< k: the patch has 2^k x 2^k blocks of the node's size.
  uint8_t s = 0, t = 0;     ///< Which of these blocks the node is: its column and row.
  uint32_t parent1 = 0;     ///< Smallest node around it, plus one; 0: none.
  float area = 0;           ///< Of the sub-patch; of a partial node's cells. [m^2]
  uint64_t cells = 0;       ///< Partial node: the cells of its block, bit 8 t + s. 0: all.
};

/// A directed link from a node. The opposite arc is always at the other node, except for drop links
/// and one-way off-mesh links.
struct NodeArc {
  uint32_t to = 0;       ///< Index of the other node.
  uint16_t classes = 0;  ///< Bit per class that can use it.
  LinkKind kind = LinkKind::kWalk;
  /// A link over a hole: the nodes do not touch. A body moves in a straight line from parameters
  /// (from_s, from_t) of this node's patch to (to_s, to_t) of the other's, and its axis turns
  /// evenly. On a drop link it moves horizontally until it is above the second point, is upright
  /// there, and moves straight down.
  bool over_hole = false;
  double from_s = 0, from_t = 0, to_s = 0, to_t = 0;
};

/// Sizes of nodes, and what was made.
struct NodeSummary {
  uint64_t nodes = 0;
  uint64_t terminal = 0;  ///< Of the nodes: NodeInfo::terminal.
  uint64_t partial = 0;   ///< Of the nodes: with NodeInfo::cells.
  uint64_t arcs = 0;      ///< Two per undirected link.
  uint64_t patches = 0;   ///< Bezier patches and level tiles.
  uint64_t bezier_patches = 0;
  uint64_t zones = 0;         ///< With nodes.
  uint64_t zones_made = 0;    ///< Zones with patches, with or without nodes.
  uint64_t zones_reused = 0;  ///< Of these, reused: nothing that they depend on has changed.
  uint64_t bytes = 0;         ///< Of all zones.
  double seconds = 0;         ///< To make them; 0 if they were opened.
  NodeBins bins;
  std::vector<AvatarClass> classes;
};

/// The cylinder of a node: as wide and as high as it promises, in its middle along the ground's
/// normal. Source: [PACS00] 1.2.3.1.
struct NodeCylinder {
  Vec3d feet;           ///< [m]
  Vec3d axis{0, 1, 0};  ///< Unit vector; straight up on level tiles.
  double radius = 0;    ///< [m]
  double height = 0;    ///< [m]
};

/// How much ground of a class promises what: areas by the codes of NodeBins. Each adds up to the
/// class's area. [m^2]
struct NodeDistribution {
  std::array<double, 16> inclination{}, height{}, headroom{}, width{};
};

/// A connected component: nodes between which a class can move in both directions.
struct NodeComponent {
  double area = 0;  ///< [m^2]
  uint64_t nodes = 0;
  uint32_t node = 0;  ///< Its first node.
};

/// A place on a node: a body stands at `feet` along `axis`, which is the surface's normal for
/// climbers on Bezier patches and straight up for all others. A zero-initialised place is nowhere.
struct NodePlace {
  uint32_t node1 = 0;  ///< Node plus one.
  Vec3d feet;          ///< [m]
  Vec3d axis;
  Vec3d normal;         ///< Of the surface; straight up on level tiles.
  double s = 0, t = 0;  ///< Parameters on the node's patch. [0 to 1]
  [[nodiscard]] explicit operator bool() const { return node1 != 0; }
};

/// What a class may rely on at a place, or all along a path, from what nodes promise: always on the
/// safe side. By default nothing. Source: [PACS00] 1.2.3.
struct NodeClearance {
  uint16_t classes = 0;      ///< Bit per class: its body may stand there.
  double inclination = 180;  ///< The ground is no steeper. [degrees]
  /// Free height along the ground's normal, above what any class steps over; on level tiles
  /// straight up. [m]
  double height = 0;
  double headroom = 0;  ///< The same straight up; 0 where it is too steep to walk. [m]
  double width = 0;     ///< The class may stand wherever ground is no farther off. [m]
};

/// The nodes of a world. Cheap to copy (shared, immutable); safe to read from many threads.
class THRONG_API Nodes {
 public:
  Nodes() = default;
  /// False for a handle without nodes, made by default.
  [[nodiscard]] explicit operator bool() const { return state_ != nullptr; }

  /// Makes the nodes of a world from the scene that it was baked from: on the Bezier patches of the
  /// scene, and on level tiles where the scene has triangles of no patch. Nodes of zones in the
  /// world's folder that are up to date are reused (BakeConfig::carry_nodes). Fails with
  /// kBadConfig, kBadFile (a zone cannot be used), kLimit or kCancelled.
  [[nodiscard]] static Result<Nodes> create(const World& world, const Scene& scene,
                                            const NodeConfig& config, Context& context);
  /// The same for a world that was opened from its folder, into which the nodes are written batch
  /// by batch, so that only one batch is in memory. They replace those in the folder once all are
  /// made; if the call is cancelled or killed before, the next call reuses what was made. Also
  /// fails with kIo.
  [[nodiscard]] static Result<Nodes> create_in_folder(const World& world, const Scene& scene,
                                                      const NodeConfig& config, Context& context);
  /// The same nodes, byte for byte, of a scene that is never in memory as a whole: it is read twice
  /// to find what zones depend on, and then around each batch. `working_bytes` counts triangles,
  /// too; more is taken where a single zone and what lies near it need more, and by off-mesh links
  /// over long distances, whose batches hold all in between. Besides, 16 bytes a patch and 500 a
  /// zone are in memory, and of the world's files what WorldConfig::resident_bytes lets stay. Also
  /// fails as SceneRegions::region does, and with kBadInput if its regions contradict each other.
  [[nodiscard]] static Result<Nodes> create_in_folder(const World& world, const SceneRegions& scene,
                                                      const NodeConfig& config, Context& context);
  /// Opens the nodes in a world's folder. Fails with kBadFile (by name) or kIo.
  [[nodiscard]] static Result<Nodes> open(const std::string& world_path);
  /// Have nodes been written into the folder that a world was opened from?
  [[nodiscard]] static bool exist(const World& world);
  /// The same for a world that was opened from its folder.
  [[nodiscard]] static Result<Nodes> open(const World& world);
  /// The world that the nodes were made for. [the handle is not empty]
  [[nodiscard]] const World& world() const;
  /// Writes the nodes into the folder of the world that they were made for, and replaces those
  /// there. Fails with kBadConfig (workers), kIo or, if the folder holds another world, kBadFile.
  /// `workers`: threads, 0 for all cores. [>= 0]
  [[nodiscard]] Result<void> write(const std::string& world_path, int32_t workers = 0) const;
  /// Checks every zone against the index. Fails with kBadFile and the zone's name.
  [[nodiscard]] Result<void> check_all() const;

  // For a handle that is not empty. `node` is an index below node_count(). A zone that cannot be
  // used counts as empty: see check_all.

  /// Sizes of all nodes. Reads every zone; time is linear in the nodes and arcs.
  [[nodiscard]] NodeSummary summary() const;
  [[nodiscard]] uint32_t node_count() const;  ///< Of all zones.
  /// What bodies may rely on in a node. Time: logarithmic in the zones.
  [[nodiscard]] NodeInfo node(uint32_t node) const;
  /// The links that lead from a node. Time: linear in them, and logarithmic in the zones.
  [[nodiscard]] std::vector<NodeArc> arcs(uint32_t node) const;
  /// The cells of a partial node on which a class may stand, bit 8 t + s of its block of 8 x 8. 0
  /// if the node is not partial, or is none of the class.
  [[nodiscard]] uint64_t partial_cells(int32_t avatar_class, uint32_t node) const;
  /// Corners of a node's sub-patch on the ground, in the order of BezierPatch's vertices; for a
  /// partial node those of its block, where the ground may be missing. [m]
  [[nodiscard]] std::array<Vec3d, 4> corners(uint32_t node) const;
  /// The ground in the middle of a node; for a partial node, in the middle of one of its cells. [m]
  [[nodiscard]] Vec3d middle(uint32_t node) const;
  /// The ground at parameters (s, t) of a node's patch, in the node or not; (0, 0, 0) if its zone
  /// cannot be used. [m, 0 to 1]
  [[nodiscard]] Vec3d point(uint32_t node, double s, double t) const;
  /// The place at parameters (s, t) of the patch, which must lie in the node. Nowhere if the class
  /// may not stand there or the ground's zone cannot be used (check_all returns the error).
  [[nodiscard]] NodePlace place(int32_t avatar_class, uint32_t node, double s, double t) const;
  /// The n-th of a reproducible stream of places of a class, about uniform over its area. Nowhere
  /// only if the class has no node.
  [[nodiscard]] NodePlace random_place(int32_t avatar_class, uint64_t seed, uint64_t n) const;

  /// The cylinder of a node; nothing of one that promises no width or no height.
  [[nodiscard]] std::optional<NodeCylinder> cylinder(uint32_t node) const;
  /// What the nodes around a place promise a class. Nothing if the class may not stand there. The
  /// largest height and width that can be promised are the last edges of NodeBins, a width within
  /// one patch also the distance to its borders. Time: linear in the nodes and cells of the patch.
  [[nodiscard]] NodeClearance clearance(int32_t avatar_class, const NodePlace& place) const;
  /// Do the nodes promise that a body fits at a place, whose size need not be that of a class? Its
  /// radius, height, step height and slopes count. True if it lies inside the body of a class that
  /// may stand there, or inside those around the place and the headroom above them. False: not
  /// promised; the body may still fit. Time: linear in the nodes and cells of the patch.
  [[nodiscard]] bool fits(const NodePlace& place, const AvatarClass& body) const;

  /// The ground of a class by what the smallest node around it that holds the class promises.
  /// Linear in the nodes.
  [[nodiscard]] NodeDistribution distribution(int32_t avatar_class) const;

  /// The connected components of a class, largest first. If given, `of_node` gets the component of
  /// each node, UINT32_MAX for nodes where the class cannot stand. Linear in nodes and arcs.
  [[nodiscard]] std::vector<NodeComponent> components(
      int32_t avatar_class, std::vector<uint32_t>* of_node = nullptr) const;

 private:
  friend struct Access;
  explicit Nodes(std::shared_ptr<const graph::NodeData> state) : state_(std::move(state)) {}
  std::shared_ptr<const graph::NodeData> state_;
};

/// Calls visit(s, t, count) for each run of cells in a row of a partial node (NodeInfo::cells,
/// Nodes::partial_cells): `count` cells along s from (s, t) of its block of 8 x 8 on.
template <class Visit>
void for_partial_runs(uint64_t cells, Visit visit) {
  for (int32_t t = 0; t < 8; ++t) {
    for (auto row = static_cast<uint32_t>(cells >> (8 * t) & 0xff); row != 0;) {
      const int32_t s = std::countr_zero(row), count = std::countr_one(row >> s);
      visit(s, t, count);
      row &= ~(((1u << count) - 1) << s);
    }
  }
}

// ----
// Links between the air of a world and its nodes: where what flies comes to the ground.

/// Names a leaf of the octree of the air: a free cube, or a connected piece of the free voxels of a
/// block of 4 x 4 x 4. The sky over the octree of a zone is one leaf.
struct AirLeafId {
  int32_t zone_x = 0, zone_z = 0;  ///< Zone of the world.
  uint32_t node = 0;               ///< Word of the zone's octree; UINT32_MAX: the sky.
  uint32_t piece = 0;              ///< Of a block: the lowest voxel of the piece.

  friend bool operator==(const AirLeafId&, const AirLeafId&) = default;
};

/// A link between a leaf of the air and a node under it, the best for some classes: the node on
/// which most of them can land, then the one that promises the greatest height and width, then the
/// place nearest to the leaf's axis. From there a body rises straight into the leaf, and it lands
/// there again by the same segment. Source: [PACS00] 1.2.3.7.
struct AirLink {
  uint32_t node = 0;     ///< The node.
  uint16_t classes = 0;  ///< Bit per class that can use it, in both directions.
  double s = 0, t = 0;   ///< Where they land, on the node's patch. [0 to 1]
  Vec3d feet = {};       ///< The same place. [m]
  Box3d leaf = {};       ///< Where the leaf lies: its cube, or the cube that it is a piece of. [m]
  AirLeafId leaf_id = {};
};

/// Sizes of the links between the air and the nodes.
struct AirLinkSummary {
  uint64_t links = 0;
  uint64_t leaves = 0;      ///< That links lead from.
  uint64_t nodes = 0;       ///< That links lead to.
  uint64_t leaf_sinks = 0;  ///< Leaves into which some class rises from a node, without a link: 0.
  uint64_t bytes = 0;       ///< Of their files.
};

/// The links between the air and the nodes of a world, which a bake makes that makes nodes and air
/// (docs/design/005-air.md). They are for the classes that fly; if none does, for all classes. Each
/// leads in both directions. Cheap to copy (shared, immutable); safe to read from many threads.
class THRONG_API AirLinks {
 public:
  AirLinks() = default;
  /// False for a handle without links, made by default.
  [[nodiscard]] explicit operator bool() const { return state_ != nullptr; }

  /// Opens the links in the folder that nodes were opened from: reads the index alone. Fails with
  /// kNotFound (there are none), kBadFile (by name: damaged, or of other air or nodes) or kIo.
  [[nodiscard]] static Result<AirLinks> open(const Nodes& nodes);
  /// Are there links in the folder that a world was opened from?
  [[nodiscard]] static bool exist(const World& world);

  // For a handle that is not empty. A zone that cannot be used counts as empty: see check_all.

  /// Checks every zone against the index. Fails with kBadFile and the zone's name.
  [[nodiscard]] Result<void> check_all() const;
  /// The links of a node: from the leaves that have elected it. Time: linear in them, and
  /// logarithmic in those of its zone. [node < Nodes::node_count]
  [[nodiscard]] std::vector<AirLink> of_node(uint32_t node) const;
  /// The links of the leaf that holds a point of the air, each class in at most one; none if no
  /// class rises into it from a node. Time: logarithmic in the links of its zone. [m]
  [[nodiscard]] std::vector<AirLink> of_leaf(const Vec3d& position) const;
  /// The n-th of all, none if its zone cannot be used or there are fewer. Linear in the zones.
  [[nodiscard]] std::optional<AirLink> link(uint64_t n) const;
  /// Sizes of all. Linear in the zones.
  [[nodiscard]] AirLinkSummary summary() const;

 private:
  friend struct Access;
  explicit AirLinks(std::shared_ptr<const graph::LeafLinkData> state) : state_(std::move(state)) {}
  std::shared_ptr<const graph::LeafLinkData> state_;
};

}  // namespace throng
