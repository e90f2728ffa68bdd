// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "throng/avatar.h"
#include "throng/base.h"

namespace throng {

/// Fails with kBadConfig, in the name of `caller` ("path"), if a world has no such class.
inline Result<void> check_class(const std::vector<AvatarClass>& classes, int32_t avatar_class,
                                const char* caller) {
  if (avatar_class >= 0 && static_cast<size_t>(avatar_class) < classes.size()) return {};
  return Error{Errc::kBadConfig, std::string(caller) + ": there is no class " +
                                     std::to_string(avatar_class) + ", the world has " +
                                     std::to_string(classes.size())};
}

}  // namespace throng
