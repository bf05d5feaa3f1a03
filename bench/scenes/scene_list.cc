// SPDX-License-Identifier: MIT
#include <algorithm>
#include <iterator>

#include "scenes/scene.h"

// Every scene, in the order of the list. A new one is a file with a function `SceneInfo
// <Name>Scene()` and its name here.
#define CAIRN_BENCH_SCENES(SCENE) \
  SCENE(Castle)                   \
  SCENE(Pyramid)                  \
  SCENE(Pyramid3d)                \
  SCENE(Wall)                     \
  SCENE(Tower)                    \
  SCENE(HeavyTop)                 \
  SCENE(Bridge)                   \
  SCENE(TwoPinBridge)             \
  SCENE(Chain)                    \
  SCENE(Ragdolls)                 \
  SCENE(Rubble)                   \
  SCENE(Islands)                  \
  SCENE(Stairs)                   \
  SCENE(Car)                      \
  SCENE(Door)                     \
  SCENE(Pendulum)                 \
  SCENE(Seesaw)                   \
  SCENE(Dominoes)                 \
  SCENE(Arch)                     \
  SCENE(Incline)                  \
  SCENE(GrowingTower)             \
  SCENE(Slab)                     \
  SCENE(WreckingBall)             \
  SCENE(Crane)                    \
  SCENE(Chandelier)               \
  SCENE(Truck)                    \
  SCENE(CrateBridge)              \
  SCENE(Balls)

namespace cairn::bench {

#define CAIRN_BENCH_DECLARE(name) SceneInfo name##Scene();
CAIRN_BENCH_SCENES(CAIRN_BENCH_DECLARE)
#undef CAIRN_BENCH_DECLARE

std::span<const SceneInfo> Scenes() {
#define CAIRN_BENCH_CALL(name) name##Scene(),
  static const SceneInfo scenes[] = {CAIRN_BENCH_SCENES(CAIRN_BENCH_CALL)};
#undef CAIRN_BENCH_CALL
  return scenes;
}

const SceneInfo* FindScene(std::string_view name) {
  const std::span<const SceneInfo> scenes = Scenes();
  const auto found = std::find_if(scenes.begin(), scenes.end(),
                                  [&](const SceneInfo& info) { return info.name == name; });
  return found == scenes.end() ? nullptr : &*found;
}

std::unique_ptr<Scene> Make(const SceneInfo& info) { return info.make(info); }

}  // namespace cairn::bench
