// SPDX-License-Identifier: MIT
// [bodies]
#include <cairn/joints.h>
#include <cairn/solver.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdio>
#include <future>
#include <vector>

using Eigen::Matrix3d, Eigen::Quaterniond, Eigen::Vector3d;
constexpr double kStep = 1 / 60.0, kGravity = 9.81;  // [s], [m/s^2]

// A box, or a ball: half the edges, or the radius [m]. Without mass [kg] nothing pushes it aside.
struct Thing {
  double mass = 0, radius = 0, restitution = 0;
  Vector3d half = Vector3d::Zero(), position = Vector3d::Zero();
  Quaterniond turn = Quaterniond::Identity();
  cairn::Velocity velocity = {};
  bool asleep = false;
  bool moves() const { return !asleep && (mass > 0 || velocity.linear != cairn::Vector3()); }
};

cairn::Body ToBody(const Thing& t, std::uint64_t id) {
  cairn::Body body{.velocity = t.velocity, .id = id};
  if (t.mass == 0 || t.asleep) return body;
  body.inv_mass = 1 / t.mass;
  body.impulse = {0, -t.mass * kGravity * kStep, 0};
  const Vector3d squares = t.half.cwiseAbs2().array() + 0.6 * t.radius * t.radius;
  const Vector3d inertia = t.mass / 3 * (Vector3d::Constant(squares.sum()) - squares);
  const Matrix3d axes(t.turn);
  body.inv_inertia = axes * inertia.cwiseInverse().asDiagonal() * axes.transpose();
  return body;
}
// [/bodies]

// [world]
struct Link {  // holds two things together: where, and along which axes, as each of them sees it
  cairn::JointKind kind;
  int things[2];
  Vector3d anchors[2];
  Matrix3d axes;
};

struct World {
  std::vector<Thing> things;  // thing i is body i - 1; thing 0 is the ground: cairn::kWorld, -1
  std::vector<Link> links;
  cairn::Contacts contacts;
  cairn::Joints joints;
  cairn::Solver solver;
};
// [/world]

// [contacts]
// Corners of box a, or the middle of ball a, at the face of box b that looks towards a.
void AddContact(int a, int b, World* world) {
  Thing &first = world->things[a], &second = world->things[b];
  if (second.radius > first.radius) return AddContact(b, a, world);
  const Quaterniond to_b = second.turn.inverse();
  const Vector3d local = to_b * (first.position - second.position);
  int face;
  (local.cwiseAbs() - second.half).maxCoeff(&face);
  const double side = local[face] < 0 ? -1 : 1;
  std::vector<cairn::TouchPoint> points;
  for (std::uint32_t i = 0; i < (first.radius > 0 ? 1 : 8); ++i) {
    const Vector3d signs(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
    const Vector3d corner = local + to_b * (first.turn * signs.cwiseProduct(first.half));
    const double depth = second.half[face] + first.radius - side * corner[face];
    Vector3d at = corner.cwiseMin(second.half).cwiseMax(-second.half);
    at[face] = corner[face] - side * first.radius;  // the edge carries what hangs over
    if ((at - corner).norm() < first.radius + 0.1 && depth > -0.05)
      points.push_back({second.position + second.turn * at, depth, i});
  }
  if (points.empty() || !(first.moves() || second.moves())) return;
  first.asleep = second.asleep = false;
  const Vector3d normal = second.turn * (side * Vector3d::Unit(face));
  cairn::Touch touch{a - 1, b - 1, first.position, second.position, normal};
  touch.restitution = std::max(first.restitution, second.restitution);
  touch.id = static_cast<std::uint64_t>(a) << 32 | b;  // any name of the two does
  world->contacts.Add(touch, points);
}
// [/contacts]

// [joints]
void AddJoint(const Link& link, std::uint64_t id, World* world) {
  Thing &a = world->things[link.things[0]], &b = world->things[link.things[1]];
  if (!a.moves() && !b.moves()) return;
  a.asleep = b.asleep = false;
  const auto side = [&link](int i, const Thing& thing) -> cairn::JointSide {
    return {link.things[i] - 1, thing.position, thing.position + thing.turn * link.anchors[i],
            thing.turn * link.axes};
  };
  world->joints.Add(link.kind, side(0, a), side(1, b), id);
}
// [/joints]

// [step]
cairn::Report Step(World* world) {
  auto& [things, links, contacts, joints, solver] = *world;
  std::vector<cairn::Body> bodies;
  for (size_t i = 1; i < things.size(); ++i) bodies.push_back(ToBody(things[i], i));
  const cairn::StepInput step{.bodies = bodies, .time_step = kStep};
  contacts.Begin(step);
  for (size_t a = 1; a < things.size(); ++a)
    for (size_t b = 0; b < a; ++b) AddContact(a, b, world);
  joints.Begin(step);
  for (size_t i = 0; i < links.size(); ++i) AddJoint(links[i], i + 1, world);
  std::vector<cairn::Velocity> velocities(bodies.size());
  cairn::Report report =
      solver.Solve(ProblemOf(step, contacts, joints), StartOf(&contacts, &joints), velocities);
  if (!report.ok()) return report;  // nothing was written
  for (size_t i = 0; i < bodies.size(); ++i) {
    Thing& thing = things[i + 1];
    const int island = report.island_of[i];  // -1: nothing touches it, or it sleeps
    thing.asleep |= island >= 0 && report.islands[island].quiet >= 30;
    thing.velocity = thing.asleep ? cairn::Velocity() : velocities[i];
    thing.position += kStep * Vector3d(thing.velocity.linear);
    const Vector3d turn = kStep * Vector3d(thing.velocity.angular);
    thing.turn = (Eigen::AngleAxisd(turn.norm(), turn.normalized()) * thing.turn).normalized();
  }
  return report;
}
// [/step]

// [jobs]
struct JobSystem final : cairn::Executor {  // the threads of an engine: here one at a time
  void Submit(void (*work)(void*), void* what) override { job = std::async(work, what); }
  std::future<void> job;
};
// [/jobs]

// [main]
int main() {
  JobSystem jobs;
  World world;
  world.solver.settings() = {.tolerance = 2e-5, .threads = 2, .executor = &jobs};
  world.things = {
      {.half = {50, 1, 50}, .position = {0, -1, 0}},                            // the ground
      {.half = {1, 0.1, 1}, .position = {5, 0, 0}, .velocity = {{0, 0.5, 0}}},  // a platform
      {.mass = 10, .half = {0.5, 0.5, 0.5}, .position = {5, 0.6, 0}},  // the platform lifts it
      {.mass = 1, .radius = 0.2, .restitution = 0.5, .position = {-5, 2.2, 0}},  // a ball
      {.mass = 20, .half = {0.5, 1, 0.05}, .position = {0, 1.2, 5}},             // a door
      {.mass = 30, .half = {0.2, 0.3, 0.1}, .position = {-10, 2, 0}, .velocity = {{0, 0, 3}}},
      {.mass = 5, .half = {0.1, 0.12, 0.1}, .position = {-10, 2.5, 0}},  // a ragdoll: chest, head,
      {.mass = 5, .half = {0.3, 0.05, 0.05}, .position = {-10.6, 2.25, 0}},  // limbs
      {.mass = 5, .half = {0.3, 0.05, 0.05}, .position = {-9.4, 2.25, 0}},
      {.mass = 5, .half = {0.07, 0.4, 0.07}, .position = {-10.1, 1.2, 0}},
      {.mass = 5, .half = {0.07, 0.4, 0.07}, .position = {-9.9, 1.2, 0}}};
  for (int i = 0; i < 10; ++i)
    world.things.push_back({.mass = 10, .half = {0.5, 0.5, 0.5}, .position = {0, 0.5 + i, 0}});
  const Matrix3d flat = Matrix3d::Identity(), up(Quaterniond(0.5, 0.5, 0.5, 0.5));  // x is up
  const auto hinge = cairn::HingeJoint({.lo = 0, .hi = 1.5, .speed = 1, .max_motor_force = 50});
  const auto cone = cairn::ConeTwistJoint(0.8, {.lo = -0.3, .hi = 0.3});
  world.links = {{hinge, {4, 0}, {{-0.5, 0, 0}, {-0.5, 2.2, 5}}, up},
                 {cone, {6, 5}, {{0, -0.16, 0}, {0, 0.34, 0}}, up},
                 {cone, {7, 5}, {{0.35, 0, 0}, {-0.25, 0.25, 0}}, flat},
                 {cone, {8, 5}, {{-0.35, 0, 0}, {0.25, 0.25, 0}}, flat},
                 {cone, {9, 5}, {{0, 0.45, 0}, {-0.1, -0.35, 0}}, up},
                 {cone, {10, 5}, {{0, 0.45, 0}, {0.1, -0.35, 0}}, up}};
  for (int frame = 0; frame < 300; ++frame) {
    const cairn::Report report = Step(&world);
    if (!report.ok()) return std::puts(Describe(report).c_str()), 1;
    if (frame == 57) std::printf("ball bounced to %.2f m, ", world.things[3].position.y() - 0.2);
  }
  const Thing& top = world.things.back();
  std::printf("box at %.2f m, door open by %.2f rad, head at %.1f m, tower %.2f m, asleep: %d\n",
              world.things[2].position.y(), Eigen::AngleAxisd(world.things[4].turn).angle(),
              world.things[6].position.y(), top.position.y() + 0.5, top.asleep);
}
// [/main]
