// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "throng/picture.h"

namespace throng::test {

/// Tolerances against the golden picture: exact on one machine's llvmpipe; the vector instructions
/// of others may round a pixel differently.
struct ImageLimits {
  double mean = 0.2;         ///< Of the differences of colour values, of 255.
  double far_share = 0.002;  ///< Of values that differ by more than 32.
};

/// Expects a picture within tolerances of the PNG; THRONG_WRITE_GOLDEN writes the PNG first.
void expect_golden(const Image& image, const std::string& golden, const ImageLimits& limits = {});

}  // namespace throng::test
