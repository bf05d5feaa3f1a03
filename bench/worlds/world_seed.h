// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace cairn::bench {

/// Which world: the same bits each time.
struct WorldSeed {
  std::uint64_t seed = 0;
  double scale = 1;      ///< In (0, 1]: smaller worlds of the same kind, to shrink one that fails.
  bool locks = false;    ///< Bodies have locked axes; all else is as without.
  bool heavy = false;    ///< Loads of ropes and bridges are 10 to 10,000 times as heavy, likewise.
  bool crowded = false;  ///< Ten times as many bodies may touch or hang on a hub.
  bool played = false;   ///< Somebody pushes, spins, moves and weighs bodies, see Player.
  bool moving = false;   ///< What is static moves instead, see MovingGround.
  bool dragged = false;  ///< Somebody drags bodies about, see Mouse.
  bool pressed = false;  ///< Plates close on all bodies and open again, see Press.
  bool colliding = false;  ///< Bodies of a joint may collide, see LetConnectedCollide().
  double unit = 1;         ///< Units of length in a metre, see ChangeUnits(); without events.
};

/// What worlds may be on top of what is drawn: one of the bools of WorldSeed. Each is an option of
/// `cairn worlds`, a field of its JSON, and a word where a world is described.
struct Condition {
  std::string name;
  bool WorldSeed::*on;
  std::string words;  ///< "heavy loads"
  std::string help;   ///< of the option
};
std::span<const Condition> Conditions();

/// The options of `cairn worlds` for a world's conditions, each with a space before it: " --heavy".
std::string OptionsOf(const WorldSeed& seed);

}  // namespace cairn::bench
