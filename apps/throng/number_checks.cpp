// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "number_checks.h"

#include <fmt/format.h>

#include <cmath>
#include <string>

namespace throng::app {
namespace {

// `wrong` says what is wrong with a number, or nothing.
template <class Wrong>
CLI::Validator validator(const std::string& range, Wrong wrong) {
  return {[wrong](std::string& given) -> std::string {
            double number = 0;
            if (!CLI::detail::lexical_cast(given, number)) return given + " is no number";
            if (!std::isfinite(number)) return given + " is not a finite number";
            const std::string what = wrong(number);
            return what.empty() ? what : given + " is " + what;
          },
          range};
}

}  // namespace

CLI::Validator at_least(double least) {
  return validator(fmt::format("[{} or more]", least), [least](double number) {
    return number < least ? fmt::format("below {}", least) : std::string();
  });
}

CLI::Validator above(double bound) {
  return validator(fmt::format("[above {}]", bound), [bound](double number) {
    return number <= bound ? fmt::format("not above {}", bound) : std::string();
  });
}

CLI::Validator between(double least, double most) {
  return validator(fmt::format("[{} to {}]", least, most), [least, most](double number) {
    if (number < least) return fmt::format("below {}", least);
    return number > most ? fmt::format("above {}", most) : std::string();
  });
}

}  // namespace throng::app
