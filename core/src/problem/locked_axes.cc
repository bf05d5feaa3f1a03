// SPDX-License-Identifier: MIT
#include "problem/locked_axes.h"

#include "cairn/detail/eigen.h"

namespace cairn {
namespace {

/// A row moves a body if that answers at least this share of what it would without locks: speeds
/// along free axes come to thirty times its target at most, once it is solved.
constexpr double kLeastShare = 1e-3;
/// Of directions whose length is 1 in floats.
constexpr double kRounding = 1e-6;
/// The inertia without locks is not known where a row only turns: this is rounding of floats, and
/// none of a long thin body.
constexpr double kLeastShareOfTurn = 1e-10;

double SquaredNorm(std::span<const double> numbers) {
  double sum = 0;
  for (double number : numbers) sum += number * number;
  return sum;
}

}  // namespace

bool HasLockedAxes(const Body& body) {
  const auto inertia = View(body.inv_inertia).diagonal();
  const bool turns = (inertia.array() != 0).any();
  return (body.inv_mass > 0 && (View(body.linear_factor).array() == 0).any()) ||
         (turns && (inertia.array() == 0).any());
}

LockedSide LookAtLocked(const Body& body, double linear2, double angular2,
                        std::span<const double, 6> g) {
  const double turned = SquaredNorm(g.subspan<3>());
  if (linear2 == 0) {
    return {turned < kLeastShareOfTurn * angular2 * View(body.inv_inertia).trace(), 0};
  }
  double free = 0, pushed = 0;
  for (int k = 0; k < 3; ++k) {
    const double inv_mass = body.inv_mass * body.linear_factor[k];
    if (inv_mass > 0) free += g[k] * g[k] / inv_mass;
    pushed += g[k] * g[k];
  }
  const bool locks = body.inv_mass > 0 && (View(body.linear_factor).array() == 0).any();
  const bool denied = locks && linear2 - free > kRounding * linear2;
  const double locked = denied ? body.inv_mass * (linear2 - free) : 0;
  const bool alone = pushed + turned < kLeastShare * locked;
  return {alone, alone ? 0 : locked};
}

}  // namespace cairn
