// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "core/files/config_file.h"
#include "throng/avatar.h"

/// What load_classes does once the file is parsed.
namespace throng {

/// One table's keys but its name, which the caller reads. Refuses unknown keys and what breaks a
/// limit.
void read_class(ConfigReader& reader, AvatarClass& avatar);

[[nodiscard]] Result<std::vector<AvatarClass>> read_classes(const ConfigNode& root,
                                                            const std::string& name);

}  // namespace throng
