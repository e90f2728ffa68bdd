// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "view/timeline_source.h"

#include <algorithm>
#include <utility>

namespace throng {

MomentFeed::MomentFeed(std::unique_ptr<MomentSource> source) : source_(std::move(source)) {
  task_.emplace([this] { run(); });
}

MomentFeed::~MomentFeed() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  wake_.notify_all();
  task_.reset();
}

// Two moments around what is shown, and one more so that the next is there in time.
bool MomentFeed::wants_more() const {
  if (ended_) return false;
  if (made_.size() < 2) return made_.empty() || made_.back()->time <= wanted_;
  return made_[made_.size() - 2]->time <= wanted_;
}

void MomentFeed::run() {
  std::unique_lock lock(mutex_);
  while (true) {
    wake_.wait(lock, [&] { return stopping_ || seeking_ || !posted_.empty() || wants_more(); });
    if (stopping_) return;
    working_ = true;
    if (!posted_.empty()) {
      const Posted posted = std::move(posted_.front());
      posted_.pop_front();
      lock.unlock();
      posted.work(*source_);
      std::shared_ptr<const TimelineFrame> again = posted.at_once ? source_->again() : nullptr;
      lock.lock();
      if (again) made_.assign(1, std::move(again));
    } else if (seeking_) {
      const double time = seek_to_;
      seeking_ = false;
      lock.unlock();
      std::shared_ptr<const TimelineFrame> first = source_->seek(time);
      lock.lock();
      if (first && !seeking_) {
        made_.clear();
        made_.push_back(std::move(first));
        ended_ = false;
      }
    } else {
      lock.unlock();
      std::shared_ptr<const TimelineFrame> next = source_->next();
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
    SideTask::breathe();
    lock.lock();
  }
}

MomentPair MomentFeed::at(double time) {
  MomentPair pair;
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

void MomentFeed::seek(double time) {
  {
    const std::lock_guard lock(mutex_);
    seeking_ = true;
    seek_to_ = time;
    wanted_ = time;
  }
  wake_.notify_all();
}

void MomentFeed::post(std::function<void(MomentSource&)> work, bool at_once) {
  {
    const std::lock_guard lock(mutex_);
    posted_.push_back({std::move(work), at_once});
    ended_ = false;
  }
  wake_.notify_all();
}

void MomentFeed::finish_posted() {
  std::unique_lock lock(mutex_);
  idle_.wait_for(*task_, lock, [&] { return posted_.empty() && !working_; });
}

void MomentFeed::finish() {
  std::unique_lock lock(mutex_);
  idle_.wait_for(*task_, lock,
                 [&] { return posted_.empty() && !working_ && !seeking_ && !wants_more(); });
}

void MomentFeed::wait_for(double time) {
  std::unique_lock lock(mutex_);
  wanted_ = time;
  wake_.notify_all();
  idle_.wait_for(*task_, lock, [&] {
    return !seeking_ && (ended_ || (!made_.empty() && made_.back()->time > time));
  });
}

double MomentFeed::latest() const {
  const std::lock_guard lock(mutex_);
  return made_.empty() ? 0 : made_.back()->time;
}

}  // namespace throng
