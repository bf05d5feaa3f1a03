// SPDX-License-Identifier: MIT
// Rows whose impulses, velocities and errors are known by hand, on every target. Lane l has the
// numbers of the first lane times l + 1: the problems are homogeneous, and a lane that reads those
// of another one is seen. All numbers are exact in float.
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <cmath>

#include "pair_blocks.h"
#include "simd/pairs/pair_sweep.h"

namespace cairn::simd {
namespace {

using test::PairScene;
using test::RowView;
using test::ZeroScene;

class PairRowsOf : public testing::TestWithParam<Target> {
 protected:
  const PairKernels& kernels() const { return PairKernelsFor(GetParam()); }
};

std::string NameOf(const testing::TestParamInfo<Target>& target) {
  return std::string(TargetName(target.param));
}

INSTANTIATE_TEST_SUITE_P(Every, PairRowsOf, testing::ValuesIn(SupportedTargets()), NameOf);

constexpr RowShape kNormal = {.bound = RowBound::kPush};
constexpr RowShape kFriction = {.bound = RowBound::kFriction, .parent = 0};

void SetLine(Line* line, float value) {
  for (float& number : line->lane) number = value;
}
void SetScaled(Line* line, float first) {
  for (int lane = 0; lane < kLanes; ++lane) line->lane[lane] = static_cast<float>(lane + 1) * first;
}

/// Bodies of unit mass and inertia against the world: row i acts along axis i (0 to 2 linear, 3 to
/// 5 angular), so that d = 1.
PairScene Ball(const std::vector<RowShape>& rows, const std::vector<int>& axes) {
  PairScene scene = ZeroScene({.blocks = {{PairForm::kSingle, rows}}});
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const RowView view = scene.View(0, static_cast<int>(i));
    SetLine(&view.g[axes[i]], 1);
    SetLine(view.step, 1);
  }
  return scene;
}

void Move(int part, float first, PairScene* scene) {
  for (int lane = 0; lane < kLanes; ++lane) {
    scene->BodyA(0, lane).u[part] = static_cast<float>(lane + 1) * first;
  }
}

void ExpectX(PairScene* scene, int row, float first) {
  for (int lane = 0; lane < kLanes; ++lane) {
    EXPECT_EQ(scene->X(0, row, lane), static_cast<float>(lane + 1) * first) << lane;
  }
}
void ExpectMove(PairScene* scene, int part, float first) {
  for (int lane = 0; lane < kLanes; ++lane) {
    EXPECT_EQ(scene->BodyA(0, lane).u[part], static_cast<float>(lane + 1) * first) << lane;
  }
}

TEST_P(PairRowsOf, OneContactCarriesAUnitWeightInOneSweep) {
  PairScene scene = Ball({kNormal}, {1});
  Move(1, -1, &scene);
  scene.Run(kernels().sweep);
  ExpectX(&scene, 0, 1);
  ExpectMove(&scene, 1, 0);
}

/// Four lanes that push one ball of unit mass along x; each sees a quarter of it, so that G is 2.
PairScene SharedBall() {
  PairScene scene = ZeroScene({.blocks = {{PairForm::kSingle, {kNormal}, 4}}});
  const RowView view = scene.View(0, 0);
  SetLine(&view.g[0], 2);
  SetLine(view.step, 0.25f);
  for (int lane = 0; lane < 4; ++lane) {
    scene.blocks[0].a[lane] = static_cast<int>(scene.bodies.size());
    scene.copies.push_back({1, ShareOfBody(4)});
    scene.bodies.push_back({});
  }
  scene.blocks[0].copies = scene.runs[0].copies = true;
  scene.d_ratios.resize(1);
  SetLine(&scene.d_ratios[0], 4);
  return scene;
}

// Each stops its quarter, all of them the ball.
TEST_P(PairRowsOf, LanesThatShareABodyMoveItTogether) {
  PairScene scene = SharedBall();
  scene.bodies[1].u[0] = -8;
  scene.Run(kernels().sweep);
  for (int lane = 0; lane < 4; ++lane) EXPECT_EQ(scene.X(0, 0, lane), 2) << lane;
  EXPECT_EQ(scene.bodies[1].u[0], 0);
}

// What is asked for by one alone is a quarter done in a sweep.
TEST_P(PairRowsOf, OneOfTheLanesThatShareABodyMovesItByItsShare) {
  PairScene scene = SharedBall();
  scene.View(0, 0).target->lane[2] = 8;
  scene.Run(kernels().sweep);
  EXPECT_EQ(scene.X(0, 0, 2), 2);
  EXPECT_EQ(scene.bodies[1].u[0], 2);
  // as the whole ball has it, d = 1: an impulse of 1 may give way by 1
  scene.X(0, 0, 1) = 1;
  scene.Run(kernels().measure);
  EXPECT_EQ(scene.errors[0].max.lane[2], 6);
  EXPECT_EQ(scene.errors[0].energy.lane[2], 36);
  EXPECT_EQ(scene.errors[0].max.lane[1], 1);
}

TEST_P(PairRowsOf, SharedBodiesStartFromAllImpulses) {
  PairScene scene = SharedBall();
  for (int lane = 0; lane < 4; ++lane) scene.X(0, 0, lane) = static_cast<float>(lane);
  scene.Run(kernels().start);
  EXPECT_EQ(scene.bodies[1].u[0], 6);
}

TEST_P(PairRowsOf, AContactDoesNotPull) {
  PairScene scene = Ball({kNormal}, {1});
  Move(1, 1, &scene);
  SetScaled(&scene.x[scene.blocks[0].x], 0.25f);
  scene.Run(kernels().sweep);
  ExpectX(&scene, 0, 0);
  ExpectMove(&scene, 1, 0.75f);
}

TEST_P(PairRowsOf, RowsOfEveryFormStopTwoBodiesThatMeet) {
  // unit masses at -1 and +1: w = -2, d = 2, and an impulse of 1 stops both
  const float c = std::sqrt(0.5f), r = std::sqrt(2.0f);
  for (const PairForm form : {PairForm::kJoint, PairForm::kContact}) {
    const bool contact = form == PairForm::kContact;
    PairScene scene = ZeroScene({.blocks = {{form, {kNormal}}}});
    const RowView view = scene.View(0, 0);
    SetLine(&view.g[1], contact ? r : 1);
    if (!contact) SetLine(&view.g[7], -1);
    for (int i = 0; contact && i < 2; ++i) SetLine(scene.PairOf(0) + i, c);
    SetLine(view.step, 0.5f);
    Move(1, -1, &scene);
    for (int lane = 0; lane < kLanes; ++lane) {
      scene.BodyB(0, lane).u[1] = -scene.BodyA(0, lane).u[1];
    }
    scene.Run(kernels().sweep);
    // c and r are rounded
    const float tolerance = contact ? 4e-7f : 0;
    for (int lane = 0; lane < kLanes; ++lane) {
      const auto weight = static_cast<float>(lane + 1);
      EXPECT_NEAR(scene.X(0, 0, lane), weight, weight * tolerance);
      EXPECT_NEAR(scene.BodyA(0, lane).u[1], 0, weight * tolerance);
      EXPECT_NEAR(scene.BodyB(0, lane).u[1], 0, weight * tolerance);
    }
  }
}

TEST_P(PairRowsOf, FrictionIsCutToItsShareOfTheParent) {
  // the weight is carried by 1, so half of it is all that friction has against a velocity of 2
  PairScene scene = Ball({kNormal, kFriction}, {1, 0});
  SetLine(scene.View(0, 1).bounds, 0.5f);
  Move(1, -1, &scene);
  Move(0, 2, &scene);
  scene.Run(kernels().sweep);
  ExpectX(&scene, 0, 1);
  ExpectX(&scene, 1, -0.5f);
  ExpectMove(&scene, 0, 1.5f);
}

TEST_P(PairRowsOf, FrictionIsCutToItsOwnBoundsToo) {
  RowShape cut = kFriction;
  cut.bound = RowBound::kCutFriction;
  // at velocities of +2 and -2 the impulses would be -1 and 1; -0.25 and 0.75 are the bounds
  for (const float sign : {1.0f, -1.0f}) {
    PairScene scene = Ball({kNormal, cut}, {1, 0});
    SetLine(scene.View(0, 1).bounds, 1);
    SetScaled(scene.View(0, 1).bounds + 1, -0.25f);
    SetScaled(scene.View(0, 1).bounds + 2, 0.75f);
    Move(1, -1, &scene);
    Move(0, 2 * sign, &scene);
    scene.Run(kernels().sweep);
    ExpectX(&scene, 1, sign > 0 ? -0.25f : 0.75f);
  }
}

TEST_P(PairRowsOf, ALiftedContactDropsItsFrictionUnlessHeld) {
  PairScene scene = Ball({kNormal, kFriction}, {1, 0});
  SetLine(scene.View(0, 1).bounds, 0.5f);
  SetScaled(&scene.x[scene.blocks[0].x + 1], 0.25f);
  Move(1, 1, &scene);
  Move(0, 0.25f, &scene);
  PairScene held = scene;
  held.hold_lifted = true;

  scene.Run(kernels().sweep);
  ExpectX(&scene, 1, 0);
  ExpectMove(&scene, 0, 0);
  held.Run(kernels().sweep);
  ExpectX(&held, 1, 0.25f);
  ExpectMove(&held, 0, 0.25f);

  // errors see the law of friction, whoever holds it
  held.Run(kernels().measure);
  for (int lane = 0; lane < kLanes; ++lane) {
    EXPECT_EQ(held.errors[0].max.lane[lane], static_cast<float>(lane + 1) * 0.25f);
  }
}

TEST_P(PairRowsOf, ARowRestsAfterItsSweeps) {
  RowShape row = kNormal;
  row.max_sweeps = 2;
  PairScene scene = Ball({row}, {1});
  for (scene.sweep = 0; scene.sweep < 4; ++scene.sweep) {
    Move(1, -1, &scene);
    scene.Run(scene.sweep % 2 ? kernels().measured_sweep : kernels().sweep);
    const bool rests = scene.sweep >= 2;
    ExpectX(&scene, 0, rests ? 2 : static_cast<float>(scene.sweep + 1));
    ExpectMove(&scene, 1, rests ? -1 : 0);
  }

  // it still counts: as an impulse to start from, and in the errors
  scene.Run(kernels().measure);
  for (int lane = 0; lane < kLanes; ++lane) {
    EXPECT_EQ(scene.errors[0].max.lane[lane], static_cast<float>(lane + 1));
  }
  scene.Run(kernels().start);
  ExpectMove(&scene, 1, 1);
}

TEST_P(PairRowsOf, ASoftRowGivesWay) {
  // x = -(G u + x - target) / 2 + x with compliance 1, d = 2
  PairScene scene = Ball({{.soft = true}}, {2});
  SetLine(scene.View(0, 0).compliance, 1);
  SetLine(scene.View(0, 0).step, 0.5f);
  SetScaled(scene.View(0, 0).target, 3);
  SetScaled(&scene.x[scene.blocks[0].x], 2);
  scene.Run(kernels().sweep);
  ExpectX(&scene, 0, 2.5f);
  ExpectMove(&scene, 2, 0.5f);
}

TEST_P(PairRowsOf, ErrorsAreNaturalResidualsWhateverTheRelaxation) {
  // row 0: G = 2, d = 4, x = 1, u_x = 2.5, target -1: w = 6, x - w / d < 0 is cut to 0, so that
  //        e = 4 |1 - 0| = 4, energy 16 / 4; relaxation 1.5 would have reached further
  // row 1: angular, d = 1, w = u = -3: e = 3, energy 9
  // row 2: angular, d = 1, w = u = 2: e = 2, energy 4
  PairScene scene = Ball({{.bound = RowBound::kPush, .relaxed = true},
                          {.relaxed = true, .angular = true},
                          {.angular = true}},
                         {0, 3, 5});
  SetLine(&scene.View(0, 0).g[0], 2);
  SetLine(scene.View(0, 0).relaxation, 1.5f);
  SetLine(scene.View(0, 0).step, 1.5f / 4);
  SetLine(scene.View(0, 1).relaxation, 0.5f);
  SetLine(scene.View(0, 1).step, 0.5f);
  SetScaled(scene.View(0, 0).target, -1);
  SetScaled(&scene.x[scene.blocks[0].x], 1);
  Move(0, 2.5f, &scene);
  Move(4, -3, &scene);
  Move(6, 2, &scene);

  scene.Run(kernels().measure);
  for (int lane = 0; lane < kLanes; ++lane) {
    const float scale = static_cast<float>(lane + 1);
    EXPECT_EQ(scene.errors[0].max.lane[lane], 4 * scale);
    EXPECT_EQ(scene.errors[0].max_angular.lane[lane], 3 * scale);
    EXPECT_EQ(scene.errors[0].energy.lane[lane], (4 + 9 + 4) * scale * scale);
  }

  // A sweep moves row 1 by half of what it lacks, and says so; row 0 reaches its bound either way.
  scene.Run(kernels().measured_sweep);
  for (int lane = 0; lane < kLanes; ++lane) {
    const float scale = static_cast<float>(lane + 1);
    EXPECT_EQ(scene.errors[0].max.lane[lane], 4 * scale);
    EXPECT_EQ(scene.errors[0].max_angular.lane[lane], 2 * scale);
    EXPECT_EQ(scene.errors[0].energy.lane[lane], (4 + 2.25f + 4) * scale * scale);
  }
}

TEST_P(PairRowsOf, NothingIsLeftToMeasureAtASolution) {
  PairScene scene = Ball({kNormal, kFriction}, {1, 0});
  SetLine(scene.View(0, 1).bounds, 0.5f);
  Move(1, -1, &scene);
  Move(0, 2, &scene);
  scene.Run(kernels().sweep);
  scene.Run(kernels().measure);
  for (int lane = 0; lane < kLanes; ++lane) {
    EXPECT_EQ(scene.errors[0].max.lane[lane], 0);
    EXPECT_EQ(scene.errors[0].max_angular.lane[lane], 0);
    EXPECT_EQ(scene.errors[0].energy.lane[lane], 0);
  }
}

}  // namespace
}  // namespace cairn::simd
