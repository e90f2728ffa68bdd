// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "world/region_groups.h"

#include <gtest/gtest.h>

#include <array>
#include <bit>

#include "core/random.h"

namespace throng {
namespace {

constexpr uint32_t kClasses = 7;

// A list of the groups, as it would be without sharing and packing.
struct PlainGroups {
  struct Part {
    uint32_t avatar_class = 0, begins_in = 0, component = 0;
  };
  struct Component {
    uint32_t avatar_class = 0;
    uint64_t cells = 0;
    int32_t feet = 0;
    uint16_t tile = 0;
  };

  std::vector<std::vector<Part>> groups;
  std::vector<Component> components;
};

struct Made {
  PlainGroups plain;
  world::GroupTables tables;

  [[nodiscard]] world::RegionGroups view() const {
    return {tables.groups, tables.blocks, tables.names, tables.begun};
  }
};

// Groups whose classes begin components, or go on with some of those that there are.
Made make_groups(uint64_t seed, uint32_t count) {
  Made made;
  world::GroupWriter writer;
  for (uint32_t g = 0; g < count; ++g) {
    const auto draw = [&](uint64_t n, uint64_t end) {
      return static_cast<uint32_t>(random_below(seed, g, n, end));
    };
    const uint32_t classes = 1 + draw(0, (1u << kClasses) - 1);
    const auto feet = static_cast<int32_t>(random_u64(seed, g, 1) >> (32 + draw(2, 32)));
    const auto tile = static_cast<uint16_t>(draw(3, 65536));
    std::vector<PlainGroups::Part> parts;
    std::vector<uint32_t> begins_in;
    std::vector<uint64_t> cells;
    for (uint32_t c = 0; c < kClasses; ++c) {
      if ((classes >> c & 1) == 0) continue;
      std::vector<PlainGroups::Part> before;
      for (const auto& group : made.plain.groups) {
        for (const PlainGroups::Part& part : group) {
          if (part.avatar_class == c) before.push_back(part);
        }
      }
      PlainGroups::Part part{c, g, static_cast<uint32_t>(made.plain.components.size())};
      if (!before.empty() && draw(10 + c, 3) > 0) {
        part = before[draw(20 + c, before.size())];
      } else {
        cells.push_back(1 + (random_u64(seed, g, 30 + c) >> (24 + draw(40 + c, 40))));
        made.plain.components.push_back({c, cells.back(), feet, tile});
      }
      parts.push_back(part);
      begins_in.push_back(part.begins_in);
    }
    made.plain.groups.push_back(parts);
    writer.add({classes, begins_in, cells, feet, tile});
  }
  made.tables = writer.take();
  return made;
}

TEST(RegionGroups, NameTheComponentsOfAPlainList) {
  for (uint64_t seed = 0; seed < 20; ++seed) {
    const uint32_t count = std::array{0u, 1u, 31u, 32u, 33u, 300u}[seed % 6];
    const Made made = make_groups(seed, count);
    const world::RegionGroups groups = made.view();
    std::vector<uint32_t> begins_in;
    ASSERT_EQ(groups.fault(kClasses, begins_in), nullptr);
    EXPECT_EQ(groups.component_count(), made.plain.components.size());
    for (uint32_t g = 0; g < count; ++g) {
      for (const PlainGroups::Part& part : made.plain.groups[g]) {
        EXPECT_EQ(groups.component(g, part.avatar_class), part.component);
        EXPECT_EQ(begins_in[g * kClasses + part.avatar_class], part.begins_in);
      }
    }
  }
}

TEST(RegionGroups, GiveWhereComponentsBeginAndHowLargeTheyAre) {
  const Made made = make_groups(3, 500);
  world::BegunReader reader{made.tables.begun};
  size_t next = 0;
  for (const format::RegionGroup& group : made.tables.groups) {
    if (group.begins() != 0) {
      ASSERT_TRUE(reader.next_place());
    }
    for (uint32_t left = group.begins(); left != 0; left &= left - 1) {
      ASSERT_TRUE(reader.next_cells());
      const PlainGroups::Component& same = made.plain.components[next++];
      EXPECT_EQ(static_cast<uint32_t>(std::countr_zero(left)), same.avatar_class);
      EXPECT_EQ(static_cast<uint64_t>(reader.cells), same.cells);
      EXPECT_EQ(reader.feet, same.feet);
      EXPECT_EQ(reader.tile, same.tile);
    }
  }
  EXPECT_EQ(next, made.plain.components.size());
  EXPECT_FALSE(reader.next_place());
}

// Where all classes have the same roof, it is named once.
TEST(RegionGroups, PlacesThatClassesShareAreStoredOnce) {
  const std::vector<uint64_t> cells(6, 900);
  world::GroupWriter six, one;
  for (uint32_t g = 0; g < 320; ++g) {
    const std::vector<uint32_t> own(6, g);
    const auto tile = static_cast<uint16_t>(g / 4);
    six.add({0x3f, own, cells, 3000, tile});
    one.add({1, std::span(own).first(1), std::span(cells).first(1), 3000, tile});
  }
  const world::GroupTables a = six.take(), b = one.take();
  EXPECT_EQ(a.groups.size(), b.groups.size());
  EXPECT_TRUE(a.names.empty());
  EXPECT_EQ(a.begun.size(), b.begun.size() + 320 * 5);  // a byte a class: as many cells
}

TEST(RegionGroups, FalseOnesAreRefusedOrLeadSomewhere) {
  const Made made = make_groups(5, 100);
  size_t refused = 0, used = 0;
  for (uint64_t seed = 0; seed < 4000; ++seed) {
    world::GroupTables t = made.tables;
    const auto change = [&](auto& values) {
      auto* bytes = reinterpret_cast<uint8_t*>(values.data());
      const size_t size = values.size() * sizeof(values[0]);
      bytes[random_below(seed, 1, 0, size)] = static_cast<uint8_t>(random_u64(seed, 2, 0));
    };
    switch (random_below(seed, 0, 0, 6)) {
      case 0:
        change(t.groups);
        break;
      case 1:
        change(t.blocks);
        break;
      case 2:
        change(t.names);
        break;
      case 3:
        change(t.begun);
        break;
      case 4:
        t.names.pop_back();
        break;
      default:
        t.begun.resize(random_below(seed, 3, 0, t.begun.size()));
    }
    const world::RegionGroups groups{t.groups, t.blocks, t.names, t.begun};
    std::vector<uint32_t> begins_in;
    if (groups.fault(kClasses, begins_in) != nullptr) {
      ++refused;
      continue;
    }
    ++used;
    for (uint32_t g = 0; g < t.groups.size(); ++g) {
      for (uint32_t left = t.groups[g].classes(); left != 0; left &= left - 1) {
        const auto c = static_cast<uint32_t>(std::countr_zero(left));
        ASSERT_LT(groups.component(g, c), groups.component_count());
      }
    }
  }
  EXPECT_GT(refused, 2000u);
  EXPECT_GT(used, 200u);
}

}  // namespace
}  // namespace throng
