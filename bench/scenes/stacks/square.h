// SPDX-License-Identifier: MIT
#pragma once

namespace cairn::bench {

/// Places along a side of the smallest square that has so many.
inline int PlacesPerSide(int places) {
  int side = 1;
  while (side * side < places) ++side;
  return side;
}

}  // namespace cairn::bench
