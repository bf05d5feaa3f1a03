// SPDX-License-Identifier: MIT
// The inside of the solver, for tests of one stage.
#pragma once

#include <vector>

#include "problem/islands.h"
#include "problems.h"
#include "reference/pack.h"
#include "reference/row_sweep.h"

namespace cairn::test {

/// A scene of one island, packed, after some sweeps from zero.
struct Packed {
  PackedIsland island;
  IslandState state;

  Packed(const Scene& scene, int sweeps) {
    const Array<Island> islands = FindIslands(scene.problem());
    EXPECT_EQ(islands.size(), 1u);
    island = Packer(scene.problem(), Settings{}).Pack(islands[0]);
    state = Packer::Start(island, islands[0], std::vector<double>(scene.rows.size(), 0.0));
    const int rows = static_cast<int>(scene.rows.size());
    for (int k = 0; k < sweeps; ++k) {
      SweepRows(island, {0, rows, k}, detail::LiftedFriction::kRelease, &state);
    }
  }
};

}  // namespace cairn::test
