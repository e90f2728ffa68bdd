// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include <cctype>
#include <string>
#include <utility>

#include "throng/impostor.h"

// Finds the body part of a material, and a clip, by their names.
namespace throng {
namespace {

std::string lower(std::string_view text) {
  std::string out(text);
  for (char& c : out) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return out;
}

// The last word of a clip's name: what follows the last sign that is neither letter nor digit.
std::string_view last_word(std::string_view name) {
  size_t begin = name.size();
  while (begin > 0 && std::isalnum(static_cast<unsigned char>(name[begin - 1])) != 0) --begin;
  return name.substr(begin);
}

}  // namespace

BodyPart body_part_of(std::string_view material) {
  // A word that holds another stands before it; the first that is found decides.
  static constexpr std::pair<std::string_view, BodyPart> kWords[] = {
      {"hair", BodyPart::kHair},     {"beard", BodyPart::kHair},  {"brow", BodyPart::kHair},
      {"shoe", BodyPart::kShoes},    {"boot", BodyPart::kShoes},  {"sock", BodyPart::kShoes},
      {"sole", BodyPart::kShoes},    {"pant", BodyPart::kPants},  {"jean", BodyPart::kPants},
      {"trouser", BodyPart::kPants}, {"skirt", BodyPart::kPants}, {"shorts", BodyPart::kPants},
      {"shirt", BodyPart::kShirt},   {"suit", BodyPart::kShirt},  {"jacket", BodyPart::kShirt},
      {"dress", BodyPart::kShirt},   {"coat", BodyPart::kShirt},  {"top", BodyPart::kShirt},
      {"skin", BodyPart::kSkin},     {"face", BodyPart::kSkin},
  };
  const std::string name = lower(material);
  for (const auto& [word, part] : kWords) {
    if (name.find(word) != std::string::npos) return part;
  }
  return BodyPart::kOther;
}

const char* word_for(BodyPart part) {
  static constexpr const char* kWords[] = {"other", "skin", "hair", "shirt", "pants", "shoes"};
  return kWords[static_cast<size_t>(part)];
}

Result<size_t> find_clip(const Character& character, std::string_view word) {
  const std::string wanted = lower(word);
  std::string names;
  for (size_t i = 0; i < character.clips.size(); ++i) {
    const std::string name = lower(character.clips[i].name);
    if (name == wanted) return i;
    names += (i == 0 ? "" : ", ") + character.clips[i].name;
  }
  for (size_t i = 0; i < character.clips.size(); ++i) {
    const std::string name = lower(character.clips[i].name);
    if (last_word(name) == wanted) return i;
  }
  return Error{Errc::kNotFound, "no clip " + std::string(word) + "; this character has " +
                                    (names.empty() ? std::string("none") : names)};
}

}  // namespace throng
