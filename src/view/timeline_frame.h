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

#include "throng/base.h"
#include "throng/crowd.h"
#include "throng/impostor.h"
#include "throng_draw/draw.h"
#include "view/curved_frame.h"

/// The avatars at one time, and the blend of two such frames.
namespace throng::view {

/// How many avatars of a scenario entered, left, or do not get on.
struct SceneFlow {
  uint64_t entered = 0, left = 0;  ///< So far.
  uint64_t outside = 0, in_links = 0, goal_unreachable = 0;
};

/// One array entry an avatar, ascending ids, positions relative to the stage's origin.
struct TimelineFrame {
  double time = 0;
  std::vector<uint64_t> ids;
  /// Differs between avatars that had the same id one after the other; empty: ids are never reused.
  std::vector<uint32_t> generations;
  std::vector<uint8_t> classes;
  std::vector<float> x, y, z;  ///< Y: once followed, of the figure, which does not hop on stairs.
  std::vector<float> heading;  ///< From +Z towards +X. [turns, 0 to 1]
  std::vector<float> walked;   ///< Since first seen. [m]
  std::vector<float> speed;    ///< Running mean. [m/s]
  std::vector<uint8_t> moves;  ///< 1: its figure walks, 0: it stands.
  /// The axis of each body from its feet; empty: all are upright. Of a body that leans, `heading`
  /// is the one before leaning (lean.h). [unit length]
  std::vector<Vec3d> ups = {};
  CrowdReport report = {};  ///< Of the step that made the frame; empty for recordings.
  std::shared_ptr<const std::vector<Prism>> obstacles = {};  ///< That are up now, or null.
  SceneFlow flow = {};                                       ///< Of scenarios.
  std::shared_ptr<const CurvedFrame> curved = {};  ///< Of avatars that [CAACD] steers, or null.
  std::string fault = {};                          ///< Why this is the last frame, or empty.

  [[nodiscard]] size_t size() const { return ids.size(); }
  void resize(size_t avatars);
  [[nodiscard]] Vec3d up(size_t i) const { return ups.empty() ? Vec3d{0, 1, 0} : ups[i]; }
  /// Index of an id, or size().
  [[nodiscard]] size_t find(uint64_t id) const;
};

/// Fills in the avatars, with positions relative to an origin.
void put_states(const std::vector<AvatarState>& states, Vec3d origin, TimelineFrame& frame);

/// Fills in `walked`, `speed` and `moves` of `now` from the frame before it, and limits the turns
/// of its headings and how fast it rises and sinks. `before` may be empty, or later: then time runs
/// backwards.
void follow(const TimelineFrame& before, TimelineFrame& now);

/// The atlases of each class, by number, at least one per class.
struct Figures {
  std::vector<std::vector<size_t>> of_class;
  std::vector<Atlas> shapes;  ///< By number of the atlas, without texels.
};

/// A crowd between two frames, as arrays grouped for drawing.
class BlendedCrowd {
 public:
  /// The avatars of `b`, interpolated at `share` between `a` (0) and `b` (1); those that are only
  /// in `b` stand still. Avatars above `cut` are not drawn.
  void blend(const TimelineFrame& a, const TimelineFrame& b, double share, const Figures& figures,
             double cut);
  [[nodiscard]] const std::vector<DrawnCrowd>& crowds() const { return crowds_; }
  /// From the next blend on, does not draw this avatar: the eye is in its head. -1: none.
  void hide(int64_t id) { hidden_ = id; }

  /// All avatars of `b` at the blended time, also those that are not drawn.
  [[nodiscard]] const TimelineFrame& now() const { return now_; }

 private:
  struct Group {
    std::vector<float> x, y, z;
    std::vector<uint16_t> heading, phase, look;
    std::vector<Vec3d> ups;
  };
  void put(size_t i, const Figures& figures);

  TimelineFrame now_;
  // By atlas, clip, and whether the avatars lean.
  std::map<std::tuple<size_t, size_t, bool>, Group> groups_;
  std::vector<DrawnCrowd> crowds_;
  int64_t hidden_ = -1;
};

}  // namespace throng::view
