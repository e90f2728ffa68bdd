// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "impostor/atlas_file.h"

#include <flatbuffers/flatbuffers.h>

#include <bit>
#include <cmath>
#include <span>
#include <string>
#include <vector>

#include "core/files/file_map.h"
#include "core/hash.h"
#include "impostor/atlas_generated.h"
#include "impostor/atlas_size.h"
#include "impostor/view_packer.h"
#include "throng/impostor.h"

// Reads and writes atlas files (FlatBuffers) and checks every number that is used as an index.
namespace throng {
namespace {

constexpr const char* kIdentifier = "THIA";
constexpr uint32_t kVersion = 3;

// Programs of version 1 know no ETC2, those of version 2 no parts; they refuse newer files by
// their version.
uint32_t version_of(AtlasFormat format, bool has_parts) {
  if (has_parts) return kVersion;
  return format >= AtlasFormat::kEtc2a1 ? 2 : 1;
}

// A checksum over all fields and texels of an atlas.
uint64_t sum_of(const Atlas& atlas) {
  std::vector<uint64_t> words;
  const auto add_number = [&](auto value) { words.push_back(static_cast<uint64_t>(value)); };
  const auto add_double = [&](double value) { words.push_back(std::bit_cast<uint64_t>(value)); };
  const AtlasShape& s = atlas.shape;
  for (const int32_t value : {s.pixels, s.directions, s.elevations, s.frames, atlas.width,
                              atlas.height, atlas.pages, static_cast<int32_t>(atlas.format)}) {
    add_number(value);
  }
  for (const double value : {s.side, s.centre, s.height}) add_double(value);
  for (const AtlasClip& clip : atlas.clips) {
    words.push_back(hash_bytes(clip.name.data(), clip.name.size()));
    add_number(clip.first_frame);
    add_number(clip.frames);
    add_double(clip.seconds);
    add_double(clip.stride);
  }
  for (const AtlasView& v : atlas.views) {
    for (const uint16_t value : {v.page, v.x, v.y, v.width, v.height, v.left, v.top}) {
      add_number(value);
    }
  }
  for (const auto& colour : atlas.part_colour) {
    for (const uint8_t value : colour) add_number(value);
  }
  for (const AtlasPart& part : atlas.parts) {
    words.push_back(hash_bytes(part.name.data(), part.name.size()));
    add_number(part.kind);
  }
  uint64_t sum = hash_span(std::span<const uint64_t>(words));
  for (const auto* bytes : {&atlas.colour, &atlas.normal, &atlas.mask}) {
    sum = hash_span(std::span<const uint8_t>(*bytes), sum);
  }
  return sum;
}

Error bad(const std::string& path, const std::string& what) {
  return {Errc::kBadFile, path + ": " + what + "; make it again with throng atlas"};
}

// Checks every number that is used as an index or as a divisor.
bool is_sound(const Atlas& atlas) {
  const AtlasShape& s = atlas.shape;
  const bool shape = s.pixels >= 8 && s.pixels <= 256 && s.directions >= 2 && s.directions <= 64 &&
                     s.elevations >= 1 && s.elevations <= 32 && s.frames >= 1 &&
                     s.frames <= 16 * 64 && std::isfinite(s.side) && s.side > 0 &&
                     std::isfinite(s.centre) && std::isfinite(s.height) && s.height > 0;
  const bool pages = atlas.width >= 4 && atlas.width <= impostor::kPageWidth &&
                     atlas.width % 4 == 0 && atlas.height >= 4 &&
                     atlas.height <= impostor::kPageHeight && atlas.height % 4 == 0 &&
                     atlas.pages >= 1 && atlas.pages <= impostor::kMaxPages;
  const size_t layers = 1 + atlas.parts.size();
  if (!shape || !pages || layers > 1 + kMaxWorn) return false;
  if (atlas.views.size() != layers * s.view(s.frames, 0, 0)) return false;
  if (layers > 1 && atlas.views.size() > impostor::kMaxViews) return false;
  for (const AtlasPart& part : atlas.parts) {
    if (static_cast<int32_t>(part.kind) >= kWornKinds) return false;
  }
  for (const AtlasView& v : atlas.views) {
    const bool inside = v.page < atlas.pages && v.x + v.width <= atlas.width &&
                        v.y + v.height <= atlas.height && v.left < s.pixels && v.top < s.pixels &&
                        v.width >= 1 && v.height >= 1;
    if (!inside) return false;
  }
  int32_t frames = 0;
  for (const AtlasClip& clip : atlas.clips) {
    const bool sound = clip.first_frame == frames && clip.frames >= 1 &&
                       clip.frames <= s.frames - frames && std::isfinite(clip.seconds) &&
                       clip.seconds >= 0 && std::isfinite(clip.stride);
    if (!sound) return false;
    frames += clip.frames;
  }
  if (frames != s.frames) return false;
  const size_t texels = impostor::texel_count(atlas);
  return atlas.colour.size() == impostor::colour_bytes(atlas.format, texels) &&
         atlas.normal.size() == impostor::normal_bytes(atlas.format, texels) &&
         atlas.mask.size() == texels;
}

}  // namespace

Result<void> save_atlas(const Atlas& atlas, const std::string& path) {
  THRONG_ASSERT(is_sound(atlas));
  flatbuffers::FlatBufferBuilder builder(atlas.colour.size() + atlas.normal.size() +
                                         atlas.mask.size() + (1 << 16));
  std::vector<format::AtlasView> views;
  views.reserve(atlas.views.size());
  for (const AtlasView& v : atlas.views) {
    views.emplace_back(v.page, v.x, v.y, v.width, v.height, v.left, v.top);
  }
  std::vector<flatbuffers::Offset<format::AtlasClip>> clips;
  for (const AtlasClip& clip : atlas.clips) {
    clips.push_back(format::CreateAtlasClip(builder, builder.CreateString(clip.name),
                                            clip.first_frame, clip.frames, clip.seconds,
                                            clip.stride));
  }
  std::vector<uint8_t> parts;
  for (const auto& colour : atlas.part_colour)
    parts.insert(parts.end(), colour.begin(), colour.end());
  const AtlasShape& s = atlas.shape;
  std::vector<flatbuffers::Offset<format::AtlasPart>> worn;
  for (const AtlasPart& part : atlas.parts) {
    worn.push_back(format::CreateAtlasPart(builder, builder.CreateString(part.name),
                                           static_cast<uint8_t>(part.kind)));
  }
  // Without parts the bytes are those of before.
  const auto worn_at = worn.empty() ? 0 : builder.CreateVector(worn);
  const auto clips_at = builder.CreateVector(clips);
  const auto views_at = builder.CreateVectorOfStructs(views);
  const auto parts_at = builder.CreateVector(parts);
  const auto colour_at = builder.CreateVector(atlas.colour);
  const auto normal_at = builder.CreateVector(atlas.normal);
  const auto mask_at = builder.CreateVector(atlas.mask);
  builder.Finish(format::CreateAtlasFile(
                     builder, version_of(atlas.format, !worn.empty()), sum_of(atlas), s.pixels,
                     s.directions, s.elevations, s.frames, s.side, s.centre, s.height,
                     static_cast<uint8_t>(atlas.format), atlas.width, atlas.height, atlas.pages,
                     clips_at, views_at, parts_at, colour_at, normal_at, mask_at, worn_at),
                 kIdentifier);
  return write_file(path, {builder.GetBufferPointer(), builder.GetSize()});
}

Result<Atlas> load_atlas(const std::string& path) {
  const Result<FileMap> map = FileMap::open(path);
  if (!map) return map.error();
  return impostor::read_atlas(map->bytes(), path);
}

Result<Atlas> impostor::read_atlas(std::span<const uint8_t> bytes, const std::string& path) {
  flatbuffers::Verifier verifier(bytes.data(), bytes.size());
  if (bytes.size() < 8 || !flatbuffers::BufferHasIdentifier(bytes.data(), kIdentifier) ||
      !verifier.VerifyBuffer<format::AtlasFile>(kIdentifier)) {
    return bad(path, "not an atlas, or truncated");
  }
  const format::AtlasFile& file = *flatbuffers::GetRoot<format::AtlasFile>(bytes.data());
  if (file.version() < 1 || file.version() > kVersion) {
    return bad(path, "atlas version " + std::to_string(file.version()) +
                         ", this program reads 1 to " + std::to_string(kVersion));
  }
  if (file.format() >= kAtlasFormats ||
      file.version() != version_of(static_cast<AtlasFormat>(file.format()),
                                   file.parts() != nullptr && file.parts()->size() > 0) ||
      file.part_colour()->size() != 3 * kBodyParts) {
    return bad(path, "its numbers make no sense");
  }
  Atlas atlas;
  atlas.shape = {.pixels = file.pixels(),
                 .directions = file.directions(),
                 .elevations = file.elevations(),
                 .frames = file.frames(),
                 .side = file.side(),
                 .centre = file.centre(),
                 .height = file.figure()};
  atlas.format = static_cast<AtlasFormat>(file.format());
  atlas.width = file.width();
  atlas.height = file.height();
  atlas.pages = file.pages();
  for (const format::AtlasClip* clip : *file.clips()) {
    atlas.clips.push_back({.name = clip->name()->str(),
                           .first_frame = clip->first_frame(),
                           .frames = clip->frames(),
                           .seconds = clip->seconds(),
                           .stride = clip->stride()});
  }
  for (const format::AtlasView* v : *file.views()) {
    atlas.views.push_back(
        {v->page(), v->x(), v->y(), v->width(), v->height(), v->left(), v->top()});
  }
  if (file.parts() != nullptr) {
    for (const format::AtlasPart* part : *file.parts()) {
      atlas.parts.push_back(
          {.name = part->name()->str(), .kind = static_cast<WornKind>(part->kind())});
    }
  }
  for (size_t i = 0; i < 3 * kBodyParts; ++i) {
    atlas.part_colour[i / 3][i % 3] = file.part_colour()->Get(static_cast<uint32_t>(i));
  }
  const auto copy = [](const flatbuffers::Vector<uint8_t>& from) {
    return std::vector<uint8_t>(from.begin(), from.end());
  };
  atlas.colour = copy(*file.colour());
  atlas.normal = copy(*file.normal());
  atlas.mask = copy(*file.mask());
  if (file.sum() != sum_of(atlas)) return bad(path, "its checksum is wrong (damaged)");
  if (!is_sound(atlas)) return bad(path, "its numbers make no sense");
  return atlas;
}

}  // namespace throng
