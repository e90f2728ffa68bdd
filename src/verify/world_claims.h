// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "verify/claims.h"

namespace throng::verify {

/// What a world says of one class, by its public look-ups alone. The world must outlive them. Fails
/// with kBadConfig (no such class).
[[nodiscard]] Result<Claims> claims_of(const World& world, int32_t avatar_class);

}  // namespace throng::verify
