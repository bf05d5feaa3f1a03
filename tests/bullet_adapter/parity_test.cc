// SPDX-License-Identifier: MIT
// With k_sm = 0 Mode::kReference makes Bullet's own iteration: every step taken from the same state
// ends in the same velocities, impulses and positions, to rounding.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <string_view>
#include <vector>

#include "cairn/bullet/constraint_solver.h"
#include "measure/instrumented_solver.h"
#include "measure/substep.h"
#include "tests/bullet_adapter/scene_world.h"

namespace cairn::test {
namespace {

using bench::Substep;

Settings PlainSweeps() { return {.path = Path::kReference, .k_sm = 0}; }

/// Everything a solver leaves behind in the objects of one substep.
struct Outcome {
  std::vector<double> velocities, positions, impulses;
};

void Append(const btVector3& v, std::vector<double>* values) {
  values->insert(values->end(), {v.x(), v.y(), v.z()});
}

Outcome ReadOutcome(const Substep& substep) {
  Outcome outcome;
  for (const btRigidBody* body : substep.bodies()) {
    Append(body->getLinearVelocity(), &outcome.velocities);
    Append(body->getAngularVelocity(), &outcome.velocities);
    Append(body->getWorldTransform().getOrigin(), &outcome.positions);
  }
  outcome.impulses = substep.Impulses();
  return outcome;
}

Outcome SolveFrom(const Substep& substep, btConstraintSolver* solver,
                  const btContactSolverInfo& info) {
  substep.Restore();
  substep.SolveWith(solver, info, nullptr);
  return ReadOutcome(substep);
}

/// The same after velocities and starting impulses were moved by up to 16 roundings: a row of ten
/// sweeps sees more.
Outcome SolveFromRounded(const Substep& substep, btConstraintSolver* solver,
                         const btContactSolverInfo& info, std::mt19937* random) {
  substep.Restore();
  std::uniform_real_distribution<double> factor(1 - 16 * kBulletEpsilon, 1 + 16 * kBulletEpsilon);
  const auto rounding = [&] { return static_cast<btScalar>(factor(*random)); };
  for (btRigidBody* body : substep.bodies()) {
    body->setLinearVelocity(body->getLinearVelocity() * rounding());
    body->setAngularVelocity(body->getAngularVelocity() * rounding());
  }
  for (const Substep::Group& group : substep.groups()) {
    for (btPersistentManifold* manifold : group.manifolds) {
      for (int i = 0; i < manifold->getNumContacts(); ++i) {
        manifold->getContactPoint(i).m_appliedImpulse *= rounding();
      }
    }
  }
  substep.SolveWith(solver, info, nullptr);
  return ReadOutcome(substep);
}

/// Largest difference, relative to the largest value or `scale`, whichever is more.
double Relative(const std::vector<double>& a, const std::vector<double>& b, double scale) {
  double largest = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    largest = std::max(largest, std::abs(a[i] - b[i]));
    scale = std::max(scale, std::abs(a[i]));
  }
  return largest / scale;
}

double Difference(const Outcome& a, const Outcome& b) {
  // What gravity adds in a step and contacts take away again [m/s]: the velocities of bodies at
  // rest are what rounding leaves of it.
  constexpr double kOfGravity = 9.81 / 60, kNone = 1e-30;
  return std::max({Relative(a.velocities, b.velocities, kOfGravity),
                   Relative(a.positions, b.positions, kNone),
                   Relative(a.impulses, b.impulses, kNone)});
}

/// How far Bullet's own answer moves when its input is rounded differently. Far, where a normal
/// impulse ends within a rounding of zero: Bullet then either holds the friction of that contact or
/// takes it away, and it is the rounding that decides.
double RoundingOfBullet(const Substep& substep, const Outcome& exact,
                        const btContactSolverInfo& info) {
  std::mt19937 random(1);
  btSequentialImpulseConstraintSolver bullet;
  double largest = 0;
  for (int k = 0; k < 32; ++k) {
    const Outcome rounded = SolveFromRounded(substep, &bullet, info, &random);
    largest = std::max(largest, Difference(exact, rounded));
  }
  return largest;
}

// Ten sweeps over rows whose numbers Bullet rounds at each operation. Measured over all cases:
// below 200 roundings, and 225 with soft joints in double.
constexpr double kTolerance = 500 * kBulletEpsilon;

using Change = std::function<void(bench::World*)>;

/// Runs a scene, changed or as it is, with Bullet's solver, and in every substep also gives Cairn
/// the same state.
void ExpectBulletsOwnResult(std::string_view scene, int frames, const Change& change) {
  btSequentialImpulseConstraintSolver driver, bullet;
  bullet::ConstraintSolver cairn(PlainSweeps(), {.mode = bullet::Mode::kReference});
  bench::InstrumentedSolver instrumented(&driver);
  SceneWorld world(scene, &instrumented);
  change(&world.world());

  for (int frame = 0; frame < frames; ++frame) {
    instrumented.ProbeNext([&](Substep* substep, const btContactSolverInfo& info) {
      const Outcome expected = SolveFrom(*substep, &bullet, info);
      const double difference = Difference(expected, SolveFrom(*substep, &cairn, info));
      if (difference <= kTolerance) return;
      // velocities are made from the impulses in the end, which Bullet rounds at each sweep
      EXPECT_LE(difference, 3 * RoundingOfBullet(*substep, expected, info)) << "frame " << frame;
    });
    world.Step(1);
  }
}

class ParityOnScene : public testing::TestWithParam<std::string_view> {};

TEST_P(ParityOnScene, EndsInBulletsOwnVelocitiesPositionsAndImpulsesOver120Frames) {
  ExpectBulletsOwnResult(GetParam(), 120, [](bench::World*) {});
}

INSTANTIATE_TEST_SUITE_P(Every, ParityOnScene, testing::ValuesIn(SceneNames()), SceneTestName());

TEST(Parity, HoldsWhereContactsAndFrictionAreInterleaved) {
  ExpectBulletsOwnResult("rubble", 60, [](bench::World* world) {
    world->solver_info().m_solverMode |= SOLVER_INTERLEAVE_CONTACT_AND_FRICTION_CONSTRAINTS;
  });
}

TEST(Parity, HoldsWithOneFrictionDirectionAndWithoutWarmStart) {
  ExpectBulletsOwnResult(
      "rubble", 60, [](bench::World* world) { world->solver_info().m_solverMode = SOLVER_SIMD; });
}

TEST(Parity, HoldsWithOverRelaxationAndSoftContacts) {
  ExpectBulletsOwnResult("wall", 60, [](bench::World* world) {
    world->solver_info().m_sor = btScalar(1.3);
    world->solver_info().m_globalCfm = btScalar(1e-3);
  });
}

TEST(Parity, HoldsWithSoftJoints) {
  ExpectBulletsOwnResult("bridge", 60, [](bench::World* world) {
    for (btTypedConstraint* joint : world->joints()) {
      joint->setParam(BT_CONSTRAINT_CFM, btScalar(0.3));
    }
  });
}

}  // namespace
}  // namespace cairn::test
