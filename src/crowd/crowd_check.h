// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "crowd/avatars.h"
#include "throng/wanderers.h"
#include "throng/world.h"

/// A look at a crowd that shares nothing with the step: exact distances, the world's own look-ups.
namespace throng {

CrowdCheck check_avatars(const World& world, int32_t avatar_class, std::span<const Avatar> avatars,
                         int32_t workers);

}  // namespace throng
