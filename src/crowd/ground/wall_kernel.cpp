// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "crowd/ground/wall_kernel.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "crowd/ground/wall_kernel.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
#include <hwy/highway.h>

// How far each direction of a fan leads over free squares. A lane for each direction: all advance
// by half a square at a time. Walls are as thick as bodies, since squares are free where a body's
// centre may be, so none is stepped over. In integers, hence the same for every vector width.
// Linear in the directions and in the half squares of the range.
HWY_BEFORE_NAMESPACE();
namespace throng::crowd {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using DI = hn::CappedTag<int32_t, 16>;
using DF = hn::RebindToFloat<DI>;
using VI = hn::Vec<DI>;

// Rows of the window by number.
class Rows {
 public:
  HWY_INLINE explicit Rows(const WallWindow& window) : rows_(window.rows.data()) {}
  HWY_INLINE VI at(VI index) const {
    const DI d;
    const auto* rows = reinterpret_cast<const int32_t*>(rows_);
#if HWY_TARGET <= HWY_AVX3 && HWY_ARCH_X86
    // All fit two vectors: two permutations, where a gather takes a load for each lane.
    const auto low = hn::IndicesFromVec(d, hn::And(index, hn::Set(d, 15)));
    return hn::IfThenElse(hn::Gt(index, hn::Set(d, 15)),
                          hn::TableLookupLanes(hn::Load(d, rows + 16), low),
                          hn::TableLookupLanes(hn::Load(d, rows), low));
#else
    return hn::GatherIndex(d, rows, index);
#endif
  }

 private:
  const uint32_t* rows_;
};

void FindFreeDistances(const WallWindow& window, const steer::Fan& fan, float query_range,
                       FreeDistances& distances) {
  const DI d;
  const DF df;
  constexpr size_t kMax = 32;  // directions, up to a whole vector
  alignas(64) std::array<steer::Plane, kMax> directions{};
  std::copy(fan.begin(), fan.end(), directions.begin());
  alignas(64) std::array<float, kMax> found;
  const auto spacing = static_cast<float>(window.spacing());
  const auto steps = static_cast<int32_t>(std::ceil(query_range / spacing));
  const Rows rows(window);
  const VI one = hn::Set(d, 1);
  for (size_t n = 0; n < fan.size(); n += hn::Lanes(d)) {
    hn::Vec<DF> dx, dz;
    hn::LoadInterleaved2(df, &directions[n].x, dx, dz);
    const VI by_x = hn::NearestInt(hn::Mul(dx, hn::Set(df, spacing)));
    const VI by_z = hn::NearestInt(hn::Mul(dz, hn::Set(df, spacing)));
    VI x = hn::Set(d, window.x), z = hn::Set(d, window.z);
    VI free = one, count = hn::Zero(d);
    for (int32_t k = 0; k < steps; ++k) {
      x = hn::Add(x, by_x);
      z = hn::Add(z, by_z);
      const VI row = rows.at(hn::ShiftRightSame(z, window.shift));
      const VI column = hn::ShiftRightSame(x, window.shift);
      const hn::RebindToUnsigned<DI> du;
      free = hn::And(free, hn::BitCast(d, hn::Shr(hn::BitCast(du, row), hn::BitCast(du, column))));
      count = hn::Add(count, free);
    }
    const auto distance = hn::Mul(hn::ConvertTo(df, count), hn::Set(df, spacing));
    hn::Store(hn::Min(distance, hn::Set(df, query_range)), df, &found[n]);
  }
  std::copy_n(found.begin(), distances.size(), distances.begin());
}

}  // namespace HWY_NAMESPACE
}  // namespace throng::crowd
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace throng::crowd {

HWY_EXPORT(FindFreeDistances);

void find_free_distances(const WallWindow& window, const steer::Fan& fan, float query_range,
                         FreeDistances& distances) {
  HWY_DYNAMIC_DISPATCH(FindFreeDistances)(window, fan, query_range, distances);
}

}  // namespace throng::crowd
#endif
