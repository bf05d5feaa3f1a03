// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string_view>

#include "worlds/draft.h"

namespace cairn::bench {

/// A family of random worlds.
struct Kind {
  std::string_view name, description;
  /// Adds bodies, joints and events; may change the rules.
  void (*draw)(Draft* draft);
  /// Bodies that touch nothing static and have inertia alike about all axes: momentum is kept.
  bool floats = false;
};

/// All kinds, in the order of the table. Seed s draws a world of kind s modulo their number.
std::span<const Kind> Kinds();

}  // namespace cairn::bench
