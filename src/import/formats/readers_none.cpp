// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <filesystem>

#include "core/files/read_file.h"
#include "import/formats/assimp_reader.h"
#include "import/formats/city.h"
#include "import/formats/glb.h"
#include "import/formats/patch_json.h"
#include "import/formats/plan.h"
#include "import/formats/texture_reader.h"

// A build without assimp, pugixml and simdjson, and without child processes: a browser's.
namespace throng::importer {
namespace {

Error not_here(const std::string& name) {
  return {Errc::kBadFile, name +
                              ": this build does not read such files; the program does: throng "
                              "bake makes a world of it, which opens everywhere"};
}

}  // namespace

Result<RawScene> read_with_assimp(const std::string& path, const ReadOptions& options,
                                  Context& context) {
  const std::string extension = std::filesystem::path(path).extension().string();
  if (extension != ".glb" && extension != ".GLB") return not_here(path);
  const auto bytes = read_file(path);
  if (!bytes) return bytes.error();
  return read_glb(*bytes, options, context);
}

Result<RawScene> read_cityjson(std::string_view, const ReadOptions& options, Context&) {
  return not_here(options.name);
}

Result<RawScene> read_citygml(std::string_view, const ReadOptions& options, Context&) {
  return not_here(options.name);
}

Result<RawScene> read_geojson(std::string_view, const ReadOptions& options, Context&) {
  return not_here(options.name);
}

Result<RawScene> read_patch_json(std::string_view, const ReadOptions& options, Context&) {
  return not_here(options.name);
}

Result<std::vector<Result<Texture>>> read_all_textures(const std::vector<TextureSource>& sources,
                                                       const std::string& model, int32_t max_side,
                                                       Context& context,
                                                       const TextureDecoding& decoding) {
  std::vector<Result<Texture>> all;
  for (const TextureSource& source : sources) {
    if (context.cancel) return Error{Errc::kCancelled, "cancelled while reading"};
    all.push_back(decoding.read(source, model, max_side));
  }
  return all;
}

}  // namespace throng::importer
