// SPDX-License-Identifier: MIT
#include "problems/bearings/infinite_bearing.h"
#include "problems/bearings/journal_bearing.h"
#include "problems/bearings/slider.h"
#include "problems/obstacle.h"
#include "problems/options/american_put.h"
#include "problems/options/two_asset_put.h"
#include "problems/problem.h"
#include "problems/torsion.h"

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
