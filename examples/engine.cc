// SPDX-License-Identifier: MIT
// The smallest engine around the solver: boxes and a ball, a tower, a platform, a door with a
// motor.
#include <cairn/joints.h>
#include <cairn/solver.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <condition_variable>
#include <cstdint>
#include <cstdio>
#include <deque>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// [things]
constexpr double kStep = 1 / 60.0;  // [s]
constexpr double kGravity = 9.81;   // [m/s^2]

// A box, or a ball. Without mass it goes where its velocity takes it, whatever pushes.
struct Thing {
  double mass = 0;                       // [kg]
  Vector3d half = Vector3d::Zero();      // half the edges of a box [m]
  Vector3d position = Vector3d::Zero();  // of the centre of mass [m]
  double radius = 0;                     // of a ball [m]
  double restitution = 0;
  Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
  cairn::Velocity velocity = {};
};

// Thing 0 is the ground; every other one is a body, in the same order.
int BodyOf(int thing) { return thing == 0 ? cairn::kWorld : thing - 1; }

cairn::Body ToBody(const Thing& thing, std::uint64_t id) {
  cairn::Body body{.velocity = thing.velocity, .id = id};
  if (thing.mass == 0) return body;
  body.inv_mass = 1 / thing.mass;
  body.impulse = {0, -thing.mass * kGravity * kStep, 0};
  const Vector3d squares = thing.half.cwiseAbs2();
  const Vector3d box = thing.mass / 3 * (Vector3d::Constant(squares.sum()) - squares);
  const Vector3d ball = Vector3d::Constant(0.4 * thing.mass * thing.radius * thing.radius);
  const Matrix3d axes = thing.turn.toRotationMatrix();
  const Vector3d inertia = thing.radius > 0 ? ball : box;
  body.inv_inertia = axes * inertia.cwiseInverse().asDiagonal() * axes.transpose();
  return body;
}
// [/things]

// [contacts]
using Points = std::vector<cairn::TouchPoint>;

// Corners of box a at the face of box b that looks towards a; returns the normal of that face.
Vector3d FindBoxPoints(const Thing& a, const Thing& b, Points* points) {
  const Vector3d local = b.turn.inverse() * (a.position - b.position);
  int face;
  (local.cwiseAbs() - b.half).maxCoeff(&face);
  const double side = local[face] < 0 ? -1 : 1;
  for (std::uint32_t i = 0; i < 8; ++i) {
    const Vector3d signs(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
    const Vector3d corner = a.position + a.turn * signs.cwiseProduct(a.half);
    Vector3d beyond = b.turn.inverse() * (corner - b.position);
    const double depth = b.half[face] - side * beyond[face];
    beyond[face] = 0;
    const bool over = ((beyond.cwiseAbs() - b.half).array() < 0.02).all();
    if (over && depth > -0.05) points->push_back({corner, depth, i});
  }
  return b.turn * (side * Vector3d::Unit(face));
}

Vector3d FindBallPoint(const Thing& ball, const Thing& box, Points* points) {
  const Vector3d local = box.turn.inverse() * (ball.position - box.position);
  const Vector3d nearest = local.cwiseMin(box.half).cwiseMax(-box.half);
  const double distance = (local - nearest).norm();
  points->push_back({box.position + box.turn * nearest, ball.radius - distance});
  return box.turn * ((local - nearest) / distance);
}

void FindContacts(const std::vector<Thing>& things, cairn::Contacts* contacts) {
  Points points;
  for (int a = 1; a < static_cast<int>(things.size()); ++a) {
    for (int b = 0; b < a; ++b) {
      const Thing &first = things[a], &second = things[b];
      if (first.mass + second.mass == 0) continue;  // nothing would come of it
      points.clear();
      const auto find = first.radius > 0 ? FindBallPoint : FindBoxPoints;
      const Vector3d normal = find(first, second, &points);
      cairn::Touch touch{BodyOf(a), BodyOf(b), first.position, second.position, normal};
      touch.restitution = std::max(first.restitution, second.restitution);
      touch.id = static_cast<std::uint64_t>(a) * things.size() + b;  // any name of the two does
      contacts->Add(touch, points);
    }
  }
}
// [/contacts]

// [door]
// A door on the world: its hinge is at one edge, upright. A motor opens it as far as it goes.
void HangDoor(const Thing& door, const Thing& closed, int body, cairn::Joints* joints) {
  Matrix3d upright;  // the axis of a hinge is x: here the world's y
  upright << 0, 0, 1, 1, 0, 0, 0, 1, 0;
  const Vector3d edge(-door.half.x(), 0, 0);
  const cairn::JointAxis about{.lo = 0, .hi = 1.5, .speed = 1, .motor_most = 50};
  joints->Add(cairn::HingeJoint(about),
              {.body = body,
               .centre = door.position,
               .anchor = door.position + door.turn * edge,
               .axes = door.turn * upright},
              {.anchor = closed.position + edge, .axes = upright}, 1);
}
// [/door]

// [step]
struct World {
  std::vector<Thing> things;
  cairn::Contacts contacts;
  cairn::Joints joints;
  cairn::Solver solver;
  int door = 0;
  Thing closed_door = {};
};

void Move(const cairn::Velocity& velocity, Thing* thing) {
  thing->velocity = velocity;
  thing->position += kStep * velocity.linear;
  const double angle = kStep * velocity.angular.norm();
  if (angle == 0) return;
  thing->turn = Eigen::AngleAxisd(angle, velocity.angular.normalized()) * thing->turn;
  thing->turn.normalize();
}

cairn::Report Step(World* world) {
  std::vector<cairn::Body> bodies;
  for (size_t i = 1; i < world->things.size(); ++i) bodies.push_back(ToBody(world->things[i], i));
  const cairn::StepInput step{.bodies = bodies, .time_step = kStep};
  world->contacts.Begin(step);
  FindContacts(world->things, &world->contacts);
  world->joints.Begin(step);
  HangDoor(world->things[world->door], world->closed_door, BodyOf(world->door), &world->joints);

  std::vector<cairn::Velocity> velocities(bodies.size());
  cairn::Report report = world->solver.Solve(ProblemOf(step, world->contacts, world->joints),
                                             StartOf(&world->contacts, &world->joints), velocities);
  if (!report.ok()) return report;  // nothing was written
  for (size_t i = 0; i < bodies.size(); ++i) Move(velocities[i], &world->things[i + 1]);
  return report;
}
// [/step]

// [jobs]
// A thread of the engine, which the solver takes where a frame is large enough.
class JobSystem final : public cairn::Executor {
 public:
  ~JobSystem() override { Submit(nullptr, nullptr); }
  void Submit(void (*work)(void*), void* what) override {
    const std::lock_guard lock(mutex_);
    jobs_.emplace_back(work, what);
    filled_.notify_one();
  }

 private:
  void Run() {
    for (;;) {
      std::unique_lock lock(mutex_);
      filled_.wait(lock, [this] { return !jobs_.empty(); });
      const auto [work, what] = jobs_.front();
      jobs_.pop_front();
      lock.unlock();
      if (work == nullptr) return;
      work(what);
    }
  }

  std::mutex mutex_;
  std::condition_variable filled_;
  std::deque<std::pair<void (*)(void*), void*>> jobs_;
  std::jthread thread_{[this] { Run(); }};  // the last member: it ends first
};
// [/jobs]

}  // namespace

// [main]
int main() {
  JobSystem jobs;
  World world;
  world.solver.settings().tolerance = 2e-5;  // [m/s]: rest is rest
  world.solver.settings().threads = 2;
  world.solver.settings().executor = &jobs;

  std::vector<Thing>& things = world.things;
  const Vector3d cube(0.5, 0.5, 0.5);
  things.push_back({.half = {50, 1, 50}, .position = {0, -1, 0}});  // the ground
  for (int i = 0; i < 10; ++i) {
    things.push_back({.mass = 10, .half = cube, .position = {0, 0.5 + i, 0}});
  }
  things.push_back({.half = {1, 0.1, 1}, .position = {5, 0, 0}});  // a platform that rises
  things.back().velocity.linear = {0, 0.5, 0};
  things.push_back({.mass = 10, .half = cube, .position = {5, 0.6, 0}});
  things.push_back({.mass = 1, .position = {-5, 2.2, 0}, .radius = 0.2, .restitution = 0.5});
  world.closed_door = {.mass = 20, .half = {0.5, 1, 0.05}, .position = {0, 1.01, 5}};
  world.door = static_cast<int>(things.size());
  things.push_back(world.closed_door);

  double bounce = 0;
  for (int frame = 0; frame < 300; ++frame) {
    const cairn::Report report = Step(&world);
    if (!report.ok()) return std::puts(Describe(report).c_str()), 1;
    const bool after_first_landing = frame > 40 && frame < 80;
    if (after_first_landing) bounce = std::max(bounce, things[13].position.y() - 0.2);
  }
  double fastest = 0;
  for (int i = 1; i <= 10; ++i) fastest = std::max(fastest, things[i].velocity.linear.norm());
  const Eigen::Quaterniond& door = things[world.door].turn;
  std::printf(
      "tower %.2f m high and %s, ball bounced to %.2f m, box was lifted to %.2f m, door is "
      "open by %.2f rad\n",
      things[10].position.y() + 0.5, fastest < 1e-3 ? "at rest" : "moving", bounce,
      things[12].position.y(), 2 * std::atan2(door.y(), door.w()));
}
// [/main]
