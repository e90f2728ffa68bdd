// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "command.h"
#include "report/image_folder.h"
#include "throng/impostor.h"
#include "throng/picture.h"

// throng atlas: pictures of a walking character from all sides, for crowds.
namespace throng::app {
namespace {

constexpr const char* kFrameImages = "frame_";

struct AtlasOptions {
  std::string character;
  std::string output;
  std::string images;
  std::string format = "bc3";
  bool parts = false;
  std::vector<std::string> wear;
  AtlasConfig config;
};

// One row per format: bytes of its colours, and their PSNR against 8 bits per channel.
struct FormatRow {
  AtlasFormat format;
  uint64_t sheet = 0, packed = 0;
  double psnr = 0;
};

std::vector<FormatRow> compare_formats(const Atlas& exact) {
  std::vector<FormatRow> rows;
  for (int32_t f = 0; f < kAtlasFormats; ++f) {
    const auto format = static_cast<AtlasFormat>(f);
    rows.push_back({format, sheet_colour_bytes(exact.shape, format),
                    packed_colour_bytes(exact, format),
                    atlas_psnr(exact, convert_atlas(exact, format))});
  }
  return rows;
}

Json json_of(const Atlas& atlas, const std::vector<FormatRow>& rows) {
  Json clips = Json::array(), formats = Json::array(), parts = Json::object();
  for (const AtlasClip& clip : atlas.clips) {
    clips.push_back({{"name", clip.name},
                     {"frames", clip.frames},
                     {"seconds", clip.seconds},
                     {"stride", clip.stride}});
  }
  for (const FormatRow& row : rows) {
    formats.push_back({{"format", word_for(row.format)},
                       {"sheet_bytes", row.sheet},
                       {"packed_bytes", row.packed},
                       {"psnr", std::isfinite(row.psnr) ? Json(row.psnr) : Json(nullptr)}});
  }
  Json worn = Json::array();
  for (const AtlasPart& part : atlas.parts) {
    worn.push_back({{"name", part.name}, {"kind", word_for(part.kind)}});
  }
  for (int32_t p = 0; p < kBodyParts; ++p) {
    const auto& colour = atlas.part_colour[static_cast<size_t>(p)];
    parts[word_for(static_cast<BodyPart>(p))] = {colour[0], colour[1], colour[2]};
  }
  return {{"directions", 2 * atlas.shape.directions},
          {"elevations", atlas.shape.elevations},
          {"frames", atlas.shape.frames},
          {"pixels", atlas.shape.pixels},
          {"views", atlas.views.size()},
          {"height", atlas.shape.height},
          {"metres_per_texel", atlas.shape.side / atlas.shape.pixels},
          {"pages", atlas.pages},
          {"page_width", atlas.width},
          {"page_height", atlas.height},
          {"colour_bytes", atlas.colour.size()},
          {"normal_bytes", atlas.normal.size()},
          {"mask_bytes", atlas.mask.size()},
          {"clips", clips},
          {"part_colours", parts},
          {"worn", worn},
          {"formats", formats}};
}

std::string text_of(const Atlas& atlas, const std::vector<FormatRow>& rows) {
  std::string text = fmt::format(
      "{} frames from {} directions and {} elevations: {} views on {} page{} of {} x {}\n"
      "{:.2f} m high, {:.1f} mm a texel; colours {}, normals {}, masks {}\n",
      atlas.shape.frames, 2 * atlas.shape.directions, atlas.shape.elevations, atlas.views.size(),
      atlas.pages, atlas.pages == 1 ? "" : "s", atlas.width, atlas.height, atlas.shape.height,
      1000 * atlas.shape.side / atlas.shape.pixels, human_bytes(atlas.colour.size()),
      human_bytes(atlas.normal.size()), human_bytes(atlas.mask.size()));
  for (const AtlasClip& clip : atlas.clips) {
    text +=
        fmt::format("clip {}: {:.2f} s, {:.2f} m a cycle\n", clip.name, clip.seconds, clip.stride);
  }
  for (const AtlasPart& part : atlas.parts) {
    text += fmt::format("{}: {}, worn by some\n", word_for(part.kind), part.name);
  }
  text += "colour and alpha   equal squares   packed   PSNR\n";
  for (const FormatRow& row : rows) {
    text += fmt::format("{:<18} {:>13} {:>8}   {}\n", word_for(row.format), human_bytes(row.sheet),
                        human_bytes(row.packed),
                        std::isfinite(row.psnr) ? fmt::format("{:.1f} dB", row.psnr) : "exact");
  }
  return text;
}

// One of word_for()'s words: others do not get past the options.
AtlasFormat format_called(const std::string& word) {
  int32_t format = 0;
  while (word != word_for(static_cast<AtlasFormat>(format))) ++format;
  return static_cast<AtlasFormat>(format);
}

// "hair=FILE": the hair of another character, over the body of this one.
Result<void> wear(Character& character, const std::string& word, Context& context) {
  struct Named {
    const char* kind;
    WornKind worn;
    BodyPart part;
  };
  constexpr Named kNamed[] = {{"hair", WornKind::kHair, BodyPart::kHair},
                              {"hat", WornKind::kHat, BodyPart::kOther},
                              {"coat", WornKind::kCoat, BodyPart::kShirt},
                              {"bag", WornKind::kBag, BodyPart::kOther},
                              {"skirt", WornKind::kSkirt, BodyPart::kPants}};
  const size_t equals = word.find('=');
  for (const Named& named : kNamed) {
    if (equals == std::string::npos || word.substr(0, equals) != named.kind) continue;
    const std::string path = word.substr(equals + 1);
    const Result<Character> from = load_character(path, context);
    if (!from) return from.error();
    const auto done = wear_part(character, *from, named.part, named.worn);
    if (!done) return Error{done.error().code, path + ": " + done.error().message};
    return {};
  }
  return Error{Errc::kBadConfig, "--wear: cannot use '" + word +
                                     "'; write hair, hat, coat, bag or skirt=CHARACTER.glb"};
}

int atlas(Session& session, const AtlasOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  Character character;
  if (options.character.empty()) {
    character = options.parts ? built_in_character_with_parts() : built_in_character();
  } else {
    Result<Character> loaded = load_character(options.character, session.context);
    if (!loaded) return fail(loaded.error());
    character = *std::move(loaded);
  }
  for (const std::string& word : options.wear) {
    if (auto done = wear(character, word, session.context); !done) return fail(done.error());
  }
  const Result<Atlas> exact = create_atlas(character, options.config, session.context);
  if (!exact) {
    const std::string whose = options.character.empty() ? "" : options.character + ": ";
    return fail({exact.error().code, whose + exact.error().message});
  }
  const Atlas kept = convert_atlas(*exact, format_called(options.format), options.config.workers);
  if (!options.output.empty()) {
    if (auto done = save_atlas(kept, options.output); !done) return fail(done.error());
  }
  if (!options.images.empty()) {
    const auto draw = [&](size_t frame) { return draw_atlas(kept, static_cast<int32_t>(frame)); };
    const auto frames = static_cast<size_t>(kept.shape.frames);
    if (auto done = write_images(options.images, kFrameImages, frames, draw); !done) {
      return fail(done.error());
    }
  }
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const std::vector<FormatRow> rows = compare_formats(*exact);
  Json json = json_of(kept, rows);
  json["triangles"] = character.triangles.size();
  json["bones"] = character.bones.size();
  json["format"] = options.format;
  json["seconds"] = seconds;
  print_result(session, json, text_of(kept, rows));
  return kDone;
}

}  // namespace

void add_atlas(CLI::App& parser, Session& session) {
  CLI::App* command =
      add_command(parser, session, "atlas", "Draw a walking character from all sides, for crowds",
                  "throng atlas -o people.atlas --images views");
  const auto options = std::make_shared<AtlasOptions>();
  AtlasConfig& config = options->config;
  command
      ->add_option(
          "character", options->character,
          "Character with a skeleton (glb, gltf, fbx, dae); a built-in figure if not given")
      ->type_name("CHARACTER.glb");
  add_output(*command, session, "-o,--output", options->output, "Atlas to write")
      ->required()
      ->type_name("FILE.atlas");
  command
      ->add_option("--clip", config.clips,
                   "Clip to draw, by its name or last word; may be repeated")
      ->type_name("NAME")
      ->allow_extra_args(false)
      ->capture_default_str();
  command->add_option("--frames", config.frames, "Frames of each clip, 1 or even")
      ->capture_default_str();
  command->add_option("--directions", config.directions, "Directions over half a turn, mirrored")
      ->capture_default_str();
  command->add_option("--elevations", config.elevations, "Elevations from the horizon up")
      ->capture_default_str();
  command->add_option("--pixels", config.pixels, "Side of a view [texels]")->capture_default_str();
  command->add_option("--height", config.height, "Height of the figure, 0: the file's own [m]")
      ->capture_default_str();
  auto* parts = command->add_flag("--parts", options->parts,
                                  "With the built-in figure: hair, hats, a coat, a rucksack and a "
                                  "skirt, which avatars exchange");
  command
      ->add_option("--wear", options->wear,
                   "A part of another character with the same skeleton, which some avatars wear: "
                   "hair, coat (its shirt), skirt (its trousers), hat or bag (what is no body part "
                   "by its material's name); may be repeated")
      ->type_name("KIND=CHARACTER.glb")
      ->allow_extra_args(false);
  command->get_option("character")->excludes(parts);
  std::vector<std::string> words;
  for (int32_t f = 0; f < kAtlasFormats; ++f) {
    words.emplace_back(word_for(static_cast<AtlasFormat>(f)));
  }
  command
      ->add_option("--format", options->format,
                   "How colours are kept; bc1 and bc3 for desktops, etc2a1 and etc2 for phones")
      ->transform(CLI::IsMember(words, CLI::ignore_case))
      ->capture_default_str();
  add_image_folder(*command, session, "--images", options->images, kFrameImages,
                   "Folder for a picture of each frame; replaces those of before");
  add_threads(*command, config.workers);
  command->callback([&session, options] { session.exit_code = atlas(session, *options); });
}

}  // namespace throng::app
