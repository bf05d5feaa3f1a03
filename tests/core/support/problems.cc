// SPDX-License-Identifier: MIT
#include "problems.h"
#include "cairn/detail/eigen.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

namespace cairn::test {

Solution Solve(Solver* solver, const Scene& scene, std::vector<double> start) {
  Solution solution{.report = {}, .x = std::move(start), .v = {}};
  if (solution.x.empty()) solution.x.assign(scene.rows.size(), 0);
  solution.v.resize(scene.bodies.size());
  solution.report = solver->Solve(scene.problem(), solution.x, solution.v);
  return solution;
}

Solution Solve(const Settings& settings, const Scene& scene, std::vector<double> start) {
  Solver solver(settings);
  return Solve(&solver, scene, std::move(start));
}

testing::AssertionResult SameBits(const Solution& a, const Solution& b) {
  static_assert(sizeof(Velocity) == 6 * sizeof(double), "no padding to compare");
  if (a.x.size() != b.x.size() || a.v.size() != b.v.size()) {
    return testing::AssertionFailure() << "sizes differ";
  }
  for (size_t i = 0; i < a.x.size(); ++i) {
    if (std::memcmp(&a.x[i], &b.x[i], sizeof(double)) == 0) continue;
    return testing::AssertionFailure()
           << "impulse " << i << ": " << a.x[i] << " and " << b.x[i] << ", " << a.x[i] - b.x[i];
  }
  for (size_t i = 0; i < a.v.size(); ++i) {
    if (std::memcmp(&a.v[i], &b.v[i], sizeof(Velocity)) == 0) continue;
    return testing::AssertionFailure() << "velocity of body " << i;
  }
  return testing::AssertionSuccess();
}

double Distance(const std::vector<double>& a, const std::vector<double>& b) {
  double largest = 0;
  for (size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::abs(a[i] - b[i]));
  return largest;
}

double Distance(const std::vector<Velocity>& a, const std::vector<Velocity>& b) {
  double largest = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    largest = std::max({largest, (View(a[i].linear) - View(b[i].linear)).cwiseAbs().maxCoeff(),
                        (View(a[i].angular) - View(b[i].angular)).cwiseAbs().maxCoeff()});
  }
  return largest;
}

Settings PlainSweeps(int sweeps) {
  return {.method = Method::kPgs,
          .path = Path::kReference,
          .k_sm = 0,
          .max_sweeps = sweeps,
          .tolerance = 0,
          .tuning = {.min_sweeps = 0}};
}

Settings AlwaysSteps(int sweeps) {
  return {.path = Path::kReference,
          .max_sweeps = sweeps,
          .tolerance = 0,
          .step_policy = StepPolicy::kAlways,
          .tuning = {.min_sweeps = 0}};
}

double Random::Uniform(double lo, double hi) {
  const double share = static_cast<double>(engine_() >> 11) * 0x1p-53;
  return lo + share * (hi - lo);
}

Vector3d Random::Vector(double size) {
  const double x = Uniform(-size, size), y = Uniform(-size, size), z = Uniform(-size, size);
  return {x, y, z};
}

Vector3d Random::Direction() {
  Vector3d v = Vector(1);
  while (v.norm() < 0.1 || v.norm() > 1) v = Vector(1);
  return v.normalized();
}

Eigen::Matrix3d Random::Rotation() {
  const Vector3d axis = Direction();
  return Eigen::AngleAxisd(Uniform(0, 3), axis).toRotationMatrix();
}

Body PointMass(double mass, const Vector3d& impulse) {
  Body body;
  body.inv_mass = 1 / mass;
  body.impulse = impulse;
  return body;
}

Body Box(double mass, const Vector3d& sides) {
  Body body = PointMass(mass);
  const Vector3d s = sides.cwiseProduct(sides);
  const Vector3d inertia = mass / 12 * Vector3d(s.y() + s.z(), s.x() + s.z(), s.x() + s.y());
  body.inv_inertia = inertia.cwiseInverse().asDiagonal();
  return body;
}

Body RandomBody(Random* random) {
  Body body = PointMass(std::pow(10, random->Uniform(-1, 1)));
  const Eigen::Matrix3d turn = random->Rotation();
  const Vector3d axes = Vector3d::Constant(6) + random->Vector(3);
  const Eigen::Matrix3d root = turn * axes.cwiseSqrt().asDiagonal();
  const Eigen::Matrix3d product = body.inv_mass * (root * root.transpose());
  body.inv_inertia = 0.5 * (product + product.transpose());
  body.velocity = {.linear = random->Vector(1), .angular = random->Vector(1)};
  body.impulse = random->Vector(0.3) / body.inv_mass;
  body.angular_impulse = random->Vector(0.1) / body.inv_mass;
  return body;
}

Row LinearRow(int a, int b, const Vector3d& direction) {
  Row row;
  row.body_a = a;
  row.body_b = b;
  if (a != kWorld) row.linear_a = direction;
  if (b != kWorld) row.linear_b = -direction;
  return row;
}

Row PushRow(int a, int b, const Vector3d& normal) {
  Row row = LinearRow(a, b, normal);
  row.lo = 0;
  return row;
}

Row AngularRow(int a, int b, const Vector3d& axis) {
  Row row;
  row.body_a = a;
  row.body_b = b;
  if (a != kWorld) row.angular_a = axis;
  if (b != kWorld) row.angular_b = -axis;
  return row;
}

Row PointRow(const Scene& scene, int a, int b, const Vector3d& point, const Vector3d& direction) {
  Row row = LinearRow(a, b, direction);
  if (a != kWorld) row.angular_a = (point - scene.positions[a]).cross(direction);
  if (b != kWorld) row.angular_b = -(point - scene.positions[b]).cross(direction);
  return row;
}

void AddContact(Scene* scene, Row normal, const Vector3d& point, double friction) {
  const int a = normal.body_a, b = normal.body_b;
  const Vector3d n = a != kWorld ? Vector3d(normal.linear_a) : Vector3d(-View(normal.linear_b));
  const Vector3d first = n.unitOrthogonal(), second = n.cross(first);
  const int parent = static_cast<int>(scene->rows.size());
  normal.lo = 0;
  scene->rows.push_back(normal);
  for (const Vector3d& direction : {first, second}) {
    Row row = PointRow(*scene, a, b, point, direction);
    row.parent = parent;
    row.friction = friction;
    scene->rows.push_back(row);
  }
}

void AddPin(Scene* scene, int a, int b, const Vector3d& point) {
  for (int axis = 0; axis < 3; ++axis) {
    scene->rows.push_back(PointRow(*scene, a, b, point, Vector3d::Unit(axis)));
  }
}

Scene Tower(int boxes) {
  Scene scene;
  for (int i = 0; i < boxes; ++i) {
    scene.bodies.push_back(Box(1, {1, 1, 1}));
    scene.bodies.back().impulse.z() = -kGravityStep;
    scene.positions.emplace_back(0, 0, i + 0.5);
    for (const auto& [x, y] : {std::pair(-0.5, -0.5), {-0.5, 0.5}, {0.5, -0.5}, {0.5, 0.5}}) {
      const Vector3d point(x, y, i);
      const int below = i == 0 ? kWorld : i - 1;
      AddContact(&scene, PointRow(scene, i, below, point, Vector3d::UnitZ()), point, 0.5);
    }
  }
  return scene;
}

Scene HangingChain(int links, double end_mass) {
  Scene scene;
  Vector3d joint(0, 0, 0);
  for (int i = 0; i < links; ++i) {
    const double mass = i + 1 == links ? end_mass : 1;
    const Vector3d half(0, 0, -0.5);
    scene.bodies.push_back(Box(mass, {0.2, 0.2, 1}));
    scene.bodies.back().impulse.z() = -mass * kGravityStep;
    scene.positions.push_back(joint + half);
    AddPin(&scene, i, i == 0 ? kWorld : i - 1, joint);
    joint += 2 * half;
  }
  return scene;
}

Scene RandomPile(const PileOptions& options, std::uint64_t seed) {
  Random random(seed);
  Scene scene;
  const double side = std::cbrt(static_cast<double>(options.bodies));
  for (int i = 0; i < options.bodies; ++i) {
    scene.bodies.push_back(RandomBody(&random));
    scene.positions.push_back(random.Vector(side));
  }
  for (int i = 0; i < options.contacts + options.pins; ++i) {
    const int a = random.Index(options.bodies);
    int b = (a + 1 + random.Index(options.bodies - 1)) % options.bodies;
    if (random.Uniform(0, 1) < options.world_share) b = kWorld;
    const Vector3d centre = b == kWorld ? scene.positions[a]
                                        : Vector3d(0.5 * (scene.positions[a] + scene.positions[b]));
    const Vector3d point = centre + random.Vector(0.5);
    if (i < options.pins) {
      AddPin(&scene, a, b, point);
      continue;
    }
    Row normal = PointRow(scene, a, b, point, random.Direction());
    normal.target = random.Uniform(-0.1, 0.1);
    normal.compliance = random.Uniform(0, 0.01);
    AddContact(&scene, normal, point, random.Uniform(0, 1));
  }
  return scene;
}

}  // namespace cairn::test
