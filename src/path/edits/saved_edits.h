// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "path/edits/edit_list.h"

/// A list of edits as bytes, in this machine's byte order.
namespace throng::path {

/// All that a list holds, but not the calls that made it. Equal lists give equal bytes.
[[nodiscard]] std::vector<uint8_t> save_edits(const EditList& list);
/// The calls that changed a list since a version; none if they are forgotten.
[[nodiscard]] std::vector<uint8_t> save_calls(const EditList& list, uint64_t since);

/// The list of these bytes, which knows these calls and none before. None if they are not what
/// save_edits and save_calls give.
[[nodiscard]] std::optional<EditList> restore_edits(std::span<const uint8_t> edits,
                                                    std::span<const uint8_t> calls);

}  // namespace throng::path
