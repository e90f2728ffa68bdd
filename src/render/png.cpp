// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <string>

#include "throng/picture.h"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#pragma GCC diagnostic ignored "-Wunused-function"
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#include <stb/stb_image_write.h>
#pragma GCC diagnostic pop

namespace throng {
namespace {

Error io_error(const std::string& path, const char* what) {
  return {Errc::kIo, path + ": cannot " + what + ": " + std::strerror(errno) +
                         "; check the folder, its rights and the free space"};
}

struct Sink {
  std::FILE* file = nullptr;
  bool failed = false;
};

void write_bytes(void* context, void* data, int size) {
  auto* sink = static_cast<Sink*>(context);
  const auto bytes = static_cast<size_t>(size);
  sink->failed |= std::fwrite(data, 1, bytes, sink->file) != bytes;
}

}  // namespace

Result<void> write_png(const Image& image, const std::string& path) {
  THRONG_ASSERT(image.rgb.size() ==
                static_cast<size_t>(image.width) * static_cast<size_t>(image.height) * 3);
  const std::string part = path + ".part";
  Sink sink{.file = std::fopen(part.c_str(), "wb")};
  if (sink.file == nullptr) return io_error(path, "write");
  const int stride = image.width * 3;
  const bool encoded = stbi_write_png_to_func(write_bytes, &sink, image.width, image.height, 3,
                                              image.rgb.data(), stride) != 0;
  sink.failed |= std::fflush(sink.file) != 0;
  sink.failed |= std::fclose(sink.file) != 0;
  if (encoded && !sink.failed && std::rename(part.c_str(), path.c_str()) == 0) return {};
  const Error error = io_error(path, encoded ? "write" : "encode");
  std::remove(part.c_str());
  return error;
}

}  // namespace throng
