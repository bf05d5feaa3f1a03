// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>
#include <vector>

#include "cairn/contact_problem.h"
#include "measure/bullet_pools.h"

namespace cairn::bench {

/// A ContactProblem without manifolds in the terms of Bullet's pools.
struct PoolProblem {
  std::vector<PoolBody> bodies;  ///< Those of the problem, and one more that never moves.
  std::vector<PoolRow> rows;     ///< In the order of the problem.
  /// One sentence, without a full stop, if there is a row that Bullet's pools do not have.
  std::string refusal;
};

/// Rows that others have as their parent, and all from @p first_contact on without one, are
/// contacts; the rest is joints. Impulses are those of the start.
PoolProblem ToPools(const ContactProblem& problem, std::span<const double> impulses,
                    int first_contact);

}  // namespace cairn::bench
