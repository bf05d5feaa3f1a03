// SPDX-License-Identifier: MIT
#pragma once

namespace cairn::simd {

/// A body as the rows of contacts and joints see it: R with M^-1 = R R', and velocities. Zeros for
/// what is not there.
struct alignas(32) ContactBody {
  float linear[3];   ///< diagonal of the linear part of R
  float angular[9];  ///< angular part of R, column by column
  float free[6];     ///< velocity without constraints: linear, angular
  float start[6];    ///< the same before external impulses
};
inline constexpr int kContactBodyNumbers = sizeof(ContactBody) / sizeof(float);

}  // namespace cairn::simd
