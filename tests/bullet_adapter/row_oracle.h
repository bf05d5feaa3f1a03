// SPDX-License-Identifier: MIT
#pragma once

#include <functional>

#include "bullet_adapter/src/fast_group.h"
#include "measure/substep.h"
#include "scenes/world.h"

namespace cairn::test {

/// Applied to the state of a substep before rows are made of it.
using ChangeState = std::function<void(const bench::Substep&)>;

/// How many rows were compared.
struct RowCounts {
  int joints = 0, normals = 0, frictions = 0, twists = 0;
  int points = 0;   ///< of contact that go to the core in manifolds
  int compact = 0;  ///< rows of joints that go to the core as such
  int locked = 0;   ///< of joints that do not, of bodies with an angular factor
};

/// Expects that for every group of a substep the rows of FastGroup are those that Bullet's own
/// set-up makes from the same state: J, target, compliance, bounds, friction coefficients, and the
/// start of normals; that making them twice gives the same; and that the joints and manifolds of
/// FastGroup stand for those rows, to the precision of floats.
RowCounts ExpectBulletsRows(const bench::Substep& substep, const btContactSolverInfo& info,
                            const ChangeState& change);

/// The same in every @p stride -th of @p frames frames of a world that is driven by Bullet.
/// @param build  fills the world
RowCounts ExpectBulletsRowsInWorld(const std::function<void(bench::World*)>& build,
                                   const ChangeState& change, int frames, int stride);

}  // namespace cairn::test
