// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "crowd/walk/ghost_codec.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <vector>

#include "core/random.h"

// Ghosts come over as they were, whatever changes; other bytes are refused and crash nothing.
namespace throng::crowd {
namespace {

constexpr StepUnits kUnits{.unit = 0.1f / 2048, .dt = 0.1f};

class Numbers {
 public:
  explicit Numbers(uint64_t seed) : seed_(seed) {}
  uint64_t operator()(uint64_t below) { return random_u64(seed_, 1, n_++) % below; }

 private:
  uint64_t seed_, n_ = 0;
};

Ghost ghost(uint32_t name, Numbers& numbers) {
  Ghost made;
  made.body.slot = name;
  made.body.x = static_cast<int32_t>(numbers(1 << 30));
  made.body.z = static_cast<int32_t>(numbers(1 << 30));
  made.body.y = static_cast<int32_t>(numbers(100000)) - 50000;
  made.body.level = static_cast<uint32_t>(numbers(1000));
  made.body.velocity = {1.1f, -0.3f};
  made.progress.after = 12.5f;
  return made;
}

// As a step moves it: on as it was, another move, none; sometimes all of it differs.
void step(Ghost& of, Numbers& numbers) {
  const uint64_t what = numbers(8);
  if (what == 0) {
    of = ghost(of.body.slot, numbers);
    return;
  }
  int32_t x = kUnits.displacement(of.body.velocity.x), z = kUnits.displacement(of.body.velocity.z);
  if (what == 1) x = z = 0;
  if (what == 2) x += static_cast<int32_t>(numbers(200)) - 100;
  of.body.x += x;
  of.body.z += z;
  const bool moved = x != 0 || z != 0;
  of.body.velocity = {moved ? kUnits.velocity(x) : 0, moved ? kUnits.velocity(z) : 0};
  if (what == 3) of.body.steps = static_cast<uint8_t>(numbers(3)) & 31;
  if (what == 4) of.body.asks = !of.body.asks;
}

void expect_same(const std::vector<Ghost>& a, const std::vector<Ghost>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (size_t n = 0; n < a.size(); ++n) {
    EXPECT_EQ(std::memcmp(&a[n].body, &b[n].body, sizeof a[n].body), 0) << n;
    EXPECT_EQ(std::memcmp(&a[n].progress, &b[n].progress, sizeof a[n].progress), 0) << n;
    EXPECT_EQ(std::memcmp(&a[n].request, &b[n].request, sizeof a[n].request), 0) << n;
    EXPECT_EQ(a[n].level_speed, b[n].level_speed) << n;
  }
}

TEST(GhostCodec, GhostsComeOverAsTheyWere) {
  for (uint64_t seed = 1; seed <= 20; ++seed) {
    Numbers numbers(seed);
    GhostCodec here, there;
    std::vector<Ghost> ghosts;
    for (int n = 0; n < 60; ++n) {
      // Some come, some go.
      std::erase_if(ghosts, [&](const Ghost&) { return numbers(10) == 0; });
      for (Ghost& one : ghosts) step(one, numbers);
      for (uint64_t more = numbers(6); more > 0; --more) {
        const auto name = static_cast<uint32_t>(numbers(seed % 2 == 0 ? 100 : 4000000000u));
        const bool is_known = std::any_of(ghosts.begin(), ghosts.end(),
                                          [&](const Ghost& one) { return one.body.slot == name; });
        if (!is_known) ghosts.push_back(ghost(name, numbers));
      }
      std::sort(ghosts.begin(), ghosts.end(),
                [](const Ghost& a, const Ghost& b) { return a.body.slot < b.body.slot; });
      std::vector<uint8_t> bytes;
      here.encode(ghosts, kUnits, bytes);
      std::vector<Ghost> came;
      size_t at = 0;
      ASSERT_TRUE(there.decode(bytes, at, kUnits, came));
      EXPECT_EQ(at, bytes.size());
      expect_same(came, ghosts);
    }
  }
}

TEST(GhostCodec, ThatWhichMovesOnTakesThreeBytes) {
  Numbers numbers(1);
  GhostCodec here;
  std::vector<Ghost> ghosts;
  for (uint32_t name = 0; name < 500; ++name) {
    ghosts.push_back(ghost(60 * name, numbers));
    Body& body = ghosts.back().body;
    body.velocity = {kUnits.velocity(2222), kUnits.velocity(-111)};
  }
  std::vector<uint8_t> bytes;
  here.encode(ghosts, kUnits, bytes);
  for (Ghost& one : ghosts) {
    one.body.x += 2222;
    one.body.z -= 111;
  }
  bytes.clear();
  here.encode(ghosts, kUnits, bytes);
  EXPECT_LT(bytes.size(), 3 * ghosts.size());
}

TEST(GhostCodec, MovesAndNamesComeOverToThoseThatSeeThem) {
  Numbers numbers(2);
  std::vector<Ghost> shown;
  std::vector<GhostMove> moves, expected;
  std::vector<uint32_t> names, expected_names;
  for (uint32_t name = 7; name < 5000; name += 1 + static_cast<uint32_t>(numbers(90))) {
    const Ghost one = ghost(name, numbers);
    const bool is_shown = numbers(3) != 0;
    if (is_shown) shown.push_back(one);
    const GhostMove move{.name = name,
                         .round = static_cast<uint32_t>(numbers(4)),
                         .place = {one.body.x + 40, one.body.z - 3, one.body.y + 2,
                                   numbers(5) == 0 ? 3u : one.body.level}};
    moves.push_back(move);
    names.push_back(name);
    if (is_shown) expected.push_back(move);
    if (is_shown) expected_names.push_back(name);
  }
  std::vector<uint8_t> bytes;
  encode_moves(moves, shown, bytes);
  std::vector<GhostMove> came;
  ASSERT_TRUE(decode_moves(bytes, shown, came));
  ASSERT_EQ(came.size(), expected.size());
  for (size_t n = 0; n < came.size(); ++n) {
    EXPECT_EQ(std::memcmp(&came[n], &expected[n], sizeof came[n]), 0) << n;
  }
  bytes.clear();
  encode_names(names, shown, bytes);
  std::vector<uint32_t> came_names;
  ASSERT_TRUE(decode_names(bytes, came_names));
  EXPECT_EQ(came_names, expected_names);
}

TEST(GhostCodec, OtherBytesAreRefusedOrHarmless) {
  Numbers numbers(3);
  uint64_t refused = 0;
  for (int n = 0; n < 20000; ++n) {
    std::vector<Ghost> ghosts;
    for (uint32_t name = 0; name < 20; ++name) ghosts.push_back(ghost(3 * name, numbers));
    GhostCodec here, there;
    std::vector<uint8_t> bytes;
    here.encode(ghosts, kUnits, bytes);
    if (numbers(2) == 0) bytes.resize(numbers(bytes.size()));
    for (uint64_t hits = numbers(4); hits > 0 && !bytes.empty(); --hits) {
      bytes[numbers(bytes.size())] ^= static_cast<uint8_t>(1u << numbers(8));
    }
    std::vector<Ghost> came;
    size_t at = 0;
    refused += there.decode(bytes, at, kUnits, came) ? 0 : 1;
    std::vector<GhostMove> moves;
    (void)decode_moves(bytes, ghosts, moves);
    std::vector<uint32_t> names;
    (void)decode_names(bytes, names);
  }
  EXPECT_GT(refused, 9000u);
}

}  // namespace
}  // namespace throng::crowd
