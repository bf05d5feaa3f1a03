// SPDX-License-Identifier: MIT
// The helpers of C give the bits of those of C++.
#include <gtest/gtest.h>

#include <cstring>
#include <span>
#include <type_traits>
#include <vector>

#include "cairn/cairn_helpers.h"
#include "cairn/joints.h"
#include "cairn/solver.h"
#include "tests/c/helper_frames.h"

namespace cairn {
namespace {

using test::AnyJoint, test::RandomFrames, test::ToC;

template <class To, class From>
bool SameBytes(std::span<const From> a, const To* b, int count) {
  static_assert(sizeof(To) == sizeof(From));
  return a.size() == static_cast<size_t>(count) &&
         (count == 0 || std::memcmp(a.data(), b, a.size_bytes()) == 0);
}

void ExpectSame(const PositionError& expected, const CairnPositionError& got) {
  EXPECT_EQ(expected.largest, got.largest);
  EXPECT_EQ(expected.taken_back, got.takenBack);
}

/// Both sides of a comparison: one frame after another is made, compared, solved and compared.
template <class BodyOfC, class VelocityOfC>
class Twins {
 public:
  Twins(const ContactOptions& options, int substeps)
      : contacts_(options), substeps_(substeps), solver_({.substeps = substeps}) {
    CairnFrameSettings settings = cairnDefaultFrameSettings();
    settings.contacts = ToC(options);
    EXPECT_EQ(cairnCreateFrame(cairnHelperLayout(), &settings, &frame_), cairnOk);
    CairnSettings solver = cairnDefaultSettings();
    solver.substeps = substeps;
    EXPECT_EQ(cairnCreateSolver(cairnLayout(), &solver, &c_solver_), cairnOk);
  }
  ~Twins() {
    cairnDestroyFrame(frame_);
    cairnDestroySolver(c_solver_);
  }
  Twins(const Twins&) = delete;
  Twins& operator=(const Twins&) = delete;

  void Begin(std::span<const Body> bodies, double h) {
    c_bodies_.clear();
    CairnStep step = cairnDefaultStep();
    for (const Body& body : bodies) c_bodies_.push_back(ToC(body, DefaultBody()));
    PutBodies(&step);
    step.bodyCount = static_cast<int32_t>(bodies.size());
    step.timeStep = h;
    step.substeps = substeps_;
    step_ = {bodies, h, substeps_};
    contacts_.Begin(step_);
    joints_.Begin(step_);
    ASSERT_EQ(cairnBeginFrame(frame_, &step), cairnOk);
  }

  void Add(const Touch& touch, const std::vector<TouchPoint>& points) {
    contacts_.Add(touch, points);
    std::vector<CairnTouchPoint> c_points;
    for (const TouchPoint& point : points) c_points.push_back(ToC(point));
    const CairnTouch c_touch = ToC(touch);
    ASSERT_EQ(cairnAddTouch(frame_, &c_touch, c_points.data(), static_cast<int>(c_points.size())),
              cairnOk);
  }

  void Add(const AnyJoint& joint, const JointSide& a, const JointSide& b, std::uint64_t id) {
    const CairnJointSide c_a = ToC(a), c_b = ToC(b);
    EXPECT_EQ(TwistOf(a, b), cairnTwistOf(&c_a, &c_b));
    int place = -2;
    std::int32_t c_place = -3;
    CairnStatus status = cairnFailed;
    if (joint.form == AnyJoint::kKind) {
      const CairnJointKind kind = ToC(joint.kind);
      place = joints_.Add(joint.kind, a, b, id);
      status = cairnAddJoint(frame_, &kind, &c_a, &c_b, id, &c_place);
    } else if (joint.form == AnyJoint::kDistance) {
      const CairnJointAxis length = ToC(joint.length);
      place = joints_.AddDistance(joint.length, a, b, id);
      status = cairnAddDistance(frame_, &length, &c_a, &c_b, id, &c_place);
    } else {
      const JointGear gear_a{a, 0.3, joint.teeth[0]}, gear_b{b, -0.1, joint.teeth[1]};
      const CairnJointGear c_gear_a = ToC(gear_a), c_gear_b = ToC(gear_b);
      place = joints_.AddGear(gear_a, gear_b, id);
      status = cairnAddGear(frame_, &c_gear_a, &c_gear_b, id, &c_place);
    }
    ASSERT_EQ(status, cairnOk);
    EXPECT_EQ(place, c_place);
  }

  /// Velocities are written to the bodies, as C has them.
  void SolveAndCompare(std::vector<Body>* bodies) {
    ASSERT_EQ(cairnFrameProblem(frame_, &problem_, &solution_), cairnOk);
    CompareInput();
    ContactProblem problem = ProblemOf(step_, contacts_, joints_);
    problem.time_step = problem_.timeStep;  // a float in C
    std::vector<Velocity> velocities(bodies->size());
    std::vector<VelocityOfC> c_velocities(bodies->size());
    const Report report = solver_.Solve(problem, StartOf(&contacts_, &joints_), velocities);
    ASSERT_TRUE(report.ok()) << Describe(report);
    ASSERT_EQ(Solve(c_velocities.data()), cairnOk);
    CompareImpulses();
    for (size_t i = 0; i < bodies->size(); ++i) {
      using Number = std::remove_reference_t<decltype(c_velocities[0].linear[0])>;
      for (int k = 0; k < 3; ++k) {
        EXPECT_EQ(static_cast<Number>(velocities[i].linear[k]), c_velocities[i].linear[k]);
        EXPECT_EQ(static_cast<Number>(velocities[i].angular[k]), c_velocities[i].angular[k]);
        (*bodies)[i].velocity.linear[k] = c_velocities[i].linear[k];
        (*bodies)[i].velocity.angular[k] = c_velocities[i].angular[k];
      }
    }
  }

  int rows() const { return problem_.jointRowCount; }
  int points() const { return problem_.pointCount; }

 private:
  static constexpr bool kFloats = std::is_same_v<BodyOfC, CairnBody>;

  static BodyOfC DefaultBody() {
    if constexpr (kFloats) {
      return cairnDefaultBody();
    } else {
      return cairnDefaultBodyD();
    }
  }
  void PutBodies(CairnStep* step) const {
    if constexpr (kFloats) {
      step->bodies = c_bodies_.data();
    } else {
      step->bodiesD = c_bodies_.data();
    }
  }
  CairnStatus Solve(VelocityOfC* velocities) {
    if constexpr (kFloats) {
      EXPECT_EQ(problem_.bodies, c_bodies_.data());
      solution_.velocities = velocities;
      return cairnSolve(c_solver_, &problem_, &solution_, nullptr);
    } else {
      EXPECT_EQ(problem_.bodies, nullptr);
      return cairnSolveD(c_solver_, &problem_, c_bodies_.data(), &solution_, velocities, nullptr);
    }
  }

  void CompareInput() {
    EXPECT_TRUE(SameBytes(contacts_.manifolds(), problem_.manifolds, problem_.manifoldCount));
    EXPECT_TRUE(SameBytes(contacts_.points(), problem_.points, problem_.pointCount));
    EXPECT_TRUE(SameBytes(joints_.joints(), problem_.joints, problem_.jointCount));
    EXPECT_TRUE(SameBytes(joints_.rows(), problem_.jointRows, problem_.jointRowCount));
    CompareImpulses();
    const CairnPositionErrors errors = cairnFrameErrors(frame_);
    ExpectSame(contacts_.deepest(), errors.depth);
    ExpectSame(joints_.worst_gap(), errors.gap);
    ExpectSame(joints_.worst_angle(), errors.angle);
  }
  void CompareImpulses() {
    const std::span<const ContactImpulse> points = contacts_.impulses();
    const std::span<const float> rows = joints_.impulses();
    EXPECT_TRUE(SameBytes(points, solution_.points, problem_.pointCount));
    EXPECT_TRUE(SameBytes(rows, solution_.jointRows, problem_.jointRowCount));
  }

  Contacts contacts_;
  Joints joints_;
  StepInput step_;
  int substeps_;
  Solver solver_;
  CairnFrame* frame_ = nullptr;
  CairnSolver* c_solver_ = nullptr;
  std::vector<BodyOfC> c_bodies_;
  CairnProblem problem_ = cairnDefaultProblem();
  CairnSolution solution_ = {};
};

/// The numbers of a body as C has them: rounded, where these are floats.
template <class BodyOfC>
void TakeNumbers(const BodyOfC& from, Body* to) {
  to->inv_mass = from.invMass;
  to->inv_inertia = Matrix3::Diagonal(from.invInertia[0], from.invInertia[4], from.invInertia[8]);
  for (int k = 0; k < 3; ++k) {
    to->velocity.linear[k] = from.velocity.linear[k];
    to->velocity.angular[k] = from.velocity.angular[k];
    to->impulse[k] = from.impulse[k];
  }
}

/// Frames that start from the impulses of the last, in another order.
template <class BodyOfC, class VelocityOfC>
void ExpectSameFrames(const ContactOptions& options, int substeps, std::uint32_t seed) {
  RandomFrames frames(seed);
  for (Body& body : frames.bodies) TakeNumbers(ToC(body, BodyOfC{}), &body);
  Twins<BodyOfC, VelocityOfC> twins(options, substeps);
  const std::vector<AnyJoint> kinds = test::AllKinds();
  for (int frame = 0; frame < 4; ++frame) {
    SCOPED_TRACE(frame);
    twins.Begin(frames.bodies, 1 / 60.0);
    for (int k = 0; k < RandomFrames::kBodies; ++k) {
      const int i = (k + frame) % RandomFrames::kBodies;
      const Touch touch = frames.NextTouch(i);
      twins.Add(touch, frames.NextPoints(touch, i % 7));
      const JointSide a = frames.NextSide(i), b = frames.NextSide(touch.body_b);
      twins.Add(kinds[static_cast<size_t>(i) % kinds.size()], a, b, touch.id);
    }
    twins.SolveAndCompare(&frames.bodies);
    if (testing::Test::HasFailure()) return;
    EXPECT_GT(twins.points(), 30);
    EXPECT_GT(twins.rows(), 80);
  }
}

TEST(CHelpers, GiveTheBitsOfCpp) {
  for (std::uint32_t seed = 1; seed <= 3; ++seed) {
    ExpectSameFrames<CairnBody, CairnVelocity>({}, 1, seed);
    ExpectSameFrames<CairnBodyD, CairnVelocityD>({}, 1, seed);
  }
}

TEST(CHelpers, GiveTheBitsOfCppWithOtherOptionsAndSubsteps) {
  const ContactOptions soft{.slop = 0.01,
                            .erp = 0.4,
                            .max_push = 1,
                            .max_gap = 0.05,
                            .min_bounce = 0.3,
                            .frequency = 12,
                            .damping_ratio = 3};
  ExpectSameFrames<CairnBody, CairnVelocity>(soft, 2, 4);
  ExpectSameFrames<CairnBodyD, CairnVelocityD>(soft, 2, 4);
}

bool SameAxis(const JointAxis& expected, const CairnJointAxis& got) {
  return std::memcmp(&expected, &got, sizeof got) == 0;
}

void ExpectSameKind(const JointKind& expected, const CairnJointKind& got) {
  for (int k = 0; k < 3; ++k) EXPECT_TRUE(SameAxis(expected.linear[k], got.linear[k]));
  EXPECT_TRUE(SameAxis(expected.twist, got.twist));
  EXPECT_EQ(expected.cone, got.cone);
}

TEST(CHelpers, HaveTheKindsOfCpp) {
  const JointAxis axis{.lo = -1, .hi = 2, .speed = 3, .max_motor_force = 4};
  const CairnJointAxis c_axis = ToC(axis);
  ExpectSameKind({}, cairnDefaultJointKind());
  ExpectSameKind(BallJoint(), cairnBallJoint());
  ExpectSameKind(HingeJoint(), cairnHingeJoint(nullptr));
  ExpectSameKind(HingeJoint(axis), cairnHingeJoint(&c_axis));
  ExpectSameKind(SliderJoint(axis), cairnSliderJoint(&c_axis));
  ExpectSameKind(FixedJoint(), cairnFixedJoint());
  ExpectSameKind(ConeTwistJoint(0.7, axis), cairnConeTwistJoint(0.7, &c_axis));
}

}  // namespace
}  // namespace cairn
