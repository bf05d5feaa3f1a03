// SPDX-License-Identifier: MIT
#include "problems/generators.h"
#include "problems/problem.h"

namespace cairn::problems {

// In the order of the list. A new one is a file with a function `Generator <Name>()`, which
// generators.h declares, and its name here.
const std::vector<Generator>& Generators() {
  static const std::vector<Generator> generators = {
      JournalBearing(),   InfiniteBearing(), Slider(),       Obstacle(),
      TwoSidedObstacle(), Torsion(),         AmericanPut(),  AmericanPutStep(),
      PutOnMin(),         PutOnAverage(),    PutOnMinStep(),
  };
  return generators;
}

}  // namespace cairn::problems
