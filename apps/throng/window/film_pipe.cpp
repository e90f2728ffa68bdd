// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "window/film_pipe.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <utility>
#include <vector>

extern char** environ;

// A child process of ffmpeg that reads raw pictures from a pipe.
namespace throng::app {
namespace {

Error io_error(const std::string& path, const std::string& what) {
  return {Errc::kIo, path + ": " + what};
}

}  // namespace

FilmPipe::FilmPipe(FilmPipe&& other) noexcept
    : path_(std::move(other.path_)),
      beside_(std::move(other.beside_)),
      child_(std::exchange(other.child_, -1)),
      pipe_(std::exchange(other.pipe_, -1)) {}

FilmPipe::~FilmPipe() {
  if (pipe_ >= 0) close(pipe_);
  if (child_ < 0) return;
  waitpid(child_, nullptr, 0);
  std::remove(beside_.c_str());
}

Result<FilmPipe> FilmPipe::open(const std::string& path, const FilmFormat& format) {
  FilmPipe film;
  film.path_ = path;
  // ffmpeg chooses the format by the extension.
  const std::filesystem::path p(path);
  film.beside_ =
      (p.parent_path() / (p.stem().string() + ".part" + p.extension().string())).string();
  int ends[2] = {-1, -1};
  if (pipe2(ends, O_CLOEXEC) != 0) return io_error(path, "no pipe can be opened");
  film.pipe_ = ends[1];
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[0], STDIN_FILENO);
  const std::string size = fmt::format("{}x{}", format.width, format.height);
  const std::string rate = std::to_string(format.rate);
  const std::vector<const char*> words = {"ffmpeg",     "-y",         "-loglevel",
                                          "error",      "-f",         "rawvideo",
                                          "-pix_fmt",   "rgb24",      "-s",
                                          size.c_str(), "-r",         rate.c_str(),
                                          "-i",         "-",          "-pix_fmt",
                                          "yuv420p",    "-crf",       "18",
                                          "-movflags",  "+faststart", film.beside_.c_str(),
                                          nullptr};
  pid_t child = -1;
  const int failed = posix_spawnp(&child, "ffmpeg", &actions, nullptr,
                                  const_cast<char* const*>(words.data()), environ);
  posix_spawn_file_actions_destroy(&actions);
  close(ends[0]);
  if (failed == ENOENT) {
    return Error{Errc::kNotFound,
                 "film: ffmpeg is not on this machine; install it (apt-get install ffmpeg)"};
  }
  if (failed != 0) return io_error(path, "ffmpeg cannot be started");
  film.child_ = child;
  // Writing to a closed pipe must fail, not end the program.
  std::signal(SIGPIPE, SIG_IGN);
  return film;
}

Result<void> FilmPipe::add(const Image& image) {
  size_t done = 0;
  while (done < image.rgb.size()) {
    const ssize_t wrote = write(pipe_, image.rgb.data() + done, image.rgb.size() - done);
    if (wrote < 0 && errno == EINTR) continue;
    if (wrote <= 0) {
      return io_error(path_, "ffmpeg ended before the film did; what it says is above");
    }
    done += static_cast<size_t>(wrote);
  }
  return {};
}

Result<void> FilmPipe::finish() {
  close(std::exchange(pipe_, -1));
  int status = 0;
  waitpid(std::exchange(child_, -1), &status, 0);
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
    std::remove(beside_.c_str());
    return io_error(path_, "ffmpeg could not write it; what it says is above");
  }
  std::error_code error;
  std::filesystem::rename(beside_, path_, error);
  if (error) return io_error(path_, "cannot be written");
  return {};
}

}  // namespace throng::app
