// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "command.h"
#include "throng/crowd.h"
#include "throng/papers.h"

/// Words on the command line for settings of [CAACD].
namespace throng::app {

/// "2.0/0.4/0.06". Fails with kBadConfig.
[[nodiscard]] Result<caacd::ParameterSet> parse_set(const std::string& text);

/// "time" or "state". Fails with kBadConfig.
[[nodiscard]] Result<caacd::Order> parse_order(const std::string& word);

/// "side" or "side-and-up"; "ours" is that of other models. Fails with kBadConfig.
[[nodiscard]] Result<FlyerAxes> parse_axes(const std::string& word);
[[nodiscard]] const char* word_for(FlyerAxes axes);

/// From a step on, another set for all avatars, or for one.
struct SetChange {
  uint64_t step = 0;               ///< It is made when so many steps are done.
  std::optional<uint32_t> avatar;  ///< Its slot; none: all.
  caacd::ParameterSet set;
};
/// "100:1.0/0.8/0.06" for all, "100:17:1.0/0.8/0.06" for avatar 17. Fails with kBadConfig.
[[nodiscard]] Result<SetChange> parse_set_change(const std::string& text);

/// Words of the model caacd for a crowd, as an option gives them; empty: not given.
struct CurveWords {
  std::string set, order, axes;
};
/// Adds --set, --order and --axes.
void add_curve_options(CLI::App& command, CurveWords& words);
/// Fills them in. Fails with kBadConfig: a bad word, or one beside another model.
[[nodiscard]] Result<void> read_curves(const CurveWords& words, SteeringModel model,
                                       CrowdTuning& tuning);

}  // namespace throng::app
