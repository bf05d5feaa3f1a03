// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>

#include "runtime/crew.h"

namespace cairn {

/// One stage of units that are all alike.
template <class Function>
class Parts final : public StagedWork {
 public:
  Parts(int units, const Function& function, SpanLabel label)
      : units_(units), function_(function), label_(label) {}
  int stages() const override { return 1; }
  int units(int) const override { return units_; }
  void Do(int, int unit) override { function_(unit); }
  SpanLabel label(int) const override { return label_; }

 private:
  int units_;
  const Function& function_;
  SpanLabel label_;
};

/// function(unit) for all units.
template <class Function>
void ForUnits(int units, Crew* crew, const Function& function, SpanLabel label = {}) {
  if (crew->alone()) {
    const SpanClock clock(crew->recorder(), 0, label, units);
    for (int unit = 0; unit < units; ++unit) function(unit);
    return;
  }
  Parts parts(units, function, label);
  crew->Run(&parts);
}

/// function(first, count) for all parts of a range.
template <class Function>
void InParts(int size, int of_part, Crew* crew, const Function& function, SpanLabel label = {}) {
  const auto part = [&](int unit) {
    const int first = unit * of_part;
    function(first, std::min(of_part, size - first));
  };
  ForUnits((size + of_part - 1) / of_part, crew, part, label);
}

}  // namespace cairn
