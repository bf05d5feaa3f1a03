// SPDX-License-Identifier: MIT
// Scenes of C++ as problems of C.
#pragma once

#include <vector>

#include "cairn/cairn.h"
#include "tests/core/support/manifold_problems.h"

namespace cairn::test {

/// Points into the scene, whose bodies have numbers that floats hold.
struct CScene {
  ManifoldScene* scene;
  std::vector<CairnBody> bodies;
  std::vector<CairnVelocity> velocities;
  CairnProblem problem;
  CairnSolution solution;
};

/// Rounds the bodies of a scene to floats, and shows it to C. @pre it has no rows and no motions
CScene ToC(ManifoldScene* scene);

}  // namespace cairn::test
