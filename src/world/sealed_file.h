// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "throng/base.h"

/// Files whose sum no other file knows, and that end in their own: XXH3 of all before, 8 bytes, the
/// low one first.
namespace throng::world {

[[nodiscard]] std::vector<uint8_t> sealed(std::span<const uint8_t> content);

/// What is before the sum. Fails with kBadFile and `name` if the sum is another's.
[[nodiscard]] Result<std::span<const uint8_t>> unsealed(std::span<const uint8_t> file,
                                                        const std::string& name);

}  // namespace throng::world
