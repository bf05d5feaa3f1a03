/* SPDX-License-Identifier: MIT */
/* A small engine in C around cairn_helpers.h: boxes that all weigh and turn alike. */
#ifndef CAIRN_TESTS_C_SMALL_WORLD_H
#define CAIRN_TESTS_C_SMALL_WORLD_H

#include <cairn/cairn_helpers.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

static int failures = 0;

#define CHECK(condition)                                               \
  do {                                                                 \
    if (!(condition)) {                                                \
      printf("%s:%d: not true: %s\n", __FILE__, __LINE__, #condition); \
      ++failures;                                                      \
    }                                                                  \
  } while (0)

enum { kMostThings = 10 };

static const double kTimeStep = 1 / 60.0;

typedef struct Thing {
  double position[3], axes[3][3];
} Thing;

typedef struct World {
  int count;
  double gravity;
  Thing things[kMostThings];
  CairnBody bodies[kMostThings]; /* 1 kg, cubes of 1 m */
  CairnSolver* solver;
  CairnFrame* frame;
  CairnProblem problem;
  CairnSolution solution;
  CairnReport report;
} World;

static void Turn(const CairnVelocity* velocity, double axis[3]) {
  const float* w = velocity->angular;
  const double speed = sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]);
  if (speed == 0) return;
  const double k[3] = {w[0] / speed, w[1] / speed, w[2] / speed};
  const double c = cos(speed * kTimeStep), s = sin(speed * kTimeStep);
  const double along = (k[0] * axis[0] + k[1] * axis[1] + k[2] * axis[2]) * (1 - c);
  const double old[3] = {axis[0], axis[1], axis[2]};
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, l = (i + 2) % 3;
    axis[i] = c * old[i] + s * (k[j] * old[l] - k[l] * old[j]) + along * k[i];
  }
}

/* A point of a thing, in the world. */
static void PlaceOf(const Thing* thing, const double local[3], double place[3]) {
  for (int i = 0; i < 3; ++i) {
    place[i] = thing->position[i];
    for (int k = 0; k < 3; ++k) place[i] += thing->axes[k][i] * local[k];
  }
}

static void MakeWorld(const CairnFrameSettings* settings, int count, World* world) {
  memset(world, 0, sizeof *world);
  world->count = count;
  world->gravity = 9.81;
  for (int i = 0; i < count; ++i) {
    for (int k = 0; k < 3; ++k) world->things[i].axes[k][k] = 1;
    world->bodies[i] = cairnDefaultBody();
    world->bodies[i].invMass = 1;
    for (int k = 0; k < 3; ++k) world->bodies[i].invInertia[4 * k] = 6;
    world->bodies[i].id = (uint64_t)i + 1;
  }
  CairnSettings solver = cairnDefaultSettings();
  solver.tolerance = 2e-5;
  CHECK(cairnCreateSolver(cairnLayout(), &solver, &world->solver) == cairnOk);
  CHECK(cairnCreateFrame(cairnHelperLayout(), settings, &world->frame) == cairnOk);
}

static void FreeWorld(World* world) {
  cairnDestroyFrame(world->frame);
  cairnDestroySolver(world->solver);
}

static void Begin(World* world) {
  for (int i = 0; i < world->count; ++i) {
    world->bodies[i].impulse[1] = (float)(-world->gravity * kTimeStep);
  }
  CairnStep step = cairnDefaultStep();
  step.bodies = world->bodies;
  step.bodyCount = world->count;
  step.timeStep = kTimeStep;
  CHECK(cairnBeginFrame(world->frame, &step) == cairnOk);
}

/* Solves what was added, and moves the things. */
static void End(World* world) {
  CairnVelocity velocities[kMostThings];
  CHECK(cairnFrameProblem(world->frame, &world->problem, &world->solution) == cairnOk);
  world->solution.velocities = velocities;
  CHECK(cairnSolve(world->solver, &world->problem, &world->solution, &world->report) == cairnOk);
  for (int i = 0; i < world->count; ++i) {
    world->bodies[i].velocity = velocities[i];
    for (int k = 0; k < 3; ++k) {
      world->things[i].position[k] += kTimeStep * velocities[i].linear[k];
      Turn(&velocities[i], world->things[i].axes[k]);
    }
  }
}

/* What a joint holds of a thing, or of the world. */
static CairnJointSide SideOf(const World* world, int thing, double x, double y, double z) {
  CairnJointSide side = cairnDefaultJointSide();
  const double local[3] = {x, y, z};
  if (thing == CAIRN_WORLD) {
    memcpy(side.anchor, local, sizeof local);
    return side;
  }
  side.body = thing;
  memcpy(side.centre, world->things[thing].position, sizeof side.centre);
  memcpy(side.axes, world->things[thing].axes, sizeof side.axes);
  PlaceOf(&world->things[thing], local, side.anchor);
  return side;
}

#endif
