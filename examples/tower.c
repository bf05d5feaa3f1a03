/* SPDX-License-Identifier: MIT */
/* Cairn from C: ten boxes, each above the next, fall on the ground and on each other, and stand. */

// [program]
#include <cairn/cairn.h>
#include <stdio.h>

enum { kBoxes = 10, kPoints = 4 * kBoxes };

static const float kStep = 1.0f / 60, kGravity = 9.81f;

int main(void) {
  CairnSettings settings = cairnDefaultSettings();
  settings.tolerance = 1e-4;
  settings.budgetKind = cairnWork; /* the same bits on every machine */
  settings.budget = 100000;
  CairnSolver* solver = NULL;
  CairnStatus status = cairnCreateSolver(cairnLayout(), &settings, &solver);
  if (status != cairnOk) return printf("%s\n", cairnDescribe(status)), 1;

  /* boxes of 1 kg and 1 m, which stay upright here: an engine turns them, too */
  float height[kBoxes];
  CairnBody bodies[kBoxes];
  CairnManifold manifolds[kBoxes];
  CairnContactPoint points[kPoints];
  CairnContactImpulse impulses[kPoints] = {{0}}; /* warm start: kept from step to step */
  CairnVelocity velocities[kBoxes];
  for (int i = 0; i < kBoxes; ++i) {
    height[i] = 0.5f + 1.01f * (float)i;
    bodies[i] = cairnDefaultBody();
    bodies[i].invMass = 1;
    for (int k = 0; k < 3; ++k) bodies[i].invInertia[4 * k] = 6;
    bodies[i].impulse[1] = -kGravity * kStep;
    bodies[i].id = (uint64_t)i + 1;
    manifolds[i] = cairnDefaultManifold();
    manifolds[i].bodyA = i;
    manifolds[i].bodyB = i > 0 ? i - 1 : CAIRN_WORLD;
    manifolds[i].firstPoint = 4 * i;
    manifolds[i].points = 4;
  }

  CairnProblem problem = cairnDefaultProblem();
  problem.bodies = bodies;
  problem.bodyCount = kBoxes;
  problem.manifolds = manifolds;
  problem.manifoldCount = kBoxes;
  problem.points = points;
  problem.pointCount = kPoints;
  CairnSolution solution = {impulses, NULL, NULL, velocities};

  CairnReport report;
  for (int frame = 0; frame < 120; ++frame) {
    for (int p = 0; p < kPoints; ++p) {
      const int box = p / 4;
      const float below = box > 0 ? height[box - 1] + 0.5f : 0;
      const float gap = height[box] - 0.5f - below;
      const float x = p & 1 ? 0.5f : -0.5f, z = p & 2 ? 0.5f : -0.5f;
      points[p] = cairnDefaultContactPoint();
      points[p].normal[1] = 1;
      points[p].friction = 0.5f;
      points[p].armA[0] = points[p].armB[0] = x;
      points[p].armA[1] = -0.5f;
      points[p].armB[1] = 0.5f;
      points[p].armA[2] = points[p].armB[2] = z;
      /* a gap may close in this step; a fifth of what is too deep is taken back */
      points[p].bias = gap > 0 ? -gap / kStep : -0.2f * gap / kStep;
    }
    if (cairnSolve(solver, &problem, &solution, &report) != cairnOk) {
      char text[200];
      cairnDescribeReport(solver, text, sizeof text);
      return printf("%s\n", text), 1;
    }
    for (int i = 0; i < kBoxes; ++i) {
      bodies[i].velocity = velocities[i];
      height[i] += kStep * velocities[i].linear[1];
    }
  }

  float ground = 0;
  for (int p = 0; p < 4; ++p) ground += impulses[p].normal;
  printf("%d boxes, %.2f m high, ground gives %.2f N s a step, %d island, residual %s 1e-4 m/s\n",
         kBoxes, height[kBoxes - 1] + 0.5f, ground, report.islandCount,
         report.residualMax <= 1e-4 ? "below" : "above");
  cairnDestroySolver(solver);
  return 0;
}
// [/program]
