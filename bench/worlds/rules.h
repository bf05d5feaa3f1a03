// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "scenes/random.h"
#include "scenes/world.h"

namespace cairn::bench {

/// How a world is stepped and what holds for all of its bodies: drawn at random, like the world.
struct Rules {
  double rate = 60;     ///< Steps a second [Hz].
  double uneven = 1;    ///< Steps are longer or shorter by up to this factor, >= 1.
  int iterations = 10;  ///< btContactSolverInfo::m_numIterations
  int friction_directions = 2;
  bool split_impulse = true;
  bool sleeping = false;
  bool events = false;                       ///< Bodies and joints come and go; see events.cc.
  Surface surface = {};                      ///< Of all bodies.
  btVector3 gravity{0, btScalar(-9.81), 0};  ///< At the start [m/s^2].
};

/// Frequent choices are what games have: 60 Hz, 4 to 30 iterations, two directions of friction.
Rules DrawRules(Random* random);

/// Settings of Bullet, gravity, and whether bodies sleep.
void Apply(const Rules& rules, World* world);

/// "60 Hz, 10 iterations, friction 0.5, ..."
std::string Describe(const Rules& rules);

}  // namespace cairn::bench
