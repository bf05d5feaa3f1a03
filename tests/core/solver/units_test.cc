// SPDX-License-Identifier: MIT
// The unit of length does not matter: with Tuning::units_per_metre a problem in other units has the
// same answer, to the bit, as units are powers of two. Masses: problem/properties_test.cc.
#include <gtest/gtest.h>

#include <vector>

#include "cairn/detail/eigen.h"
#include "tests/core/support/block_problems.h"

namespace cairn {
namespace {

using test::Scene;
using test::Solution;

bool OnlyTurns(const Row& row) {
  return View(row.linear_a).isZero() && View(row.linear_b).isZero();
}

/// The scene with lengths in units of which there are so many in a metre.
Scene InUnits(const Scene& scene, double unit) {
  Scene other = scene;
  for (Eigen::Vector3d& position : other.positions) position *= unit;
  for (Body& body : other.bodies) {
    View(body.inv_inertia) /= unit * unit;
    View(body.velocity.linear) *= unit;
    View(body.impulse) *= unit;
    View(body.angular_impulse) *= unit * unit;
  }
  for (Row& row : other.rows) {
    const bool turns = OnlyTurns(row);
    if (!turns) {
      View(row.angular_a) *= unit;
      View(row.angular_b) *= unit;
      row.target *= unit;
    } else {
      row.compliance /= unit * unit;
    }
    const double impulse = turns ? unit * unit : unit;
    row.lo *= impulse;
    row.hi *= impulse;
    // coefficients of what turns against what pushes are lengths
    if (row.parent != kNoRow && turns && !OnlyTurns(scene.rows[row.parent])) row.friction *= unit;
  }
  return other;
}

/// A solution back in metres.
Solution InMetres(Solution solution, const Scene& scene, double unit) {
  for (size_t i = 0; i < solution.x.size(); ++i) {
    solution.x[i] /= OnlyTurns(scene.rows[i]) ? unit * unit : unit;
  }
  for (Velocity& velocity : solution.v) View(velocity.linear) /= unit;
  return solution;
}

/// Frame after frame with one solver, which remembers.
void ExpectTheSameInUnits(const Scene& scene, Settings settings, double unit) {
  Solver in_metres(settings);
  settings.tuning.units_per_metre = unit;
  Solver in_units(settings);
  const Scene other = InUnits(scene, unit);
  for (int frame = 0; frame < 3; ++frame) {
    const Solution expected = test::Solve(&in_metres, scene);
    const Solution solution = test::Solve(&in_units, other);
    ASSERT_TRUE(solution.report.ok());
    ASSERT_TRUE(test::SameBits(InMetres(solution, scene, unit), expected)) << "frame " << frame;
    EXPECT_EQ(solution.report.sweeps, expected.report.sweeps);
    EXPECT_EQ(solution.report.steps_accepted, expected.report.steps_accepted);
    EXPECT_EQ(solution.report.steps_restored, expected.report.steps_restored);
    EXPECT_EQ(solution.report.stop, expected.report.stop);
    EXPECT_EQ(solution.report.residual_max, unit * expected.report.residual_max);
    EXPECT_EQ(solution.report.residual_angular, expected.report.residual_angular);
  }
}

std::vector<Scene> Scenes() {
  std::vector<Scene> scenes = {test::Tower(8), test::HangingChain(10, 100), test::Plate(24)};
  for (std::uint64_t seed = 1; seed <= 2; ++seed) {
    scenes.push_back(test::Heap({.bodies = 20, .contacts = 45, .pins = 10}, seed));
  }
  return scenes;
}

/// As they come, but for how many there may be.
Settings Sweeps() {
  Settings settings;
  settings.max_sweeps = 60;
  return settings;
}

class Units : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Every, Units, testing::Values(0.0078125, 2, 128));

TEST_P(Units, DoNotChangeWhatComesOut) {
  for (const Scene& scene : Scenes()) ExpectTheSameInUnits(scene, Sweeps(), GetParam());
}

TEST_P(Units, DoNotChangeWhichStepsAreTaken) {
  Settings weighed, always = test::ColouredSteps(40);
  weighed.step_policy = StepPolicy::kWeighed;
  weighed.max_sweeps = 10;
  always.tolerance = 1e-5;
  Settings work;
  work.budget = Budget::Work(50'000);
  for (const Settings& settings : {weighed, always, work}) {
    for (const Scene& scene : Scenes()) ExpectTheSameInUnits(scene, settings, GetParam());
  }
}

TEST_P(Units, DoNotChangeWhatComesOutInDoublePrecision) {
  Settings settings;
  settings.path = Path::kReference;
  settings.max_sweeps = 40;
  for (const Scene& scene : Scenes()) ExpectTheSameInUnits(scene, settings, GetParam());
}

TEST(UnitsPerMetre, HaveARange) {
  for (const double unit : {-1.0, 1e-7, 1e7, kInfinity}) {
    Settings settings;
    settings.tuning.units_per_metre = unit;
    EXPECT_STREQ(FindBadSetting(settings).name, "tuning.units_per_metre") << unit;
  }
}

TEST(UnitsPerMetre, ScaleWhatIsQuiet) {
  Scene scene = test::Tower(2);
  for (Body& body : scene.bodies) body.velocity.linear = {0.2, 0, 0};
  Settings settings;
  EXPECT_EQ(test::Solve(settings, scene).report.islands[0].quiet, 0);
  settings.tuning.units_per_metre = 100;
  EXPECT_GT(test::Solve(settings, scene).report.islands[0].quiet, 0);
}

}  // namespace
}  // namespace cairn
