// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/facts.h"
#include "scenes/scene.h"
#include "scenes/world.h"

namespace cairn::test {

/// Rounding of the arithmetic that Bullet was built with.
inline constexpr double kBulletEpsilon = std::numeric_limits<btScalar>::epsilon();

/// A scene of bench/scenes in its world, at its default size unless options say so.
class SceneWorld {
 public:
  SceneWorld(std::string_view name, btConstraintSolver* solver, std::uint64_t seed = 0)
      : SceneWorld(name, solver, bench::SceneOptions{.seed = seed}) {}
  SceneWorld(std::string_view name, btConstraintSolver* solver, const bench::SceneOptions& options)
      : world_(solver) {
    scene_ = bench::Make(*bench::FindScene(name));
    scene_->Build(&world_, options);
  }

  void Step(int frames) {
    for (int i = 0; i < frames; ++i) {
      scene_->BeforeStep(&world_, frame_++);
      world_.Step();
    }
  }

  bench::World& world() { return world_; }
  bench::SceneFacts Measure() const { return scene_->Measure(world_); }

 private:
  bench::World world_;
  std::unique_ptr<bench::Scene> scene_;
  int frame_ = 0;
};

inline std::vector<std::string_view> SceneNames() {
  std::vector<std::string_view> names;
  for (const bench::SceneInfo& info : bench::Scenes()) names.push_back(info.name);
  return names;
}

/// For INSTANTIATE_TEST_SUITE_P over SceneNames().
struct SceneTestName {
  template <class Info>
  std::string operator()(const Info& info) const {
    std::string name(info.param);
    std::replace(name.begin(), name.end(), '-', '_');
    return name;
  }
};

}  // namespace cairn::test
