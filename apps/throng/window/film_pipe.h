// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <string>

#include "throng/base.h"
#include "throng/picture.h"

namespace throng::app {

struct FilmFormat {
  int32_t width = 1280, height = 720;  ///< [px, even]
  int32_t rate = 30;                   ///< Pictures a second. [1 to 120]
};

/// A film that ffmpeg writes while its pictures are made. The file gets its name when it is
/// finished; one that is not leaves nothing behind.
class FilmPipe {
 public:
  /// Fails with kNotFound: no ffmpeg; kIo.
  [[nodiscard]] static Result<FilmPipe> open(const std::string& path, const FilmFormat& format);
  FilmPipe(FilmPipe&& other) noexcept;
  FilmPipe& operator=(FilmPipe&&) = delete;
  ~FilmPipe();

  /// Fails with kIo: ffmpeg has ended.
  [[nodiscard]] Result<void> add(const Image& image);
  /// Fails with kIo and what ffmpeg's exit code was.
  [[nodiscard]] Result<void> finish();

 private:
  FilmPipe() = default;
  std::string path_, beside_;
  pid_t child_ = -1;
  int pipe_ = -1;
};

}  // namespace throng::app
