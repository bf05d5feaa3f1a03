// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "worlds/kinds/kinds.h"

namespace cairn::bench {

/// Which world: the same bits each time.
struct WorldSeed {
  std::uint64_t seed = 0;
  double scale = 1;      ///< In (0, 1]: smaller worlds of the same kind, to shrink one that fails.
  bool locks = false;    ///< Bodies have locked axes; all else is as without.
  bool heavy = false;    ///< Loads of ropes and bridges are 10 to 10,000 times as heavy, likewise.
  bool crowded = false;  ///< Ten times as many bodies may touch or hang on a hub.
  double unit = 1;       ///< Units of length in a metre, see ChangeUnits(); without events.
};

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
  double time_ = 0;
  bool locks_ = false, heavy_ = false, crowded_ = false;
  double unit_ = 1;
};

}  // namespace cairn::bench
