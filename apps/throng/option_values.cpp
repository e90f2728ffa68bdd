// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "option_values.h"

#include <algorithm>
#include <cerrno>
#include <cstdlib>

// Checks of all options of a command at once, so that none is forgotten.
namespace throng::app {
namespace {

bool is_named(const CLI::Option& option, const std::string& word) {
  const auto has = [](const std::vector<std::string>& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  if (word.starts_with("--")) {
    return has(option.get_lnames(), word.substr(2, word.find('=') - 2));
  }
  return word.size() > 1 && word[0] == '-' && has(option.get_snames(), word.substr(1, 1));
}

// Can a word be one more value of a list of numbers?
bool begins_like_a_number(const std::string& word) {
  const size_t sign = word.find_first_not_of("+-");
  return sign != std::string::npos && sign < 2 &&
         std::string("0123456789.,").find(word[sign]) != std::string::npos;
}

bool is_nan(std::string word) {
  std::transform(word.begin(), word.end(), word.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
  return word == "nan" || word == "+nan" || word == "-nan";
}

void refuse(const CLI::Option& option, const std::string& what) {
  throw CLI::ValidationError(option.get_name(), what);
}

// Kinds of options as --help names them.
bool is_one_of(const std::vector<std::string>& kinds, const CLI::Option& option) {
  const std::string name = option.get_type_name();  // "INT:[0 to 8]": its limits come last.
  return std::find(kinds.begin(), kinds.end(), name.substr(0, name.find(':'))) != kinds.end();
}

bool is_whole_number(const CLI::Option& option) {
  return is_one_of({"INT", "UINT", "N", "S", "ID"}, option);
}

// Options with a delimiter are lists of numbers; that of words is a list of number/number/number.
bool is_numeric(const CLI::Option& option) {
  return is_whole_number(option) || is_one_of({"FLOAT", "M", "MIB", "LOW HIGH"}, option) ||
         option.get_delimiter() != '\0';
}

// Does a whole number need more than 64 bits? strtoull then returns the largest, and says so aside.
bool is_beyond_64_bits(const std::string& number, bool has_sign) {
  errno = 0;
  if (has_sign) {
    std::strtoll(number.c_str(), nullptr, 10);
  } else {
    std::strtoull(number.c_str(), nullptr, 10);
  }
  return errno == ERANGE;
}

// Drops what is before the first digit that counts: blanks, and zeros before other digits.
// Returns what is wrong, or nothing.
std::string make_base_10(std::string& number, bool whole, bool has_sign) {
  number.erase(0, std::min(number.size(), number.find_first_not_of(" \t\n\v\f\r")));
  const size_t digits = number.starts_with('-') || number.starts_with('+') ? 1 : 0;
  if (number.size() > digits + 1 && number[digits] == '0' && (number[digits + 1] | 0x20) == 'x') {
    return number + " is hexadecimal; write it with the digits 0 to 9";
  }
  size_t zeros = 0;
  while (digits + zeros + 1 < number.size() && number[digits + zeros] == '0' &&
         number[digits + zeros + 1] >= '0' && number[digits + zeros + 1] <= '9') {
    ++zeros;
  }
  number.erase(digits, zeros);
  return whole && is_beyond_64_bits(number, has_sign) ? number + " is too large" : std::string();
}

void check_list(const CLI::Option& option, const std::vector<std::string>& words) {
  const char between = option.get_delimiter();
  const std::string typed = typed_values(option, words);
  if (between == '\0' || typed.empty()) return;
  if (typed.front() == between || typed.back() == between ||
      typed.find(std::string(2, between)) != std::string::npos) {
    refuse(option, typed + " leaves out a value; write " + option.get_type_name());
  }
}

}  // namespace

std::string typed_values(const CLI::Option& option, const std::vector<std::string>& words) {
  std::vector<std::string> values;
  for (size_t i = 0; i < words.size(); ++i) {
    if (!is_named(option, words[i])) continue;
    const size_t after = words[i].starts_with("--") ? words[i].find('=') : std::string::npos;
    if (after != std::string::npos) {
      values.push_back(words[i].substr(after + 1));
    } else if (!words[i].starts_with("--") && words[i].size() > 2) {
      values.push_back(words[i].substr(2));
    } else if (i + 1 < words.size()) {
      values.push_back(words[++i]);
    }
    while (i + 1 < words.size() && begins_like_a_number(words[i + 1])) values.push_back(words[++i]);
  }
  const char between = option.get_delimiter();
  return CLI::detail::join(values, std::string(1, between != '\0' ? between : ' '));
}

void read_base_10(CLI::App& command) {
  for (CLI::Option* option : command.get_options()) {
    if (!is_numeric(*option)) continue;
    const bool whole = is_whole_number(*option);
    const bool has_sign = is_one_of({"INT", "ID"}, *option);
    // Before all checks of the option, which then see what will be read.
    option->transform(CLI::Validator(
        [whole, has_sign](std::string& number) { return make_base_10(number, whole, has_sign); },
        ""));
  }
}

void check_values(const CLI::App& command, const std::vector<std::string>& words) {
  for (const CLI::Option* option : command.get_options()) {
    if (option->count() == 0) continue;
    const bool counts = option->get_type_name().starts_with("UINT");
    for (const std::string& given : option->results()) {
      if (given.empty()) refuse(*option, "its value is empty; give one, or leave the option out");
      if (!option->get_positional() && is_nan(given)) {
        refuse(*option, given + " is not a finite number");
      }
      if (counts && given.front() == '-') refuse(*option, given + " is below 0");
    }
    check_list(*option, words);
  }
}

}  // namespace throng::app
