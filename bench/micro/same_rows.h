// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "micro/scene_kind.h"

namespace cairn::micro {

/// What is wrong with a scene of this kind, or "". Nothing is if one sweep in the same order gives
/// Bullet's impulses, so that both sides have the same rows, and if many sweeps end near the
/// solution with numbers that no CPU is slow with, so that times do not depend on how many were
/// made.
std::string FindFault(SceneKind kind);

}  // namespace cairn::micro
