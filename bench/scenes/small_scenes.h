// SPDX-License-Identifier: MIT
#pragma once

namespace cairn::bench {

/// A scene at a size that most games have, of 1 to 400 bodies.
struct SmallScene {
  const char* name;
  int size;
};

/// What `cairn run small` runs, and `cairn doctor --verify`. A new one is a line here.
inline constexpr SmallScene kSmallScenes[] = {
    {"incline", 1},       {"seesaw", 1},        {"door", 1},       {"pendulum", 5}, {"car", 1},
    {"growing-tower", 7}, {"tower", 10},        {"stairs", 1},     {"arch", 11},    {"slab", 6},
    {"dominoes", 100},    {"wrecking-ball", 6}, {"pyramid3d", 10},
};

}  // namespace cairn::bench
