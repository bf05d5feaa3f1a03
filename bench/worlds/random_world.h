// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "scenes/scene.h"
#include "worlds/conditions/mouse.h"
#include "worlds/conditions/moving_ground.h"
#include "worlds/conditions/player.h"
#include "worlds/conditions/press.h"
#include "worlds/kinds/kinds.h"
#include "worlds/world_seed.h"

namespace cairn::bench {

/// The kind that a seed is of.
const Kind& KindOf(std::uint64_t seed);

/// What becomes of a world nobody chose: bodies, joints, settings and events drawn at random from a
/// seed. It has its own rate of steps and rules.
class RandomScene : public Scene {
 public:
  /// `random`: the size is the seed, nothing is on top, and the iterations are Bullet's default.
  static const SceneInfo& Info();

  explicit RandomScene(const SceneInfo& info) : Scene(info) {}
  explicit RandomScene(const WorldSeed& seed) : Scene(Info()), seed_(seed), seeded_(true) {}

  /// What happens at this time, and how long the next step is.
  void BeforeStep(World* world, int frame) override;

  /// @pre built, as all that follows
  const Kind& kind() const { return KindOf(seed_.seed); }
  const Rules& rules() const { return rules_; }
  double time() const { return time_; }  ///< After the next step [s].

  /// One sentence: kind, bodies, joints, masses, rules.
  std::string Describe(const World& world) const;

 protected:
  void AddBodies(World* world, int size) override;

 private:
  WorldSeed seed_;
  bool seeded_ = false;  ///< Otherwise the size is the seed.
  Rules rules_;
  Random steps_{0};  ///< for lengths of steps
  std::vector<Event> events_;
  size_t next_event_ = 0;
  std::optional<Player> player_;
  std::optional<Mouse> mouse_;
  std::optional<Press> press_;
  std::optional<MovingGround> moving_ground_;
  double time_ = 0;
};

/// A random scene in a world of its own.
class RandomWorld {
 public:
  /// @pre `solver` outlives the world
  RandomWorld(const WorldSeed& seed, btConstraintSolver* solver);

  void Step();

  const Kind& kind() const { return scene_.kind(); }
  const Rules& rules() const { return scene_.rules(); }
  /// Steps so many seconds take, on average.
  int Frames(double seconds) const;
  World& world() { return world_; }
  const World& world() const { return world_; }
  double time() const { return scene_.time(); }  ///< [s]
  /// Of the last step [s].
  double time_step() const { return world_.time_step(); }
  std::string Describe() const { return scene_.Describe(world_); }

 private:
  World world_;
  RandomScene scene_;
};

}  // namespace cairn::bench
