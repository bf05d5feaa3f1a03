// SPDX-License-Identifier: MIT
#pragma once

#include <limits>

#include "cairn/budget.h"
#include "cairn/report.h"

namespace cairn {

/// Keeps the first setting that is out of its range.
class SettingJudge {
 public:
  /// @p range says the same for people. What is not a number is outside.
  void Inside(const char* name, double value, double lo, double hi, const char* range) {
    Holds(value >= lo && value <= hi, {name, value, range});
  }
  /// @p least is 0 or 1.
  void AtLeast(const char* name, double value, int least) {
    constexpr double kMost = std::numeric_limits<double>::infinity();
    Inside(name, value, least, kMost, least == 0 ? "0 or more" : "1 or more");
  }
  template <class Enum>
  void Enumerator(const char* name, Enum value, Enum last, const char* range) {
    Inside(name, static_cast<double>(value), 0, static_cast<double>(last), range);
  }
  void Limit(const char* name, const Budget& budget) {
    const bool is_time = budget.kind() == Budget::Kind::kTime;
    AtLeast(name, static_cast<double>(is_time ? budget.time().count() : budget.work()), 0);
  }
  void Holds(bool holds, const BadSetting& otherwise) {
    if (!holds && bad_.name == nullptr) bad_ = otherwise;
  }

  const BadSetting& bad() const { return bad_; }

 private:
  BadSetting bad_;
};

}  // namespace cairn
