// SPDX-License-Identifier: MIT
#pragma once

namespace cairn::test {

/// What becomes of memory that Bullet gave back: bodies, joints, shapes, manifolds.
enum class Recycling {
  kByTheSystem,
  kAtOnce,  ///< The next of that size gets the same address.
  kLate,    ///< Only once some hundred others of that size were given back.
};

/// For all that follows, on one thread. What was allocated before may be freed after it.
void SetRecycling(Recycling recycling);

}  // namespace cairn::test
