// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "throng/scene.h"

/// Hints that a model was read in another unit, or with another axis up, than it was made with.
namespace throng::app {

/// "60.0 x 40.0 m, 7.4 m high".
[[nodiscard]] std::string size_text(const Box3d& bounds);

/// Sentences, each with the option to check; none for a model that looks right. A hint can be
/// wrong, as for a lone wall: the model is read as it is. Linear in the triangles.
[[nodiscard]] std::vector<std::string> scene_hints(const Scene& scene);

}  // namespace throng::app
