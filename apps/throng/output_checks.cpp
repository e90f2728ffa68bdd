// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "output_checks.h"

#include <algorithm>
#include <filesystem>
#include <initializer_list>
#include <string>
#include <system_error>

// Compares the files that a command's options name before it begins. Files that an input file names
// in turn (the model of a scenario) are not known here.
namespace throng::app {
namespace {

namespace fs = std::filesystem;

// Does the type that --help shows name a file or a folder?
bool takes_file(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  return std::ranges::any_of(
      std::initializer_list<const char*>{"FILE", "WORLD", "MODEL", "CHARACTER", "DIR", "FOLDER"},
      [&](const char* word) { return type.find(word) != std::string::npos; });
}

// Absolute and without links, also if the file does not exist yet; empty if that is not known.
fs::path whole_path(const fs::path& path) {
  std::error_code failed;
  const fs::path absolute = fs::absolute(path, failed);
  const fs::path whole = failed ? fs::path() : fs::weakly_canonical(absolute, failed);
  return failed ? fs::path() : whole;
}

bool is_same(const fs::path& a, const fs::path& b) {
  std::error_code failed;
  if (fs::equivalent(a, b, failed)) return true;  // Hard links, too. Fails if one is missing.
  const fs::path whole = whole_path(a);
  return !whole.empty() && whole == whole_path(b);
}

// Is it the file, or the one that becomes it?
bool overwrites(const std::string& output, const std::string& file) {
  return is_same(output, file) || is_same(output + ".part", file);
}

bool is_world(const fs::path& folder) {
  std::error_code failed;
  return !folder.empty() && fs::exists(folder / "manifest.thm", failed);
}

bool is_in_world(const std::string& file) { return is_world(whole_path(file).parent_path()); }

void refuse_output(const CLI::Option& output, const std::string& what) {
  throw CLI::ValidationError(output.get_name(), what);
}

void check_against(const CLI::Option& output, const std::string& path, const CLI::Option& other,
                   bool is_output) {
  if (!is_output && !takes_file(other)) return;
  for (const std::string& file : other.results()) {
    if (!overwrites(path, file)) continue;
    const std::string what = is_output ? path + " is also what " + other.get_name() + " writes"
                                       : path + " is an input (" + other.get_name() + ")";
    refuse_output(output, what + "; name another file");
  }
}

bool is_picture_in(const fs::path& folder, const std::string& prefix, const std::string& file) {
  const fs::path whole = whole_path(file);
  const std::string name = whole.filename().string();
  return whole.parent_path() == folder && name.starts_with(prefix) && name.ends_with(".png");
}

void check_is_no_picture(const CLI::Option& other, const fs::path& whole, const std::string& prefix,
                         const CLI::Option& folder) {
  for (const std::string& file : other.results()) {
    if (!is_picture_in(whole, prefix, file)) continue;
    refuse_output(other,
                  file + " is also a picture of " + folder.get_name() + "; name another file");
  }
}

}  // namespace

void check_outputs(const CLI::App& command, const std::vector<const CLI::Option*>& outputs) {
  const auto options = command.get_options();
  for (const CLI::Option* output : outputs) {
    if (std::ranges::find(options, output) == options.end()) continue;  // of another command
    for (const std::string& path : output->results()) {
      std::error_code failed;
      const fs::file_status status = fs::status(path, failed);
      if (fs::is_directory(status)) refuse_output(*output, path + " is a folder; name a file");
      // Most are renamed when they are whole, which would replace a device or a pipe.
      if (fs::exists(status) && !fs::is_regular_file(status)) {
        refuse_output(*output, path + " is no regular file; name another");
      }
      if (is_in_world(path))
        refuse_output(*output, path + " lies in a baked world; name a file elsewhere");
      for (const CLI::Option* other : options) {
        const bool is_output = std::ranges::find(outputs, other) != outputs.end();
        if (other != output) check_against(*output, path, *other, is_output);
      }
    }
  }
}

void check_image_folders(const CLI::App& command, const std::vector<ImageFolder>& folders,
                         const std::vector<const CLI::Option*>& outputs) {
  const auto options = command.get_options();
  for (const auto& [folder, prefix] : folders) {
    if (std::ranges::find(options, folder) == options.end()) continue;  // of another command
    for (const std::string& path : folder->results()) {
      std::error_code failed;
      const fs::path whole = whole_path(path);
      const fs::file_status status = fs::status(path, failed);
      if (fs::exists(status) && !fs::is_directory(status)) {
        refuse_output(*folder, path + " is a file; name a folder");
      }
      if (is_world(whole) || is_world(whole.parent_path())) {
        refuse_output(*folder, path + " lies in a baked world; name another folder");
      }
      for (const CLI::Option* other : options) {
        const bool is_output = std::ranges::find(outputs, other) != outputs.end();
        if (is_output || takes_file(*other)) check_is_no_picture(*other, whole, prefix, *folder);
      }
    }
  }
}

}  // namespace throng::app
