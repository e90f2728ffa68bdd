// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "throng/base.h"
#include "throng/impostor.h"
#include "throng/picture.h"
#include "throng/scene.h"

/// Draws a world and its crowd with a graphics library, without a window or in one. A separate
/// library, throng_draw: the run-time library needs no graphics. OpenGL ES 3.0, so that a browser
/// can run the same.
namespace throng {

/// A scene prepared for a graphics card. Can be made on any thread, so that a window need not wait.
class THRONG_API PreparedScene {
 public:
  /// Makes corners, normals, and the edges to draw: sides of triangles where the surface bends by
  /// 25 degrees or more, or ends. `origin` is the point that everything drawn is relative to. Fails
  /// with kLimit: more triangles than cards hold.
  [[nodiscard]] static Result<PreparedScene> create(const Scene& scene, Vec3d origin);
  PreparedScene(PreparedScene&&) noexcept;
  PreparedScene& operator=(PreparedScene&&) noexcept;
  ~PreparedScene();
  [[nodiscard]] const Box3d& bounds() const;  ///< Relative to the origin.
  [[nodiscard]] Vec3d origin() const;         ///< As it was given.

 private:
  friend struct Access;
  struct State;
  explicit PreparedScene(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// Red, green, blue and alpha, 8 bits each, red lowest; alpha is not multiplied in.
using Rgba = uint32_t;
/// Makes a colour of 8-bit channels.
[[nodiscard]] constexpr Rgba rgba(uint32_t red, uint32_t green, uint32_t blue,
                                  uint32_t alpha = 255) {
  return red | green << 8 | blue << 16 | alpha << 24;
}

/// A vertex of marks.
struct MarkVertex {
  float x = 0, y = 0, z = 0;  ///< Relative to the drawing's origin. [m]
  Rgba colour = 0;
};

/// Marks drawn over a scene to explain it: flat colours, no light.
struct Marks {
  std::vector<MarkVertex> triangles;  ///< Three vertices per triangle.
  std::vector<MarkVertex> lines;      ///< Two vertices per line.
  float line_width = 2;               ///< [px]
  bool through_walls = false;         ///< Hidden parts are drawn faintly.
};
/// Number of slots for marks.
inline constexpr size_t kMarkSlots = 16;

/// A vertex of a panel.
struct PanelVertex {
  float x = 0, y = 0;  ///< From the picture's upper left corner. [px]
  float u = 0, v = 0;  ///< Of the panel's texture. [0 to 1]
  Rgba colour = 0;
};

/// A run of triangles of a panel that is drawn only inside a rectangle. [px]
struct PanelRun {
  uint32_t first = 0, count = 0;  ///< Indices.
  int32_t left = 0, top = 0, right = 0, bottom = 0;
};

/// Text and buttons over the picture. Borrowed.
struct PanelView {
  std::span<const PanelVertex> vertices;
  std::span<const uint32_t> indices;  ///< Three per triangle.
  std::span<const PanelRun> runs;
};

/// Avatars that share an atlas and a clip. Positions are relative to the drawing's origin.
struct DrawnCrowd {
  size_t atlas = 0;  ///< The number that Drawing::add_atlas returned.
  size_t clip = 0;
  ImpostorArrays avatars;
  /// Unit vectors along each body from its feet; empty: all are upright. Headings are before the
  /// lean (avatar.h).
  std::span<const Vec3d> up_vectors = {};
};

/// How avatars are drawn.
enum class AvatarStyle : uint8_t {
  kPeople,      ///< In the detail that can be seen.
  kPlainQuads,  ///< One rectangle of one colour per avatar, for comparison.
};

/// Whether to query, while a picture is drawn, what the nearer parts of the scene hide, and to skip
/// hidden avatars and pieces of the scene. The picture is the same, byte for byte. The query makes
/// a graphics card wait for its own work, so it pays off where a processor draws.
enum class HiddenCulling : uint8_t {
  kWhereItPays,  ///< If the driver draws with the processor.
  kNever,        ///< All is drawn.
  kAlways,       ///< With any driver.
};

/// Settings for Drawing::draw and show.
struct DrawingConfig {
  /// Relative to the drawing's origin; `aspect` follows from the picture. [field of view over 0.01]
  EyeCamera camera;
  int32_t width = 1280, height = 720;  ///< [px, 16 to 8192]
  int32_t samples = 2;                 ///< Along each side of a pixel. [1 to 4]
  Vec3d to_sun{-0.5, 0.75, 0.45};      ///< Towards the sun, any length. [y > 0]
  AvatarStyle avatars = AvatarStyle::kPeople;
  /// An avatar that has a model is drawn as a mesh where a texel of its atlas would take this many
  /// samples of the picture or more. 0: never. [>= 0]
  double mesh_texel = 3;
  /// An avatar whose view's side takes at most this many samples of the picture is drawn as a
  /// point: head, chest and legs in its colours. 0: never. [>= 0]
  double point_pixels = 10;
  /// Views fade into the next ones as the eye moves around an avatar, over this share of the angle
  /// between them. 0: only the nearest view is drawn. [0 to 1]
  double view_blend = 0.4;
  bool avatar_shadows = true;  ///< Those of the scene are always drawn.
  bool soft_shadows = true;    ///< Nine samples of the shadow map per pixel; else one, filtered.
  int32_t sun_pixels = 4096;   ///< Along a side of the shadow map. [256 to 8192]
  HiddenCulling culling = HiddenCulling::kWhereItPays;
  double edges = 0.5;  ///< How dark edges of the scene are. 0: not drawn. [0 to 1]
  /// Height above which the scene is cut away, to show the inside of buildings; relative to the
  /// origin. The caller leaves out avatars above it. [m]
  double cut_height = std::numeric_limits<double>::infinity();
  int32_t workers = 0;  ///< For packing, 0 for all cores. [>= 0]
};

/// Counts and times of a picture.
struct DrawingReport {
  size_t avatars = 0;       ///< In all crowds.
  size_t drawn = 0;         ///< Not culled.
  size_t hidden = 0;        ///< Inside the frame, but behind the scene.
  size_t triangles = 0;     ///< Of the scene, drawn for the eye.
  double seconds_pack = 0;  ///< Culling and packing, shadows included.
  /// The query of what is hidden, and the driver's work that must end before it.
  double seconds_cull = 0;
  double seconds_draw = 0;  ///< Upload, draw calls and reading back.
};

/// A renderer. Movable, not copyable; one thread at a time.
class THRONG_API Drawing {
 public:
  /// Creates a renderer without a window. Fails with kNotFound if there is no EGL, or no driver
  /// that draws without a window.
  [[nodiscard]] static Result<Drawing> create();
  /// Creates a renderer for the window whose OpenGL ES 3.0 context is current on this thread, now
  /// and whenever the renderer is used; the context must outlive it. Fails with kNotFound.
  [[nodiscard]] static Result<Drawing> create_in_current_context();
  Drawing(Drawing&&) noexcept;
  Drawing& operator=(Drawing&&) noexcept;
  ~Drawing();

  /// The driver's name: "llvmpipe (LLVM 15.0.6, 256 bits)".
  [[nodiscard]] std::string renderer() const;
  /// Sets the scene and the point that everything is relative to; replaces both. Fails with kLimit:
  /// more triangles than the card's memory holds.
  [[nodiscard]] Result<void> set_scene(const Scene& scene, Vec3d origin);
  /// The same for a scene that was prepared, perhaps on another thread: only the upload is left.
  [[nodiscard]] Result<void> set_scene(const PreparedScene& scene);
  /// Sets props: temporary parts of the scene, such as crates and barriers. Replaces all; an empty
  /// scene removes them. `origin` as of the scene. Fails with kLimit.
  [[nodiscard]] Result<void> set_props(const Scene& props, Vec3d origin);
  /// Sets the marks of a slot < kMarkSlots; lower slots are drawn first. Fails with kBadInput (no
  /// such slot, or vertices that are no whole triangles or lines) or kLimit.
  [[nodiscard]] Result<void> set_marks(size_t slot, const Marks& marks);
  /// Sets the panel's texture: the opacity of each texel, rows from the top. Fails with kBadInput
  /// (other than width * height bytes) or kLimit.
  [[nodiscard]] Result<void> set_panel_texture(int32_t width, int32_t height,
                                               std::span<const uint8_t> alpha);
  /// Adds a copy of an atlas and returns its number. Colours in blocks that the card reads (S3TC,
  /// ETC2) stay packed, others are unpacked. Fails with kLimit: pages larger than the card's
  /// textures.
  [[nodiscard]] Result<size_t> add_atlas(const Atlas& atlas);
  /// The size of an atlas's colours in the card's memory, without smaller levels.
  [[nodiscard]] size_t colour_bytes(size_t atlas) const;
  /// Can the card read colours of this format as they are? False for formats without blocks.
  [[nodiscard]] bool takes_blocks(AtlasFormat format) const;
  /// Sets the model that is drawn for near avatars of an atlas. Fails with kBadInput
  /// (other clips than the atlas has), kLimit.
  [[nodiscard]] Result<void> set_model(size_t atlas, const FigureModel& model);
  void clear_atlases();  ///< Removes all: the next one is number 0.
  /// Checks the settings. Fails with kBadConfig if draw() would.
  [[nodiscard]] static Result<void> check(const DrawingConfig& config);
  /// Draws a picture. Fails with kBadConfig, kBadInput (a crowd of no such atlas or clip, or with
  /// arrays of different lengths), or kLimit: a picture larger than the card draws.
  [[nodiscard]] Result<Image> draw(std::span<const DrawnCrowd> crowds, const DrawingConfig& config,
                                   DrawingReport* report = nullptr, const PanelView& panel = {});
  /// Draws into the window of the current context, which is `config.width` by `config.height`
  /// pixels.
  [[nodiscard]] Result<void> show(std::span<const DrawnCrowd> crowds, const DrawingConfig& config,
                                  DrawingReport* report = nullptr, const PanelView& panel = {});

 private:
  struct State;
  explicit Drawing(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace throng
