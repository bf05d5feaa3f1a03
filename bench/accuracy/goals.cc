// SPDX-License-Identifier: MIT
#include "accuracy/goals.h"

#include <limits>
#include <utility>

namespace cairn::accuracy {
namespace {

constexpr std::pair<std::string_view, double> kGoals[] = {
    {"chain", 0.01}, {"bridge", 0.1}, {"heavy-top", 0.1}, {"tower", 0.1},  {"pyramid", 0.2},
    {"wall", 0.2},   {"castle", 0.2}, {"rubble", 1},      {"ragdolls", 1}, {"islands", 1},
};

}  // namespace

double GoalOf(std::string_view scene) {
  for (const auto& [name, share] : kGoals) {
    if (name == scene) return share;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

}  // namespace cairn::accuracy
