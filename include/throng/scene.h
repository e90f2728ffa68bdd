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

/// A Scene is a triangle soup with an area kind per triangle: the only thing that a bake reads.
/// Y is up, metres. Nothing is assumed of it: holes, overlaps, inverted normals are all welcome.
namespace throng {

/// What a surface is for. 2 to 63 are the user's own numbers, walkable like 1.
using AreaKind = uint8_t;
inline constexpr AreaKind kAreaBlocked = 0;   ///< Matter that nobody may stand on.
inline constexpr AreaKind kAreaWalkable = 1;  ///< The default.
inline constexpr AreaKind kAreaLast = 63;
inline constexpr AreaKind kAreaIgnored = 255;  ///< In a rule only: the triangles are dropped.

/// Where a run of triangles came from: one mesh, material or node of a file.
struct ScenePart {
  std::string file;
  std::string node;
  std::string material;
  uint32_t first_triangle = 0;
  uint32_t triangle_count = 0;
  uint32_t material1 = 0;  ///< Index into Scene::materials plus one; 0: nothing is known of it.
};

/// What an import met and did. All zero for a clean model.
struct SceneReport {
  uint64_t triangles_read = 0;
  uint64_t non_finite = 0;  ///< Triangles dropped: a vertex is NaN or infinite.
  uint64_t bad_index = 0;   ///< Triangles dropped: an index is out of range.
  uint64_t degenerate = 0;  ///< Zero-area triangles: kept as lines and points of matter.
  uint64_t duplicate = 0;   ///< Coincident triangles: harmless, counted.
  uint64_t ignored = 0;     ///< Triangles dropped by an `ignored` rule.
  uint64_t spikes = 0;      ///< Triangles over 10 times longer than all others together need.
  std::vector<std::string> warnings;  ///< Sentences: suspicious units, far-off parts ...
};

/// Owned triangle soup. Triangle t has corners positions[triangles[t][0..2]] and area[t].
struct THRONG_API Scene {
  std::vector<Vec3d> positions;
  std::vector<std::array<uint32_t, 3>> triangles;
  std::vector<AreaKind> area;    ///< One per triangle.
  std::vector<ScenePart> parts;  ///< In order of triangles; may be empty.
  PatchSet patches;              ///< Curved ground; its triangles are among the above.
  /// One per triangle, kNoPatch for those of no patch; empty where there are no patches.
  std::vector<uint32_t> patch_of_triangle;
  /// As PatchMesh has them: one per triangle, those of no patch hold nothing; and one per patch.
  /// Both empty where nobody knows: then a patch's own triangles are taken for anybody's.
  std::vector<PatchPart> patch_part;
  std::vector<double> patch_off;
  std::vector<Material> materials;  ///< Of the parts; empty where nobody asked for them.
  std::vector<Texture> textures;
  /// One per triangle; empty where nothing has a texture.
  std::vector<TextureCorners> texture_corners;
  SceneReport report;

  void add_triangle(Vec3d a, Vec3d b, Vec3d c, AreaKind kind = kAreaWalkable);
  void add_quad(Vec3d a, Vec3d b, Vec3d c, Vec3d d, AreaKind kind = kAreaWalkable);
  /// The six sides of an axis-aligned box, facing out.
  void add_box(Vec3d low, Vec3d high, AreaKind kind = kAreaWalkable);
  [[nodiscard]] Box3d bounds() const;
};

/// One file to read and how to place it. Unset options take the file format's own convention.
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

/// Floors inside the prism get an area kind, whatever rules said; kAreaIgnored cuts them out. The
/// last volume that holds a place wins.
struct AreaVolume {
  Prism prism;
  AreaKind kind = kAreaWalkable;
};

/// Whether to read what surfaces look like. The triangles are the same either way.
enum class SceneLooks : uint8_t {
  kLeaveOut,
  /// Colours and textures (PNG, JPEG, TGA, BMP), in the file or beside it. Those that cannot be
  /// used are told in one warning a file, and their surfaces get plain colours; large ones are made
  /// smaller, so that those of a file take 256 MiB at most. What has no material gets one by its
  /// name, if that says what it is (roof, grass ...).
  kRead,
};

/// What to read and how: the content of a scene file.
struct SceneConfig {
  std::vector<SceneSource> sources;
  std::vector<AreaRule> rules;
  std::vector<AreaVolume> volumes;
  double plan_height = 3.0;  ///< How high obstacles of 2D plans rise. [m, > 0]
  double curve_tolerance =
      0.02;  ///< Largest gap between a curved patch and its triangles. [m, > 0]
  SceneLooks looks = SceneLooks::kLeaveOut;
};

/// Reads all sources into one Scene. Bad triangles are dropped and counted; a file that cannot be
/// used is refused with kBadFile or kBadInput and a sentence. Never crashes on any bytes.
/// Formats by extension: obj gltf glb fbx ply stl dae ifc 3ds (assimp), city.json/json (CityJSON
/// 1-2), gml (CityGML 2-3), bsp (Quake 3), wkt, geojson (2D plans), bpt, zonel, patches.json
/// (curved patches). A folder stands for all its .zonel files; zones that meet are joined.
[[nodiscard]] THRONG_API Result<Scene> load_scene(const SceneConfig& config, Context& context);

/// Gives what lies inside a volume its kind: triangles that it cuts are cut in pieces. Fails with
/// kBadInput: not a convex prism, or not an area kind.
[[nodiscard]] THRONG_API Result<void> mark_volume(Scene& scene, const AreaVolume& volume);

/// Reads a scene file (TOML or JSON). Paths inside are relative to the file. Fails with kBadFile,
/// line and key.
[[nodiscard]] THRONG_API Result<SceneConfig> load_scene_config(const std::string& path);

/// A ring of (x, z) corners, first corner not repeated. [m]
using Ring = std::vector<std::array<double, 2>>;

/// A polygon with holes in the ground plane.
struct Polygon {
  Ring outer;
  std::vector<Ring> holes;
};

/// A world without a 3D model: a flat ground and obstacles that rise from it.
struct PlaneConfig {
  Polygon ground;  ///< Where one may walk.
  std::vector<Polygon> obstacles;
  double ground_height = 0;      ///< [m]
  double obstacle_height = 3.0;  ///< [m, > 0]
};

/// Builds the triangles of a plane world. Fails with kBadInput and the polygon's index.
[[nodiscard]] THRONG_API Result<Scene> make_plane_scene(const PlaneConfig& config);

/// Writes a binary glTF with looks, one mesh per part. Nothing is left behind when it fails.
[[nodiscard]] THRONG_API Result<void> write_glb(const Scene& scene, const std::string& path);

/// Writes a Wavefront OBJ: corners to a tenth of a millimetre at 100 km, a name and a material name
/// a part, no material file. Nothing is left behind when it fails.
[[nodiscard]] THRONG_API Result<void> write_obj(const Scene& scene, const std::string& path);

}  // namespace throng
