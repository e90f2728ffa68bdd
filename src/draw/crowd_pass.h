// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/function_ref.h"
#include "draw/atlas_textures.h"
#include "draw/depth_pyramid.h"
#include "draw/gl_objects.h"
#include "draw/leaning_avatars.h"
#include "draw/matrix.h"
#include "draw/model_mesh.h"
#include "throng/base.h"
#include "throng_draw/draw.h"

namespace throng::draw {

/// Draws crowds: culled and packed by the processor, uploaded at once, pulled by vertex number.
class CrowdPass {
 public:
  /// Fails with kNotFound: the driver refuses a shader.
  [[nodiscard]] Result<void> make_programs();
  /// Fails with kLimit.
  [[nodiscard]] Result<size_t> add_atlas(const Atlas& atlas);
  [[nodiscard]] size_t colour_bytes(size_t atlas) const { return atlases_[atlas].colour_bytes; }
  void clear_atlases() {
    atlases_.clear();
    models_.clear();
    looks_.clear();
  }
  /// Fails with kBadInput (other clips than the atlas), kLimit.
  [[nodiscard]] Result<void> set_model(size_t atlas, const FigureModel& model);

  /// Fails with kBadInput: no such atlas or clip, or arrays of different lengths.
  [[nodiscard]] Result<void> check(std::span<const DrawnCrowd> crowds) const;
  /// Finds which avatars the eye sees, and which the sun. [check]
  void pack(std::span<const DrawnCrowd> crowds, const DrawingConfig& config, Vec3d to_sun);
  /// After pack(), leaves out the avatars behind the depths of the same view.
  void drop_hidden(const DrawingConfig& config, const DepthPyramid& depths);
  /// Uploads the avatars that cast shadows, before draw_shadows(); those that are seen, before
  /// draw().
  void upload_shadows();
  void upload_seen();
  /// Draws into the shadow map.
  void draw_shadows(const Matrix& sun_from_world, Vec3d to_sun, Vec3d sun_right,
                    Vec3d sun_up) const;
  /// `begin` puts a program in use and sets what all share.
  void draw(const DrawingConfig& config, FunctionRef<void(const GlProgram&)> begin);
  [[nodiscard]] size_t drawn() const { return drawn_; }    ///< Not culled.
  [[nodiscard]] size_t hidden() const { return hidden_; }  ///< By drop_hidden().

 private:
  // A run of instances of one crowd, in the one upload.
  struct Run {
    size_t atlas = 0, clip = 0;
    size_t first = 0, count = 0;
    LevelDistances levels = {};
    size_t layer = 0;  // 0: bodies; else what they wear: a part's number plus one.
  };
  // The instances of one level of detail, in rows of their own in the instances' texture.
  struct Runs {
    std::vector<Run> runs;
    size_t used = 0;
    GLsizei first_row = 0;
    size_t texels = 1;  // Of an instance.
    void add(const Run& run);
  };
  template <class Instance>
  struct Level : Runs {
    Level() { texels = sizeof(Instance) / sizeof(ImpostorInstance); }
    std::vector<Instance> instances;
    [[nodiscard]] std::span<Instance> rest() { return std::span(instances).subspan(used); }
    /// Makes room for so many more.
    void reserve(size_t count) {
      if (instances.size() < used + count) instances.resize(used + count);
    }
    void begin(size_t max_count);
    [[nodiscard]] GLsizei rows() const;
    void upload();
    /// Removes the instances for which is_hidden(run, instance) is true.
    void drop(int32_t workers, const auto& is_hidden);
  };
  void draw_cards(const GlProgram& program, const Runs& level) const;
  static int first_texel(const Runs& level, size_t instance);
  void use_run(const GlProgram& program, const Runs& level, const Run& run) const;
  void for_each_level(const auto& act) {
    act(meshes_), act(views_), act(points_), act(thrown_), act(blends_);
    act(leaning_meshes_), act(leaning_views_), act(leaning_thrown_);
  }
  [[nodiscard]] size_t count_avatars(const DrawingConfig& config) const;
  // Adds a run of bodies, and one for each part that some of them wear.
  template <class Instance>
  void add_runs(Level<Instance>& level, const Run& bodies, size_t layers);
  void pack_leaning_crowd(const DrawnCrowd& crowd, const DrawingConfig& config, Vec3d to_sun);

  GlProgram impostor_, blended_, model_, point_, plain_, shadow_;
  GlProgram leaning_impostor_, leaning_model_, leaning_shadow_;
  GlVertexArray nothing_;  // Vertices by number alone.
  GlVertexArray cards_;    // Four corners a card, by number.
  GlBuffer card_corners_;
  std::vector<AtlasTextures> atlases_;
  std::vector<std::optional<ModelMesh>> models_;  // By atlas.
  std::vector<GlTexture> looks_;                  // By atlas.
  Level<ImpostorInstance> meshes_, views_, points_, thrown_;
  Level<BlendedInstance> blends_;
  Level<LeaningInstance> leaning_meshes_, leaning_views_, leaning_thrown_;
  size_t drawn_ = 0, hidden_ = 0;
  GlTexture instance_texture_;
  GLsizei instance_rows_ = 0;
};

/// Fails with kNotFound if a program is not linked.
[[nodiscard]] Result<void> check_linked(std::initializer_list<const GlProgram*> programs);

}  // namespace throng::draw
