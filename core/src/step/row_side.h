// SPDX-License-Identifier: MIT
#pragma once

#include "simd/pair_law.h"

namespace cairn {

using simd::RowSide;

}  // namespace cairn
