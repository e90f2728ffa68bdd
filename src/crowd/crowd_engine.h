// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/huge_array.h"
#include "crowd/body.h"
#include "crowd/neighbour_grid.h"
#include "crowd/step_units.h"
#include "crowd/stride_ground.h"
#include "steer/sampled.h"

/// The step of a crowd with goals as passes over arrays: sort, sense and steer, commit in rounds,
/// settle. test/support/plain_crowd.h is the same, as plainly as it can be written.
namespace throng {

struct EngineConfig {
  StepUnits units;
  float sight = 5;  ///< [m]
  int32_t rounds = 3;
  bool patient = true;
  uint64_t seed = 1;
  int32_t workers = 0;
  steer::SampledSettings steering;
  steer::Patience patience;
};

struct EngineCounts {
  std::atomic<uint64_t> contested{0};  // could touch somebody
  std::atomic<uint64_t> free_ways{0};  // had an open wish and nobody in reach
  std::atomic<uint64_t> stood{0};      // found no place to go, or stay by choice
  std::atomic<uint64_t> arrived{0};    // in this step
  std::atomic<int64_t> progress{0};    // sum of the speeds towards aims by those wished, millionths
};

class CrowdEngine {
 public:
  /// Grounds by class; a world of width x depth cells. Bodies may not be wider than `widest` units
  /// nor faster than `fastest`.
  CrowdEngine(const EngineConfig& config, std::vector<StrideGround> grounds, int32_t width,
              int32_t depth, int32_t widest, float fastest);

  /// Makes room for so many. Bodies stay.
  void reserve(size_t bodies);
  [[nodiscard]] std::span<Body> bodies() const { return {bodies_.data(), size_}; }
  void add(const Body& body);
  /// Takes the last ones away.
  void shrink(size_t size) { size_ = size; }

  struct Times {
    double sort = 0, steer = 0, commit = 0, settle = 0;  // [s]
  };
  /// One step. `step`: its number, for the order of claims.
  void step(uint64_t step, EngineCounts& counts, Times& times);
  [[nodiscard]] uint64_t bytes() const;

  /// Heights of two bodies' feet between which, and of what they can rise in a step, they could
  /// touch. [mm]
  static constexpr int32_t kMostRise = 900;

 private:
  // Somebody who could touch others: whom, and where he would go, the best first.
  struct Contest {
    uint32_t body;
    uint32_t first, last;  // of `others`
    uint32_t ways;
    struct Way {
      int32_t x, z;
    };
    std::array<Way, steer::kChoices + 3> way;
  };
  struct Worker {
    std::vector<float> squares;
    std::vector<uint32_t> entries;
    std::vector<uint32_t> others;
    std::vector<Contest> contests;
  };

  void wish_all();
  void decide_all(EngineCounts& counts);
  void decide(uint32_t i, Worker& worker, const NeighbourGrid::Around& around,
              EngineCounts& counts);
  void commit(uint64_t step);
  void settle_all(EngineCounts& counts);
  void name(const Contest& contest, const Worker& worker, uint8_t round);
  [[nodiscard]] bool holds(const Contest& contest, const Worker& worker, uint8_t round,
                           uint64_t step) const;
  template <class Do>
  void for_contests(Do act);
  bool try_place(const Body& body, int32_t x, int32_t z, Body& place) const;

  EngineConfig config_;
  std::vector<StrideGround> grounds_;
  int32_t width_, depth_;
  int32_t widest_, longest_, sight_;
  size_t size_ = 0;
  HugeArray<Body> bodies_;
  HugeArray<Body> spare_;  // while sorting: where from; then: where to
  std::optional<NeighbourGrid> grid_;
  std::vector<Worker> workers_;
};

}  // namespace throng
