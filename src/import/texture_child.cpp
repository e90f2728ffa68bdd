// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "import/child_process.h"
#include "import/texture_reader.h"

// Decoders of pictures are code that strangers' files have crashed before. So they run in a child
// process; where one ends early, the next goes on behind the texture that it ended at. A file full
// of textures that end it is no model any more: then the rest is left.
namespace throng {
namespace {

struct Told {
  int32_t width = 0, height = 0;  // 0: it cannot be used, and a clause follows.
  uint64_t size = 0;
};

constexpr uint64_t kLongestClause = 1000;
constexpr size_t kMaxEnds = 8;  // Of children, before the rest of a model is left.

bool take(PipeReader& pipe, const TextureSource& source, int32_t most,
          std::vector<Result<Texture>>& all) {
  Told told;
  if (!pipe.read(&told, sizeof told)) return false;
  if (told.width == 0) {
    if (told.size > kLongestClause) return false;
    std::string why(static_cast<size_t>(told.size), ' ');
    if (!pipe.read(why.data(), why.size())) return false;
    all.emplace_back(Error{Errc::kBadFile, std::move(why)});
    return true;
  }
  const bool sound =
      told.width > 0 && told.width <= most && told.height > 0 && told.height <= most &&
      told.size == static_cast<uint64_t>(told.width) * static_cast<uint64_t>(told.height) * 4;
  if (!sound) return false;
  Texture texture{.name = source.name, .width = told.width, .height = told.height, .rgba = {}};
  texture.rgba.resize(static_cast<size_t>(told.size));
  if (!pipe.read(texture.rgba.data(), texture.rgba.size())) return false;
  all.emplace_back(std::move(texture));
  return true;
}

void tell(const PipeWriter& pipe, const Result<Texture>& texture) {
  Told told;
  if (!texture) {
    const std::string why = texture.error().message.substr(0, kLongestClause);
    told.size = why.size();
    pipe.write(&told, sizeof told);
    pipe.write(why.data(), why.size());
    return;
  }
  told = {texture->width, texture->height, texture->rgba.size()};
  pipe.write(&told, sizeof told);
  pipe.write(texture->rgba.data(), texture->rgba.size());
}

}  // namespace

Result<std::vector<Result<Texture>>> read_all_textures(const std::vector<TextureSource>& sources,
                                                       const std::string& model, int32_t most,
                                                       Context& context,
                                                       const TextureDecoding& decoding) {
  std::vector<Result<Texture>> all;
  all.reserve(sources.size());
  for (size_t ends = 0; all.size() < sources.size();) {
    const size_t first = all.size();
    const auto done = run_in_child(
        {.bytes = decoding.bytes, .seconds = decoding.seconds * (sources.size() + 1)}, context,
        [&](const PipeWriter& pipe) {
          for (size_t i = first; i < sources.size(); ++i) {
            allow_this_child(decoding.seconds);
            tell(pipe, decoding.read(sources[i], model, most));
          }
        },
        [&](PipeReader& pipe) {
          while (all.size() < sources.size()) {
            if (!take(pipe, sources[all.size()], most, all)) return false;
          }
          return true;
        });
    if (!done && done.error().code == Errc::kCancelled) return done.error();
    if (all.size() == sources.size()) break;
    if (!done && done.error().code == Errc::kIo) {  // There is no child: the next would not be.
      all.resize(sources.size(), Error{Errc::kIo, "is not decoded: " + done.error().message});
      break;
    }
    all.emplace_back(
        Error{Errc::kBadFile, "crashes its decoder, or takes it too long or too much memory"});
    if (++ends == kMaxEnds) {
      all.resize(sources.size(), Error{Errc::kBadFile, "is not tried after so many others"});
    }
  }
  return all;
}

}  // namespace throng
