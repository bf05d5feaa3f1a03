// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "cairn/contact_problem.h"

namespace cairn {

/// What a body is known by from frame to frame: its id, or where it has none its place.
inline std::uint64_t BodyNameOf(const Body& body, int place) {
  // ids of users are far from there
  constexpr std::uint64_t kUnnamed = std::uint64_t{1} << 63;
  return body.id != 0 ? body.id : kUnnamed + static_cast<std::uint64_t>(place);
}

}  // namespace cairn
