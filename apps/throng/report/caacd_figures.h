// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include "throng/papers.h"
#include "throng/picture.h"

/// [CAACD] figures 10 and 11 from a study.
namespace throng::app {

/// "Target high vs. overall": the paper's bad sets, and the mean of all sets of the study.
Chart figure_10(const caacd::Study& study, int32_t seeds);

/// "Target low": all other sets, the paper's best one bold.
Chart figure_11(const caacd::Study& study, int32_t seeds);

}  // namespace throng::app
