// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "record/frame_codec.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "record/bit_stream.h"

// A frame holds the removed avatars, the added ones, and for each other avatar the differences of
// position and heading from a constant move in a constant direction. Differences are Golomb-Rice
// codes [Ric79] whose parameter follows the last differences of the same avatar and field, so that
// an avatar that stands costs a bit a number. One large difference is likely to stay the only one,
// so the parameter grows slowly. After a turn the expected move has the new direction. If the run
// may lean, the changed axes follow; an added avatar starts upright. Time: linear in the avatars.
namespace throng::record {
namespace {

constexpr double kMaxCoordinate = 2e6;  // from the origin [m]: millimetres fit 32 bits
constexpr double kMaxDiameter = 65.0;   // [m]: millimetres fit 16 bits
constexpr uint32_t kMinBits = 13;       // of an added avatar
constexpr size_t kUpMean = 4;           // Index in Track::mean of the axis' two means.

// Differences wrap, so that no bytes can overflow anything.
int32_t minus(int32_t a, int32_t b) {
  return static_cast<int32_t>(static_cast<uint32_t>(a) - static_cast<uint32_t>(b));
}
int32_t plus(int32_t a, int32_t b) {
  return static_cast<int32_t>(static_cast<uint32_t>(a) + static_cast<uint32_t>(b));
}

// The Rice parameter for numbers of this mean (in 1/16): the logarithm of 0.69 times it.
uint32_t rice_parameter(uint16_t mean) {
  const uint32_t scaled = mean * 11u >> 8;
  return scaled == 0 ? 0 : static_cast<uint32_t>(std::bit_width(scaled)) - 1;
}

void follow(uint16_t& mean, uint32_t value) {
  const uint32_t limit = std::min(mean * 2u + 32, 64000u);
  const auto now = static_cast<int32_t>(std::min(std::min(value, 4000u) * 16, limit));
  mean = static_cast<uint16_t>(mean + (now - mean) / 4);
}

// Turns the expected move into the new direction.
void expect_turned(Track& track, int32_t turn) {
  const double x = track.by[0], z = track.by[2];
  const double size = std::sqrt(x * x + z * z);
  if (std::abs(turn) < 2 || !(size < 1e6)) return;
  const Heading heading = heading_of(track.heading);
  track.by[0] = static_cast<int32_t>(std::floor(heading.x * size + 0.5));
  track.by[2] = static_cast<int32_t>(std::floor(heading.z * size + 0.5));
}

int32_t expected(const Track& track, size_t axis) { return plus(track.at[axis], track.by[axis]); }

void move_to(Track& track, size_t axis, int32_t value) {
  track.by[axis] = minus(value, track.at[axis]);
  track.at[axis] = value;
}

Error bad_avatar(uint64_t id, const char* what) {
  return {Errc::kBadInput, "recording: avatar " + std::to_string(id) + " " + what};
}

}  // namespace

uint8_t heading_code(Heading heading) {
  const double x = heading.x, z = heading.z;
  const double size = std::fabs(x) + std::fabs(z);
  if (!(size > 0 && size < 1e30)) return 64;  // no direction: along z
  // Around a square instead of a circle: no sine, the same bytes everywhere.
  double turn = 0;
  if (x >= 0 && z >= 0) turn = z / size;
  if (x < 0 && z >= 0) turn = 1 - x / size;
  if (x < 0 && z < 0) turn = 2 - z / size;
  if (x >= 0 && z < 0) turn = 3 + x / size;
  return static_cast<uint8_t>(static_cast<int32_t>(turn * 64 + 0.5) & 255);
}

Heading heading_of(uint8_t code) {
  const double part = (code & 63) / 64.0;
  const double size = std::sqrt((1 - part) * (1 - part) + part * part);
  const auto a = static_cast<float>((1 - part) / size), b = static_cast<float>(part / size);
  switch (code >> 6) {
    case 0:
      return {a, b};
    case 1:
      return {-b, a};
    case 2:
      return {-a, -b};
    default:
      return {b, -a};
  }
}

UpCode up_code(Vec3d up) {
  const double size = std::fabs(up.x) + std::fabs(up.y) + std::fabs(up.z);
  double x = up.x / size, z = up.z / size;
  if (up.y < 0) {  // The lower faces are folded out.
    const double folded = 1 - std::fabs(z);
    z = std::copysign(1 - std::fabs(x), z);
    x = std::copysign(folded, x);
  }
  const auto code = [](double v) { return static_cast<int16_t>(std::floor(v * kUpSteps + 0.5)); };
  return {code(x), code(z)};
}

Vec3d up_of(UpCode code) {
  double x = static_cast<double>(code[0]) / kUpSteps, z = static_cast<double>(code[1]) / kUpSteps;
  const double y = 1 - std::fabs(x) - std::fabs(z);
  if (y < 0) {
    const double folded = 1 - std::fabs(z);
    z = std::copysign(1 - std::fabs(x), z);
    x = std::copysign(folded, x);
  }
  const double size = std::sqrt(x * x + y * y + z * z);
  return {x / size, y / size, z / size};
}

// Fills wanted_ with the frame as tracks in order of id.
Result<void> FrameEncoder::quantise(const FrameView& frame) {
  const size_t count = frame.ids.size();
  if (frame.classes.size() != count || frame.positions.size() != count ||
      frame.radii.size() != count || frame.headings.size() != count || count >= kMaxAvatars) {
    return Error{Errc::kBadInput,
                 "recording: a frame needs as many classes, positions, radii and headings as ids, "
                 "fewer than 2^28"};
  }
  if (!frame.up_vectors.empty() && frame.up_vectors.size() != count) {
    return Error{Errc::kBadInput, "recording: a frame needs as many axes as ids, or none"};
  }
  order_.resize(count);
  std::iota(order_.begin(), order_.end(), 0u);
  if (!std::is_sorted(frame.ids.begin(), frame.ids.end())) {
    std::sort(order_.begin(), order_.end(),
              [&](uint32_t a, uint32_t b) { return frame.ids[a] < frame.ids[b]; });
  }
  wanted_.resize(count);
  for (size_t k = 0; k < count; ++k) {
    const uint32_t i = order_[k];
    Track& track = wanted_[k];
    track.id = frame.ids[i];
    if (k > 0 && wanted_[k - 1].id == track.id) return bad_avatar(track.id, "is there twice");
    if (track.id == UINT64_MAX) return bad_avatar(track.id, "has a number too large");
    const Vec3d p = frame.positions[i] - origin_;
    const double metres[3] = {p.x, p.y, p.z};
    for (size_t axis = 0; axis < 3; ++axis) {
      if (!(std::fabs(metres[axis]) < kMaxCoordinate)) {
        return bad_avatar(track.id,
                          "is nowhere, or farther than 2000 km from the recording's origin; set "
                          "RecordingInfo::origin");
      }
      track.at[axis] = static_cast<int32_t>(std::floor(metres[axis] * 1000 + 0.5));
    }
    const double radius = frame.radii[i];
    if (!(radius >= 0 && radius <= kMaxDiameter)) {
      return bad_avatar(track.id, "has no radius between 0 and 65 m");
    }
    track.radius = static_cast<uint16_t>(radius * 1000 + 0.5);
    track.avatar_class = frame.classes[i];
    track.heading = heading_code(frame.headings[i]);
    track.up = {};
    if (!frame.up_vectors.empty()) {
      const Vec3d& up = frame.up_vectors[i];
      const double size = length(up);
      if (!(size > 1e-100 && size < 1e100)) return bad_avatar(track.id, "has no axis");
      track.up = up_code(up);
      if (!leans_ && track.up != UpCode{}) {
        return bad_avatar(track.id, "leans; set RecordingInfo::leans");
      }
    }
    track.by = {};
    track.mean = {};
  }
  return {};
}

Result<void> FrameEncoder::encode(const FrameView& frame, std::vector<uint8_t>& bytes) {
  if (auto ok = quantise(frame); !ok) return ok;
  // The removed (indices in tracks_) and the added (indices in wanted_). A changed body is both.
  removed_.clear();
  added_.clear();
  for (size_t a = 0, b = 0; a < tracks_.size() || b < wanted_.size();) {
    const bool is_removed =
        b == wanted_.size() || (a < tracks_.size() && tracks_[a].id < wanted_[b].id);
    const bool is_new =
        a == tracks_.size() || (b < wanted_.size() && wanted_[b].id < tracks_[a].id);
    const bool same = !is_removed && !is_new && tracks_[a].radius == wanted_[b].radius &&
                      tracks_[a].avatar_class == wanted_[b].avatar_class;
    if (!same && !is_new) removed_.push_back(static_cast<uint32_t>(a));
    if (!same && !is_removed) added_.push_back(static_cast<uint32_t>(b));
    a += is_new ? 0 : 1;
    b += is_removed ? 0 : 1;
  }

  BitWriter out(bytes);
  out.put_gamma(removed_.size());
  uint32_t next = 0;
  for (const uint32_t place : removed_) {
    out.put_gamma(place - next);
    next = place + 1;
  }
  out.put_gamma(added_.size());
  Track last;
  uint64_t next_id = 0;
  for (const uint32_t place : added_) {
    const Track& track = wanted_[place];
    out.put_gamma(track.id - next_id);
    next_id = track.id + 1;
    const bool alike = track.avatar_class == last.avatar_class && track.radius == last.radius;
    out.put(alike ? 0 : 1, 1);
    if (!alike) {
      out.put(track.avatar_class, 8);
      out.put(track.radius, 16);
    }
    for (size_t axis = 0; axis < 3; ++axis) {
      out.put_gamma(zigzag(minus(track.at[axis], last.at[axis])));
    }
    out.put(track.heading, 8);
    last = track;
  }

  // All others, in order of id; next_ becomes the decoder's tracks.
  size_t next_removed = 0, next_added = 0;
  next_.resize(wanted_.size());
  for (size_t a = 0, b = 0; b < wanted_.size(); ++b) {
    if (next_added < added_.size() && added_[next_added] == b) {
      ++next_added;
      next_[b] = wanted_[b];
      next_[b].up = {};
      continue;
    }
    while (next_removed < removed_.size() && removed_[next_removed] == a) {
      ++next_removed;
      ++a;
    }
    Track& track = next_[b] = tracks_[a++];
    const auto put = [&](size_t field, int32_t difference) {
      const uint32_t value = zigzag(difference);
      out.put_rice(value, rice_parameter(track.mean[field]));
      follow(track.mean[field], value);
    };
    const auto turn = static_cast<int8_t>(wanted_[b].heading - track.heading);
    put(3, turn);
    track.heading = wanted_[b].heading;
    expect_turned(track, turn);
    for (size_t axis = 0; axis < 3; ++axis) {
      put(axis, minus(wanted_[b].at[axis], expected(track, axis)));
      move_to(track, axis, wanted_[b].at[axis]);
    }
  }
  if (leans_) {
    uint64_t turned = 0;
    for (size_t b = 0; b < next_.size(); ++b) turned += next_[b].up != wanted_[b].up ? 1 : 0;
    out.put_gamma(turned);
    for (size_t b = 0, after = 0; b < next_.size(); ++b) {
      Track& track = next_[b];
      if (track.up == wanted_[b].up) continue;
      out.put_gamma(b - after);
      after = b + 1;
      for (size_t k = 0; k < track.up.size(); ++k) {
        const uint32_t value = zigzag(wanted_[b].up[k] - track.up[k]);
        out.put_rice(value, rice_parameter(track.mean[kUpMean + k]));
        follow(track.mean[kUpMean + k], value);
      }
      track.up = wanted_[b].up;
    }
  }
  out.align();
  tracks_.swap(next_);
  return {};
}

bool FrameDecoder::decode(std::span<const uint8_t> bytes, uint32_t avatars) {
  BitReader in(bytes);
  const uint64_t removed = in.get_gamma();
  if (!in.ok() || removed > tracks_.size()) return false;
  // The tracks that stay, without gaps.
  kept_.clear();
  uint64_t next = 0;
  for (uint64_t r = 0; r < removed; ++r) {
    const uint64_t skipped = in.get_gamma();
    if (!in.ok() || skipped >= tracks_.size() - next) return false;
    kept_.insert(kept_.end(), tracks_.begin() + static_cast<ptrdiff_t>(next),
                 tracks_.begin() + static_cast<ptrdiff_t>(next + skipped));
    next += skipped + 1;
  }
  kept_.insert(kept_.end(), tracks_.begin() + static_cast<ptrdiff_t>(next), tracks_.end());

  const uint64_t added = in.get_gamma();
  if (!in.ok() || added > in.left() / kMinBits || kept_.size() + added != avatars) return false;
  added_.clear();
  Track last;
  uint64_t next_id = 0;
  for (uint64_t k = 0; k < added; ++k) {
    Track track;
    track.id = next_id + in.get_gamma();
    if (!in.ok() || track.id < next_id || track.id == UINT64_MAX) return false;
    next_id = track.id + 1;
    track.avatar_class = last.avatar_class;
    track.radius = last.radius;
    if (in.get(1) != 0) {
      track.avatar_class = static_cast<uint8_t>(in.get(8));
      track.radius = static_cast<uint16_t>(in.get(16));
    }
    for (size_t axis = 0; axis < 3; ++axis) {
      const uint64_t value = in.get_gamma();
      track.at[axis] = plus(last.at[axis], unzigzag(static_cast<uint32_t>(value)));
    }
    track.heading = static_cast<uint8_t>(in.get(8));
    added_.push_back(track);
    last = track;
  }
  if (!in.ok() || kept_.size() > in.left() / 4) return false;

  tracks_.clear();
  size_t a = 0, b = 0;
  while (a < kept_.size() || b < added_.size()) {
    const bool is_new = a == kept_.size() || (b < added_.size() && added_[b].id < kept_[a].id);
    if (!is_new && b < added_.size() && added_[b].id == kept_[a].id) return false;
    if (is_new) {
      tracks_.push_back(added_[b++]);
      continue;
    }
    Track track = kept_[a++];
    const auto get = [&](size_t field) {
      const uint32_t value = in.get_rice(rice_parameter(track.mean[field]));
      follow(track.mean[field], value);
      return unzigzag(value);
    };
    const auto turn = static_cast<int8_t>(get(3));
    track.heading = static_cast<uint8_t>(track.heading + turn);
    expect_turned(track, turn);
    for (size_t axis = 0; axis < 3; ++axis) {
      move_to(track, axis, plus(expected(track, axis), get(axis)));
    }
    tracks_.push_back(track);
  }
  if (!leans_) return in.ok();
  const uint64_t turned = in.get_gamma();
  if (!in.ok() || turned > tracks_.size()) return false;
  uint64_t after = 0;
  for (uint64_t n = 0; n < turned; ++n) {
    const uint64_t skipped = in.get_gamma();
    if (!in.ok() || skipped >= tracks_.size() - after) return false;
    Track& track = tracks_[after + skipped];
    after += skipped + 1;
    for (size_t k = 0; k < track.up.size(); ++k) {
      const uint32_t value = in.get_rice(rice_parameter(track.mean[kUpMean + k]));
      follow(track.mean[kUpMean + k], value);
      const int32_t code = plus(track.up[k], unzigzag(value));
      if (code < -kUpSteps || code > kUpSteps) return false;
      track.up[k] = static_cast<int16_t>(code);
    }
  }
  return in.ok();
}

}  // namespace throng::record
