// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "import/raw/orient.h"

#include <array>
#include <cmath>

// A floating-point filter first; where it cannot decide, the six products of the expanded
// determinant are summed without error as a list of non-overlapping terms.
// Method: Shewchuk. Adaptive precision floating-point arithmetic and fast robust geometric
// predicates. 1997.
namespace throng::importer {
namespace {

// The exact sum of up to 12 terms: components in rising magnitude, no two overlapping.
class ExactSum {
 public:
  void add_product(double a, double b) {
    const double product = a * b;
    add(std::fma(a, b, -product));
    add(product);
  }
  [[nodiscard]] int sign() const {
    for (int i = size_; i-- > 0;) {
      if (terms_[i] != 0) return terms_[i] > 0 ? 1 : -1;
    }
    return 0;
  }

 private:
  void add(double value) {
    for (int i = 0; i < size_; ++i) {
      const double sum = value + terms_[i];
      const double shift = sum - value;
      terms_[i] = (value - (sum - shift)) + (terms_[i] - shift);
      value = sum;
    }
    terms_[size_++] = value;
  }

  std::array<double, 12> terms_{};
  int size_ = 0;
};

}  // namespace

int orient(Vec2d a, Vec2d b, Vec2d c) {
  const double left = (a.x - c.x) * (b.y - c.y);
  const double right = (a.y - c.y) * (b.x - c.x);
  const double difference = left - right;
  constexpr double kBound = 3.3306690738754716e-16;  // (3 + 16 eps) eps, eps = 2^-53
  if (std::fabs(difference) > kBound * (std::fabs(left) + std::fabs(right))) {
    return difference > 0 ? 1 : -1;
  }
  ExactSum sum;
  sum.add_product(a.x, b.y);
  sum.add_product(-a.x, c.y);
  sum.add_product(-c.x, b.y);
  sum.add_product(-a.y, b.x);
  sum.add_product(a.y, c.x);
  sum.add_product(c.y, b.x);
  return sum.sign();
}

}  // namespace throng::importer
