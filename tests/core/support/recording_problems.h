// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "cairn/detail/recording.h"

namespace cairn::test {

/// Bodies, rows of every kind, joints, manifolds and impulses, which can be solved.
Recording RandomRecording(std::uint64_t seed);

}  // namespace cairn::test
