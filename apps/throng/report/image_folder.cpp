// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "report/image_folder.h"

#include <fmt/format.h>

#include <filesystem>
#include <system_error>

// Numbers its pictures from 0, so that those of an earlier run are the names after the last one.
namespace throng::app {

Result<void> write_images(const std::string& folder, const std::string& prefix, size_t count,
                          const std::function<Image(size_t)>& draw) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) {
    return Error{Errc::kIo, fmt::format("{}: cannot make this folder: {}; give --images another "
                                        "one",
                                        folder, error.message())};
  }
  const auto name = [&](size_t n) { return fmt::format("{}/{}{:03}.png", folder, prefix, n); };
  for (size_t n = 0; n < count; ++n) {
    if (auto done = write_png(draw(n), name(n)); !done) return done.error();
  }
  for (size_t n = count; std::filesystem::remove(name(n), error); ++n) {
  }
  return {};
}

}  // namespace throng::app
