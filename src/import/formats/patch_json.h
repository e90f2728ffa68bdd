// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

#include "import/raw/raw_scene.h"

/// Our own landscape format, patches as JSON: docs/file_format.md.
namespace throng::importer {

/// Reads patches with all their neighbours. Fails with kBadFile and the group, patch and key.
[[nodiscard]] Result<RawScene> read_patch_json(std::string_view bytes, const ReadOptions& options,
                                               Context& context);

}  // namespace throng::importer
