// SPDX-License-Identifier: MIT
#include "worlds/world_seed.h"

#include <sstream>

namespace cairn::bench {

std::span<const Condition> Conditions() {
  static const Condition conditions[] = {
      {"locks", &WorldSeed::locks, "locked axes",
       "Bodies with locked axes, as games in a plane have them; no momentum then"},
      {"heavy", &WorldSeed::heavy, "heavy loads",
       "Loads on ropes, chains and bridges are 10 to 10,000 times as heavy"},
      {"crowded", &WorldSeed::crowded, "crowded hubs",
       "Hubs touch or hold up to 500 bodies instead of 50"},
      {"played", &WorldSeed::played, "somebody plays",
       "Some eight times a second a body is pushed, thrown, spun, moved or gets another mass; no "
       "momentum then"},
      {"moving", &WorldSeed::moving, "moving ground",
       "What is static moves instead: all together like a ship, or each by itself"},
      {"dragged", &WorldSeed::dragged, "somebody drags",
       "Some twice a second somebody takes hold of a body and drags it about; no momentum then"},
      {"pressed", &WorldSeed::pressed, "plates press",
       "Two plates close on all bodies, again and again; no momentum then"},
      {"colliding", &WorldSeed::colliding, "connected bodies collide",
       "Bodies of a joint may collide, as addConstraint() has it by default"}};
  return conditions;
}

std::string OptionsOf(const WorldSeed& seed) {
  std::ostringstream text;
  for (const Condition& condition : Conditions()) {
    if (seed.*condition.on) text << " --" << condition.name;
  }
  if (seed.unit != 1) text << " --unit " << seed.unit;
  return text.str();
}

}  // namespace cairn::bench
