// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "view/timeline_source.h"

#include <algorithm>
#include <utility>

// One producer (the player's task) and one consumer (the window) around a short queue of frames.
namespace throng::view {

TimelineSource::TimelineSource(std::unique_ptr<TimelinePlayer> player)
    : player_(std::move(player)) {
  task_.emplace([this] { run(); });
}

TimelineSource::~TimelineSource() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  wake_.notify_all();
  task_.reset();
}

// The two frames around the time shown, and one more, made ahead.
bool TimelineSource::wants_more() const {
  if (ended_) return false;
  if (made_.size() < 2) return made_.empty() || made_.back()->time <= wanted_;
  return made_[made_.size() - 2]->time <= wanted_;
}

void TimelineSource::run() {
  std::unique_lock lock(mutex_);
  while (true) {
    wake_.wait(lock, [&] { return stopping_ || seeking_ || !posted_.empty() || wants_more(); });
    if (stopping_) return;
    working_ = true;
    if (!posted_.empty()) {
      const Posted posted = std::move(posted_.front());
      posted_.pop_front();
      lock.unlock();
      posted.work(*player_);
      std::shared_ptr<const TimelineFrame> again = posted.at_once ? player_->again() : nullptr;
      lock.lock();
      if (again) made_.assign(1, std::move(again));
    } else if (seeking_) {
      const double time = seek_to_;
      seeking_ = false;
      lock.unlock();
      std::shared_ptr<const TimelineFrame> first = player_->seek(time);
      lock.lock();
      if (first && !seeking_) {
        made_.clear();
        made_.push_back(std::move(first));
        ended_ = false;
      }
    } else {
      lock.unlock();
      std::shared_ptr<const TimelineFrame> next = player_->next();
      lock.lock();
      if (next) {
        made_.push_back(std::move(next));
      } else {
        ended_ = true;
      }
      while (made_.size() > 2 && made_[1]->time <= wanted_) made_.pop_front();
    }
    working_ = false;
    idle_.notify_all();
    lock.unlock();
    SideTask::pause_if_due();
    lock.lock();
  }
}

FramePair TimelineSource::at(double time) {
  FramePair pair;
  {
    const std::lock_guard lock(mutex_);
    wanted_ = time;
    if (made_.empty()) {
      wake_.notify_all();
      return pair;
    }
    size_t i = 0;
    while (i + 2 < made_.size() && made_[i + 1]->time <= time) ++i;
    pair.a = made_[i];
    pair.b = made_[std::min(i + 1, made_.size() - 1)];
  }
  wake_.notify_all();
  const double between = pair.b->time - pair.a->time;
  pair.share = between > 0 ? std::clamp((time - pair.a->time) / between, 0.0, 1.0) : 1;
  return pair;
}

void TimelineSource::seek(double time) {
  {
    const std::lock_guard lock(mutex_);
    seeking_ = true;
    seek_to_ = time;
    wanted_ = time;
  }
  wake_.notify_all();
}

void TimelineSource::post(std::function<void(TimelinePlayer&)> work, bool at_once) {
  {
    const std::lock_guard lock(mutex_);
    posted_.push_back({std::move(work), at_once});
    ended_ = false;
  }
  wake_.notify_all();
}

void TimelineSource::finish_posted() {
  std::unique_lock lock(mutex_);
  idle_.wait_for(*task_, lock, [&] { return posted_.empty() && !working_; });
}

void TimelineSource::finish() {
  std::unique_lock lock(mutex_);
  idle_.wait_for(*task_, lock,
                 [&] { return posted_.empty() && !working_ && !seeking_ && !wants_more(); });
}

void TimelineSource::wait_for(double time) {
  std::unique_lock lock(mutex_);
  wanted_ = time;
  wake_.notify_all();
  idle_.wait_for(*task_, lock, [&] {
    return !seeking_ && (ended_ || (!made_.empty() && made_.back()->time > time));
  });
}

double TimelineSource::latest() const {
  const std::lock_guard lock(mutex_);
  return made_.empty() ? 0 : made_.back()->time;
}

}  // namespace throng::view
