// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "worlds/conditions/mouse.h"
#include "worlds/conditions/moving_ground.h"
#include "worlds/conditions/player.h"
#include "worlds/conditions/press.h"
#include "worlds/kinds/kinds.h"
#include "worlds/world_seed.h"

namespace cairn::bench {

/// The kind that a seed is of.
const Kind& KindOf(std::uint64_t seed);

/// A world nobody chose: bodies, joints, settings and events drawn at random from a seed.
class RandomWorld {
 public:
  /// @pre `solver` outlives the world
  RandomWorld(const WorldSeed& seed, btConstraintSolver* solver);

  /// What happens at this time, then one step.
  void Step();

  const Kind& kind() const { return kind_; }
  const Rules& rules() const { return rules_; }
  /// Steps so many seconds take, on average.
  int Frames(double seconds) const;
  World& world() { return world_; }
  const World& world() const { return world_; }
  double time() const { return time_; }  ///< [s]
  /// Of the last step [s].
  double time_step() const { return world_.time_step(); }

  /// One sentence: kind, bodies, joints, masses, rules.
  std::string Describe() const;

 private:
  const Kind& kind_;
  Rules rules_;
  World world_;
  Random steps_;  ///< for lengths of steps
  std::vector<Event> events_;
  size_t next_event_ = 0;
  std::optional<Player> player_;
  std::optional<Mouse> mouse_;
  std::optional<Press> press_;
  std::optional<MovingGround> moving_ground_;
  double time_ = 0;
  WorldSeed seed_;
};

}  // namespace cairn::bench
