// SPDX-License-Identifier: MIT
// The smallest engine around the solver: boxes and balls, a tower, a platform, a door with a motor,
// a ragdoll; what rests sleeps.
#include <cairn/joints.h>
#include <cairn/solver.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <future>
#include <vector>

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// [things]
constexpr double kStep = 1 / 60.0, kGravity = 9.81;  // [s], [m/s^2]

// A box, or a ball. Without mass it goes where its velocity takes it, whatever pushes.
struct Thing {
  double mass = 0;                       // [kg]
  Vector3d half = Vector3d::Zero();      // half the edges of a box [m]
  Vector3d position = Vector3d::Zero();  // of the centre of mass [m]
  double radius = 0;                     // of a ball [m]
  double restitution = 0;
  int group = 0;  // things of one group, but 0, pass through each other
  bool asleep = false;
  Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
  cairn::Velocity velocity = {};

  bool moves() const { return !asleep && (mass > 0 || velocity.linear != cairn::Vector3()); }
};

// Thing 0 is the ground; every other one is a body, in the same order.
int BodyOf(int thing) { return thing == 0 ? cairn::kWorld : thing - 1; }

cairn::Body ToBody(const Thing& thing, std::uint64_t id) {
  cairn::Body body{.velocity = thing.velocity, .id = id};
  if (thing.mass == 0 || thing.asleep) return body;
  body.inv_mass = 1 / thing.mass;
  body.impulse = {0, -thing.mass * kGravity * kStep, 0};
  const Vector3d squares = thing.half.cwiseAbs2();
  Vector3d inertia = thing.mass / 3 * (Vector3d::Constant(squares.sum()) - squares);
  if (thing.radius > 0) inertia.setConstant(0.4 * thing.mass * thing.radius * thing.radius);
  const Matrix3d axes = thing.turn.toRotationMatrix();
  body.inv_inertia = axes * inertia.cwiseInverse().asDiagonal() * axes.transpose();
  return body;
}

// What touches something that moves, or is held by it, wakes up. False: nothing comes of the two.
bool Wake(Thing* a, Thing* b) {
  if (a->mass + b->mass == 0 || !(a->moves() || b->moves())) return false;
  a->asleep = b->asleep = false;
  return true;
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
    const Vector3d apart = a.position + a.turn * signs.cwiseProduct(a.half) - b.position;
    const Vector3d corner = b.turn.inverse() * apart;
    const double depth = b.half[face] - side * corner[face];
    Vector3d at = corner.cwiseMin(b.half).cwiseMax(-b.half);  // the edge carries what hangs over
    at[face] = corner[face];
    const bool over = (at - corner).norm() < 0.1;
    if (over && depth > -0.05) points->push_back({b.position + b.turn * at, depth, i});
  }
  return b.turn * (side * Vector3d::Unit(face));
}

Vector3d FindBallPoint(const Thing& ball, const Thing& box, Points* points) {
  const Vector3d local = box.turn.inverse() * (ball.position - box.position);
  const Vector3d nearest = local.cwiseMin(box.half).cwiseMax(-box.half);
  const double depth = ball.radius - (local - nearest).norm();
  if (depth > -0.05) points->push_back({box.position + box.turn * nearest, depth});
  return box.turn * (local - nearest).normalized();
}

void FindContacts(std::vector<Thing>* things, cairn::Contacts* contacts) {
  Points points;
  for (int a = 1; a < static_cast<int>(things->size()); ++a) {
    for (int b = 0; b < a; ++b) {
      Thing &first = (*things)[a], &second = (*things)[b];
      if (first.group != 0 && first.group == second.group) continue;
      points.clear();
      const auto find = first.radius > 0 ? FindBallPoint : FindBoxPoints;
      const Vector3d normal = find(first, second, &points);
      if (points.empty() || !Wake(&first, &second)) continue;
      cairn::Touch touch{BodyOf(a), BodyOf(b), first.position, second.position, normal};
      touch.restitution = std::max(first.restitution, second.restitution);
      touch.id = static_cast<std::uint64_t>(a) * things->size() + b;  // any name of the two does
      contacts->Add(touch, points);
    }
  }
}
// [/contacts]

// [joints]
// Two things held together: where, and along which axes, as each of them sees it.
struct Link {
  cairn::JointKind kind;
  int things[2];
  Vector3d anchors[2];
  Matrix3d axes = Matrix3d::Identity();
};

void AddLink(const Link& link, std::uint64_t id, std::vector<Thing>* things,
             cairn::Joints* joints) {
  Thing &a = (*things)[link.things[0]], &b = (*things)[link.things[1]];
  if (!Wake(&a, &b)) return;
  const auto side = [&link](int i, const Thing& thing) -> cairn::JointSide {
    return {BodyOf(link.things[i]), thing.position, thing.position + thing.turn * link.anchors[i],
            thing.turn * link.axes};
  };
  joints->Add(link.kind, side(0, a), side(1, b), id);
}
// [/joints]

// [step]
struct World {
  std::vector<Thing> things;
  std::vector<Link> links;
  cairn::Contacts contacts;
  cairn::Joints joints;
  cairn::Solver solver;
};

void Move(const cairn::Velocity& velocity, Thing* thing) {
  thing->velocity = velocity;
  thing->position += kStep * Vector3d(velocity.linear);
  const Vector3d turn = kStep * Vector3d(velocity.angular);
  thing->turn = (Eigen::AngleAxisd(turn.norm(), turn.normalized()) * thing->turn).normalized();
}

cairn::Report Step(World* world) {
  std::vector<cairn::Body> bodies;
  for (size_t i = 1; i < world->things.size(); ++i) bodies.push_back(ToBody(world->things[i], i));
  const cairn::StepInput step{.bodies = bodies, .time_step = kStep};
  world->contacts.Begin(step);
  FindContacts(&world->things, &world->contacts);
  world->joints.Begin(step);
  for (size_t i = 0; i < world->links.size(); ++i) {
    AddLink(world->links[i], i + 1, &world->things, &world->joints);
  }
  std::vector<cairn::Velocity> velocities(bodies.size());
  cairn::Report report = world->solver.Solve(ProblemOf(step, world->contacts, world->joints),
                                             StartOf(&world->contacts, &world->joints), velocities);
  if (!report.ok()) return report;  // nothing was written
  for (size_t i = 0; i < bodies.size(); ++i) {
    const int island = report.island_of[i];  // -1: nothing touches it, or it sleeps
    const bool falls_asleep = island >= 0 && report.islands[island].quiet >= 30;
    Move(falls_asleep ? cairn::Velocity{} : velocities[i], &world->things[i + 1]);
    if (falls_asleep) world->things[i + 1].asleep = true;
  }
  return report;
}
// [/step]

// [jobs]
// The threads of the engine, which the solver takes where a frame is large enough: here one.
class JobSystem final : public cairn::Executor {
 public:
  void Submit(void (*work)(void*), void* what) override {
    job_ = std::async(std::launch::async, work, what);  // a pool puts them in its queue
  }

 private:
  std::future<void> job_;
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
  const auto add = [&things](const Thing& thing) {
    things.push_back(thing);
    return static_cast<int>(things.size()) - 1;
  };
  const auto link = [&](const cairn::JointKind& kind, int a, int b, const Vector3d& at,
                        const Matrix3d& axes) {
    world.links.push_back({kind, {a, b}, {at - things[a].position, at - things[b].position}, axes});
  };
  const Vector3d cube(0.5, 0.5, 0.5);
  const int ground = add({.half = {50, 1, 50}, .position = {0, -1, 0}});
  int top = 0;
  for (int i = 0; i < 10; ++i) top = add({.mass = 10, .half = cube, .position = {0, 0.5 + i, 0}});
  const int platform = add({.half = {1, 0.1, 1}, .position = {5, 0, 0}});
  things[platform].velocity.linear = {0, 0.5, 0};  // it rises
  const int lifted = add({.mass = 10, .half = cube, .position = {5, 0.6, 0}});
  const int ball = add({.mass = 1, .position = {-5, 2.2, 0}, .radius = 0.2, .restitution = 0.5});

  // a door with its hinge at one edge, upright; a motor opens it as far as it goes
  Matrix3d upright;  // a hinge turns about its x axis: here the world's y
  upright << 0, 0, 1, 1, 0, 0, 0, 1, 0;
  const int door = add({.mass = 20, .half = {0.5, 1, 0.05}, .position = {0, 1.2, 5}});
  const cairn::JointAxis about{.lo = 0, .hi = 1.5, .speed = 1, .max_motor_force = 50};
  link(cairn::HingeJoint(about), door, ground, {-0.5, 1.2, 5}, upright);

  // a ragdoll that falls: each limb turns in a cone, and is twisted a little
  const Vector3d chest(-10, 2, 0);
  const int torso = add({.mass = 30, .half = {0.2, 0.3, 0.1}, .position = chest, .group = 1});
  const auto limb = [&](const Vector3d& half, const Vector3d& from, const Vector3d& to,
                        const Matrix3d& axes) {
    const Vector3d middle = chest + (from + to) / 2;
    const int part = add({.mass = 5, .half = half, .position = middle, .group = 1});
    link(cairn::ConeTwistJoint(0.8, {.lo = -0.3, .hi = 0.3}), part, torso, chest + from, axes);
    return part;
  };
  const Matrix3d sideways = Matrix3d::Identity();
  const int head = limb({0.1, 0.12, 0.1}, {0, 0.32, 0}, {0, 0.6, 0}, upright);
  for (const double side : {-1.0, 1.0}) {
    limb({0.3, 0.05, 0.05}, {0.22 * side, 0.25, 0}, {0.86 * side, 0.25, 0}, sideways);
    limb({0.07, 0.4, 0.07}, {0.1 * side, -0.32, 0}, {0.1 * side, -1.16, 0}, upright);
  }
  things[torso].velocity.linear = {0, 0, 3};  // somebody pushed it

  double bounce = 0;
  for (int frame = 0; frame < 300; ++frame) {
    const cairn::Report report = Step(&world);
    if (!report.ok()) return std::puts(Describe(report).c_str()), 1;
    const bool after_first_landing = frame > 40 && frame < 80;
    if (after_first_landing) bounce = std::max(bounce, things[ball].position.y() - 0.2);
  }
  const auto sleeps = [](const Thing& thing) { return thing.asleep; };
  const Eigen::Quaterniond& turn = things[door].turn;
  std::printf(
      "tower %.2f m high and %s, ball bounced to %.2f m, box was lifted to %.2f m, door is "
      "open by %.2f rad, head of the ragdoll at %.1f m, %d things sleep\n",
      things[top].position.y() + 0.5, things[top].asleep ? "asleep" : "awake", bounce,
      things[lifted].position.y(), 2 * std::atan2(turn.y(), turn.w()), things[head].position.y(),
      static_cast<int>(std::count_if(things.begin(), things.end(), sleeps)));
}
// [/main]
