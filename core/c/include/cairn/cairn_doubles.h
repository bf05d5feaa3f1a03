/* SPDX-License-Identifier: MIT */
/* Bodies and velocities in double precision, for engines that keep them so; all else is of
   cairn/cairn.h. They are what the solver computes with: the floats of cairn.h are turned into
   them, and velocities rounded. Contacts and joints are relative to their bodies, and stay floats.
   These structs are not in CairnLayout: they change with the minor version alone, which is. */
#ifndef CAIRN_CAIRN_DOUBLES_H
#define CAIRN_CAIRN_DOUBLES_H

#include <cairn/cairn.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Linear [m/s] and angular [rad/s]. */
typedef struct CairnVelocityD {
  double linear[3], angular[3];
} CairnVelocityD;

/* As CairnBody. */
typedef struct CairnBodyD {
  double invMass;
  double invInertia[9];
  double linearFactor[3];
  CairnVelocityD velocity;
  double impulse[3], angularImpulse[3], strain;
  uint64_t id;
} CairnBodyD;

CAIRN_API CairnBodyD cairnDefaultBodyD(void);

/* cairnSolve() with these bodies, bodyCount of the problem: its own are not read. Velocities, one
   per body, are written here: those of the solution are not. */
CAIRN_API CairnStatus cairnSolveD(CairnSolver* solver, const CairnProblem* problem,
                                  const CairnBodyD* bodies, const CairnSolution* solution,
                                  CairnVelocityD* velocities, CairnReport* report);

/* cairnMeanVelocities() of the last step, whichever of the two functions solved it. */
CAIRN_API CairnStatus cairnMeanVelocitiesD(const CairnSolver* solver, CairnVelocityD* velocities,
                                           int32_t count);

#ifdef __cplusplus
}
#endif

#endif
