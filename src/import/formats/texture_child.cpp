// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "import/formats/texture_reader.h"
#include "import/raw/child_process.h"

// Damaged files can crash decoders of pictures. So they run in a child process; if it ends early,
// the next one goes on after the texture at which it ended. After kMaxEnds such textures the rest
// is not decoded.
namespace throng::importer {
namespace {

struct TextureHeader {
  int32_t width = 0, height = 0;  // 0: it cannot be used, and the reason follows.
  uint64_t size = 0;
};

constexpr uint64_t kLongestClause = 1000;
constexpr size_t kMaxEnds = 8;  // Children that may end early in one model.

bool receive_texture(PipeReader& pipe, const TextureSource& source, int32_t max_side,
                     std::vector<Result<Texture>>& all) {
  TextureHeader header;
  if (!pipe.read(&header, sizeof header)) return false;
  if (header.width == 0) {
    if (header.size > kLongestClause) return false;
    std::string why(static_cast<size_t>(header.size), ' ');
    if (!pipe.read(why.data(), why.size())) return false;
    all.emplace_back(Error{Errc::kBadFile, std::move(why)});
    return true;
  }
  const bool sound =
      header.width > 0 && header.width <= max_side && header.height > 0 &&
      header.height <= max_side &&
      header.size == static_cast<uint64_t>(header.width) * static_cast<uint64_t>(header.height) * 4;
  if (!sound) return false;
  Texture texture{.name = source.name, .width = header.width, .height = header.height, .rgba = {}};
  texture.rgba.resize(static_cast<size_t>(header.size));
  if (!pipe.read(texture.rgba.data(), texture.rgba.size())) return false;
  all.emplace_back(std::move(texture));
  return true;
}

void send_texture(const PipeWriter& pipe, const Result<Texture>& texture) {
  TextureHeader header;
  if (!texture) {
    const std::string why = texture.error().message.substr(0, kLongestClause);
    header.size = why.size();
    pipe.write(&header, sizeof header);
    pipe.write(why.data(), why.size());
    return;
  }
  header = {texture->width, texture->height, texture->rgba.size()};
  pipe.write(&header, sizeof header);
  pipe.write(texture->rgba.data(), texture->rgba.size());
}

}  // namespace

Result<std::vector<Result<Texture>>> read_all_textures(const std::vector<TextureSource>& sources,
                                                       const std::string& model, int32_t max_side,
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
            send_texture(pipe, decoding.read(sources[i], model, max_side));
          }
        },
        [&](PipeReader& pipe) {
          while (all.size() < sources.size()) {
            if (!receive_texture(pipe, sources[all.size()], max_side, all)) return false;
          }
          return true;
        });
    if (!done && done.error().code == Errc::kCancelled) return done.error();
    if (all.size() == sources.size()) break;
    if (!done && done.error().code == Errc::kIo) {  // No child could be started.
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

}  // namespace throng::importer
