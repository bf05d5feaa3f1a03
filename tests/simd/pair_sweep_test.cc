// SPDX-License-Identifier: MIT
// What is true of every target. That the reference computes what it should is in
// pair_reference_test.cc.
#include "simd/pairs/pair_sweep.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "pair_blocks.h"
#include "simd/pairs/pair_reference.h"

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

namespace cairn::simd {
namespace {

using test::BlockSpec;
using test::IsFinite;
using test::Manifold;
using test::PairScene;
using test::Random;
using test::RandomRows;
using test::RandomScene;
using test::RandomSpec;
using test::SameBits;
using test::SceneSpec;
using test::ShareBodies;

constexpr PairForm kForms[] = {PairForm::kJoint, PairForm::kContact, PairForm::kSingle};
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

class PairKernelsOf : public testing::TestWithParam<Target> {
 protected:
  const PairKernels& kernels() const { return PairKernelsFor(GetParam()); }
};

std::string NameOf(const testing::TestParamInfo<Target>& target) {
  return std::string(TargetName(target.param));
}

INSTANTIATE_TEST_SUITE_P(Every, PairKernelsOf, testing::ValuesIn(SupportedTargets()), NameOf);

/// All passes, of which the sweeps reach max_sweeps of RandomRows() and KindsOfRows().
struct Step {
  const char* name;
  PairKernels::Kernel PairKernels::*kernel;
  int sweep;
};
constexpr Step kSteps[] = {{"start", &PairKernels::start, 0},
                           {"sweep 0", &PairKernels::sweep, 0},
                           {"measured sweep 1", &PairKernels::measured_sweep, 1},
                           {"friction 1", &PairKernels::friction, 1},
                           {"measure", &PairKernels::measure, 0},
                           {"measured sweep 2", &PairKernels::measured_sweep, 2},
                           {"sweep 3", &PairKernels::sweep, 3}};

/// Every pass from states that the passes before it left, with and without hold_lifted.
void ExpectBitsOfTheReference(const PairKernels& kernels, const PairScene& start) {
  for (const bool hold : {false, true}) {
    PairScene expected = start;
    expected.hold_lifted = hold;
    PairScene scene = expected;
    for (const Step& step : kSteps) {
      expected.sweep = scene.sweep = step.sweep;
      expected.Run(ReferencePairKernels().*step.kernel);
      scene.Run(kernels.*step.kernel);
      ASSERT_TRUE(SameBits(scene, expected)) << step.name << (hold ? ", hold lifted" : "");
      ASSERT_TRUE(IsFinite(scene)) << step.name;
    }
  }
}
void ExpectBitsOfTheReference(const PairKernels& kernels, const SceneSpec& spec) {
  ExpectBitsOfTheReference(kernels, RandomScene(spec));
}

/// Each form, bound, softness, relaxation and limit of sweeps, with 1 to 16 lanes in turn.
SceneSpec KindsOfRows() {
  SceneSpec spec;
  for (const PairForm form : kForms) {
    for (const RowBound bound : {RowBound::kFree, RowBound::kPush, RowBound::kOwn,
                                 RowBound::kFriction, RowBound::kCutFriction}) {
      for (int kind = 0; kind < 16; ++kind) {
        RowShape row = {.bound = bound,
                        .soft = (kind & 1) != 0,
                        .relaxed = (kind & 4) != 0,
                        .angular = (kind & 2) != 0};
        if (bound == RowBound::kFriction || bound == RowBound::kCutFriction) row.parent = 0;
        if (kind & 8) row.max_sweeps = 2;
        const int lanes = 1 + static_cast<int>(spec.blocks.size()) % kLanes;
        spec.blocks.push_back({form, {{.bound = RowBound::kPush}, row, row}, lanes});
      }
    }
  }
  return spec;
}

TEST_P(PairKernelsOf, CouplesRowsWithTheBitsOfTheReference) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    PairScene scene = RandomScene(RandomSpec(seed)), expected = scene;
    scene.Couple(kernels());
    expected.Couple(ReferencePairKernels());
    for (std::size_t b = 0; b < scene.blocks.size(); ++b) {
      for (int row = 0; row < scene.blocks[b].row_count; ++row) {
        const int block = static_cast<int>(b);
        ASSERT_EQ(std::memcmp(scene.View(block, row).coupling, expected.View(block, row).coupling,
                              scene.blocks[b].lanes * sizeof(float)),
                  0)
            << "seed " << seed << ", block " << b << ", row " << row;
      }
    }
  }
}

TEST_P(PairKernelsOf, EveryPassOverEveryKindOfRowGivesTheBitsOfTheReference) {
  ExpectBitsOfTheReference(kernels(), KindsOfRows());
}

TEST_P(PairKernelsOf, ManifoldsGiveTheBitsOfTheReferenceWithAnyNumberOfLanes) {
  SceneSpec spec;
  for (const PairForm form : {PairForm::kContact, PairForm::kSingle}) {
    for (int points = 1; points <= 4; ++points) {
      for (int kind = 0; kind < 12; ++kind) {
        const std::vector<RowShape> rows = Manifold({.points = points,
                                                     .friction_rows = 1 + kind % 2,
                                                     .rolling_rows = kind / 2 % 3,
                                                     .relaxed = kind >= 6});
        for (int lanes = 1; lanes <= kLanes; ++lanes) spec.blocks.push_back({form, rows, lanes});
      }
    }
  }
  ExpectBitsOfTheReference(kernels(), spec);
}

TEST_P(PairKernelsOf, JointsGiveTheBitsOfTheReferenceWithAnyNumberOfLanes) {
  SceneSpec spec;
  Random random(1);
  for (const PairForm form : {PairForm::kJoint, PairForm::kSingle}) {
    for (std::size_t rows = 1; rows <= 6; ++rows) {
      for (int lanes = 1; lanes <= kLanes; ++lanes) {
        BlockSpec block = {form, {}, lanes};
        while (block.rows.size() != rows) block.rows = RandomRows(6, &random);
        spec.blocks.push_back(block);
      }
    }
  }
  ExpectBitsOfTheReference(kernels(), spec);
}

TEST_P(PairKernelsOf, BlocksThatAreAlikeGiveTheBitsOfTheReference) {
  for (const PairForm form : kForms) {
    for (int lanes = 1; lanes <= kLanes; lanes += 5) {
      SceneSpec spec;
      spec.bodies = 4 * kLanes;
      Random random(static_cast<unsigned>(lanes));
      for (int kind = 0; kind < 8; ++kind) {
        const bool alone = form != PairForm::kJoint && kind % 2 == 0;
        const BlockSpec block{
            form, alone ? Manifold({.relaxed = kind > 4}) : RandomRows(6, &random), lanes, true};
        spec.blocks.push_back(block);
        spec.blocks.push_back({form, block.rows, kLanes + 1 - lanes});
      }
      SCOPED_TRACE(lanes);
      ExpectBitsOfTheReference(kernels(), spec);
    }
  }
}

TEST_P(PairKernelsOf, RandomScenesGiveTheBitsOfTheReference) {
  for (unsigned seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(seed);
    ExpectBitsOfTheReference(kernels(), RandomSpec(seed));
  }
}

TEST_P(PairKernelsOf, RunsThatShareBlocksAndBodiesGiveTheBitsOfTheReference) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    SCOPED_TRACE(seed);
    PairScene scene = RandomScene(RandomSpec(seed));
    CutRuns(seed, &scene);
    ExpectBitsOfTheReference(kernels(), scene);
    if (HasFatalFailure()) return;
  }
}

TEST_P(PairKernelsOf, CopiesOfSharedBodiesGiveTheBitsOfTheReference) {
  std::size_t copies = 0;
  for (unsigned seed = 0; seed < 200; ++seed) {
    SCOPED_TRACE(seed);
    SceneSpec spec = RandomSpec(seed);
    spec.bodies = 3 * kLanes;
    PairScene scene = RandomScene(spec);
    if (seed % 2 == 0) CutRuns(seed, &scene);
    ShareBodies(seed, &scene);
    copies += scene.copies.size();
    ExpectBitsOfTheReference(kernels(), scene);
    if (HasFatalFailure()) return;
  }
  EXPECT_GT(copies, 1000u);
}

TEST_P(PairKernelsOf, CopiesAreZeroBetweenPasses) {
  PairScene scene = RandomScene({.blocks = {{PairForm::kContact, Manifold({})}}});
  ShareBodies(1, &scene);
  ASSERT_FALSE(scene.copies.empty());
  for (const Step& step : kSteps) {
    scene.Run(kernels().*step.kernel);
    for (std::size_t i = scene.bodies.size() - scene.copies.size(); i < scene.bodies.size(); ++i) {
      for (const float u : scene.bodies[i].u) EXPECT_EQ(u, 0) << step.name;
    }
  }
}

TEST_P(PairKernelsOf, AMeasuredSweepMovesWhatASweepMovesAndMeasureMovesNothing) {
  for (unsigned seed = 1; seed <= 50; ++seed) {
    PairScene scene = RandomScene(RandomSpec(seed));
    scene.hold_lifted = seed % 2 == 0;
    scene.sweep = static_cast<int>(seed % 3);
    PairScene measured = scene, before = scene;
    scene.Run(kernels().measure);
    before.errors = scene.errors;
    ASSERT_TRUE(SameBits(scene, before)) << seed;

    scene.Run(kernels().sweep);
    measured.Run(kernels().measured_sweep);
    measured.errors = scene.errors;
    ASSERT_TRUE(SameBits(scene, measured)) << seed;
  }
}

TEST_P(PairKernelsOf, StartAndSweepLeaveTheErrorsAlone) {
  const PairScene before = RandomScene(RandomSpec(1));
  PairScene scene = before;
  scene.Run(kernels().start);
  scene.Run(kernels().sweep);
  const std::size_t bytes = scene.errors.size() * sizeof(BlockError);
  EXPECT_EQ(std::memcmp(scene.errors.data(), before.errors.data(), bytes), 0);
}

/// Slots of the bodies that some lane in use has.
std::vector<bool> NamedBodies(const PairScene& scene) {
  std::vector<bool> named(scene.bodies.size(), false);
  for (const PairBlock& block : scene.blocks) {
    for (int lane = 0; lane < block.lanes; ++lane) {
      named[block.a[lane]] = true;
      if (block.form != PairForm::kSingle) named[block.b[lane]] = true;
    }
  }
  return named;
}

TEST_P(PairKernelsOf, UnusedLanesMayHoldNaNAndOtherBodiesKeepTheirBits) {
  for (const PairForm form : kForms) {
    for (int lanes = 1; lanes < kLanes; ++lanes) {
      SCOPED_TRACE(lanes);
      SceneSpec spec;
      spec.blocks = {{form, Manifold({.rolling_rows = 1}), lanes}};
      PairScene clean = RandomScene(spec);
      spec.unused = kNaN;
      PairScene scene = RandomScene(spec);
      const PairScene before = scene;
      const std::vector<bool> named = NamedBodies(scene);
      for (const Step& step : kSteps) {
        scene.Run(kernels().*step.kernel);
        clean.Run(kernels().*step.kernel);
        // the bits of zero are zeros: no -0 either
        const BodyLane zero = {};
        ASSERT_EQ(std::memcmp(&scene.bodies[0], &zero, sizeof zero), 0) << step.name;
        for (std::size_t i = 0; i < named.size(); ++i) {
          if (named[i]) continue;
          const void* const now = &scene.bodies[i];
          ASSERT_EQ(std::memcmp(now, &before.bodies[i], sizeof zero), 0) << step.name;
          clean.bodies[i] = scene.bodies[i];
        }
        ASSERT_TRUE(SameBits(scene, clean)) << step.name;
      }
    }
  }
}

TEST_P(PairKernelsOf, LinesOfOtherBlocksKeepTheirBits) {
  SceneSpec spec;
  spec.blocks.assign(3, {PairForm::kContact, Manifold({}), kLanes});
  PairScene scene = RandomScene(spec);
  const PairScene before = scene;
  scene.blocks = {scene.blocks[1]};
  scene.runs.resize(1);
  for (const Step& step : kSteps) scene.Run(kernels().*step.kernel);
  const std::size_t first = scene.blocks[0].x, last = first + scene.blocks[0].row_count;
  for (std::size_t i = 0; i < scene.x.size(); ++i) {
    const bool same = std::memcmp(&scene.x[i], &before.x[i], sizeof(Line)) == 0;
    EXPECT_EQ(same, i < first || i >= last) << i;
  }
}

TEST_P(PairKernelsOf, ContactsKeepTheMomentum) {
  for (const bool unit_mass : {true, false}) {
    SceneSpec spec;
    spec.blocks = {{PairForm::kContact, Manifold({.rolling_rows = 1, .relaxed = true})}};
    PairScene scene = RandomScene(spec);
    for (int i = 0; unit_mass && i < 2 * kLanes; ++i) {
      scene.PairOf(0)[i % 2].lane[i / 2] = std::sqrt(0.5f);
    }
    for (scene.sweep = 0; scene.sweep < 10; ++scene.sweep) {
      PairScene before = scene;
      scene.Run(kernels().sweep);
      for (int lane = 0; lane < kLanes; ++lane) {
        // momentum is m v = u / s, and c is s by a factor that both bodies share. Its change is c
        // times one number for both: a rounding of the product and one of the sum, each of at most
        // half a unit in the last place; the rounding of the bound itself is in the 2 %.
        const double c_a = scene.PairOf(0)[0].lane[lane], c_b = scene.PairOf(0)[1].lane[lane];
        for (const int i : {0, 1, 2}) {
          const double a = scene.BodyA(0, lane).u[i], b = scene.BodyB(0, lane).u[i];
          const double moved_a = a - before.BodyA(0, lane).u[i];
          const double moved_b = b - before.BodyB(0, lane).u[i];
          const double size = (std::abs(a) + 2 * std::abs(moved_a)) / c_a +
                              (std::abs(b) + 2 * std::abs(moved_b)) / c_b;
          EXPECT_NEAR(moved_a / c_a, -moved_b / c_b, 1.02 * 0x1p-24 * size);
        }
      }
    }
  }
}

#if defined(__SSE2__)
constexpr unsigned kFlush = 0x8000, kZeros = 0x0040, kModes = 0xffc0;
/// What the mode of a program may be: rounding up, and traps of what is invalid or divided by zero.
constexpr unsigned kRoundUp = 0x4000, kTraps = 0x0280;

TEST_P(PairKernelsOf, TheModeOfTheCallerIsRestoredAndChangesNoBits) {
  PairScene expected = RandomScene(RandomSpec(1));
  // impulses and velocities on both sides of the smallest normal number
  for (Line& line : expected.x) {
    for (float& x : line.lane) x *= 0x1p-126f;
  }
  for (BodyLane& body : expected.bodies) {
    for (float& u : body.u) u *= 0x1p-126f;
  }
  const unsigned before = _mm_getcsr();
  for (const Step& step : kSteps) {
    const PairScene start = expected;
    expected.Run(kernels().*step.kernel);
    const unsigned after = _mm_getcsr();
    EXPECT_EQ(after & kModes, before & kModes) << step.name;

    for (const unsigned mode : {before | kFlush | kZeros, before | kRoundUp, before & ~kTraps}) {
      PairScene in_mode = start;
      _mm_setcsr(mode);
      in_mode.Run(kernels().*step.kernel);
      const unsigned still = _mm_getcsr();
      _mm_setcsr(before);
      EXPECT_EQ(still & kModes, mode & kModes) << step.name;
      EXPECT_TRUE(SameBits(in_mode, expected)) << step.name << " in mode " << mode;
    }
  }
}

TEST_P(PairKernelsOf, ImpulsesThatDecayToDenormalsBecomeZero) {
  // No velocity and a compliance of 1, so that w = x: a step of 3/4 takes 1.5 m to 0.375 m, where
  // m is the smallest normal number. The other row begins below it.
  constexpr float kSmallest = std::numeric_limits<float>::min();
  SceneSpec spec;
  spec.blocks = {{PairForm::kSingle, {{.soft = true}, {.soft = true}}}};
  PairScene scene = test::ZeroScene(spec);
  for (int lane = 0; lane < kLanes; ++lane) {
    for (const int row : {0, 1}) {
      scene.View(0, row).compliance->lane[lane] = 1;
      scene.View(0, row).step->lane[lane] = 0.75f;
    }
    scene.X(0, 0, lane) = 1.5f * kSmallest;
    scene.X(0, 1, lane) = 0.375f * kSmallest;
  }
  ASSERT_EQ(std::fpclassify(scene.X(0, 1, 0)), FP_SUBNORMAL);
  scene.Run(kernels().sweep);
  for (int lane = 0; lane < kLanes; ++lane) {
    EXPECT_EQ(scene.X(0, 0, lane), 0);
    EXPECT_EQ(scene.X(0, 1, lane), 0);
  }
}

// Joints that break at 1e-43 N s have such bounds. A copy of one would not be 0, and break them.
TEST_P(PairKernelsOf, BoundsTooSmallForANormalFloatAreZero) {
  constexpr float kTiny = 1e-42f;
  ASSERT_EQ(std::fpclassify(kTiny), FP_SUBNORMAL);
  SceneSpec spec;
  spec.blocks = {{PairForm::kSingle, {{.bound = RowBound::kOwn}, {.bound = RowBound::kOwn}}}};
  PairScene scene = test::ZeroScene(spec);
  for (int lane = 0; lane < kLanes; ++lane) {
    for (const int row : {0, 1}) {
      const test::RowView view = scene.View(0, row);
      view.g[0].lane[lane] = view.step->lane[lane] = 1;
      view.target->lane[lane] = row == 0 ? 1 : -1;  // one row comes to each bound
      view.bounds[0].lane[lane] = -kTiny;
      view.bounds[1].lane[lane] = kTiny;
    }
  }
  scene.Run(kernels().sweep);
  for (int lane = 0; lane < kLanes; ++lane) {
    EXPECT_EQ(scene.X(0, 0, lane), 0);
    EXPECT_EQ(scene.X(0, 1, lane), 0);
  }
}
#endif

}  // namespace
}  // namespace cairn::simd
