// SPDX-License-Identifier: MIT
// The interface of C gives the bits of that of C++, and the same reports.
#include <gtest/gtest.h>

#include <cstring>
#include <span>
#include <vector>

#include "cairn/cairn_doubles.h"
#include "tests/c/c_problems.h"

namespace cairn {
namespace {

using test::ManifoldScene;

struct Solver2 {
  explicit Solver2(const CairnSettings& settings) {
    EXPECT_EQ(cairnCreateSolver(cairnLayout(), &settings, &solver), cairnOk);
  }
  ~Solver2() { cairnDestroySolver(solver); }
  Solver2(const Solver2&) = delete;
  Solver2& operator=(const Solver2&) = delete;

  CairnSolver* solver = nullptr;
};

template <class Item>
bool SameBytes(const std::vector<Item>& a, const std::vector<Item>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(Item)) == 0;
}

/// Three frames, each from the impulses of the last.
void ExpectSameBits(ManifoldScene scene, const Settings& settings,
                    const CairnSettings& c_settings) {
  test::CScene rounded = test::ToC(&scene);
  ManifoldScene copy = scene;
  test::CScene c = test::ToC(&copy);
  ASSERT_TRUE(SameBytes(rounded.bodies, c.bodies));
  Solver solver(settings);
  Solver2 c_solver(c_settings);
  std::vector<Velocity> velocities(scene.bodies.size());
  for (int frame = 0; frame < 3; ++frame) {
    const Report report = solver.Solve(scene.problem(), scene.impulses(), velocities);
    CairnReport c_report;
    ASSERT_TRUE(report.ok()) << Describe(report);
    ASSERT_EQ(cairnSolve(c_solver.solver, &c.problem, &c.solution, &c_report), cairnOk);
    EXPECT_TRUE(test::SameBits(scene.point_impulses, copy.point_impulses));
    EXPECT_TRUE(SameBytes(scene.joint_impulses, copy.joint_impulses));
    EXPECT_TRUE(SameBytes(scene.twist_impulses, copy.twist_impulses));
    for (size_t i = 0; i < velocities.size(); ++i) {
      for (int k = 0; k < 3; ++k) {
        EXPECT_EQ(static_cast<float>(velocities[i].linear[k]), c.velocities[i].linear[k]);
        EXPECT_EQ(static_cast<float>(velocities[i].angular[k]), c.velocities[i].angular[k]);
      }
    }
    EXPECT_EQ(report.residual_max, c_report.residualMax);
    EXPECT_EQ(report.sweeps, c_report.sweeps);
    EXPECT_EQ(report.factorisations, c_report.factorisations);
    EXPECT_EQ(report.work, c_report.work);
    EXPECT_EQ(static_cast<int>(report.islands.size()), c_report.islandCount);
  }
}

TEST(CInterface, GivesTheBitsOfCpp) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    ManifoldScene scene = test::RollingManifolds(30, 60, seed);
    test::AddJoints(10, seed, &scene);
    scene.motions.clear();  // this, and the law of hosts like Bullet, C does not know
    scene.law.host = {};
    ExpectSameBits(scene, {}, cairnDefaultSettings());
  }
}

CairnBodyD Copy(const Body& from) {
  CairnBodyD to = cairnDefaultBodyD();
  to.invMass = from.inv_mass;
  for (int k = 0; k < 9; ++k) to.invInertia[k] = from.inv_inertia(k / 3, k % 3);
  for (int k = 0; k < 3; ++k) {
    to.linearFactor[k] = from.linear_factor[k];
    to.velocity.linear[k] = from.velocity.linear[k];
    to.velocity.angular[k] = from.velocity.angular[k];
    to.impulse[k] = from.impulse[k];
    to.angularImpulse[k] = from.angular_impulse[k];
  }
  to.id = from.id;
  return to;
}

void ExpectSame(std::span<const Velocity> expected, const std::vector<CairnVelocityD>& got) {
  ASSERT_EQ(expected.size(), got.size());
  for (size_t i = 0; i < got.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      EXPECT_EQ(expected[i].linear[k], got[i].linear[k]) << "body " << i;
      EXPECT_EQ(expected[i].angular[k], got[i].angular[k]) << "body " << i;
    }
  }
}

// Numbers of bodies that no float holds go in and come out as they are.
TEST(CInterface, GivesTheBitsOfCppInDoubles) {
  for (const int substeps : {1, 2}) {
    ManifoldScene scene = test::RollingManifolds(30, 60, 5);
    test::AddJoints(10, 5, &scene);
    scene.motions.clear();
    scene.law.host = {};
    ManifoldScene copy = scene;
    std::vector<CairnBodyD> bodies;
    for (const Body& body : scene.bodies) bodies.push_back(Copy(body));
    const test::CScene c = test::ToC(&copy);
    CairnProblem problem = c.problem;
    problem.bodies = nullptr;
    CairnSolution solution = c.solution;
    solution.velocities = nullptr;

    CairnSettings settings = cairnDefaultSettings();
    settings.substeps = substeps;
    const Solver2 c_solver(settings);
    Solver solver({.substeps = substeps});
    std::vector<Velocity> velocities(scene.bodies.size());
    std::vector<CairnVelocityD> got(velocities.size());
    ASSERT_TRUE(solver.Solve(scene.problem(), scene.impulses(), velocities).ok());
    ASSERT_EQ(cairnSolveD(c_solver.solver, &problem, bodies.data(), &solution, got.data(), nullptr),
              cairnOk);
    ExpectSame(velocities, got);
    EXPECT_TRUE(test::SameBits(scene.point_impulses, copy.point_impulses));

    const int count = static_cast<int>(got.size());
    ASSERT_EQ(cairnMeanVelocitiesD(c_solver.solver, got.data(), count), cairnOk);
    ExpectSame(substeps == 1 ? std::span<const Velocity>(velocities) : solver.mean_velocities(),
               got);
  }
}

TEST(CInterface, NamesWhatIsMissingInDoubles) {
  const Solver2 solver(cairnDefaultSettings());
  CairnProblem problem = cairnDefaultProblem();
  const CairnSolution solution = {};
  const CairnBodyD body = cairnDefaultBodyD();
  CairnVelocityD velocity;
  EXPECT_EQ(cairnSolveD(nullptr, &problem, &body, &solution, &velocity, nullptr), cairnNullPointer);
  EXPECT_EQ(cairnMeanVelocitiesD(solver.solver, nullptr, 1), cairnNullPointer);
  problem.bodyCount = 1;
  CairnReport report;
  EXPECT_EQ(cairnSolveD(solver.solver, &problem, nullptr, &solution, &velocity, &report),
            cairnNullPointer);
  EXPECT_EQ(report.status, cairnNullPointer);
  EXPECT_EQ(cairnSolveD(solver.solver, &problem, &body, &solution, nullptr, nullptr),
            cairnNullPointer);
  EXPECT_EQ(cairnSolveD(solver.solver, &problem, &body, &solution, &velocity, nullptr), cairnOk);
  EXPECT_EQ(cairnMeanVelocitiesD(solver.solver, &velocity, 2), cairnWrongSize);
}

TEST(CInterface, PassesEverySettingOn) {
  Settings settings{.method = Method::kPgs,
                    .path = Path::kReference,
                    .k_gs = 3,
                    .k_sm = 1,
                    .steps = false,
                    .max_sweeps = 17,
                    .tolerance = 0,
                    .budget = Budget::Work(5000),
                    .threads = 2};
  settings.tuning.min_sweeps = 2;
  CairnSettings c = cairnDefaultSettings();
  c.method = cairnPgs;
  c.path = cairnReference;
  c.kGs = 3;
  c.kSm = 1;
  c.steps = false;
  c.maxSweeps = 17;
  c.tolerance = 0;
  c.budgetKind = cairnWork;
  c.budget = 5000;
  c.threads = 2;
  c.minSweeps = 2;
  ExpectSameBits(test::ManifoldTower(12), settings, c);
  settings.method = Method::kPgsSm;
  settings.path = Path::kAuto;
  settings.substeps = c.substeps = 2;
  c.method = cairnPgsSm;
  c.path = cairnAuto;
  ExpectSameBits(test::ManifoldTower(12), settings, c);
}

// A link of 1 kg that carries a ton, by three rows to the world and three to the load.
TEST(CInterface, RaisesTheInertiaOfWhatPullsTooHard) {
  Joint joints[2] = {{.body_a = 0, .rows = 3},
                     {.body_a = 0, .body_b = 1, .first_row = 3, .rows = 3}};
  JointRow rows[6];
  for (int k = 0; k < 3; ++k) {
    rows[k].linear_a[k] = rows[3 + k].linear_a[k] = 1;
    rows[3 + k].linear_b[k] = -1;
  }
  // arms of 0.5 m up, and down: y x x = -z, y x z = x
  rows[0].angular_a[2] = rows[5].angular_a[0] = -0.5f;
  rows[2].angular_a[0] = rows[3].angular_a[2] = 0.5f;
  test::ManifoldScene scene;
  scene.bodies = {{.inv_mass = 1, .inv_inertia = Matrix3::Diagonal(10, 10, 10), .id = 1},
                  {.inv_mass = 1e-3, .inv_inertia = Matrix3::Diagonal(1e-3, 1e-3, 1e-3), .id = 2}};
  scene.bodies[0].impulse = {0.01, -9.81 / 60, 0};
  scene.bodies[1].impulse = {0, -9810 / 60.0, 0};
  scene.joints.assign(joints, joints + 2);
  scene.joint_rows.assign(rows, rows + 6);
  scene.joint_impulses.assign(6, 0);
  float spins[2];
  for (const bool stiff : {false, true}) {
    test::ManifoldScene copy = scene;
    test::CScene c = test::ToC(&copy);
    c.problem.timeStep = 1 / 60.0f;
    CairnSettings settings = cairnDefaultSettings();
    settings.geometricStiffness = stiff;
    const Solver2 solver(settings);
    for (int step = 0; step < 2; ++step) {
      ASSERT_EQ(cairnSolve(solver.solver, &c.problem, &c.solution, nullptr), cairnOk);
    }
    spins[stiff ? 1 : 0] = c.solution.velocities[0].angular[2];
  }
  EXPECT_NE(spins[0], 0);
  EXPECT_LT(std::abs(spins[1]), 0.9f * std::abs(spins[0]));
}

TEST(CInterface, HasTheDefaultsOfCpp) {
  const Body body;
  const CairnBody c = cairnDefaultBody();
  EXPECT_EQ(c.invMass, body.inv_mass);
  for (int k = 0; k < 3; ++k) EXPECT_EQ(c.linearFactor[k], body.linear_factor[k]);
  EXPECT_EQ(c.id, body.id);
  const JointRow row;
  EXPECT_EQ(cairnDefaultJointRow().lo, row.lo);
  EXPECT_EQ(cairnDefaultJointRow().hi, row.hi);
  EXPECT_EQ(cairnDefaultContactPoint().friction, ContactPoint{}.friction);
  EXPECT_EQ(cairnDefaultManifold().tangents, Manifold{}.tangents);
  EXPECT_EQ(cairnDefaultJoint().damping, Joint{}.damping);
  EXPECT_EQ(cairnDefaultSettings().tolerance, Settings{}.tolerance);
  EXPECT_EQ(cairnDefaultSettings().geometricStiffness, Settings{}.geometric_stiffness);
}

TEST(CInterface, HasTheVersionOfTheProject) {
  const std::uint32_t version = cairnVersion();
  const std::string text = std::to_string(version >> 16) + "." +
                           std::to_string(version >> 8 & 255) + "." + std::to_string(version & 255);
  EXPECT_EQ(text, CAIRN_PROJECT_VERSION);
}

}  // namespace
}  // namespace cairn
