// SPDX-License-Identifier: MIT
// Problems on their way into blocks and back: the numbers of every row, what makes a plan stale,
// and what does not fit a float.
#include "pack/block_pack.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "cairn/detail/eigen.h"
#include "pack/block_frame.h"
#include "tests/core/support/block_problems.h"

namespace cairn {
namespace {

using simd::RowBound;
using simd::RowShape;
using test::Scene;

/// A float is off by this share at most.
constexpr double kFloat = 0x1p-24;

struct Laid {
  BlockFrame frame;
  Crew crew{1};

  PackResult Begin(const Scene& scene, std::vector<double> start = {}, double omega = 1) {
    start.resize(scene.rows.size());
    return frame.Begin(scene.problem(), omega, {.rows = start}, &crew);
  }
};

Scene MixedScene(std::uint64_t seed) {
  Scene scene = test::Heap({.bodies = 30, .contacts = 60, .pins = 15, .world_share = 0.3}, seed);
  scene.bodies[2].linear_factor = {1, 0, 0.5};
  scene.bodies[4] = Body{};
  scene.bodies[5].inv_mass = 0;
  for (Body& body : scene.bodies) body.angular_impulse = {0.1, -0.2, 0.05};
  return test::WithEveryLaw(scene, seed);
}

std::vector<double> RandomStart(const Scene& scene, std::uint64_t seed) {
  test::Random random(seed);
  std::vector<double> start(scene.rows.size());
  for (double& x : start) x = random.Uniform(-0.5, 1);
  return start;
}

/// One side of a row: J M^-1 J', what the body's velocity without constraints gives, and what locks
/// deny.
struct Side {
  double inertia = 0, velocity = 0, size = 0, denied = 0;
};

Side SideOf(const Scene& scene, int body, const Eigen::Vector3d& linear,
            const Eigen::Vector3d& angular) {
  if (body == kWorld) return {};
  const Body& b = scene.bodies[body];
  const Eigen::Vector3d inv_mass = b.inv_mass * View(b.linear_factor);
  const Eigen::Vector3d v = View(b.velocity.linear) + inv_mass.cwiseProduct(View(b.impulse));
  const Eigen::Vector3d turn =
      View(b.velocity.angular) + View(b.inv_inertia) * View(b.angular_impulse);
  return {linear.dot(inv_mass.cwiseProduct(linear)) + angular.dot(View(b.inv_inertia) * angular),
          linear.dot(v) + angular.dot(turn),
          linear.norm() * v.norm() + angular.norm() * turn.norm(), test::DeniedByLocks(b, linear)};
}

/// The lines of a row behind its Jacobian, and its impulse.
struct RowReader {
  const simd::Line* line;
  int lane;
  double Next() { return static_cast<double>((line++)->lane[lane]); }
};

void ExpectNumbers(const Scene& scene, int index, const RowShape& shape, double omega,
                   RowReader read) {
  const Row& row = scene.rows[index];
  const Side a = SideOf(scene, row.body_a, row.linear_a, row.angular_a);
  const Side b = SideOf(scene, row.body_b, row.linear_b, row.angular_b);
  const double d = a.inertia + b.inertia + row.compliance;
  if (d == 0) return;
  const double target = row.target - a.velocity - b.velocity;
  // computed in double, rounded once
  EXPECT_NEAR(read.Next(), target, kFloat * std::abs(target) + 1e-13 * (a.size + b.size + 1));
  const double step = omega * row.relaxation / (d + a.denied + b.denied);
  // where locks change it, of a G of floats
  const double roundings = a.denied + b.denied > 0 ? 3 : 1.001;
  EXPECT_NEAR(read.Next(), step, roundings * kFloat * step);
  EXPECT_EQ(shape.soft, row.compliance > 0);
  if (shape.soft) {
    EXPECT_EQ(read.Next(), static_cast<double>(static_cast<float>(row.compliance)));
  }
  if (shape.relaxed) {
    EXPECT_NEAR(read.Next(), omega * row.relaxation, 2 * kFloat);
  }
  if (shape.parent >= 0) {
    EXPECT_EQ(read.Next(), static_cast<double>(static_cast<float>(row.friction)));
  }
  if (simd::BoundLines(shape.bound) < 2) return;
  EXPECT_EQ(read.Next(), static_cast<double>(static_cast<float>(row.lo)));
  EXPECT_EQ(read.Next(), static_cast<double>(static_cast<float>(row.hi)));
}

TEST(BlockPack, PutsTheNumbersOfEveryRowIntoItsLane) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const Scene scene = MixedScene(seed);
    for (const double omega : {1.0, 1.3}) {
      Laid laid;
      ASSERT_EQ(laid.Begin(scene, {}, omega), PackResult::kDone);
      const Plan& plan = laid.frame.plan();
      for (int b = 0; b < static_cast<int>(plan.blocks().size()); ++b) {
        const simd::PairBlock& block = plan.blocks()[b];
        for (int lane = 0; lane < block.lanes; ++lane) {
          const auto rows = plan.rows_of(plan.pair(b, lane));
          const simd::Line* line = &laid.frame.blocks().data[block.data];
          line += simd::PairLines(block.form);
          for (int i = 0; i < block.row_count; ++i) {
            const RowShape& shape = block.rows[i];
            const RowReader reader{line + simd::JacobianLines(block.form), lane};
            ExpectNumbers(scene, rows[i], shape, omega, reader);
            line += simd::RowLines(block.form, shape);
          }
        }
      }
    }
  }
}

/// The start inside its bounds, parents first.
std::vector<double> Projected(const Scene& scene, std::vector<double> x) {
  for (size_t i = 0; i < x.size(); ++i) {
    const Row& row = scene.rows[i];
    double lo = row.lo, hi = row.hi;
    if (row.parent != kNoRow) {
      lo = std::max(lo, -row.friction * std::max(0.0, x[row.parent]));
      hi = std::min(hi, row.friction * std::max(0.0, x[row.parent]));
    }
    x[i] = std::min(std::max(x[i], lo), hi);
  }
  return x;
}

// Up to some 60 rows act on a body: so many roundings of at most its velocity.
TEST(BlockPack, AndBackGivesTheProjectedStartAndItsVelocities) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const Scene scene = MixedScene(seed);
    const std::vector<double> start = RandomStart(scene, seed), expected = Projected(scene, start);
    Laid laid;
    ASSERT_EQ(laid.Begin(scene, start), PackResult::kDone);
    std::vector<double> impulses(start.size());
    std::vector<Velocity> velocities(scene.bodies.size());
    laid.frame.End(scene.problem(), &laid.crew, {.rows = impulses}, velocities);
    for (size_t i = 0; i < start.size(); ++i) EXPECT_NEAR(impulses[i], expected[i], 2 * kFloat);

    std::vector<Velocity> by_hand;
    for (const Body& body : scene.bodies) by_hand.push_back(body.velocity);
    double most = 1;
    for (size_t i = 0; i < scene.bodies.size(); ++i) {
      const Body& body = scene.bodies[i];
      Eigen::Vector3d push = body.impulse, turn = body.angular_impulse;
      for (size_t k = 0; k < scene.rows.size(); ++k) {
        const Row& row = scene.rows[k];
        const bool is_a = row.body_a == static_cast<int>(i),
                   is_b = row.body_b == static_cast<int>(i);
        if (is_a)
          push += expected[k] * View(row.linear_a), turn += expected[k] * View(row.angular_a);
        if (is_b)
          push += expected[k] * View(row.linear_b), turn += expected[k] * View(row.angular_b);
      }
      View(by_hand[i].linear) += body.inv_mass * View(body.linear_factor).cwiseProduct(push);
      View(by_hand[i].angular) += View(body.inv_inertia) * turn;
      most = std::max({most, View(by_hand[i].linear).norm(), View(by_hand[i].angular).norm()});
    }
    EXPECT_LT(test::Distance(velocities, by_hand), 60 * kFloat * most);
  }
}

TEST(BlockFrame, KeepsThePlanWhileOnlyNumbersChange) {
  Scene scene = MixedScene(3);
  Laid laid;
  ASSERT_EQ(laid.Begin(scene), PackResult::kDone);
  test::Random random(1);
  for (int frame = 0; frame < 5; ++frame) {
    for (Body& body : scene.bodies) View(body.velocity.linear) += random.Vector(0.1);
    for (Row& row : scene.rows) {
      row.target += 0.01;
      row.friction *= 1.01;
      View(row.linear_a) *= 1.01;
      View(row.linear_b) *= 1.01;
      View(row.angular_a) += random.Vector(0.01);
      if (row.compliance > 0) row.compliance *= 1.1;
      if (row.lo == -0.05) row.hi *= 1.01;
    }
    ASSERT_EQ(laid.Begin(scene, RandomStart(scene, 1)), PackResult::kDone);
    EXPECT_EQ(laid.frame.plan_number(), 1);
  }
}

/// What a frame may change about a tower of three boxes, rows of which are n f f of four points.
struct Change {
  std::string what;
  std::function<void(Scene*)> make;
};

TEST(BlockFrame, PlansAgainWhenTheStructureChanges) {
  const std::vector<Change> changes = {
      {"one row less", [](Scene* s) { s->rows.pop_back(); }},
      {"one row more",
       [](Scene* s) {
         s->rows.push_back(test::PushRow(0, 2, {0, 0, 1}));
       }},
      {"another body",
       [](Scene* s) {
         for (int i = 12; i < 24; ++i) s->rows[i].body_b = 2;
       }},
      {"the world instead",
       [](Scene* s) {
         for (int i = 12; i < 24; ++i) s->rows[i].body_b = -1;
       }},
      {"another parent", [](Scene* s) { s->rows[11].parent = 6; }},
      {"no parent", [](Scene* s) { s->rows[11].parent = kNoRow; }},
      {"a bound more", [](Scene* s) { s->rows[0].hi = 3; }},
      {"a bound less", [](Scene* s) { s->rows[0].lo = -kInfinity; }},
      {"soft", [](Scene* s) { s->rows[4].compliance = 0.1; }},
      {"relaxed", [](Scene* s) { s->rows[4].relaxation = 0.9; }},
      {"sweeps", [](Scene* s) { s->rows[4].host.max_sweeps = 9; }},
      {"angular",
       [](Scene* s) {
         s->rows[4].linear_a = s->rows[4].linear_b = {0, 0, 0};
       }},
      {"no longer opposite", [](Scene* s) { View(s->rows[16].linear_b) *= 2; }},
      {"no longer movable", [](Scene* s) { s->bodies[1] = Body{}; }},
      {"one body more", [](Scene* s) { s->bodies.push_back(s->bodies[0]); }},
  };
  for (const Change& change : changes) {
    SCOPED_TRACE(change.what);
    Scene scene = test::Tower(3);
    Laid laid;
    ASSERT_EQ(laid.Begin(scene), PackResult::kDone);
    change.make(&scene);
    ASSERT_EQ(laid.Begin(scene), PackResult::kDone);
    EXPECT_EQ(laid.frame.plan_number(), 2);
    ASSERT_EQ(laid.Begin(scene), PackResult::kDone);
    EXPECT_EQ(laid.frame.plan_number(), 2);
  }
}

// The form of contacts has one mass for all axes, and divides by the sum of both.
TEST(BlockFrame, PlansAgainWhenABodyOfAContactLocksAnAxis) {
  Scene scene = test::Tower(3);
  Laid laid;
  ASSERT_EQ(laid.Begin(scene), PackResult::kDone);
  scene.bodies[1].linear_factor.x() = 0;
  ASSERT_EQ(laid.Begin(scene), PackResult::kDone);
  const Plan& plan = laid.frame.plan();
  for (int b = 0; b < static_cast<int>(plan.blocks().size()); ++b) {
    if (plan.pair(b, 0).b == kWorld) continue;
    EXPECT_EQ(plan.blocks()[b].form, simd::PairForm::kJoint);
  }
}

/// Of a tower that is new, and of one that was laid out before.
void ExpectEach(const std::vector<Change>& changes, PackResult expected) {
  for (const Change& change : changes) {
    for (const bool steady : {false, true}) {
      Scene scene = test::Tower(3);
      Laid laid;
      if (steady) {
        ASSERT_EQ(laid.Begin(scene), PackResult::kDone);
      }
      change.make(&scene);
      EXPECT_EQ(laid.Begin(scene), expected) << change.what << steady;
    }
  }
}

TEST(BlockFrame, SaysWhatIsNotValid) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<Change> changes = {
      {"no such body", [](Scene* s) { s->rows[13].body_a = 99; }},
      {"negative compliance", [](Scene* s) { s->rows[13].compliance = -1; }},
      {"no bounds", [nan](Scene* s) { s->rows[12].lo = nan; }},
  };
  ExpectEach(changes, PackResult::kInvalid);
}

TEST(BlockFrame, SaysWhatDoesNotFitAFloat) {
  const std::vector<Change> changes = {
      {"target", [](Scene* s) { s->rows[13].target = 1e25; }},
      {"light", [](Scene* s) { s->bodies[1].inv_mass = 1e30; }},
      {"heavy",
       [](Scene* s) {
         for (Body& b : s->bodies) b.inv_mass = 1e-30, View(b.inv_inertia) *= 1e-30;
       }},
      {"fast", [](Scene* s) { s->bodies[1].velocity.linear.z() = -1e20; }},
      {"soft", [](Scene* s) { s->rows[13].compliance = 1e20; }},
  };
  ExpectEach(changes, PackResult::kOutOfRange);
}

}  // namespace
}  // namespace cairn
