// SPDX-License-Identifier: MIT
// The reference against the formulas of pair_sweep.h in double precision, row by row and without
// the short cuts that forms of pairs allow.
#include "simd/pairs/pair_reference.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "pair_blocks.h"

namespace cairn::simd {
namespace {

using test::PairScene;
using test::Random;
using test::RandomRows;
using test::RandomScene;
using test::RowView;
using test::SceneSpec;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Both bodies: linear and angular of a, linear and angular of b.
using Vector12 = std::array<double, 12>;

struct Row {
  RowShape shape;
  Vector12 g;
  double target, step, compliance, relaxation, friction, lo, hi;
};

/// A lane of the first block of a scene, in double.
struct Lane {
  std::vector<Row> rows;
  std::vector<double> x;
  Vector12 u;
  double max = 0, max_angular = 0, energy = 0;
  double size = 1;  ///< of the largest numbers met; see RoundingError()
};

Vector12 Velocities(PairScene* scene, int lane) {
  Vector12 u;
  for (int i = 0; i < 3; ++i) {
    u[i] = scene->BodyA(0, lane).u[i];
    u[3 + i] = scene->BodyA(0, lane).u[4 + i];
    u[6 + i] = scene->BodyB(0, lane).u[i];
    u[9 + i] = scene->BodyB(0, lane).u[4 + i];
  }
  return u;
}

/// G = (g_a, g_b), where contacts store r n, the angular parts, and c_a, c_b for all rows.
Vector12 Jacobian(PairScene* scene, int row, int lane) {
  const Line* const line = scene->View(0, row).g;
  Vector12 g = {};
  switch (scene->blocks[0].form) {
    case PairForm::kJoint:
      for (int i = 0; i < 12; ++i) g[i] = line[i].lane[lane];
      break;
    case PairForm::kSingle:
      for (int i = 0; i < 6; ++i) g[i] = line[i].lane[lane];
      break;
    case PairForm::kContact:
      for (int i = 0; i < 3; ++i) {
        const double n = line[i].lane[lane];
        g[i] = scene->PairOf(0)[0].lane[lane] * n;
        g[3 + i] = line[3 + i].lane[lane];
        g[6 + i] = -(scene->PairOf(0)[1].lane[lane] * n);
        g[9 + i] = line[6 + i].lane[lane];
      }
      break;
  }
  return g;
}

Row ReadRow(PairScene* scene, int index, int lane) {
  const RowView view = scene->View(0, index);
  Row row = {.shape = scene->shapes[0][index],
             .g = Jacobian(scene, index, lane),
             .target = view.target->lane[lane],
             .step = view.step->lane[lane],
             .compliance = view.compliance ? view.compliance->lane[lane] : 0,
             .relaxation = view.relaxation ? view.relaxation->lane[lane] : 1,
             .friction = kInfinity,
             .lo = -kInfinity,
             .hi = kInfinity};
  const RowBound bound = row.shape.bound;
  const Line* line = view.bounds;
  if (bound == RowBound::kPush) row.lo = 0;
  if (bound == RowBound::kFriction || bound == RowBound::kCutFriction) {
    row.friction = (line++)->lane[lane];
  }
  if (bound == RowBound::kOwn || bound == RowBound::kCutFriction) {
    row.lo = line[0].lane[lane];
    row.hi = line[1].lane[lane];
  }
  return row;
}

Lane ReadLane(PairScene* scene, int index) {
  Lane lane;
  for (int row = 0; row < scene->blocks[0].row_count; ++row) {
    lane.rows.push_back(ReadRow(scene, row, index));
    lane.x.push_back(scene->X(0, row, index));
  }
  lane.u = Velocities(scene, index);
  return lane;
}

void AddImpulse(const Row& row, double change, Vector12* u) {
  for (int i = 0; i < 12; ++i) (*u)[i] += row.g[i] * change;
}

/// w, and the size of what it is the sum of.
double RelativeVelocity(const Row& row, double x, Lane* lane) {
  double w = row.compliance * x - row.target;
  double size = std::abs(row.compliance * x) + std::abs(row.target) + std::abs(x);
  double longest = 1;
  for (int i = 0; i < 12; ++i) {
    w += row.g[i] * lane->u[i];
    size += std::abs(row.g[i] * lane->u[i]);
    longest = std::max(longest, std::abs(row.g[i]));
  }
  lane->size = std::max(lane->size, size * std::max(1.0, row.step) * longest);
  return w;
}

double Clamp(const Row& row, const Lane& lane, double x) {
  double lo = row.lo, hi = row.hi;
  if (row.shape.parent >= 0) {
    const double most = row.friction * std::max(lane.x[row.shape.parent], 0.0);
    lo = std::max(lo, -most);
    hi = std::min(hi, most);
  }
  return std::min(std::max(x, lo), hi);
}

void Count(const Row& row, double change, Lane* lane) {
  const double d = row.relaxation / row.step, e = d * std::abs(change);
  double& most = row.shape.angular ? lane->max_angular : lane->max;
  most = std::max(most, e);
  lane->energy += e * e / d;
}

void Start(Lane* lane) {
  for (std::size_t i = 0; i < lane->rows.size(); ++i) {
    AddImpulse(lane->rows[i], lane->x[i], &lane->u);
    RelativeVelocity(lane->rows[i], lane->x[i], lane);
  }
}

void Sweep(const PairScene& scene, Lane* lane) {
  for (std::size_t i = 0; i < lane->rows.size(); ++i) {
    const Row& row = lane->rows[i];
    const bool lifted = row.shape.parent >= 0 && lane->x[row.shape.parent] <= 0;
    if (scene.sweep >= row.shape.max_sweeps || (scene.hold_lifted && lifted)) continue;
    const double old = lane->x[i], w = RelativeVelocity(row, old, lane);
    lane->x[i] = Clamp(row, *lane, old - row.step * w);
    AddImpulse(row, lane->x[i] - old, &lane->u);
    Count(row, lane->x[i] - old, lane);
  }
}

void Measure(Lane* lane) {
  for (std::size_t i = 0; i < lane->rows.size(); ++i) {
    const Row& row = lane->rows[i];
    const double x = lane->x[i], w = RelativeVelocity(row, x, lane);
    Count(row, Clamp(row, *lane, x - row.step / row.relaxation * w) - x, lane);
  }
}

/// What float may be off by after one pass over a lane.
///
/// A row makes about 16 roundings, each of at most half a unit in the last place of numbers of
/// lane.size: w (the products, four levels of the sum, target, compliance), the step to x and the
/// change of x, u, and what forms of pairs do once (relative velocity, shares). Here
/// they all add up. What earlier rows were off by does not grow: relaxing a row takes from u a part
/// of what u has along G, at most twice that, and clamping makes the part smaller.
double RoundingError(const Lane& lane) {
  return 16 * static_cast<double>(lane.rows.size()) * 0x1p-24 * lane.size;
}

void ExpectImpulses(const Lane& expected, int lane, PairScene* scene) {
  const double tolerance = RoundingError(expected);
  for (std::size_t i = 0; i < expected.x.size(); ++i) {
    EXPECT_NEAR(scene->X(0, static_cast<int>(i), lane), expected.x[i], tolerance) << i;
  }
  const Vector12 u = Velocities(scene, lane);
  for (int i = 0; i < 12; ++i) EXPECT_NEAR(u[i], expected.u[i], tolerance) << i;
}

/// The same for errors: e = d |change of x|.
double ErrorOfErrors(const Lane& lane) {
  double d = 1;
  for (const Row& row : lane.rows) d = std::max(d, row.relaxation / row.step);
  return d * RoundingError(lane);
}

void ExpectErrors(const Lane& expected, int lane, const PairScene& scene) {
  const double tolerance = ErrorOfErrors(expected);
  const BlockError& error = scene.errors[0];
  EXPECT_NEAR(error.max.lane[lane], expected.max, tolerance);
  EXPECT_NEAR(error.max_angular.lane[lane], expected.max_angular, tolerance);

  // energy: for each row the product of e and of the change of x, which is e / d
  double inv_d = 1;
  for (const Row& row : expected.rows) inv_d = std::max(inv_d, row.step / row.relaxation);
  const double largest = std::max({1.0, expected.max, expected.max_angular}) * inv_d;
  const double products = 2 * static_cast<double>(expected.rows.size());
  EXPECT_NEAR(error.energy.lane[lane], expected.energy, products * largest * tolerance);
}

/// One block of a form, its rows by the seed.
class ReferenceOfForm : public testing::TestWithParam<PairForm> {
 protected:
  static constexpr unsigned kSeeds = 100;

  PairScene Scene(unsigned seed) const {
    Random random(seed);
    SceneSpec spec;
    spec.blocks = {{GetParam(), RandomRows(20, &random), 1 + random.Index(kLanes)}};
    spec.seed = seed;
    PairScene scene = RandomScene(spec);
    scene.hold_lifted = seed % 2 == 0;
    return scene;
  }
};

std::string NameOf(const testing::TestParamInfo<PairForm>& form) {
  if (form.param == PairForm::kJoint) return "Joint";
  return form.param == PairForm::kContact ? "Contact" : "Single";
}

INSTANTIATE_TEST_SUITE_P(Every, ReferenceOfForm,
                         testing::Values(PairForm::kJoint, PairForm::kContact, PairForm::kSingle),
                         NameOf);

std::vector<Lane> ReadLanes(PairScene* scene) {
  std::vector<Lane> lanes;
  for (int lane = 0; lane < scene->blocks[0].lanes; ++lane) lanes.push_back(ReadLane(scene, lane));
  return lanes;
}

TEST_P(ReferenceOfForm, StartAddsTheImpulsesToTheVelocities) {
  for (unsigned seed = 1; seed <= kSeeds; ++seed) {
    SCOPED_TRACE(seed);
    PairScene scene = Scene(seed);
    std::vector<Lane> lanes = ReadLanes(&scene);
    scene.Run(ReferencePairKernels().start);
    for (std::size_t lane = 0; lane < lanes.size(); ++lane) {
      Start(&lanes[lane]);
      ExpectImpulses(lanes[lane], static_cast<int>(lane), &scene);
    }
  }
}

TEST_P(ReferenceOfForm, SweepsAndTheirErrorsAreThoseOfTheFormulas) {
  for (unsigned seed = 1; seed <= kSeeds; ++seed) {
    SCOPED_TRACE(seed);
    PairScene scene = Scene(seed);
    // each sweep from where float is, so that errors are those of one sweep
    for (scene.sweep = 0; scene.sweep < 4; ++scene.sweep) {
      std::vector<Lane> lanes = ReadLanes(&scene);
      scene.Run(ReferencePairKernels().measured_sweep);
      for (std::size_t lane = 0; lane < lanes.size(); ++lane) {
        Sweep(scene, &lanes[lane]);
        ExpectImpulses(lanes[lane], static_cast<int>(lane), &scene);
        ExpectErrors(lanes[lane], static_cast<int>(lane), scene);
      }
    }
  }
}

TEST_P(ReferenceOfForm, ErrorsOfAStateAreThoseOfTheFormulas) {
  for (unsigned seed = 1; seed <= kSeeds; ++seed) {
    SCOPED_TRACE(seed);
    PairScene scene = Scene(seed);
    std::vector<Lane> lanes = ReadLanes(&scene);
    scene.Run(ReferencePairKernels().measure);
    for (std::size_t lane = 0; lane < lanes.size(); ++lane) {
      Measure(&lanes[lane]);
      ExpectErrors(lanes[lane], static_cast<int>(lane), scene);
    }
  }
}

TEST_P(ReferenceOfForm, SweepsSolveWhatIsFree) {
  // Without bounds w = 0 in the end, up to what a pass cannot see.
  for (unsigned seed = 1; seed <= 20; ++seed) {
    SceneSpec spec;
    spec.blocks = {{GetParam(), {{}, {.soft = true}, {.angular = true}}}};
    spec.seed = seed;
    PairScene scene = RandomScene(spec);
    for (scene.sweep = 0; scene.sweep < 2000; ++scene.sweep) {
      scene.Run(ReferencePairKernels().sweep);
    }
    for (Lane& lane : ReadLanes(&scene)) {
      Measure(&lane);
      EXPECT_LE(std::max(lane.max, lane.max_angular), ErrorOfErrors(lane)) << seed;
    }
  }
}

}  // namespace
}  // namespace cairn::simd
