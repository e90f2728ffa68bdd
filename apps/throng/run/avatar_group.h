// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "command.h"

/// Avatars of one class, `--also CLASS:N`: on the command line, in JSON and in text.
namespace throng::app {

struct AvatarGroup {
  std::string class_name;
  uint32_t avatars = 0;
};

/// The values of --also. Fails with kBadConfig.
[[nodiscard]] Result<std::vector<AvatarGroup>> read_groups(const std::vector<std::string>& also);

/// [["giant", 5], ...], as results and recordings have it.
[[nodiscard]] Json json_of(std::span<const AvatarGroup> groups);
/// The groups "also" of a recording's settings, none if it has no such key. Fails with kBadFile.
[[nodiscard]] Result<std::vector<AvatarGroup>> groups_of(const Json& settings);

/// "adult, giant": the first class and those of the groups.
[[nodiscard]] std::string class_names(const std::string& first, std::span<const AvatarGroup> also);

}  // namespace throng::app
