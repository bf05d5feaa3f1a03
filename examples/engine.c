/* SPDX-License-Identifier: MIT */
/* A small engine in C around the helpers: boxes fall on each other and stand, a motor opens a door.
   docs/c.md. */
#include <cairn/cairn_helpers.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { kBoxes = 5, kDoor = kBoxes, kThings };

static const double kStep = 1 / 60.0, kGravity = 9.81; /* [s], [m/s^2] */

/* A box: mass [kg], half its edges [m], and its axes in the world. */
typedef struct Thing {
  double mass, half[3], position[3], axes[3][3];
  CairnVelocity velocity;
} Thing;

static CairnBody ToBody(const Thing* thing, uint64_t id) {
  CairnBody body = cairnDefaultBody();
  body.invMass = (float)(1 / thing->mass);
  body.velocity = thing->velocity;
  body.impulse[1] = (float)(-thing->mass * kGravity * kStep);
  body.id = id;
  for (int k = 0; k < 3; ++k) {
    const double y = thing->half[(k + 1) % 3], z = thing->half[(k + 2) % 3];
    const double inertia = thing->mass / 3 * (y * y + z * z);
    for (int i = 0; i < 9; ++i) {
      body.invInertia[i] += (float)(thing->axes[k][i / 3] * thing->axes[k][i % 3] / inertia);
    }
  }
  return body;
}

static void ToWorld(const Thing* thing, const double local[3], double world[3]) {
  memcpy(world, thing->position, sizeof thing->position);
  for (int i = 0; i < 9; ++i) world[i % 3] += thing->axes[i / 3][i % 3] * local[i / 3];
}

// [contacts]
/* Corners of box i above the box below it, or above the ground. */
static CairnStatus AddBox(CairnFrame* frame, const Thing* things, int i) {
  CairnTouch touch = cairnDefaultTouch(); /* the normal is up, and friction 0.5 */
  touch.bodyA = i;
  touch.bodyB = i > 0 ? i - 1 : CAIRN_WORLD;
  touch.id = (uint64_t)i + 1; /* names the two, for the warm start */
  memcpy(touch.centreA, things[i].position, sizeof touch.centreA);
  double top = 0;
  if (i > 0) {
    memcpy(touch.centreB, things[i - 1].position, sizeof touch.centreB);
    top = things[i - 1].position[1] + things[i - 1].half[1];
  }
  CairnTouchPoint points[8];
  for (uint32_t p = 0; p < 8; ++p) {
    double corner[3];
    for (int k = 0; k < 3; ++k) corner[k] = p >> k & 1 ? things[i].half[k] : -things[i].half[k];
    points[p] = cairnDefaultTouchPoint();
    ToWorld(&things[i], corner, points[p].position);
    points[p].depth = top - points[p].position[1]; /* below 0: a gap; far ones are left out */
    points[p].feature = p;
  }
  return cairnAddTouch(frame, &touch, points, 8);
}
// [/contacts]

// [joints]
/* A hinge about the y axis at the edge of the door, with a motor and limits. */
static CairnStatus AddDoor(CairnFrame* frame, const Thing* door, double* angle) {
  CairnJointAxis axis = cairnDefaultJointAxis();
  axis.lo = 0;
  axis.hi = 1.5;
  axis.speed = 1;
  axis.maxMotorForce = 50;
  const CairnJointKind hinge = cairnHingeJoint(&axis);
  const double up[3][3] = {{0, 1, 0}, {0, 0, 1}, {1, 0, 0}}; /* hinges turn about their x axis */
  CairnJointSide a = cairnDefaultJointSide(), b = cairnDefaultJointSide(); /* b: the world */
  a.body = kDoor;
  memcpy(a.centre, door->position, sizeof a.centre);
  ToWorld(door, (const double[3]){-0.5, 0, 0}, a.anchor);
  memcpy(b.anchor, (const double[3]){-0.5, 1.2, 5}, sizeof b.anchor);
  memcpy(b.axes, up, sizeof b.axes);
  for (int k = 0; k < 3; ++k) memcpy(a.axes[k], door->axes[(k + 1) % 3], sizeof a.axes[k]);
  *angle = cairnTwistOf(&a, &b);
  return cairnAddJoint(frame, &hinge, &a, &b, 1, NULL);
}
// [/joints]

/* Turns an axis by an angular velocity [rad/s]. */
static void Turn(const float w[3], double axis[3]) {
  const double speed = sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]);
  if (speed == 0) return;
  const double c = cos(speed * kStep), s = sin(speed * kStep) / speed;
  const double along = (w[0] * axis[0] + w[1] * axis[1] + w[2] * axis[2]) * (1 - c) / speed / speed;
  const double old[3] = {axis[0], axis[1], axis[2]};
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    axis[i] = c * old[i] + s * (w[j] * old[k] - w[k] * old[j]) + along * w[i];
  }
}

// [step]
static CairnStatus Step(CairnSolver* solver, CairnFrame* frame, Thing* things, double* angle) {
  CairnBody bodies[kThings];
  for (int i = 0; i < kThings; ++i) bodies[i] = ToBody(&things[i], (uint64_t)i + 1);
  CairnStep step = cairnDefaultStep();
  step.bodies = bodies;
  step.bodyCount = kThings;
  step.timeStep = kStep;
  CairnStatus status = cairnBeginFrame(frame, &step);
  for (int i = 0; i < kBoxes && status == cairnOk; ++i) status = AddBox(frame, things, i);
  if (status == cairnOk) status = AddDoor(frame, &things[kDoor], angle);

  CairnVelocity velocities[kThings];
  CairnProblem problem;
  CairnSolution solution = {NULL, NULL, NULL, velocities};
  if (status == cairnOk) status = cairnFrameProblem(frame, &problem, &solution);
  if (status == cairnOk) status = cairnSolve(solver, &problem, &solution, NULL);
  if (status != cairnOk) return status; /* nothing was written */
  for (int i = 0; i < kThings; ++i) {
    things[i].velocity = velocities[i];
    for (int k = 0; k < 3; ++k) {
      things[i].position[k] += kStep * velocities[i].linear[k];
      Turn(velocities[i].angular, things[i].axes[k]);
    }
  }
  return cairnOk;
}
// [/step]

int main(void) {
  CairnSettings settings = cairnDefaultSettings();
  settings.tolerance = 2e-5;
  const CairnFrameSettings frameSettings = cairnDefaultFrameSettings();
  CairnSolver* solver = NULL;
  CairnFrame* frame = NULL;
  CairnStatus status = cairnCreateSolver(cairnLayout(), &settings, &solver);
  if (status == cairnOk) status = cairnCreateFrame(cairnHelperLayout(), &frameSettings, &frame);

  Thing things[kThings];
  const Thing box = {.mass = 10, .half = {0.5, 0.5, 0.5}};
  const Thing door = {.mass = 20, .half = {0.5, 1, 0.05}, .position = {0, 1.2, 5}};
  for (int i = 0; i < kThings; ++i) {
    things[i] = i == kDoor ? door : box;
    if (i != kDoor) things[i].position[1] = 0.55 + 1.05 * i;
    for (int k = 0; k < 3; ++k) things[i].axes[k][k] = 1;
  }

  double angle = 0;
  for (int i = 0; i < 300 && status == cairnOk; ++i) status = Step(solver, frame, things, &angle);
  if (status == cairnOk) {
    printf("%d boxes, %.2f m high, door open by %.2f rad, its gap %s 1 mm\n", kBoxes,
           things[kBoxes - 1].position[1] + 0.5, angle,
           cairnFrameErrors(frame).gap.largest < 1e-3 ? "below" : "above");
  } else {
    char text[200] = "";
    if (frame != NULL) cairnDescribeInput(frame, text, sizeof text);
    printf("%s. %s\n", cairnDescribe(status), text);
  }
  cairnDestroyFrame(frame);
  cairnDestroySolver(solver);
  return status != cairnOk;
}
