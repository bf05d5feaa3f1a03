// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

#include "simd/pairs/pair_block.h"
#include "simd/target.h"

namespace cairn::simd {

/// Reads lines one after the other and does as little as can be done with them: adds them up. What
/// memory gives to the kernels at best. @pre the CPU supports the target
float StreamRead(Target target, const Line* lines, std::size_t count);

}  // namespace cairn::simd
