// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "import/formats/texture_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <utility>

#include "core/files/read_file.h"
#include "core/math/texel_mean.h"

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STBI_ONLY_TGA
#define STBI_ONLY_BMP
#define STBI_NO_STDIO
#define STBI_NO_SIMD  // The same bytes everywhere.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wshadow"
#include <stb/stb_image.h>
#pragma GCC diagnostic pop

// Finds the textures of a model, decodes them (stb_image) and halves them until they fit.
namespace throng::importer {
namespace {

namespace fs = std::filesystem;

constexpr int64_t kMaxTexels = int64_t{1} << 26;   // Decoding takes up to twelve bytes each.
constexpr uint64_t kMaxBytes = uint64_t{1} << 28;  // Of a file.
constexpr int64_t kBudget = int64_t{256} << 20;    // Of all textures of a model.
constexpr int32_t kLargestSide = 2048;

Error unusable(std::string why) { return {Errc::kBadFile, std::move(why)}; }

// Half as large, an odd last row or column counting for itself.
Texture halved(const Texture& from) {
  Texture to{.name = from.name,
             .width = (from.width + 1) / 2,
             .height = (from.height + 1) / 2,
             .rgba = {}};
  to.rgba.resize(static_cast<size_t>(to.width) * static_cast<size_t>(to.height) * 4);
  const auto at = [](const Texture& texture, int32_t x, int32_t y) {
    return (static_cast<size_t>(y) * static_cast<size_t>(texture.width) + static_cast<size_t>(x)) *
           4;
  };
  for (int32_t y = 0; y < to.height; ++y) {
    for (int32_t x = 0; x < to.width; ++x) {
      TexelMean mean;
      for (int32_t k = 0; k < 4; ++k) {
        const int32_t sx = std::min(2 * x + (k & 1), from.width - 1);
        const int32_t sy = std::min(2 * y + (k >> 1), from.height - 1);
        mean.add(&from.rgba[at(from, sx, sy)], 1);
      }
      mean.write(&to.rgba[at(to, x, y)]);
    }
  }
  return to;
}

Texture fitted(Texture texture, int32_t max_side) {
  while (std::max(texture.width, texture.height) > max_side) texture = halved(texture);
  return texture;
}

// "textures/old%20wall.png" of another machine: its last part may lie beside the model.
std::string clean_name(const std::string& name) {
  std::string out;
  const size_t start = name.starts_with("file://") ? 7 : name.starts_with("./") ? 2 : 0;
  const auto digit = [](char c) {
    return c >= '0' && c <= '9'   ? c - '0'
           : c >= 'a' && c <= 'f' ? c - 'a' + 10
           : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                  : -1;
  };
  for (size_t i = start; i < name.size(); ++i) {
    if (name[i] == '%' && i + 2 < name.size() && digit(name[i + 1]) >= 0 &&
        digit(name[i + 2]) >= 0) {
      out += static_cast<char>(digit(name[i + 1]) * 16 + digit(name[i + 2]));
      i += 2;
    } else {
      out += name[i] == '\\' ? '/' : name[i];
    }
  }
  return out.substr(0, out.find('\0'));
}

// The file that a model means, or an empty path. A path from a root is another machine's.
std::string find_file(const std::string& model, const std::string& named) {
  const fs::path folder = fs::path(model).parent_path();
  const fs::path name = clean_name(named);
  const fs::path last = name.filename();
  if (last.empty()) return {};
  std::vector<fs::path> tries;
  if (name.is_relative()) tries.push_back(folder / name);
  for (const char* place : {"", "textures", "../textures", "../materials/textures"}) {
    tries.push_back(folder / place / last);
  }
  for (const fs::path& path : tries) {
    std::error_code failure;
    if (fs::is_regular_file(path, failure)) return path.string();
  }
  return {};
}

// The largest side at which `count` textures fit the budget.
int32_t side_for(size_t count) {
  int32_t side = kLargestSide;
  while (side > 16 && static_cast<int64_t>(count) * side * side * 4 > kBudget) side /= 2;
  return side;
}

bool has_no_hue(const std::array<float, 4>& colour) {
  const auto [low, high] = std::minmax({colour[0], colour[1], colour[2]});
  return high - low < 0.05F;
}

}  // namespace

Result<Texture> decode_texture(std::string_view bytes, int32_t max_side) {
  const auto* data = reinterpret_cast<const stbi_uc*>(bytes.data());
  const auto size = static_cast<int>(std::min<size_t>(bytes.size(), INT32_MAX));
  int width = 0, height = 0, channels = 0;
  if (stbi_info_from_memory(data, size, &width, &height, &channels) == 0 || width <= 0 ||
      height <= 0) {
    // Or it has more than 2^30 bytes of texels: the decoder reports both alike.
    return unusable("is no PNG, JPEG, TGA or BMP that can be read");
  }
  if (int64_t{width} * height > kMaxTexels) {
    return unusable(fmt::format("has {} x {} texels, more than 67 million", width, height));
  }
  const std::unique_ptr<stbi_uc, void (*)(void*)> texels(
      stbi_load_from_memory(data, size, &width, &height, &channels, 4), stbi_image_free);
  if (!texels) return unusable("is damaged");
  Texture out{.name = {}, .width = width, .height = height, .rgba = {}};
  out.rgba.assign(texels.get(),
                  texels.get() + static_cast<size_t>(width) * static_cast<size_t>(height) * 4);
  return fitted(std::move(out), max_side);
}

Result<Texture> read_texture(const TextureSource& source, const std::string& model,
                             int32_t max_side) {
  if (source.width > 0 && source.height > 0) {
    const uint64_t size =
        static_cast<uint64_t>(source.width) * static_cast<uint64_t>(source.height) * 4;
    if (source.bytes.size() != size) return unusable("is damaged");
    Texture out{.name = source.name, .width = source.width, .height = source.height, .rgba = {}};
    out.rgba.assign(source.bytes.begin(), source.bytes.end());
    return fitted(std::move(out), max_side);
  }
  std::string read;
  if (source.bytes.empty()) {
    const std::string path = find_file(model, source.name);
    if (path.empty()) return unusable("is not there");
    std::error_code failure;
    if (fs::file_size(path, failure) > kMaxBytes || failure) return unusable("is too large");
    auto bytes = read_file(path);
    if (!bytes) return unusable("cannot be read");
    read = *std::move(bytes);
  }
  auto texture = decode_texture(source.bytes.empty() ? read : source.bytes, max_side);
  if (texture) texture->name = source.name;
  return texture;
}

Result<void> read_textures(RawScene& raw, const std::string& model, Context& context,
                           const TextureDecoding& decoding) {
  Scene& scene = raw.scene;
  if (raw.textures.empty()) return {};
  auto all =
      read_all_textures(raw.textures, model, side_for(raw.textures.size()), context, decoding);
  if (!all) return all.error();
  std::vector<uint32_t> number1(all->size(), 0);
  size_t bad = 0;
  std::string first;
  for (size_t i = 0; i < all->size(); ++i) {
    Result<Texture>& one = (*all)[i];
    if (one) {
      scene.textures.push_back(*std::move(one));
      number1[i] = static_cast<uint32_t>(scene.textures.size());
    } else if (++bad == 1) {
      first = raw.textures[i].name + " " + one.error().message;
    }
  }
  raw.textures.clear();
  std::vector<bool> unknown(scene.materials.size());
  for (size_t i = 0; i < scene.materials.size(); ++i) {
    Material& material = scene.materials[i];
    if (material.texture1 == 0) continue;
    material.texture1 = material.texture1 <= number1.size() ? number1[material.texture1 - 1] : 0;
    if (material.texture1 != 0) continue;
    material.opacity = Opacity::kOpaque;
    material.colour[3] = 1;
    // A colour without hue was meant only as a factor of the texture.
    unknown[i] = has_no_hue(material.colour);
  }
  for (ScenePart& part : scene.parts) {
    if (part.material1 != 0 && unknown[part.material1 - 1]) part.material1 = 0;
  }
  if (scene.textures.empty()) scene.texture_corners = {};
  if (bad > 0) {
    scene.report.warnings.push_back(
        fmt::format("{}: {} of {} textures cannot be used, for one {}; plain colours stand in",
                    model, bad, number1.size(), first));
  }
  return {};
}

}  // namespace throng::importer
