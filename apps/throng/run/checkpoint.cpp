// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "run/checkpoint.h"

#include <fmt/format.h>

#include <cstring>
#include <string_view>

#include "input_file.h"
#include "output_file.h"

// A checkpoint is a line of JSON, the numbers of goals as they are in memory, and a saved crowd.
namespace throng::app {
namespace {

constexpr int kVersion = 1;

uint64_t sum_of(const std::vector<uint64_t>& values) {
  uint64_t sum = 14695981039346656037u;
  for (const uint64_t value : values) sum = (sum ^ value) * 1099511628211u;
  return sum;
}

std::string_view bytes_of(const auto& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(values[0])};
}

}  // namespace

Result<void> write_checkpoint(const std::string& path, const Checkpoint& checkpoint) {
  const Json head = {{"throng_checkpoint", kVersion},      {"step", checkpoint.step},
                     {"settings", checkpoint.settings},    {"world", checkpoint.world},
                     {"avatars", checkpoint.given.size()}, {"sum", sum_of(checkpoint.given)},
                     {"bytes", checkpoint.crowd.size()}};
  OutputFile file;
  if (auto ok = file.open(path); !ok) return ok;
  file.write(head.dump() + "\n");
  file.write(bytes_of(checkpoint.given));
  file.write(bytes_of(checkpoint.crowd));
  return file.finish();
}

Result<Checkpoint> read_checkpoint(const std::string& path) {
  auto text = read_file(path, "name a file that throng run --checkpoint has written");
  if (!text) return text.error();
  const auto bad = [&](const std::string& what) {
    return Error{Errc::kBadFile, path + ": " + what};
  };
  const size_t line = text->find('\n');
  const Json head = line == std::string::npos
                        ? Json()
                        : Json::parse(text->substr(0, line), nullptr, /*allow_exceptions=*/false);
  const auto is_number = [&](const char* name) {
    return head.contains(name) && head[name].is_number_unsigned();
  };
  if (!head.is_object() || !is_number("throng_checkpoint")) {
    return bad("is no checkpoint; name a file that throng run --checkpoint has written");
  }
  if (head["throng_checkpoint"] != kVersion) {
    return bad("is a checkpoint of another version; go on with the program that wrote it");
  }
  for (const char* name : {"step", "world", "avatars", "sum", "bytes"}) {
    if (!is_number(name)) return bad("is corrupt; start the run again");
  }
  if (!head.contains("settings") || !head["settings"].is_object()) {
    return bad("is corrupt; start the run again");
  }
  const size_t behind = text->size() - line - 1;
  const auto avatars = head["avatars"].get<uint64_t>(), bytes = head["bytes"].get<uint64_t>();
  if (avatars > behind / 8 || bytes != behind - 8 * avatars) {
    return bad("is cut short; start the run again");
  }
  Checkpoint checkpoint{.step = head["step"].get<uint64_t>(),
                        .settings = head["settings"],
                        .world = head["world"].get<uint64_t>(),
                        .given = std::vector<uint64_t>(avatars),
                        .crowd = std::vector<uint8_t>(bytes)};
  const char* at = text->data() + line + 1;
  if (avatars > 0) std::memcpy(checkpoint.given.data(), at, 8 * avatars);
  if (bytes > 0) std::memcpy(checkpoint.crowd.data(), at + 8 * avatars, bytes);
  if (sum_of(checkpoint.given) != head["sum"].get<uint64_t>()) {
    return bad("is corrupt; start the run again");
  }
  return checkpoint;
}

Result<void> check_settings(const Checkpoint& checkpoint, const std::string& path, uint64_t world,
                            const Json& settings) {
  if (checkpoint.world != world) {
    return Error{Errc::kBadConfig,
                 path + ": is of another world; give the one that it was made with"};
  }
  for (const auto& [name, value] : settings.items()) {
    if (checkpoint.settings.contains(name) && checkpoint.settings[name] == value) continue;
    return Error{
        Errc::kBadConfig,
        fmt::format("{}: was made with another setting of {}: {}, not {}; give the options "
                    "of the run that wrote it",
                    path, name, checkpoint.settings.value(name, Json("none")).dump(),
                    value.dump())};
  }
  return {};
}

}  // namespace throng::app
