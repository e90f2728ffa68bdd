// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <barrier>
#include <cstdint>
#include <functional>
#include <memory>
#include <numeric>
#include <span>
#include <thread>
#include <vector>

#include "core/rank_group.h"

/// Ranks as threads of one process.
namespace throng::test {

class ThreadRanks {
 public:
  explicit ThreadRanks(int32_t size)
      : size_(size),
        together_(size),
        boxes_(static_cast<size_t>(size) * static_cast<size_t>(size)) {}

  /// Calls body(rank) on all of them.
  void run(const std::function<void(RankGroup&)>& body) {
    std::vector<std::thread> threads;
    for (int32_t rank = 0; rank < size_; ++rank) {
      threads.emplace_back([this, &body, rank] {
        Rank group(*this, rank);
        body(group);
      });
    }
    for (std::thread& thread : threads) thread.join();
  }

 private:
  class Rank final : public RankGroup {
   public:
    Rank(ThreadRanks& all, int32_t rank) : all_(all), rank_(rank) {}
    [[nodiscard]] int32_t rank() const override { return rank_; }
    [[nodiscard]] int32_t size() const override { return all_.size_; }

    std::span<const Bytes> gather(std::span<const uint8_t> mine) override {
      box(rank_, rank_).assign(mine.begin(), mine.end());
      all_.together_.arrive_and_wait();
      came_.clear();
      for (int32_t rank = 0; rank < all_.size_; ++rank) came_.push_back(box(rank, rank));
      all_.together_.arrive_and_wait();
      return came_;
    }
    std::span<const Bytes> exchange(std::span<const int32_t> ranks,
                                    std::span<const Bytes> to) override {
      for (size_t n = 0; n < ranks.size(); ++n) box(rank_, ranks[n]) = to[n];
      all_.together_.arrive_and_wait();
      came_.clear();
      for (const int32_t rank : ranks) came_.push_back(std::move(box(rank, rank_)));
      all_.together_.arrive_and_wait();
      return came_;
    }
    // Stripes across the plane, slanted so that borders cross all that is built along the axes.
    std::vector<int32_t> divide(std::span<const Weight> points) override {
      std::vector<size_t> order(points.size());
      std::iota(order.begin(), order.end(), size_t{0});
      const auto along = [&](size_t n) { return points[n].x + 0.5 * points[n].z; };
      std::stable_sort(order.begin(), order.end(),
                       [&](size_t a, size_t b) { return along(a) < along(b); });
      double whole = 0, sum = 0;
      for (const Weight& point : points) whole += point.weight;
      std::vector<int32_t> parts(points.size());
      for (const size_t n : order) {
        parts[n] = std::min(static_cast<int32_t>(sum / whole * all_.size_), all_.size_ - 1);
        sum += points[n].weight;
      }
      return parts;
    }

   private:
    Bytes& box(int32_t from, int32_t to) {
      return all_.boxes_[static_cast<size_t>(from) * static_cast<size_t>(all_.size_) +
                         static_cast<size_t>(to)];
    }
    ThreadRanks& all_;
    int32_t rank_;
    std::vector<Bytes> came_;
  };

  int32_t size_;
  std::barrier<> together_;
  std::vector<RankGroup::Bytes> boxes_;  // from each to each
};

}  // namespace throng::test
