// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "path/edits/edit_list.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "core/access.h"
#include "path/edits/saved_edits.h"

// What a list of edits remembers of its calls, and a list as bytes.
namespace throng {
namespace {

using path::EditList;

const EditList& list_of(const Edits& edits) { return *Access::state(edits); }
EditList& list_of(Edits& edits) { return *Access::state(edits); }

Prism box_at(double x) { return Prism::box({x, 0, 1}, {x + 1, 2, 2}); }

// One of each kind, of which some are off, moved or gone.
Edits all_kinds() {
  Edits edits;
  const std::vector<Vec3d> corners{{1, 0, 1}, {2, 0, 1}, {2, 1, 1}};
  const std::vector<std::array<uint32_t, 3>> triangles{{0, 1, 2}, {2, 1, 0}};
  const auto crate = edits.add_obstacle(box_at(1)),
             cart = edits.add_obstacle(Prism::circle({5, 0, 5}, 0.5, 1), ObstacleKind::kKinematic,
                                       ObstaclePolicy::kWait),
             sheet = edits.add_obstacle(corners, triangles), area = edits.add_area(box_at(3), 5),
             link = edits.add_off_mesh_link({{{1, 2, 3}, 1}, {{4, 5, 6}, 2}, 0.5, false}),
             gone = edits.add_obstacle(box_at(7));
  EXPECT_TRUE(crate && cart && sheet && area && link && gone);
  EXPECT_TRUE(edits.set_active(*crate, false) && edits.remove(*gone));
  EXPECT_TRUE(edits.move_obstacle(*cart, box_at(9)));
  EXPECT_TRUE(edits.set_area_cost(5, 3) && edits.set_area_cost(63, INFINITY));
  return edits;
}

TEST(EditList, CostsCountForKindsOfTheBakeAndForActiveAreas) {
  Edits edits;
  const EditList& list = list_of(edits);
  constexpr uint64_t kFive = uint64_t{1} << 5, kLast = uint64_t{1} << 63;
  EXPECT_FALSE(list.has_costs(~uint64_t{0}));
  EXPECT_TRUE(edits.set_area_cost(5, 2));
  EXPECT_TRUE(list.has_costs(kFive | kLast));
  EXPECT_FALSE(list.has_costs(kLast));
  EXPECT_FALSE(list.has_costs(EditList::kNoKinds));
  EXPECT_TRUE(edits.set_area_cost(63, INFINITY) && edits.set_area_cost(5, 1));
  EXPECT_TRUE(list.has_costs(kLast));
  EXPECT_FALSE(list.has_costs(kFive));
  EXPECT_TRUE(list.may_shorten_paths(kLast) && list.bears_on_ground(kLast));
  EXPECT_FALSE(list.may_shorten_paths(kFive) || list.bears_on_ground(kFive));
  const auto area = edits.add_area(box_at(1), 63);
  ASSERT_TRUE(area);
  EXPECT_TRUE(list.has_costs(EditList::kNoKinds));
  EXPECT_TRUE(edits.set_active(*area, false));
  EXPECT_FALSE(list.has_costs(EditList::kNoKinds));
}

TEST(EditList, RemembersCallsInTheirOrderWithThePlacesOfThatTime) {
  const Edits edits = all_kinds();
  std::vector<EditList::Call> calls;
  std::vector<EditId> ids;
  std::vector<double> places;
  list_of(edits).for_changed(0, [&](const EditList::Changed& what) {
    calls.push_back(what.call);
    ids.push_back(what.edit);
    if (what.place != nullptr) places.push_back(what.place->corners[0][0]);
  });
  using Call = EditList::Call;
  EXPECT_EQ(calls, (std::vector{Call::kAdd, Call::kAdd, Call::kAdd, Call::kAdd, Call::kAdd,
                                Call::kAdd, Call::kSwitchOff, Call::kRemove, Call::kMove,
                                Call::kSetCost, Call::kSetCost}));
  EXPECT_EQ(ids, (std::vector<EditId>{1, 2, 3, 4, 5, 6, 1, 6, 2, 0, 0}));
  ASSERT_EQ(places.size(), 6u);
  EXPECT_EQ(places[0], 1);
  EXPECT_GT(places[1], 5) << "before it was moved";
  EXPECT_NEAR(places[2], 1, 0.01);
  EXPECT_EQ(places[3], 7) << "before it was removed";
  EXPECT_EQ(places[4], 1);
  EXPECT_EQ(places[5], 9);
}

TEST(EditList, ForgetsTheOlderHalfOfManyCalls) {
  Edits edits;
  const auto door = edits.add_obstacle(box_at(1));
  ASSERT_TRUE(door);
  bool active = true;
  for (int n = 0; n < 100000; ++n) {
    const uint64_t before = edits.version();
    active = !active;
    ASSERT_TRUE(edits.set_active(*door, active));
    ASSERT_EQ(edits.version(), before + 1);
    ASSERT_TRUE(list_of(edits).knows_calls_since(before));
    if (before > 2000) {
      ASSERT_TRUE(list_of(edits).knows_calls_since(before - 2000));
    }
    ASSERT_LT(list_of(edits).changed.size(), 5000u);
  }
  EXPECT_FALSE(list_of(edits).knows_calls_since(0));
}

TEST(EditList, ComesBackFromItsBytesWithTheCallsThatWereAskedFor) {
  const Edits edits = all_kinds();
  const std::vector<uint8_t> saved = path::save_edits(list_of(edits));
  const uint64_t version = edits.version();
  for (uint64_t since = 0; since <= version; ++since) {
    const std::vector<uint8_t> calls = path::save_calls(list_of(edits), since);
    auto restored = path::restore_edits(saved, calls);
    ASSERT_TRUE(restored) << since;
    EXPECT_EQ(path::save_edits(*restored), saved);
    EXPECT_EQ(path::save_calls(*restored, since), calls);
    EXPECT_EQ(restored->version(), version);
    EXPECT_EQ(restored->first_version, since);
    EXPECT_EQ(restored->active_solids, list_of(edits).active_solids);
    EXPECT_EQ(restored->active_areas, 1u);
    EXPECT_EQ(restored->active_links, 1u);
    EXPECT_TRUE(restored->has_costs(EditList::kNoKinds));
    // It goes on as the list itself does.
    Edits other = all_kinds(), again;
    list_of(again) = *std::move(restored);
    EXPECT_EQ(*other.add_obstacle(box_at(2)), *again.add_obstacle(box_at(2)));
    EXPECT_TRUE(again.set_active(1, true) && other.set_active(1, true));
    EXPECT_EQ(path::save_edits(list_of(again)), path::save_edits(list_of(other)));
  }
  EXPECT_EQ(path::save_edits({}), path::save_edits(*path::restore_edits(path::save_edits({}), {})));
}

TEST(EditList, BytesThatAreNoListAreRefused) {
  const Edits edits = all_kinds();
  const std::vector<uint8_t> saved = path::save_edits(list_of(edits)),
                             calls = path::save_calls(list_of(edits), 3);
  for (size_t size = 0; size < saved.size(); ++size) {
    EXPECT_FALSE(path::restore_edits(std::span(saved).first(size), calls)) << size;
  }
  std::vector<uint8_t> longer = saved;
  longer.push_back(0);
  EXPECT_FALSE(path::restore_edits(longer, calls));
  uint64_t accepted = 0, refused = 0;
  // The bytes of the list, then those of the calls, with one bit of them changed.
  std::vector<uint8_t> all = saved;
  all.insert(all.end(), calls.begin(), calls.end());
  for (size_t bit = 0; bit < all.size() * 8; ++bit) {
    all[bit / 8] ^= static_cast<uint8_t>(1 << bit % 8);
    const std::span<const uint8_t> bytes(all);
    const auto restored =
        path::restore_edits(bytes.first(saved.size()), bytes.subspan(saved.size()));
    // What is accepted is a list: it can be saved and restored again.
    if (restored) {
      EXPECT_TRUE(path::restore_edits(path::save_edits(*restored),
                                      path::save_calls(*restored, restored->first_version)));
    }
    ++(restored ? accepted : refused);
    all[bit / 8] ^= static_cast<uint8_t>(1 << bit % 8);
  }
  EXPECT_GT(accepted, 1000u) << "a corner that moved a little";
  EXPECT_GT(refused, 1000u);
}

}  // namespace
}  // namespace throng
