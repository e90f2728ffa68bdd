// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>
#include <vector>

#include "render/storey_raster.h"
#include "throng/base.h"
#include "throng/picture.h"

/// The whole picture: title, plans, fan, section, legend, laid out as a poster.
namespace throng::render {

struct PosterText {
  std::string title;
  std::vector<std::string> lines;  ///< Under the title, each in one line.
};

/// Draws a world that is not empty. Fails with kBadConfig or kNotFound, like draw_world.
[[nodiscard]] Result<Image> draw_poster(const PictureWorld& world, const PosterText& text,
                                        std::span<const PictureAvatar> avatars,
                                        const PictureConfig& config);

}  // namespace throng::render
