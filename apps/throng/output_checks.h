// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <CLI/CLI.hpp>
#include <vector>

#include "command.h"

/// Keeps commands from writing over what they read. The options of `outputs` name files to write.
namespace throng::app {

/// Refuses an output that is a folder or a device, a file that another option of the command reads
/// or writes, or part of a baked world. Nothing is opened. Throws CLI::ValidationError, which names
/// the option.
void check_outputs(const CLI::App& command, const std::vector<const CLI::Option*>& outputs);

/// Refuses a folder of pictures that is a file or part of a baked world, and one of whose pictures
/// another option of the command reads or writes. Throws CLI::ValidationError, as above.
void check_image_folders(const CLI::App& command, const std::vector<ImageFolder>& folders,
                         const std::vector<const CLI::Option*>& outputs);

}  // namespace throng::app
