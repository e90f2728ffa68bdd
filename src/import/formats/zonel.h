// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string_view>

#include "import/raw/raw_scene.h"

/// Zones of a Bezier landscape (.zonel), the kind of world that [PACS00] was made for.
namespace throng::importer {

/// Reads one zone (version 3 to 5): its patches, with their neighbours in the same zone, and in
/// RawScene::zone the edges and corners to other zones. The node is the zone's name, "3_AC". Fails
/// with kBadFile and the place.
[[nodiscard]] Result<RawScene> read_zonel(std::string_view bytes, const ReadOptions& options,
                                          Context& context);

/// Binds the edges between zones that were read together, zones[i].first_patch being where each
/// begins. Edges towards a zone that is not here stay open; the report's warnings count them. Fails
/// with kBadInput if a zone is given twice, or if two zones contradict each other.
[[nodiscard]] Result<void> join_zones(PatchSet& set, std::span<PatchZone> zones,
                                      SceneReport& report);

/// "3_AC" for 514: row 3, column AC.
[[nodiscard]] std::string zone_name(uint16_t id);

}  // namespace throng::importer
