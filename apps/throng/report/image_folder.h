// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include "throng/base.h"
#include "throng/picture.h"

/// Folders of numbered pictures, as --images writes them.
namespace throng::app {

/// Writes FOLDER/PREFIX000.png and so on, and makes the folder if it is missing. Pictures of higher
/// numbers are of an earlier run and are removed. Fails with kIo and the reason.
[[nodiscard]] Result<void> write_images(const std::string& folder, const std::string& prefix,
                                        size_t count, const std::function<Image(size_t)>& draw);

}  // namespace throng::app
