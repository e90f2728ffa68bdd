// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "golden_image.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <cstdlib>
#include <memory>

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wunused-function"
#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#define STBI_ONLY_PNG
#include <stb/stb_image.h>
#pragma GCC diagnostic pop

// Compares pixel values one by one.
namespace throng::test {

void expect_golden(const Image& image, const std::string& golden, const ImageLimits& limits) {
  if (std::getenv("THRONG_WRITE_GOLDEN") != nullptr) {
    ASSERT_TRUE(write_png(image, golden));
  }
  int width = 0, height = 0, channels = 0;
  const std::unique_ptr<stbi_uc, decltype(&stbi_image_free)> expected(
      stbi_load(golden.c_str(), &width, &height, &channels, 3), stbi_image_free);
  ASSERT_NE(expected, nullptr) << golden;
  ASSERT_EQ(width, image.width);
  ASSERT_EQ(height, image.height);
  int64_t off = 0, far_off = 0;
  for (size_t i = 0; i < image.rgb.size(); ++i) {
    const int32_t difference = std::abs(image.rgb[i] - expected.get()[i]);
    off += difference;
    far_off += difference > 32 ? 1 : 0;
  }
  const auto values = static_cast<double>(image.rgb.size());
  EXPECT_LT(static_cast<double>(off), limits.mean * values) << golden;
  EXPECT_LT(static_cast<double>(far_off), limits.far_share * values) << golden;
}

}  // namespace throng::test
