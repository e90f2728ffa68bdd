// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

#include "throng/crowd.h"
#include "throng/impostor.h"
#include "throng/prism.h"
#include "throng_draw/draw.h"

/// Where everybody is at one time, and what lies between two of these.
namespace throng {

/// How many came and left, and who does not get on.
struct SceneFlow {
  uint64_t entered = 0, left = 0;  ///< So far.
  uint64_t outside = 0, in_links = 0, goal_unreachable = 0;
};

/// One array entry an avatar, ascending ids, positions relative to the stage's origin.
struct TimelineFrame {
  double time = 0;
  std::vector<uint64_t> ids;
  /// Who has an id that was another's tells so by another number; empty: no id is given twice.
  std::vector<uint32_t> lives;
  std::vector<uint8_t> classes;
  std::vector<float> x, y, z;
  std::vector<float> heading;  ///< From +Z towards +X. [turns, 0 to 1]
  std::vector<float> walked;   ///< Since first seen. [m]
  std::vector<float> pace;     ///< Mean speed of late. [m/s]
  /// Along each body from its feet; nothing: all are upright. Of who leans, `heading` is the one
  /// before he leans (lean.h). [unit length]
  std::vector<Vec3d> ups = {};
  CrowdReport report = {};  ///< Of the step that led here; empty for recordings.
  std::shared_ptr<const std::vector<Prism>> obstacles = {};  ///< That are up now, or none.
  SceneFlow flow = {};                                       ///< Of scenarios.
  std::string fault = {};                                    ///< Why no more can come, or empty.

  [[nodiscard]] size_t size() const { return ids.size(); }
  void resize(size_t avatars);
  [[nodiscard]] Vec3d up(size_t i) const { return ups.empty() ? Vec3d{0, 1, 0} : ups[i]; }
  /// Index of an id, or size().
  [[nodiscard]] size_t find(uint64_t id) const;
};

/// Fills in who is where, relative to an origin.
void put_states(const std::vector<AvatarState>& states, Vec3d origin, TimelineFrame& moment);

/// Fills in `walked` and `pace` of `now` from the moment before it and softens its headings: a
/// figure turns, it does not flip. `before` may be empty, or later: then time runs backwards.
void follow(const TimelineFrame& before, TimelineFrame& now);

/// Which pictures serve which class: atlases by number, at least one a class.
struct Figures {
  std::vector<std::vector<size_t>> of_class;
  std::vector<Atlas> shapes;  ///< By number of the atlas, without texels.
};

/// Arrays of a crowd between two moments, grouped as they are drawn.
class BlendedCrowd {
 public:
  /// Everybody of `b`, where he is at `share` of the way from `a`; who is only in `b` stands there.
  /// Who stands above `cut` is left out.
  void blend(const TimelineFrame& a, const TimelineFrame& b, double share, const Figures& figures,
             double cut);
  [[nodiscard]] const std::vector<DrawnCrowd>& crowds() const { return crowds_; }
  /// Leaves out one avatar from the next blend on: through whose eyes one looks. -1: nobody.
  void hide(int64_t id) { hidden_ = id; }

  /// All of `b` at that time, also those that are not drawn.
  [[nodiscard]] const TimelineFrame& now() const { return now_; }

 private:
  struct Group {
    std::vector<float> x, y, z;
    std::vector<uint16_t> heading, phase, look;
    std::vector<Vec3d> ups;
  };
  void put(size_t i, const Figures& figures);

  TimelineFrame now_;
  // By atlas and clip, those who lean apart from the others.
  std::map<std::tuple<size_t, size_t, bool>, Group> groups_;
  std::vector<DrawnCrowd> crowds_;
  int64_t hidden_ = -1;
};

}  // namespace throng
