// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "graph/portal_list.h"

#include <gtest/gtest.h>

#include "core/random.h"

namespace throng {
namespace {

// Lines as meshes have them, on borders and middles of cells and an inset beside them, and any.
graph::NodePortal random_portal(uint64_t n) {
  const auto draw = [&](uint64_t k, uint64_t below) {
    return static_cast<uint32_t>(random_below(5, n, k, below));
  };
  graph::NodePortal portal{.a = draw(0, 1u << 31), .b = draw(1, 1u << 31), .on_a = {}, .on_b = {}};
  portal.kind = static_cast<LinkKind>(draw(2, kLinkKinds));
  portal.over_hole = draw(3, 2) != 0;
  portal.one_way = draw(4, 2) != 0;
  portal.inside = draw(5, 2) != 0;
  const bool odd = draw(6, 10) == 0;
  for (uint64_t k = 0; k < 4; ++k) {
    const auto at = [&](uint64_t key) {
      const double plain = draw(key, 129) / 128.0;
      if (odd && draw(key + 1, 3) == 0) return random_unit(6, n, key);
      const uint32_t inset = draw(key + 2, 3);
      return inset == 0   ? plain - graph::kTileInset
             : inset == 1 ? plain
                          : plain + graph::kTileInset;
    };
    portal.on_a[k] = at(10 + 10 * k);
    portal.on_b[k] = at(60 + 10 * k);
  }
  return portal;
}

void expect_same(const graph::NodePortal& got, const graph::NodePortal& want) {
  EXPECT_EQ(got.a, want.a);
  EXPECT_EQ(got.b, want.b);
  EXPECT_EQ(got.on_a, want.on_a);
  EXPECT_EQ(got.on_b, want.on_b);
  EXPECT_EQ(got.kind, want.kind);
  EXPECT_EQ(got.over_hole, want.over_hole);
  EXPECT_EQ(got.one_way, want.one_way);
  EXPECT_EQ(got.inside, want.inside);
}

TEST(PortalList, GivesBackWhatWasAddedToTheBit) {
  graph::PortalList all;
  std::vector<graph::NodePortal> plain;
  std::vector<graph::PortalList> lists;
  for (uint64_t part = 0; part < 20; ++part) {
    std::vector<graph::NodePortal> some;
    for (uint64_t n = 0; n < 500; ++n) some.push_back(random_portal(part << 20 | n));
    lists.emplace_back(some);
    plain.insert(plain.end(), some.begin(), some.end());
    if (part % 3 != 0) continue;
    all.add_all(lists);
    lists.clear();
  }
  all.add_all(lists);
  ASSERT_EQ(all.size(), plain.size());
  for (size_t p = 0; p < plain.size(); ++p) {
    expect_same(all[p], plain[p]);
    const graph::PortalSides sides = all.sides(p);
    EXPECT_EQ(sides.a, plain[p].a);
    EXPECT_EQ(sides.b, plain[p].b);
    EXPECT_EQ(sides.one_way, plain[p].one_way);
  }
  EXPECT_LT(all.bytes(), plain.size() * sizeof(graph::NodePortal) / 2);
}

}  // namespace
}  // namespace throng
