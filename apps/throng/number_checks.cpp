// SPDX-FileCopyrightText: 2026 the throng authors
// SPDX-License-Identifier: MIT
#include "number_checks.h"

#include <fmt/format.h>

#include <cmath>
#include <string>

// Validators of numeric options. CLI11's own accept NaN.
namespace throng::app {
namespace {

// `wrong` returns the fault of a number, or nothing.
template <class Wrong>
CLI::Validator validator(const std::string& range, Wrong wrong) {
  return {[wrong](std::string& given) -> std::string {
            if (given.empty()) return "its value is empty";
            double number = 0;
            if (!CLI::detail::lexical_cast(given, number)) return given + " is no number";
            if (!std::isfinite(number)) return given + " is not a finite number";
            const std::string what = wrong(number);
            return what.empty() ? what : given + " is " + what;
          },
          range};
}

}  // namespace

CLI::Validator at_least(double min) {
  return validator(fmt::format("[{} or more]", min), [min](double number) {
    return number < min ? fmt::format("below {}", min) : std::string();
  });
}

CLI::Validator above(double bound) {
  return validator(fmt::format("[above {}]", bound), [bound](double number) {
    return number <= bound ? fmt::format("not above {}", bound) : std::string();
  });
}

CLI::Validator between(double min, double max) {
  return validator(fmt::format("[{} to {}]", min, max), [min, max](double number) {
    if (number < min) return fmt::format("below {}", min);
    return number > max ? fmt::format("above {}", max) : std::string();
  });
}

}  // namespace throng::app
