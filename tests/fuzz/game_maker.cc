// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "cairn/detail/eigen.h"
#include "tests/fuzz/contact_game.h"

namespace cairn::test {
namespace {

/// As many numbers as there once were, so that inputs kept from then mean what they meant.
constexpr Path kPaths[] = {Path::kAuto, Path::kReference, Path::kReference, Path::kReference,
                           Path::kFast};

constexpr int kMostBodies = 8, kMostRows = 24, kMostManifolds = 6, kMostJoints = 5;

}  // namespace

Settings GameMaker::MakeSettings() {
  Choices& c = choices_;
  Settings settings;
  settings.method = Method(c.OneIn(32) ? c.Below(5) : 2 - c.Below(3) % 3);
  settings.path = kPaths[c.Below(5)];
  if (c.Below(2) == 0) settings.path = Path::kFast;
  settings.k_gs = 1 + c.Below(6);
  settings.k_sm = c.OneIn(16) ? 1000 : c.Below(4);
  settings.max_sweeps = c.Below(16);
  constexpr double kTolerances[] = {0, 1e-3, 1e-6, 1e-1};
  settings.tolerance = kTolerances[c.Below(4)];
  settings.tuning.min_progress = c.OneIn(4) ? 1e-5 : 0;
  if (c.OneIn(3)) settings.budget = Budget::Work(c.Byte() * (c.Below(2) == 0 ? 1 : 100));
  settings.tuning.min_sweeps = c.Below(3);
  settings.tuning.omega = c.OneIn(3) ? 1.5 : 1;
  settings.tuning.lifted_friction = detail::LiftedFriction(c.OneIn(4));
  settings.acceleration = Acceleration(c.Below(2));
  settings.step_policy = StepPolicy(c.Below(2));
  constexpr double kProximal[] = {3e-3, 1e-8, 1, 1e-5};
  settings.tuning.proximal = kProximal[c.Below(4)];
  settings.proximal_joints = c.OneIn(3) ? 1e-12 : 1e-6;
  settings.tuning.refinements = 1 + (c.OneIn(4) ? c.Byte() : c.Below(3));
  return settings;
}

int GameMaker::AnyBody(const GameWorld& world) {
  const int bodies = static_cast<int>(world.bodies.size());
  if (choices_.OneIn(128)) return bodies;  // which is not there
  return choices_.Below(bodies + 1) - 1;
}

void GameMaker::Put(float* to) {
  for (int k = 0; k < 3; ++k) to[k] = numbers_.Float();
}

Body GameMaker::MakeBody() {
  Body body;
  const int kind = choices_.Below(8);
  if (kind > 0) body.inv_mass = kind > 1 ? numbers_.Positive() : 1;
  if (kind == 0 && choices_.Below(2) == 0) return body;
  Eigen::Matrix3d root = Eigen::Matrix3d::Identity();
  if (kind > 4) root << Vector(), Vector(), Vector();
  if (kind > 0 && kind != 2) body.inv_inertia = root * root.transpose();
  if (kind == 7) body.linear_factor = Eigen::Vector3d(choices_.Below(2), choices_.Below(2), 1);
  return body;
}

Row GameMaker::MakeRow(const GameWorld& world) {
  Row row;
  row.body_a = AnyBody(world);
  row.body_b = AnyBody(world);
  row.linear_a = choices_.OneIn(6) ? Eigen::Vector3d(Eigen::Vector3d::Zero()) : Vector();
  row.linear_b = choices_.OneIn(4) ? Vector() : Eigen::Vector3d(-View(row.linear_a));
  row.angular_a = Vector();
  row.angular_b = Vector();
  row.target = numbers_.Real();
  if (choices_.OneIn(4)) row.compliance = numbers_.Positive();
  const int bounds = choices_.Below(4);
  if (bounds == 0) row.lo = 0;
  if (bounds == 1) {
    const double first = numbers_.Real(), second = numbers_.Real();
    row.lo = std::min(first, second);
    row.hi = std::max(first, second);
  }
  if (!world.rows.empty() && choices_.Below(2) == 0) {
    const int parent = choices_.Below(static_cast<int>(world.rows.size()));
    row.parent = parent;
    row.body_a = world.rows[parent].body_a;
    row.body_b = world.rows[parent].body_b;
    row.friction = numbers_.Positive();
    if (bounds == 1) row.lo = -(row.hi = std::abs(row.hi));
  }
  if (choices_.OneIn(6)) row.relaxation = 0.5 + choices_.Byte() / 200.0;
  if (choices_.OneIn(6)) row.host.max_sweeps = choices_.Below(8);
  return row;
}

JointRow GameMaker::MakeJointRow() {
  JointRow row{};
  Put(row.linear_a);
  for (int k = 0; k < 3; ++k) row.linear_b[k] = -row.linear_a[k];
  if (choices_.OneIn(4)) Put(row.linear_b);
  Put(row.angular_a);
  Put(row.angular_b);
  row.target = numbers_.Float();
  row.compliance = numbers_.PositiveFloat();
  const float first = numbers_.Float(), second = numbers_.Float();
  row.lo = std::min(first, second);
  row.hi = std::max(first, second);
  return row;
}

ContactPoint GameMaker::MakePoint() {
  ContactPoint point{};
  Put(point.arm_a);
  Put(point.arm_b);
  Eigen::Vector3d normal = Vector();
  if (!choices_.OneIn(16)) {
    normal = normal.allFinite() && normal.norm() > 0 ? normal.normalized() : normal.UnitY();
  }
  for (int k = 0; k < 3; ++k) point.normal[k] = static_cast<float>(normal[k]);
  point.bias = numbers_.Float();
  if (choices_.OneIn(4)) point.restitution = numbers_.PositiveFloat();
  point.friction = numbers_.PositiveFloat();
  point.compliance = numbers_.PositiveFloat();
  return point;
}

void GameMaker::ChangeBodies(GameWorld* world) {
  std::vector<Body>& bodies = world->bodies;
  while (bodies.size() < kMostBodies && (bodies.empty() || !choices_.OneIn(3))) {
    if (choices_.empty() && !bodies.empty()) return;
    bodies.push_back(MakeBody());
    if (choices_.Below(2) == 0) bodies.back().id = choices_.Below(6);
  }
  if (bodies.size() > 1 && choices_.OneIn(4)) bodies.pop_back();
}

void GameMaker::ChangeRows(GameWorld* world) {
  // what is left of the last frame, and some more: parents stay where they are
  std::vector<Row>& rows = world->rows;
  if (choices_.OneIn(4)) rows.resize(choices_.Below(static_cast<int>(rows.size()) + 1));
  const int bodies = static_cast<int>(world->bodies.size());
  for (Row& row : rows) {
    row.body_a = std::min(row.body_a, bodies - 1);
    row.body_b = std::min(row.body_b, bodies - 1);
  }
  for (int more = choices_.Below(8); more > 0 && rows.size() < kMostRows; --more) {
    rows.push_back(MakeRow(*world));
  }
}

void GameMaker::ChangeJoints(GameWorld* world) {
  std::vector<Joint>& joints = world->joints;
  if (choices_.OneIn(4) && !joints.empty()) joints.erase(joints.begin());
  for (int more = choices_.Below(3); more > 0 && joints.size() < kMostJoints; --more) {
    Joint& joint = joints.emplace_back();
    joint.rows = 1 + choices_.Below(6);
    joint.bounded = static_cast<std::uint32_t>(choices_.Byte());
    joint.soft = choices_.OneIn(3);
    joint.opposite = choices_.Below(2) == 0;
    if (choices_.OneIn(4)) joint.damping = numbers_.Float();
    if (choices_.OneIn(6)) joint.host.max_sweeps = choices_.Below(8);
  }
  world->joint_rows.clear();
  for (Joint& joint : joints) {
    joint.body_a = AnyBody(*world);
    joint.body_b = AnyBody(*world);
    joint.first_row = static_cast<int>(world->joint_rows.size());
    joint.angular = 0;
    for (int i = 0; i < joint.rows; ++i) {
      JointRow& row = world->joint_rows.emplace_back(MakeJointRow());
      if (!choices_.OneIn(3)) continue;
      joint.angular |= 1u << i;
      for (int k = 0; k < 3; ++k) row.linear_a[k] = row.linear_b[k] = 0;
    }
  }
}

void GameMaker::ChangeManifolds(GameWorld* world) {
  std::vector<Manifold>& manifolds = world->manifolds;
  if (choices_.OneIn(4) && !manifolds.empty()) manifolds.erase(manifolds.begin());
  for (int more = choices_.Below(4); more > 0 && manifolds.size() < kMostManifolds; --more) {
    Manifold manifold{.body_a = AnyBody(*world), .body_b = AnyBody(*world)};
    manifold.points = static_cast<std::int8_t>(1 + choices_.Below(4));
    manifold.tangents = static_cast<std::int8_t>(choices_.Below(3));
    manifold.soft = choices_.OneIn(4);
    manifold.twists = choices_.OneIn(4);
    if (choices_.OneIn(6)) manifold.host.max_sweeps = choices_.Below(8);
    manifolds.push_back(manifold);
  }
  world->points.clear();
  const int bodies = static_cast<int>(world->bodies.size());
  for (Manifold& manifold : manifolds) {
    manifold.body_a = std::min(manifold.body_a, bodies - 1);
    manifold.body_b = std::min(manifold.body_b, bodies - 1);
    manifold.first_point = static_cast<int>(world->points.size());
    for (int p = 0; p < manifold.points; ++p) world->points.push_back(MakePoint());
  }
  world->law = {.bounce_speed = choices_.OneIn(2) ? numbers_.PositiveFloat() : 0.0f,
                .host = {.spin_before_torques = choices_.OneIn(3)}};
}

void GameMaker::ChangeNumbers(GameWorld* world) {
  for (Body& body : world->bodies) {
    body.velocity = {Vector(), Vector()};
    body.impulse = choices_.OneIn(2) ? Vector() : Eigen::Vector3d(0, -1, 0);
    if (choices_.OneIn(3)) body.angular_impulse = Vector();
  }
  world->motions.clear();
  if (choices_.OneIn(3)) {
    for (size_t i = 0; i < world->bodies.size(); ++i) {
      ContactMotion& motion = world->motions.emplace_back();
      for (float* to :
           {motion.free_velocity, motion.free_spin, motion.start_velocity, motion.start_spin}) {
        Put(to);
      }
    }
  }
}

void GameMaker::Fit(GameWorld* world) {
  const bool cold = choices_.OneIn(4);
  const auto fit = [&](size_t size, auto* values, const auto& value) {
    if (cold) values->clear();
    values->resize(size);
    for (auto& entry : *values) {
      if (choices_.OneIn(8)) entry = value();
    }
  };
  fit(world->rows.size(), &world->row_impulses, [&] { return numbers_.Real(); });
  fit(world->joint_rows.size(), &world->joint_impulses, [&] { return numbers_.Float(); });
  fit(world->points.size(), &world->point_impulses, [&] {
    return ContactImpulse{.normal = numbers_.Float(),
                          .tangential = {numbers_.Float(), numbers_.Float()},
                          .heading = static_cast<float>(choices_.Byte()) / 40};
  });
  const bool twists = std::any_of(world->manifolds.begin(), world->manifolds.end(),
                                  [](const Manifold& manifold) { return manifold.twists; });
  world->twists.resize(twists ? world->points.size() : 0);
  for (ContactTwist& twist : world->twists) {
    twist = {numbers_.PositiveFloat(), numbers_.PositiveFloat(), numbers_.PositiveFloat(),
             numbers_.PositiveFloat()};
  }
  fit(world->twists.size(), &world->twist_impulses, [&] {
    return TwistImpulse{.spinning = numbers_.Float(), .rolling = {numbers_.Float(), 0}};
  });
  world->velocities.assign(world->bodies.size(), Velocity{{7, 7, 7}, {7, 7, 7}});
}

void GameMaker::NextFrame(GameWorld* world) {
  ChangeBodies(world);
  if (choices_.Below(2) == 0) ChangeRows(world);
  if (choices_.Below(2) == 0) ChangeJoints(world);
  if (choices_.Below(2) == 0) ChangeManifolds(world);
  ChangeNumbers(world);
  Fit(world);
}

}  // namespace cairn::test
