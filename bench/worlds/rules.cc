// SPDX-License-Identifier: MIT
#include "worlds/rules.h"

#include <cmath>
#include <sstream>

namespace cairn::bench {
namespace {

double DrawRate(Random* random) {
  const double draw = random->Within(0, 1);
  return draw < 0.6 ? 60 : draw < 0.75 ? 30 : draw < 0.92 ? 120 : 240;
}

int DrawIterations(Random* random) {
  const double draw = random->Within(0, 1);
  if (draw < 0.2) return 10;
  if (draw < 0.9) return static_cast<int>(random->Within(4, 31));
  return static_cast<int>(random->Within(1, 51));
}

Surface DrawSurface(Random* random) {
  Surface surface;
  // Bullet multiplies the two: this is the product, 0 to 2.
  const double draw = random->Within(0, 1);
  const double friction = draw < 0.1 ? 0 : draw < 0.8 ? random->Within(0.2, 0.9) : 2 * draw - 0.6;
  surface.friction = static_cast<btScalar>(std::sqrt(friction));
  if (random->Within(0, 1) < 0.25) {
    surface.restitution = static_cast<btScalar>(std::sqrt(random->Within(0, 0.6)));
  }
  if (random->Within(0, 1) < 0.1) {
    surface.rolling_friction = surface.spinning_friction = btScalar(0.1);
  }
  return surface;
}

}  // namespace

Rules DrawRules(Random* random) {
  Rules rules;
  rules.rate = DrawRate(random);
  if (random->Within(0, 1) < 0.15) rules.uneven = random->Within(1.1, 2);
  rules.iterations = DrawIterations(random);
  rules.friction_directions = random->Within(0, 1) < 0.3 ? 1 : 2;
  rules.split_impulse = random->Within(0, 1) < 0.7;
  rules.sleeping = random->Within(0, 1) < 0.3;
  rules.events = random->Within(0, 1) < 0.3;
  rules.surface = DrawSurface(random);
  return rules;
}

void Apply(const Rules& rules, World* world) {
  btContactSolverInfo& info = world->solver_info();
  info.m_numIterations = rules.iterations;
  info.m_splitImpulse = rules.split_impulse ? 1 : 0;
  world->SetFrictionDirections(rules.friction_directions);
  world->bullet()->setGravity(rules.gravity);
  world->SetTimeStep(static_cast<btScalar>(1 / rules.rate));
  if (rules.sleeping) world->LetSleep();
}

std::string Describe(const Rules& rules) {
  std::ostringstream text;
  text.precision(2);
  text << rules.rate << " Hz";
  if (rules.uneven > 1) text << " (steps uneven by up to a factor of " << rules.uneven << ")";
  text << ", " << rules.iterations << " iterations, friction "
       << rules.surface.friction * rules.surface.friction << " in " << rules.friction_directions
       << (rules.friction_directions == 1 ? " direction" : " directions") << ", restitution "
       << rules.surface.restitution * rules.surface.restitution
       << (rules.surface.rolling_friction > 0 ? ", rolling friction" : "")
       << (rules.split_impulse ? ", split impulse" : ", no split impulse")
       << (rules.sleeping ? ", sleeping" : "") << (rules.events ? ", events" : "");
  return text.str();
}

}  // namespace cairn::bench
