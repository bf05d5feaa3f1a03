// SPDX-License-Identifier: MIT
// An engine of its own around the solver: a crate falls on the ground, and a lamp hangs from it.
#include <cairn/solver.h>

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <cstdio>
#include <vector>

namespace {

using Eigen::Vector3d;

// [bodies]
constexpr double kStep = 1 / 60.0;           // [s]
constexpr double kGravity = 9.81;            // [m/s^2]
constexpr double kCorrection = 0.2 / kStep;  // how fast an error of 1 m is corrected [1/s]

struct Box {
  double mass;        // [kg]
  double half;        // half an edge [m]
  Vector3d position;  // of the centre of mass [m]
  Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
  cairn::Velocity velocity = {};
  std::array<cairn::ContactImpulse, 8> impulses = {};  // of the last frame, by corner
};

cairn::Body ToBody(const Box& box, std::uint64_t id) {
  const double inertia = box.mass * 4 * box.half * box.half / 6;
  return {.inv_mass = 1 / box.mass,
          .inv_inertia = Eigen::Matrix3d::Identity() / inertia,  // that of a cube
          .velocity = box.velocity,
          .impulse = {0, -box.mass * kGravity * kStep, 0},
          .id = id};
}
// [/bodies]

void Put(const Vector3d& from, float* to) {
  for (int i = 0; i < 3; ++i) to[i] = static_cast<float>(from[i]);
}

// [joint]
struct Hook {
  Vector3d on_lamp, on_crate;       // from the centres of mass, in the bodies' own axes [m]
  std::array<float, 3> impulses{};  // of the last frame
};

// Three rows that hold a point of the lamp (body a) and a point of the crate (body b) together.
std::array<cairn::JointRow, 3> RowsOf(const Hook& hook, const Box& lamp, const Box& crate) {
  const Vector3d arm_a = lamp.turn * hook.on_lamp, arm_b = crate.turn * hook.on_crate;
  const Vector3d gap = lamp.position + arm_a - crate.position - arm_b;
  std::array<cairn::JointRow, 3> rows{};
  for (int i = 0; i < 3; ++i) {
    const Vector3d axis = Vector3d::Unit(i);
    Put(axis, rows[i].linear_a);
    Put(arm_a.cross(axis), rows[i].angular_a);
    Put(-axis, rows[i].linear_b);
    Put(-arm_b.cross(axis), rows[i].angular_b);
    rows[i].target = static_cast<float>(-kCorrection * gap[i]);
  }
  return rows;
}
// [/joint]

// [contacts]
// Corners that may touch the ground in this step, four at most; ids say which corners they are.
std::vector<cairn::ContactPoint> FindPoints(const Box& box, std::vector<int>* ids) {
  std::vector<cairn::ContactPoint> points;
  for (int id = 0; id < 8 && points.size() < cairn::Manifold::kMostPoints; ++id) {
    const Vector3d corner(id & 1 ? 1 : -1, id & 2 ? 1 : -1, id & 4 ? 1 : -1);
    const Vector3d arm = box.turn * (box.half * corner);
    const double height = box.position.y() + arm.y();
    if (height > 0.1) continue;
    cairn::ContactPoint& point = points.emplace_back();
    Put(arm, point.arm_a);
    Put(Vector3d::UnitY(), point.normal);
    point.friction = 0.5f;
    // a corner above the ground may fall as far as that, one below is lifted
    point.bias = static_cast<float>(height > 0 ? -height / kStep : -kCorrection * height);
    ids->push_back(id);
  }
  return points;
}
// [/contacts]

// [move]
void Move(const cairn::Velocity& velocity, Box* box) {
  box->velocity = velocity;
  box->position += kStep * velocity.linear;
  const double angle = kStep * velocity.angular.norm();
  if (angle == 0) return;
  box->turn = Eigen::AngleAxisd(angle, velocity.angular.normalized()) * box->turn;
  box->turn.normalize();
}
// [/move]

// [step]
cairn::Report Step(cairn::Solver* solver, Box* crate, Box* lamp, Hook* hook) {
  // problem in: bodies with names that stay theirs, a manifold with the ground, a joint
  const std::array bodies{ToBody(*crate, 1), ToBody(*lamp, 2)};
  std::vector<int> corners;
  const std::vector<cairn::ContactPoint> points = FindPoints(*crate, &corners);
  std::vector<cairn::Manifold> manifolds;
  if (!points.empty()) {
    const auto count = static_cast<std::int8_t>(points.size());
    manifolds.push_back({.body_a = 0, .body_b = cairn::kWorld, .points = count});
  }
  const std::array joints{cairn::Joint{.body_a = 1, .body_b = 0, .rows = 3, .opposite = true}};
  const std::array joint_rows = RowsOf(*hook, *lamp, *crate);
  cairn::ContactProblem problem{bodies, {}, manifolds, points};
  problem.joints = joints;
  problem.joint_rows = joint_rows;

  // warm start: what the same corners and the same joint exerted in the last frame
  std::vector<cairn::ContactImpulse> pushes;
  for (int corner : corners) pushes.push_back(crate->impulses[corner]);
  const cairn::Impulses impulses{.rows = {}, .points = pushes, .joint_rows = hook->impulses};
  std::array<cairn::Velocity, 2> velocities;
  const cairn::Report report = solver->Solve(problem, impulses, velocities);
  if (!report.ok()) return report;  // nothing was written

  // results back
  crate->impulses.fill({});
  for (size_t i = 0; i < pushes.size(); ++i) crate->impulses[corners[i]] = pushes[i];
  Move(velocities[0], crate);
  Move(velocities[1], lamp);
  return report;
}
// [/step]

}  // namespace

// [main]
int main() {
  Box crate{.mass = 10, .half = 0.5, .position = {0, 0.7, 0}};
  Box lamp{.mass = 1, .half = 0.1, .position = {0.8, 0.7, 0}};
  Hook hook{.on_lamp = {0, 0.5, 0}, .on_crate = {0.8, 0.5, 0}};

  cairn::Solver solver({.budget = cairn::Budget::Work(2000)});  // or Time: see budget.h
  for (int frame = 0; frame < 120; ++frame) {
    if (!Step(&solver, &crate, &lamp, &hook).ok()) return 1;
  }

  float ground = 0;
  for (const cairn::ContactImpulse& corner : crate.impulses) ground += corner.normal;
  std::printf("crate at %.2f m, lamp at %.2f m, ground gives %.2f N s a frame, hook %.2f N s\n",
              crate.position.y(), lamp.position.y(), ground, hook.impulses[1]);
}
// [/main]
