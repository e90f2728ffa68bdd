// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "run/avatar_group.h"

#include <charconv>

// Reads and writes groups of avatars.
namespace throng::app {

Result<std::vector<AvatarGroup>> read_groups(const std::vector<std::string>& also) {
  std::vector<AvatarGroup> groups;
  for (const std::string& group : also) {
    const size_t colon = group.rfind(':');
    uint32_t count = 0;
    const char* end = group.data() + group.size();
    const bool is_right = colon != std::string::npos && colon > 0 &&
                          std::from_chars(group.data() + colon + 1, end, count).ptr == end &&
                          count > 0;
    if (!is_right) {
      return Error{Errc::kBadConfig, "--also " + group + ": write CLASS:N, as in climber:50"};
    }
    groups.push_back({group.substr(0, colon), count});
  }
  return groups;
}

Json json_of(std::span<const AvatarGroup> groups) {
  Json json = Json::array();
  for (const AvatarGroup& group : groups) {
    json.push_back(Json::array({group.class_name, group.avatars}));
  }
  return json;
}

Result<std::vector<AvatarGroup>> groups_of(const Json& settings) {
  std::vector<AvatarGroup> groups;
  for (const Json& group : settings.value("also", Json::array())) {
    const bool is_right = group.is_array() && group.size() == 2 && group[0].is_string() &&
                          group[1].is_number_unsigned();
    if (!is_right) {
      return Error{Errc::kBadFile,
                   "the recording's settings have no usable 'also'; record the run "
                   "again with this program"};
    }
    groups.push_back({group[0], group[1]});
  }
  return groups;
}

std::string class_names(const std::string& first, std::span<const AvatarGroup> also) {
  std::string names = first;
  for (const AvatarGroup& group : also) names += ", " + group.class_name;
  return names;
}

}  // namespace throng::app
