// SPDX-License-Identifier: MIT
#include "problems/american_put.h"
#include "problems/infinite_bearing.h"
#include "problems/journal_bearing.h"
#include "problems/obstacle.h"
#include "problems/problem.h"
#include "problems/slider.h"
#include "problems/torsion.h"
#include "problems/two_asset_put.h"

namespace cairn::problems {

// In the order of the list. A new one is a file with a function `Generator <Name>()`, its header
// above and its name here.
const std::vector<Generator>& Generators() {
  static const std::vector<Generator> generators = {
      JournalBearing(),   InfiniteBearing(), Slider(),       Obstacle(),
      TwoSidedObstacle(), Torsion(),         AmericanPut(),  AmericanPutStep(),
      PutOnMin(),         PutOnAverage(),    PutOnMinStep(),
  };
  return generators;
}

}  // namespace cairn::problems
