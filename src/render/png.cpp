// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <string>
#include <vector>

#include "core/files/part_file.h"
#include "throng/picture.h"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#pragma GCC diagnostic ignored "-Wunused-function"
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#include <stb/stb_image_write.h>
#pragma GCC diagnostic pop

// Writes PNG (stb_image_write).
namespace throng {
namespace {

void write_bytes(void* file, void* data, int size) {
  static_cast<PartFile*>(file)->write(data, static_cast<size_t>(size));
}

void append_bytes(void* bytes, void* data, int size) {
  const auto* from = static_cast<const uint8_t*>(data);
  auto& to = *static_cast<std::vector<uint8_t>*>(bytes);
  to.insert(to.end(), from, from + size);
}

}  // namespace

std::vector<uint8_t> png_bytes(const Image& image) {
  THRONG_ASSERT(image.rgb.size() ==
                static_cast<size_t>(image.width) * static_cast<size_t>(image.height) * 3);
  std::vector<uint8_t> bytes;
  if (stbi_write_png_to_func(append_bytes, &bytes, image.width, image.height, 3, image.rgb.data(),
                             image.width * 3) == 0) {
    bytes.clear();
  }
  return bytes;
}

Result<void> write_png(const Image& image, const std::string& path) {
  THRONG_ASSERT(image.rgb.size() ==
                static_cast<size_t>(image.width) * static_cast<size_t>(image.height) * 3);
  PartFile file(path);
  const int stride = image.width * 3;
  if (stbi_write_png_to_func(write_bytes, &file, image.width, image.height, 3, image.rgb.data(),
                             stride) == 0) {
    return Error{Errc::kLimit, path + ": out of memory; draw a smaller picture"};
  }
  return file.close();
}

}  // namespace throng
