// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "throng/picture.h"

namespace throng::test {

/// How far a picture may be from the golden one: on one machine's llvmpipe it is exact, others'
/// vector instructions may round a pixel otherwise.
struct ImageLimits {
  double mean = 0.2;         ///< Of the differences of colour values, of 255.
  double far_share = 0.002;  ///< Of values that differ by more than 32.
};

/// Fails where a picture does not look like the PNG; with THRONG_WRITE_GOLDEN that is written
/// first.
void expect_golden(const Image& image, const std::string& golden, const ImageLimits& limits = {});

}  // namespace throng::test
