// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "draw/crowd_pass.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <string>
#include <utility>

#include "core/parallel.h"
#include "draw/hidden_avatars.h"
#include "draw/shaders.h"
#include "draw/wardrobe.h"

// Draws crowds by level of detail: meshes, views, blended views, points; upright or leaning.
namespace throng::draw {
namespace {

constexpr GLsizei kInstancesWide = 2048;  // [texels]
constexpr int kLooksUnit = 5;

constexpr size_t kCardsADraw = 16384;  // Their corners have numbers of 16 bits.

// The outfit of each look: the three colours of an avatar that is drawn as a point (head, chest,
// legs), and which of its twelve colours each part has, in four bits each. In the next row, which
// colours its worn parts have.
GlTexture make_looks(const std::vector<AtlasPart>& worn) {
  const auto all = wardrobe();
  std::vector<uint32_t> words(size_t{2} * 4 * kLooks);
  for (uint32_t look = 0; look < kLooks; ++look) {
    const uint32_t outfit = outfit_of(look), colours = worn_colours_of(look);
    const uint32_t wears = worn_by(worn, look);
    const auto wears_a = [&](WornKind kind) {
      for (size_t i = 0; i < worn.size(); ++i) {
        if ((wears >> i & 1) != 0 && worn[i].kind == kind) return true;
      }
      return false;
    };
    const auto cloth = [&](BodyPart part, size_t channel) {
      const auto p = static_cast<uint32_t>(part);
      return all[(p * kColoursAPart + (outfit >> 4 * p & 15)) * 3 + channel];
    };
    // Its own colour of this part, or that of what is worn over it, of the colours of `as`.
    const auto seen = [&](BodyPart part, WornKind over, BodyPart as, size_t channel) {
      if (!wears_a(over)) return cloth(part, channel);
      const uint32_t colour = colours >> 4 * static_cast<uint32_t>(over) & 15;
      return all[(static_cast<uint32_t>(as) * kColoursAPart + colour) * 3 + channel];
    };
    words[look * size_t{4} + 3] = outfit;
    words[(kLooks + look) * size_t{4}] = colours;
    for (size_t channel = 0; channel < 3; ++channel) {
      const float parts[] = {
          0.5F * (cloth(BodyPart::kSkin, channel) +
                  seen(BodyPart::kHair, WornKind::kHat, BodyPart::kPants, channel)),
          seen(BodyPart::kShirt, WornKind::kCoat, BodyPart::kShirt, channel),
          seen(BodyPart::kPants, WornKind::kSkirt, BodyPart::kPants, channel)};
      for (size_t i = 0; i < 3; ++i) {
        const auto root = static_cast<uint32_t>(std::lround(std::sqrt(parts[i]) * 255));
        words[look * size_t{4} + i] |= root << 8 * channel;
      }
    }
  }
  GlTexture texture = make_texture();
  glBindTexture(GL_TEXTURE_2D, texture.get());
  glTexStorage2D(GL_TEXTURE_2D, 1, GL_RGBA32UI, kLooks, 2);
  glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, kLooks, 2, GL_RGBA_INTEGER, GL_UNSIGNED_INT,
                  words.data());
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  return texture;
}

// Corners 0 1 2, 2 1 3 of each card: four corners to compute instead of six.
GlBuffer make_card_corners() {
  std::vector<uint16_t> corners;
  for (size_t card = 0; card < kCardsADraw; ++card) {
    for (const size_t k : {0, 1, 2, 2, 1, 3})
      corners.push_back(static_cast<uint16_t>(card * 4 + k));
  }
  GlBuffer buffer = make_buffer();
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffer.get());
  glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(corners.size() * 2), corners.data(),
               GL_STATIC_DRAW);
  return buffer;
}

}  // namespace

Result<void> check_linked(std::initializer_list<const GlProgram*> programs) {
  for (const GlProgram* program : programs) {
    if (program->is_linked()) continue;
    const std::string fault = program->fault().substr(0, program->fault().find('\n'));
    return Error{Errc::kNotFound,
                 "drawing: the driver refuses a shader (" + fault + "); use another driver"};
  }
  return {};
}

Result<void> CrowdPass::make_programs() {
  impostor_ = GlProgram(shaders::impostor_vertex(), shaders::impostor_fragment());
  blended_ = GlProgram(shaders::blended_vertex(), shaders::blended_fragment());
  model_ = GlProgram(shaders::model_vertex(), shaders::model_fragment());
  point_ = GlProgram(shaders::point_vertex(), shaders::point_fragment());
  shadow_ = GlProgram(shaders::shadow_vertex(), shaders::shadow_fragment());
  leaning_impostor_ =
      GlProgram(shaders::impostor_vertex(shaders::Leaning::kYes), shaders::impostor_fragment());
  leaning_model_ =
      GlProgram(shaders::model_vertex(shaders::Leaning::kYes), shaders::model_fragment());
  leaning_shadow_ =
      GlProgram(shaders::shadow_vertex(shaders::Leaning::kYes), shaders::shadow_fragment());
  nothing_ = make_vertex_array();
  cards_ = make_vertex_array();
  glBindVertexArray(cards_.get());
  card_corners_ = make_card_corners();
  glBindVertexArray(0);
  return check_linked({&impostor_, &blended_, &model_, &point_, &shadow_, &leaning_impostor_,
                       &leaning_model_, &leaning_shadow_});
}

Result<size_t> CrowdPass::add_atlas(const Atlas& atlas) {
  Result<AtlasTextures> made = AtlasTextures::create(atlas);
  if (!made) return made.error();
  atlases_.push_back(*std::move(made));
  models_.emplace_back();
  looks_.push_back(make_looks(atlas.parts));
  return atlases_.size() - 1;
}

Result<void> CrowdPass::set_model(size_t atlas, const FigureModel& model) {
  if (model.clips.size() != atlases_[atlas].shape.clips.size()) {
    return Error{Errc::kBadInput, "drawing: a figure must have the clips of its atlas"};
  }
  Result<ModelMesh> made = ModelMesh::create(model);
  if (!made) return made.error();
  models_[atlas] = *std::move(made);
  return {};
}

template <class Instance>
void CrowdPass::Level<Instance>::begin(size_t max_count) {
  if (instances.size() < max_count) instances.resize(max_count);
  runs.clear();
  used = 0;
}

void CrowdPass::Runs::add(const Run& run) {
  if (run.count == 0) return;
  runs.push_back(run);
  runs.back().first = used;
  used += run.count;
}

namespace {

// The view, or the heading and phase, and the look.
uint32_t word_of(const ImpostorInstance& instance) { return instance.view; }
uint32_t word_of(const BlendedInstance& instance) { return instance.nearest_below.view; }
uint32_t word_of(const LeaningInstance& instance) { return instance.body.view; }

// Shows a part's views in place of the body's.
void shift_views(ImpostorInstance& instance, uint32_t by) { instance.view += by; }
void shift_views(BlendedInstance& instance, uint32_t by) {
  instance.nearest_below.view += by;
  for (uint32_t& other : instance.others) other += by;
}
void shift_views(LeaningInstance& instance, uint32_t by) { instance.body.view += by; }

// Does a view show nothing, as that of a rucksack from the front?
bool shows_nothing(const std::vector<AtlasView>& views, uint32_t word) {
  const AtlasView& view = views[word & 0xfffff];
  return view.width == 4 && view.height == 4 && view.left == 0 && view.top == 0;
}
bool shows_nothing(const std::vector<AtlasView>& views, const BlendedInstance& instance) {
  return shows_nothing(views, instance.nearest_below.view) &&
         std::all_of(instance.others.begin(), instance.others.end(),
                     [&](uint32_t other) { return shows_nothing(views, other); });
}
bool shows_nothing(const std::vector<AtlasView>& views, const ImpostorInstance& instance) {
  return shows_nothing(views, instance.view);
}
bool shows_nothing(const std::vector<AtlasView>& views, const LeaningInstance& instance) {
  return shows_nothing(views, instance.body.view);
}

}  // namespace

template <class Instance>
void CrowdPass::add_runs(Level<Instance>& level, const Run& bodies, size_t layers) {
  const size_t begin = level.used;
  level.add(bodies);
  const AtlasTextures& atlas = atlases_[bodies.atlas];
  if (atlas.worn.empty()) return;
  const AtlasShape& shape = atlas.shape.shape;
  // Meshes name no view.
  const bool has_views = static_cast<const void*>(&level) != &meshes_ &&
                         static_cast<const void*>(&level) != &leaning_meshes_;
  for (size_t layer = 1; layer < layers; ++layer) {
    const auto shift =
        has_views ? static_cast<uint32_t>(layer * shape.view(shape.frames, 0, 0)) : 0;
    Run run = bodies;
    run.layer = layer;
    run.count = 0;
    for (size_t i = begin; i < begin + bodies.count; ++i) {
      if ((atlas.worn[word_of(level.instances[i]) >> 21] >> (layer - 1) & 1) == 0) continue;
      level.reserve(run.count + 1);
      Instance& instance = level.instances[level.used + run.count];
      instance = level.instances[i];
      shift_views(instance, shift);
      if (!has_views || !shows_nothing(atlas.shape.views, instance)) ++run.count;
    }
    level.add(run);
  }
}

template <class Instance>
GLsizei CrowdPass::Level<Instance>::rows() const {
  return static_cast<GLsizei>((used * texels + kInstancesWide - 1) / kInstancesWide);
}

template <class Instance>
void CrowdPass::Level<Instance>::upload() {
  if (used == 0) return;
  const size_t whole = static_cast<size_t>(rows()) * kInstancesWide / texels;
  if (instances.size() < whole) instances.resize(whole);
  glTexSubImage2D(GL_TEXTURE_2D, 0, 0, first_row, kInstancesWide, rows(), GL_RGBA_INTEGER,
                  GL_UNSIGNED_INT, instances.data());
}

Result<void> CrowdPass::check(std::span<const DrawnCrowd> crowds) const {
  for (const DrawnCrowd& crowd : crowds) {
    if (crowd.atlas >= atlases_.size()) {
      return Error{Errc::kBadInput, "drawing: a crowd is of atlas " + std::to_string(crowd.atlas) +
                                        ", and there are " + std::to_string(atlases_.size())};
    }
    const size_t clips = atlases_[crowd.atlas].shape.clips.size();
    if (crowd.clip >= clips) {
      return Error{Errc::kBadInput, "drawing: a crowd is of clip " + std::to_string(crowd.clip) +
                                        ", and its atlas has " + std::to_string(clips)};
    }
    const ImpostorArrays& a = crowd.avatars;
    const size_t count = a.x.size();
    if (a.y.size() != count || a.z.size() != count || a.heading.size() != count ||
        a.phase.size() != count || a.appearance.size() != count ||
        (!crowd.up_vectors.empty() && crowd.up_vectors.size() != count)) {
      return Error{Errc::kBadInput, "drawing: a crowd's arrays have different lengths"};
    }
  }
  return {};
}

void CrowdPass::pack(std::span<const DrawnCrowd> crowds, const DrawingConfig& config,
                     Vec3d to_sun) {
  const bool plain = config.avatars == AvatarStyle::kPlainQuads;
  size_t max_count = 0;
  for (const DrawnCrowd& crowd : crowds) max_count += crowd.avatars.x.size();
  for_each_level([&](auto& level) { level.begin(0); });
  for (auto* level : {&meshes_, &views_, &points_, &thrown_}) level->begin(max_count);
  blends_.begin(max_count);
  for (const DrawnCrowd& crowd : crowds) {
    if (!crowd.up_vectors.empty() && !plain) {
      pack_leaning_crowd(crowd, config, to_sun);
      continue;
    }
    const Atlas& shape = atlases_[crowd.atlas].shape;
    const PackConfig pack_config{.camera = config.camera,
                                 .clip = crowd.clip,
                                 .from_direction = {},
                                 .workers = config.workers};
    LevelDistances levels;
    if (!plain) {
      levels = level_distances(shape.shape, config.camera, config.height * config.samples,
                               models_[crowd.atlas] ? config.mesh_texel : 0, config.point_pixels);
      levels.blend_share = config.view_blend;
    }
    const size_t count = crowd.avatars.x.size();
    meshes_.reserve(count), views_.reserve(count), points_.reserve(count), blends_.reserve(count);
    const LevelCounts counts = pack_levels(shape, crowd.avatars, pack_config, levels,
                                           {.meshes = meshes_.rest(),
                                            .views = views_.rest(),
                                            .points = points_.rest(),
                                            .blends = blends_.rest()});
    const size_t layers = plain ? 1 : 1 + shape.parts.size();
    add_runs(meshes_, {crowd.atlas, crowd.clip, 0, counts.meshes, levels},
             models_[crowd.atlas] ? std::min(layers, models_[crowd.atlas]->layers()) : 1);
    add_runs(views_, {crowd.atlas, crowd.clip, 0, counts.views, levels}, layers);
    points_.add({crowd.atlas, crowd.clip, 0, counts.points, levels});
    add_runs(blends_, {crowd.atlas, crowd.clip, 0, counts.blends, levels}, layers);
  }
  drawn_ = count_avatars(config);
  hidden_ = 0;
  if (!config.avatar_shadows) return;
  for (const DrawnCrowd& crowd : crowds) {
    if (!crowd.up_vectors.empty() && !plain) continue;
    const PackConfig pack_config{.camera = config.camera,
                                 .clip = crowd.clip,
                                 .from_direction = to_sun,
                                 .workers = config.workers};
    const Atlas& shape = atlases_[crowd.atlas].shape;
    thrown_.reserve(crowd.avatars.x.size());
    const size_t count = pack_impostors(shape, crowd.avatars, pack_config, thrown_.rest());
    add_runs(thrown_, {crowd.atlas, crowd.clip, 0, count, {}}, 1 + shape.parts.size());
  }
}

void CrowdPass::pack_leaning_crowd(const DrawnCrowd& crowd, const DrawingConfig& config,
                                   Vec3d to_sun) {
  const size_t count = crowd.avatars.x.size();
  const Atlas& shape = atlases_[crowd.atlas].shape;
  PackConfig pack_config{
      .camera = config.camera, .clip = crowd.clip, .from_direction = {}, .workers = config.workers};
  const LevelDistances levels =
      level_distances(shape.shape, config.camera, config.height * config.samples,
                      models_[crowd.atlas] ? config.mesh_texel : 0, 0);
  for (auto* level : {&leaning_meshes_, &leaning_views_, &leaning_thrown_}) level->reserve(count);
  const LevelCounts counts =
      pack_leaning(shape, crowd, pack_config, levels,
                   {.meshes = leaning_meshes_.rest(), .views = leaning_views_.rest()});
  const size_t layers = 1 + shape.parts.size();
  add_runs(leaning_meshes_, {crowd.atlas, crowd.clip, 0, counts.meshes, levels},
           models_[crowd.atlas] ? std::min(layers, models_[crowd.atlas]->layers()) : 1);
  add_runs(leaning_views_, {crowd.atlas, crowd.clip, 0, counts.views, levels}, layers);
  if (!config.avatar_shadows) return;
  pack_config.from_direction = to_sun;
  const LevelCounts thrown =
      pack_leaning(shape, crowd, pack_config, {}, {.meshes = {}, .views = leaning_thrown_.rest()});
  add_runs(leaning_thrown_, {crowd.atlas, crowd.clip, 0, thrown.views, {}}, layers);
}

template <class Instance>
void CrowdPass::Level<Instance>::drop(int32_t workers, const auto& is_hidden) {
  std::vector<uint8_t> hidden(used);
  size_t kept = 0;
  for (Run& run : runs) {
    parallel_ranges(run.count, 2048, workers, [&](size_t begin, size_t end) {
      for (size_t i = run.first + begin; i < run.first + end; ++i) {
        hidden[i] = is_hidden(run, instances[i]) ? 1 : 0;
      }
    });
    const size_t first = kept;
    for (size_t i = run.first; i < run.first + run.count; ++i) {
      instances[kept] = instances[i];
      kept += hidden[i] == 0 ? 1 : 0;
    }
    run.first = first;
    run.count = kept - first;
  }
  std::erase_if(runs, [](const Run& run) { return run.count == 0; });
  used = kept;
}

void CrowdPass::drop_hidden(const DrawingConfig& config, const DepthPyramid& depths) {
  const HiddenAvatars test(config.camera, depths);
  const auto middle = [&](const Run& run, const ImpostorInstance& i) {
    return Vec3d{i.x, i.y + atlases_[run.atlas].shape.shape.centre, i.z};
  };
  const bool plain = config.avatars == AvatarStyle::kPlainQuads;
  const auto extent = [&](const Run& run, uint32_t word) {
    const AtlasTextures& atlas = atlases_[run.atlas];
    const double high = atlas.shape.shape.centre;
    return plain ? FigureExtent{static_cast<float>(std::hypot(0.3, high) + 0.01), 0}
                 : atlas.extents[word & 0xfffff];
  };
  views_.drop(config.workers, [&](const Run& run, const ImpostorInstance& i) {
    return test.hides(middle(run, i), extent(run, i.view));
  });
  blends_.drop(config.workers, [&](const Run& run, const BlendedInstance& b) {
    FigureExtent largest = extent(run, b.nearest_below.view);
    for (const uint32_t other : b.others) {
      largest.across = std::max(largest.across, extent(run, other).across);
      largest.front = std::max(largest.front, extent(run, other).front);
    }
    return test.hides(middle(run, b.nearest_below), largest);
  });
  meshes_.drop(config.workers, [&](const Run& run, const ImpostorInstance& i) {
    const auto all = static_cast<float>(
        models_[run.atlas]->extent(atlases_[run.atlas].shape.shape.centre) + 0.01);
    return test.hides(middle(run, i), {all, all});
  });
  points_.drop(config.workers, [&](const Run& run, const ImpostorInstance& i) {
    return test.hides_point(middle(run, i), std::max(0.2, atlases_[run.atlas].shape.shape.centre));
  });
  const auto leaning_middle = [&](const Run& run, const LeaningInstance& i) {
    const Vec3d up{i.up_x, i.up_y, i.up_z};
    return Vec3d{i.body.x, i.body.y, i.body.z} + up * atlases_[run.atlas].shape.shape.centre;
  };
  leaning_views_.drop(config.workers, [&](const Run& run, const LeaningInstance& i) {
    return test.hides(leaning_middle(run, i), extent(run, i.body.view));
  });
  leaning_meshes_.drop(config.workers, [&](const Run& run, const LeaningInstance& i) {
    const auto all = static_cast<float>(
        models_[run.atlas]->extent(atlases_[run.atlas].shape.shape.centre) + 0.01);
    return test.hides(leaning_middle(run, i), {all, all});
  });
  const size_t kept = count_avatars(config);
  hidden_ = drawn_ - kept;
  drawn_ = kept;
}

// An avatar that fades into the next level of detail is an instance of both; its nearer level
// counts.
size_t CrowdPass::count_avatars(const DrawingConfig& config) const {
  const Vec3d& eye = config.camera.eye;
  const auto eye_x = static_cast<float>(eye.x), eye_y = static_cast<float>(eye.y),
             eye_z = static_cast<float>(eye.z);
  // In the same floats as the choice of the level.
  const auto is_beyond = [&](const Run& run, const ImpostorInstance& i, double distance) {
    const auto centre = static_cast<float>(atlases_[run.atlas].shape.shape.centre);
    const float dx = eye_x - i.x, dy = eye_y - (i.y + centre), dz = eye_z - i.z;
    return dx * dx + dy * dy + dz * dz >= static_cast<float>(distance * distance);
  };
  std::atomic<size_t> count{0};
  for (const Runs* meshes :
       {static_cast<const Runs*>(&meshes_), static_cast<const Runs*>(&leaning_meshes_)}) {
    for (const Run& run : meshes->runs) count += run.layer == 0 ? run.count : 0;
  }
  const auto add = [&](const auto& level, const auto& is_first) {
    for (const Run& run : level.runs) {
      if (run.layer > 0) continue;
      parallel_ranges(run.count, 2048, config.workers, [&](size_t begin, size_t end) {
        const auto first = level.instances.begin() + static_cast<ptrdiff_t>(run.first);
        count += static_cast<size_t>(std::count_if(
            first + static_cast<ptrdiff_t>(begin), first + static_cast<ptrdiff_t>(end),
            [&](const auto& instance) { return is_first(run, instance); }));
      });
    }
  };
  add(views_, [&](const Run& run, const ImpostorInstance& i) {
    return is_beyond(run, i, run.levels.mesh_far);
  });
  add(blends_, [&](const Run& run, const BlendedInstance& b) {
    return is_beyond(run, b.nearest_below, run.levels.mesh_far);
  });
  add(points_, [&](const Run& run, const ImpostorInstance& i) {
    return is_beyond(run, i, run.levels.point_far);
  });
  add(leaning_views_, [&](const Run& run, const LeaningInstance& i) {
    const Vec3d up{i.up_x, i.up_y, i.up_z}, feet{i.body.x, i.body.y, i.body.z};
    return length(feet + up * atlases_[run.atlas].shape.shape.centre - eye) >= run.levels.mesh_far;
  });
  return count;
}

void CrowdPass::upload_shadows() {
  GLsizei rows = 0;
  for_each_level([&](auto& level) {
    level.first_row = rows;
    rows += level.rows();
  });
  glActiveTexture(GL_TEXTURE3);
  if (instance_rows_ == 0 || instance_rows_ < rows) {
    instance_rows_ = std::max(rows, GLsizei{1});
    instance_texture_ = make_texture();
    glBindTexture(GL_TEXTURE_2D, instance_texture_.get());
    glTexStorage2D(GL_TEXTURE_2D, 1, GL_RGBA32UI, kInstancesWide, instance_rows_);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  }
  glBindTexture(GL_TEXTURE_2D, instance_texture_.get());
  thrown_.upload();
  leaning_thrown_.upload();
}

void CrowdPass::upload_seen() {
  glActiveTexture(GL_TEXTURE3);
  glBindTexture(GL_TEXTURE_2D, instance_texture_.get());
  meshes_.upload(), views_.upload(), points_.upload(), blends_.upload();
  leaning_meshes_.upload(), leaning_views_.upload();
}

void CrowdPass::draw_cards(const GlProgram& program, const Runs& level) const {
  glBindVertexArray(cards_.get());
  for (const Run& run : level.runs) {
    use_run(program, level, run);
    for (size_t done = 0; done < run.count; done += kCardsADraw) {
      if (done > 0) program.set("first", first_texel(level, run.first + done));
      const size_t cards = std::min(kCardsADraw, run.count - done);
      glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(6 * cards), GL_UNSIGNED_SHORT, nullptr);
    }
  }
}

int CrowdPass::first_texel(const Runs& level, size_t instance) {
  return level.first_row * kInstancesWide + static_cast<int>(level.texels * instance);
}

void CrowdPass::use_run(const GlProgram& program, const Runs& level, const Run& run) const {
  const AtlasTextures& atlas = atlases_[run.atlas];
  atlas.bind(program);
  glActiveTexture(GL_TEXTURE0 + kLooksUnit);
  glBindTexture(GL_TEXTURE_2D, looks_[run.atlas].get());
  if (run.layer == 0) {
    program.set("worn", 0);
    program.set("worn_ahead", 0.0F);
  } else {
    const WornKind kind = atlas.shape.parts[run.layer - 1].kind;
    program.set("worn", static_cast<int>(kind) + 1);
    program.set("worn_ahead", static_cast<float>(worn_ahead(kind)));
  }
  program.set("first", first_texel(level, run.first));
  const auto number = [](double metres) { return static_cast<float>(std::min(metres, 1e9)); };
  program.set_size("mesh_range", number(run.levels.mesh_near), number(run.levels.mesh_far));
  program.set_size("point_range", number(run.levels.point_near), number(run.levels.point_far));
}

void CrowdPass::draw_shadows(const Matrix& sun_from_world, Vec3d to_sun, Vec3d sun_right,
                             Vec3d sun_up) const {
  if (!thrown_.runs.empty()) {
    shadow_.use();
    shadow_.set_matrix("clip_from_world", sun_from_world.data());
    shadow_.set("sun_right", sun_right);
    shadow_.set("sun_up", sun_up);
    shadow_.set("instances", 3);
    draw_cards(shadow_, thrown_);
  }
  if (leaning_thrown_.runs.empty()) return;
  leaning_shadow_.use();
  leaning_shadow_.set_matrix("clip_from_world", sun_from_world.data());
  leaning_shadow_.set("to_sun", to_sun);
  leaning_shadow_.set("instances", 3);
  draw_cards(leaning_shadow_, leaning_thrown_);
}

void CrowdPass::draw(const DrawingConfig& config, FunctionRef<void(const GlProgram&)> begin) {
  if (config.avatars == AvatarStyle::kPlainQuads) {
    if (!plain_.is_linked()) {
      plain_ = GlProgram(shaders::plain_vertex(), shaders::plain_fragment());
    }
    begin(plain_);
    draw_cards(plain_, views_);
    return;
  }
  static const auto kWardrobe = wardrobe();
  const auto begin_dressed = [&](const GlProgram& program) {
    begin(program);
    program.set("looks", kLooksUnit);
    program.set_colours("wardrobe", kWardrobe.data(), kColoursAPart * kBodyParts);
  };
  if (!views_.runs.empty()) {
    begin_dressed(impostor_);
    draw_cards(impostor_, views_);
  }
  if (!leaning_views_.runs.empty()) {
    begin_dressed(leaning_impostor_);
    draw_cards(leaning_impostor_, leaning_views_);
  }
  if (!blends_.runs.empty()) {
    begin_dressed(blended_);
    draw_cards(blended_, blends_);
  }
  const auto draw_meshes = [&](const GlProgram& program, const Runs& level) {
    if (level.runs.empty()) return;
    begin_dressed(program);
    for (const Run& run : level.runs) {
      use_run(program, level, run);
      models_[run.atlas]->draw(program, run.clip, run.layer, run.count);
    }
  };
  draw_meshes(model_, meshes_);
  draw_meshes(leaning_model_, leaning_meshes_);
  if (points_.runs.empty()) return;
  begin(point_);
  point_.set("looks", kLooksUnit);
  const double up = std::tan(0.5 * config.camera.field_of_view);
  point_.set("pixels_at_one", static_cast<float>(0.5 * config.height * config.samples / up));
  glBindVertexArray(nothing_.get());
  for (const Run& run : points_.runs) {
    use_run(point_, points_, run);
    glDrawArrays(GL_POINTS, 0, static_cast<GLsizei>(run.count));
  }
}

}  // namespace throng::draw
