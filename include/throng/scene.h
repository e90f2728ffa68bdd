// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "throng/base.h"
#include "throng/context.h"
#include "throng/material.h"
#include "throng/math.h"
#include "throng/patch.h"
#include "throng/prism.h"
#include "throng/result.h"

/// Scenes: a triangle soup with an area kind per triangle, the only input of a bake. Y is up,
/// metres. No requirements: holes, overlaps and inverted normals are allowed.
namespace throng {

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
  uint64_t spikes = 0;      ///< Triangles over 1 km and 10 times the extent of all others long.
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
  /// PatchMesh::parts, one per triangle (unused for triangles of no patch), and PatchMesh::off, one
  /// per patch. Both are empty if unknown: then a patch's own triangles count as solids like any
  /// others.
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
enum class SceneLooks : uint8_t {
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
  SceneLooks looks = SceneLooks::kLeaveOut;
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
[[nodiscard]] THRONG_API Result<Scene> make_plane_scene(const PlaneConfig& config);

/// Writes a binary glTF with materials, one mesh per part. Leaves no file if it fails.
[[nodiscard]] THRONG_API Result<void> write_glb(const Scene& scene, const std::string& path);

/// Writes a Wavefront OBJ: corners to a tenth of a millimetre at 100 km, a name and a material name
/// per part, no material file. Leaves no file if it fails.
[[nodiscard]] THRONG_API Result<void> write_obj(const Scene& scene, const std::string& path);

}  // namespace throng
