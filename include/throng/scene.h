// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "throng/base.h"

/// Scenes, the input of a bake: triangles and their materials, Bezier patches, maps of cells,
/// built-in worlds.
namespace throng {

// ----
// Materials and textures of surfaces. Drawing uses them, a bake does not.

/// How a surface lets light through.
enum class Opacity : uint8_t {
  kOpaque,
  kHoles,    ///< Nothing where colour and texture are less opaque than the threshold.
  kBlended,  ///< As opaque as colour and texture are.
};

/// A material of surfaces.
struct Material {
  std::string name;
  /// Red, green, blue in linear light, and opacity; multiplies the texels of a texture. [0 to 1]
  std::array<float, 4> colour{1, 1, 1, 1};
  uint32_t texture1 = 0;  ///< Index into Scene::textures plus one; 0: none.
  Opacity opacity = Opacity::kOpaque;
  float threshold = 0.5F;  ///< Of holes. [0 to 1]
};

/// A picture on a surface: red, green, blue as sRGB and opacity, 8 bits each, rows from the top. It
/// repeats in both directions.
struct Texture {
  std::string name;
  int32_t width = 0, height = 0;  ///< [px, > 0]
  std::vector<uint8_t> rgba;
};

/// Texture coordinates of a triangle's corners: to the right and down, in whole textures.
using TextureCorners = std::array<std::array<float, 2>, 3>;

// ----
// Curved ground: bicubic Bezier patches that know their neighbours, and their triangles.
// Source: [PACS00] 1.1, where a world is made of patches with 1, 2 or 4 neighbours on each edge.

/// A patch: a bicubic Bezier surface, a point for each (s, t) in [0, 1] x [0, 1]. Control point i
/// of s and j of t is points[4 * j + i]. Vertices 0 to 3 lie at (s, t) = (0, 0), (0, 1), (1, 1),
/// (1, 0); edge e runs from vertex e to vertex (e + 1) % 4, which is counter-clockwise seen from
/// the side of the normal. An edge or a vertex may be collapsed. [m]
struct THRONG_API BezierPatch {
  std::array<Vec3d, 16> points{};  ///< [m]

  [[nodiscard]] Vec3d at(double s, double t) const;       ///< The point at a parameter.
  [[nodiscard]] Vec3d along_s(double s, double t) const;  ///< First derivative by s.
  [[nodiscard]] Vec3d along_t(double s, double t) const;  ///< First derivative by t.
  /// The unit normal, along_t x along_s. Where the two are parallel or vanish (a collapsed edge),
  /// the limit from inside the patch, to about 1e-5 rad. Zero only if the patch has no area there.
  [[nodiscard]] Vec3d normal(double s, double t) const;
  /// A box that contains the surface; usually a little larger.
  [[nodiscard]] Box3d bounds() const;
  [[nodiscard]] Vec3d vertex(int32_t corner) const;  ///< `corner` is 0 to 3.
  /// The control points of an edge's curve, from vertex e on. `edge` is 0 to 3.
  [[nodiscard]] std::array<Vec3d, 4> edge(int32_t edge) const;
};

/// The point of a cubic Bezier curve at `u` in [0, 1].
[[nodiscard]] THRONG_API Vec3d cubic_point(const std::array<Vec3d, 4>& curve, double u);

/// The parts of a patch below and above parameter `at`, by de Casteljau's construction: together
/// the same surface, each with parameters from 0 to 1 of its own.
[[nodiscard]] THRONG_API std::array<BezierPatch, 2> split_s(const BezierPatch& patch, double at);
[[nodiscard]] THRONG_API std::array<BezierPatch, 2> split_t(const BezierPatch& patch, double at);

/// The same surface with a higher degree: `degree_s` and `degree_t` are 1 to 3, and `points` holds
/// (degree_s + 1) * (degree_t + 1) control points, those along s next to each other. Quake 3's
/// curved pieces have degree 2 in both.
[[nodiscard]] THRONG_API BezierPatch raise_degree(int32_t degree_s, int32_t degree_t,
                                                  std::span<const Vec3d> points);

/// Index of no patch.
inline constexpr uint32_t kNoPatch = UINT32_MAX;

/// One side of one patch.
struct PatchSide {
  uint32_t patch = kNoPatch;
  uint32_t edge = 0;  ///< 0 to 3
  friend bool operator==(PatchSide, PatchSide) = default;
};

/// How many neighbours an edge has: the number is theirs, except for kPart.
enum class EdgeBind : uint8_t {
  kOpen = 0,
  kOne = 1,
  kTwo = 2,
  kFour = 4,
  kPart = 5,  ///< The whole edge is one half or quarter of a bigger patch's edge.
};

/// The neighbours of one edge. A neighbour's edge runs in the opposite direction, so that both
/// patches face the same side. next[0] is the neighbour nearest to the edge's first vertex; unused
/// ones are null. Part k of n ends at the bigger edge's parameters k / n and (k + 1) / n.
struct PatchEdge {
  EdgeBind bind = EdgeBind::kOpen;
  std::array<PatchSide, 4> next{};
};

/// The origin of a run of patches: one node and material of a file.
struct PatchRun {
  std::string file;
  std::string node;
  std::string material;
  uint8_t kind = 1;  ///< AreaKind, before any rule.
  uint32_t first_patch = 0;
  uint32_t patch_count = 0;
};

/// Patches and their neighbours as arrays: edges[p][e] belongs to patches[p].
struct THRONG_API PatchSet {
  std::vector<BezierPatch> patches;
  std::vector<std::array<PatchEdge, 4>> edges;
  std::vector<PatchRun> runs;  ///< In order of patches; covers all of them.

  [[nodiscard]] bool empty() const { return patches.empty(); }
  [[nodiscard]] size_t size() const { return patches.size(); }

  /// Begins a run: patches that are added from here on belong to it.
  void begin_run(std::string_view file, std::string_view node, std::string_view material,
                 uint8_t kind = 1);
  /// Adds a patch with four open edges; returns its index.
  uint32_t add(const BezierPatch& patch);
  /// Makes two edges neighbours, one to one.
  void bind(PatchSide a, PatchSide b);
  /// Gives edge `big` 2 or 4 neighbours, in order from its first vertex.
  void bind_parts(PatchSide big, std::span<const PatchSide> parts);
  /// Appends all of `other`.
  void append(const PatchSet& other);
  /// A patch's name for messages: "FILE: patch 3 of 3_AC", counted within its run.
  [[nodiscard]] std::string name_of(uint32_t patch) const;
};

/// Checks the invariants of a set: finite points, runs that cover all patches, neighbours that
/// exist, name each other and run in opposite directions, and curves that meet within 0.1 m. Fails
/// with kBadInput, the first bad patch and its edge. Linear in the patches.
[[nodiscard]] THRONG_API Result<void> check_patches(const PatchSet& set);

/// The connected component of each patch, by edges: numbered from 0 in order of their first
/// patches. The set must pass check_patches.
[[nodiscard]] THRONG_API std::vector<uint32_t> patch_components(const PatchSet& set);

/// Settings of tessellation.
struct TessellationConfig {
  double tolerance = 0.02;  ///< Largest distance of a patch from its triangles. [m, > 0]
  int32_t workers = 0;      ///< Threads, 0 for all cores. Never changes the result. [>= 0]
  uint64_t max_triangles = 100'000'000;  ///< More are refused. [<= 4 thousand million]
};

/// The part of a patch's parameters that a triangle covers, in 256ths rounded outward, with both
/// ends: s from s0 / 256 to (s1 + 1) / 256.
struct PatchPart {
  uint8_t s0 = 0, s1 = 255, t0 = 0, t1 = 255;
  friend bool operator==(const PatchPart&, const PatchPart&) = default;
};

/// Triangles of patches. Those of patch p are triangles[first[p]] to triangles[first[p + 1]],
/// counter-clockwise seen from the side of the normal.
struct PatchMesh {
  std::vector<Vec3d> positions;  ///< [m]
  std::vector<std::array<uint32_t, 3>> triangles;
  std::vector<uint32_t> first;   ///< patches + 1
  std::vector<PatchPart> parts;  ///< One per triangle.
  /// Per patch: largest distance of its vertices from its surface at their parameters, from
  /// rounding and, on an edge whose neighbour has another curve, from the difference of the curves.
  /// [m]
  std::vector<double> off;
};

/// Cuts all patches into triangles, as finely as their curvature needs: each as a whole, or in 4 x
/// 4 pieces, in equal divisions (at most 128 along a side; only a patch that needs more is off by
/// more than the tolerance). Neighbours share their vertices by index whatever their divisions,
/// across halves and quarters too, so there is no crack: each edge of a triangle that is not on an
/// open edge of a patch belongs to two triangles, in opposite directions. Where the curves of
/// neighbours differ, the curve of one patch is used for both. Vertices lie on whole millimetres
/// (finer if the tolerance requires it). Time and memory are linear in the triangles. Fails with
/// kBadConfig, with kBadInput like check_patches, with kLimit or kCancelled.
[[nodiscard]] THRONG_API Result<PatchMesh> tessellate_patches(const PatchSet& set,
                                                              const TessellationConfig& config,
                                                              Context& context);

/// Writes a patch file (docs/file_format.md) that load_scene reads; numbers keep all their digits.
/// Fails with kBadInput (see check_patches) or kIo; then no file is left.
[[nodiscard]] THRONG_API Result<void> write_patches(const PatchSet& set, const std::string& path);

// ----
// Worlds given by cells or voxels in place of triangles, as in the benchmarks of path search.

/// Flat ground, row by row. A cell that is not passable stops points, not bodies beside it: it is
/// no solid.
struct FlatCells {
  int32_t width = 0;              ///< Along x. [1 to 16000]
  int32_t depth = 0;              ///< Along z. [1 to 16000]
  std::vector<uint8_t> passable;  ///< width * depth: 1 where the point may be, else 0.
};

/// Filled voxels of a box of width * height * depth voxels along x, y (up) and z.
struct VoxelCells {
  int32_t width = 0, height = 0, depth = 0;  ///< [1 to 4096]
  struct Cube {
    int32_t x = 0, y = 0, z = 0;
  };
  std::vector<Cube> filled;  ///< In any order; repetitions are allowed.
};

/// Reads a map of Moving AI's voxel benchmarks (`voxel X Y Z`, then a filled voxel a line); the
/// file's axes are ours. Fails with kBadFile and the line, or kIo. Source: [BS18].
[[nodiscard]] THRONG_API Result<VoxelCells> load_voxel_map(const std::string& path);

/// Reads a map of Moving AI's grid benchmarks (`type octile`): `.`, `G` and `S` are passable; the
/// file's x is x, its y is z. Fails with kBadFile and the line, or kIo. Source: [Stu12].
[[nodiscard]] THRONG_API Result<FlatCells> load_grid_map(const std::string& path);

// ----
// Scenes: a triangle soup with an area kind per triangle, the only input of a bake. Y is up,
// metres. No requirements: holes, overlaps and inverted normals are allowed.

/// The area kind of a surface. 2 to 63 are the user's own numbers, walkable like 1.
using AreaKind = uint8_t;
inline constexpr AreaKind kAreaBlocked = 0;   ///< Solid on which no avatar may stand.
inline constexpr AreaKind kAreaWalkable = 1;  ///< The default.
/// The largest area kind.
inline constexpr AreaKind kAreaLast = 63;
inline constexpr AreaKind kAreaIgnored = 255;  ///< In a rule only: the triangles are dropped.

/// The origin of a run of triangles: one mesh, material or node of a file.
struct ScenePart {
  std::string file;
  std::string node;
  std::string material;
  uint32_t first_triangle = 0;
  uint32_t triangle_count = 0;
  uint32_t material1 = 0;  ///< Index into Scene::materials plus one; 0: unknown.
};

/// Counts of faults that an import met. All zero for a clean model.
struct SceneReport {
  uint64_t triangles_read = 0;
  uint64_t non_finite = 0;  ///< Triangles dropped: a vertex is NaN or infinite.
  uint64_t bad_index = 0;   ///< Triangles dropped: an index is out of range.
  uint64_t degenerate = 0;  ///< Zero-area triangles: kept as solid lines and points.
  uint64_t duplicate = 0;   ///< Coincident triangles: harmless, counted.
  uint64_t ignored = 0;     ///< Triangles dropped by an `ignored` rule.
  /// Triangles longer than 1 km and than 10 times the extent of all others.
  uint64_t spikes = 0;
  std::vector<std::string> warnings;  ///< Sentences: suspicious units, far-off parts ...
};

/// A triangle soup. Triangle t has corners positions[triangles[t][0..2]] and area[t].
struct THRONG_API Scene {
  std::vector<Vec3d> positions;
  std::vector<std::array<uint32_t, 3>> triangles;
  std::vector<AreaKind> area;    ///< One per triangle.
  std::vector<ScenePart> parts;  ///< In order of triangles; may be empty.
  PatchSet patches;              ///< Curved ground; its triangles are among the above.
  /// One per triangle, kNoPatch for triangles of no patch; empty if there are no patches.
  std::vector<uint32_t> patch_of_triangle;
  /// As PatchMesh::parts, one per triangle (unused for triangles of no patch), and as
  /// PatchMesh::off, one per patch. Both are empty if unknown: then a patch's own triangles count
  /// as solids like any others.
  std::vector<PatchPart> patch_part;
  std::vector<double> patch_off;
  std::vector<Material> materials;  ///< Of the parts; empty if they were not read.
  std::vector<Texture> textures;
  /// One per triangle; empty if there are no textures.
  std::vector<TextureCorners> texture_corners;
  SceneReport report;

  void add_triangle(Vec3d a, Vec3d b, Vec3d c, AreaKind kind = kAreaWalkable);
  void add_quad(Vec3d a, Vec3d b, Vec3d c, Vec3d d, AreaKind kind = kAreaWalkable);
  /// The six sides of an axis-aligned box, facing out.
  void add_box(Vec3d low, Vec3d high, AreaKind kind = kAreaWalkable);
  /// All of `other` behind what is there, with its report.
  void append(const Scene& other);
  [[nodiscard]] Box3d bounds() const;
};

/// A file to read, and its placement. Options that are not set follow the file format's convention.
struct SceneSource {
  std::string path;
  std::optional<char> up;       ///< 'y' or 'z'.
  std::optional<double> scale;  ///< Metres per unit. [> 0]
  Transform transform;          ///< Applied last, in metres, Y up.
};

/// Gives triangles an area kind: the last rule that matches wins. Patterns are shell globs
/// (`*`, `?`), case-insensitive; an empty pattern matches everything.
struct AreaRule {
  std::string material;
  std::string node;
  AreaKind kind = kAreaWalkable;
};

/// Gives floors inside a prism an area kind, after all rules; kAreaIgnored removes them. Where
/// volumes overlap, the last one counts.
struct AreaVolume {
  Prism prism;
  AreaKind kind = kAreaWalkable;
};

/// Whether to read materials and textures. The triangles do not depend on it.
enum class SceneMaterials : uint8_t {
  kLeaveOut,
  /// Reads colours and textures (PNG, JPEG, TGA, BMP), in the file or beside it. Those that cannot
  /// be used give one warning per file, and their surfaces get plain colours; large ones are scaled
  /// down, so that those of a file take 256 MiB at most. A surface without a material gets one by
  /// its name, if the name has a meaning (roof, grass ...).
  kRead,
};

/// Sources and rules of a scene: the content of a scene file.
struct SceneConfig {
  std::vector<SceneSource> sources;
  std::vector<AreaRule> rules;
  std::vector<AreaVolume> volumes;
  double plan_height = 3.0;       ///< Height of obstacles of 2D plans. [m, > 0]
  double curve_tolerance = 0.02;  ///< Largest distance of a patch from its triangles. [m, > 0]
  SceneMaterials materials = SceneMaterials::kLeaveOut;
};

/// Reads all sources into one Scene. Bad triangles are dropped and counted; a file that cannot be
/// used gives kBadFile or kBadInput and a sentence. Does not crash on any bytes. Formats by
/// extension: obj gltf glb fbx ply stl dae ifc 3ds (assimp), city.json/json (CityJSON 1-2), gml
/// (CityGML 2-3), bsp (Quake 3), wkt, geojson (2D plans), bpt, zonel, patches.json (curved
/// patches). A folder means all its .zonel files; zones that meet are joined.
[[nodiscard]] THRONG_API Result<Scene> load_scene(const SceneConfig& config, Context& context);

/// Gives all surfaces inside a volume its area kind; triangles that it cuts are divided. Fails with
/// kBadInput: not a convex prism, or not an area kind.
[[nodiscard]] THRONG_API Result<void> mark_volume(Scene& scene, const AreaVolume& volume);

/// Reads a scene file (TOML or JSON). Paths inside are relative to the file. Fails with kBadFile,
/// line and key.
[[nodiscard]] THRONG_API Result<SceneConfig> load_scene_config(const std::string& path);

/// A ring of (x, z) corners; the first is not repeated. [m]
using Ring = std::vector<std::array<double, 2>>;

/// A polygon with holes in the ground plane.
struct Polygon {
  Ring outer;
  std::vector<Ring> holes;
};

/// A plane world, without a 3D model: flat ground and obstacles that rise from it.
struct PlaneConfig {
  Polygon ground;  ///< Walkable ground.
  std::vector<Polygon> obstacles;
  double ground_height = 0;      ///< [m]
  double obstacle_height = 3.0;  ///< [m, > 0]
};

/// Builds the triangles of a plane world. Fails with kBadInput and the polygon's index.
[[nodiscard]] THRONG_API Result<Scene> create_plane_scene(const PlaneConfig& config);

/// Writes a binary glTF with materials, one mesh per part. Leaves no file if it fails.
[[nodiscard]] THRONG_API Result<void> write_glb(const Scene& scene, const std::string& path);

/// Writes a Wavefront OBJ: corners to a tenth of a millimetre at 100 km, a name and a material name
/// per part, no material file. Leaves no file if it fails.
[[nodiscard]] THRONG_API Result<void> write_obj(const Scene& scene, const std::string& path);

// ----
// Built-in worlds: generated scenes. The same name, size and seed give the same triangles on every
// machine.

/// Which world to generate. Zero means the world's own default.
struct BuiltinWorldConfig {
  std::string name = "garage";  ///< One that builtin_worlds() lists.
  double size = 0;              ///< Side of the footprint. [m, >= 0]
  uint64_t triangles = 0;       ///< About so many (powerplant, city), exactly (blocks).
  int32_t levels = 0;           ///< Storeys, where the world has storeys. [>= 0]
  uint64_t seed = 1;
};

/// Description of a built-in world, and what BuiltinWorldConfig may ask of it.
struct BuiltinWorldInfo {
  std::string_view name;
  std::string_view summary;           ///< One line, for `throng generate --list`.
  double default_size = 0;            ///< [m]
  double min_size = 0, max_size = 0;  ///< [m]
  int32_t default_levels = 0;         ///< 0: it has no storeys to count.
  int32_t max_levels = 0;
  uint64_t max_triangles = 0;  ///< 0: it does not grow by triangles.
};

/// All built-in worlds.
[[nodiscard]] THRONG_API std::span<const BuiltinWorldInfo> builtin_worlds();

/// Fails with kNotFound (unknown name) or kBadConfig (size out of limits). Linear in the triangles.
[[nodiscard]] THRONG_API Result<Scene> create_builtin_world(const BuiltinWorldConfig& config);

// ----
// Scenes district by district, for bakes of worlds that are larger than memory.

/// What is known of a scene that is not in memory.
struct SceneFacts {
  Box3d bounds;                  ///< Of all triangles. [m]
  uint64_t triangles = 0;        ///< Of the whole scene.
  uint64_t patches = 0;          ///< Likewise.
  uint64_t patch_triangles = 0;  ///< Triangles of patches, among `triangles`.
  SceneReport report;            ///< Of the import.
};

/// A district of a scene.
struct SceneRegion {
  /// All triangles and patches of the district, and others near by, in the order of the whole
  /// scene. Its patches are numbered from 0; edges whose neighbours are not in it are open.
  Scene scene;
  std::vector<uint32_t> patch_number;  ///< In the whole scene, of each patch; ascending.
};

/// A scene that is read district by district and never held as a whole. Its functions may be called
/// from several threads.
class THRONG_API SceneRegions {
 public:
  virtual ~SceneRegions();
  [[nodiscard]] virtual const SceneFacts& facts() const = 0;
  /// About how many triangles region() gives. Fast. `box` is seen from above. [m]
  [[nodiscard]] virtual uint64_t estimate(const Box3d& box) const = 0;
  /// At least all triangles whose boxes touch `box`, seen from above, and all patches whose bounds
  /// do, with the patches around these. Fails with kIo or kCancelled.
  [[nodiscard]] virtual Result<SceneRegion> region(const Box3d& box, Context& context) const = 0;
};

/// Reads a scene as load_scene does, and built-in worlds behind it, to be taken district by
/// district: the same triangles in the same order. Files are read one after the other; their
/// triangles go to a temporary file in `folder`, which is removed with the object. Curved patches
/// stay in memory, and their triangles are made again for each district. Memory: the largest file
/// while it is read, and 600 bytes a patch. Fails as load_scene does, with kIo, and with kBadConfig
/// if the config has volumes or reads materials.
[[nodiscard]] THRONG_API Result<std::unique_ptr<SceneRegions>> load_scene_regions(
    const SceneConfig& config, std::span<const BuiltinWorldConfig> builtin,
    const std::string& folder, Context& context);

}  // namespace throng
