// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "throng/base.h"
#include "throng/impostor.h"

namespace throng::impostor {

/// load_atlas from bytes; `name` is for messages.
[[nodiscard]] Result<Atlas> read_atlas(std::span<const uint8_t> bytes, const std::string& name);

}  // namespace throng::impostor
