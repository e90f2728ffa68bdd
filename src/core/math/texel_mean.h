// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace throng {

/// Mean of texels, red, green, blue and opacity, 8 bits each. Colours are as they are shown; their
/// squares are (nearly) the light, which is what is averaged, each as much as it covers.
class TexelMean {
 public:
  void add(const uint8_t* texel, double share) {
    const double alpha = texel[3] * share;
    for (size_t c = 0; c < 3; ++c) {
      const double light = static_cast<double>(texel[c]) * texel[c];
      light_[c] += light * alpha;
      plain_[c] += light * share;
    }
    cover_ += alpha;
    weight_ += share;
  }
  /// Where all is transparent its colours count all the same.
  void write(uint8_t* texel) const {
    for (size_t c = 0; c < 3; ++c) {
      const double mean = cover_ > 0 ? light_[c] / cover_ : plain_[c] / weight_;
      texel[c] = static_cast<uint8_t>(std::min(std::sqrt(mean) + 0.5, 255.0));
    }
    texel[3] = static_cast<uint8_t>(std::min(cover_ / weight_ + 0.5, 255.0));
  }

 private:
  double light_[3] = {}, plain_[3] = {}, cover_ = 0, weight_ = 0;
};

}  // namespace throng
