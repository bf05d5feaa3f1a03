/* SPDX-License-Identifier: MIT */
/* Cairn for C, and for languages that call C: bodies, contacts and joints of one step in, impulses
   and velocities out. docs/c.md is the guide; cairn/solver.h is the same for C++, where each word
   is explained. Units are SI, vectors in world axes.

   Structs are plain data. Get each from its cairnDefault...() function, then set what differs: what
   a later version adds has its default then. Arrays are a pointer and a count; 0 of something needs
   no pointer. Nothing is kept of what a pointer points to once a function has returned, but for
   CairnSettings::jobs and memory, and the bodies of a CairnStep. No exception leaves a function. */
#ifndef CAIRN_CAIRN_H
#define CAIRN_CAIRN_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#if defined(_WIN32)
#define CAIRN_API
#else
#define CAIRN_API __attribute__((visibility("default")))
#endif

#ifdef __cplusplus
extern "C" {
#endif

#define CAIRN_VERSION_MAJOR 0
#define CAIRN_VERSION_MINOR 2
#define CAIRN_VERSION_PATCH 0

/* What does not move, as a body. What you move yourself is a body with invMass 0 and a velocity. */
#define CAIRN_WORLD (-1)

/* What came of a call. All but cairnOk leave every output untouched, a CairnReport apart. */
typedef enum CairnStatus {
  cairnOk = 0,
  cairnBadSettings,  /* a setting is out of its range; see cairnDescribeSettings() */
  cairnEmptyProblem, /* no bodies */
  cairnWrongSize,    /* a range is outside its array, or a count is negative */
  cairnNotFinite,    /* NaN, or infinity anywhere but in a bound */
  cairnBadMass,
  cairnNoSuchBody,
  cairnBadBounds, /* lo > hi */
  cairnBadCompliance,
  cairnBadParent,
  cairnBadFriction,
  cairnOverflow,           /* finite, but too large or too far apart for a finite result */
  cairnWrongVersion = 100, /* the program was compiled with another cairn.h */
  cairnNullPointer,        /* where there must be something */
  cairnOutOfMemory,
  cairnBadFile, /* it cannot be read or written, or is no recording */
  cairnFailed,  /* none of these: a mistake of ours */
  cairnBadInput /* cairn_helpers.h was given what is out of its range; see cairnDescribeInput() */
} CairnStatus;

CAIRN_API const char* cairnDescribe(CairnStatus status); /* one sentence; lives forever */
CAIRN_API uint32_t cairnVersion(void);                   /* 0x010203 is 1.2.3 */

/* Linear [m/s] and angular [rad/s]. */
typedef struct CairnVelocity {
  float linear[3], angular[3];
} CairnVelocity;

typedef struct CairnBody {
  float invMass;       /* [1/kg], >= 0; 0: no impulse changes its velocity (invInertia 0, too) */
  float invInertia[9]; /* about the centre of mass [1/(kg m^2)], symmetric positive semidefinite */
  float linearFactor[3]; /* scales invMass along each axis, >= 0 */
  CairnVelocity velocity;
  float impulse[3], angularImpulse[3]; /* external, over the step [N s], [N m s] */
  float strain; /* h^2 T r / I: pull T of joints at a distance r; a step of h blows up at 4 */
  uint64_t id;  /* its name while it lives; 0: none. What is learnt is remembered under it */
} CairnBody;

/* A point of contact. The normal row wants the velocity bias + bounce along the normal. */
typedef struct CairnContactPoint {
  float armA[3], armB[3]; /* from the centres of mass [m] */
  float normal[3];        /* unit vector, from body b to body a */
  float tangent[3];       /* unit vector across it, or zeros */
  float bias;             /* [m/s]: depth * erp / h where deep, -gap / h where apart */
  float restitution, friction;
  float compliance; /* [1/kg], read if CairnManifold::soft */
} CairnContactPoint;

/* As a start: that of an earlier frame, or zeros. */
typedef struct CairnContactImpulse {
  float normal, tangential[2]; /* [N s] */
  float heading, direction[3]; /* of tangential[0]: pass on as it is */
} CairnContactImpulse;

/* What resists turning at a point, where CairnManifold::twists. */
typedef struct CairnContactTwist {
  float spinning, rolling;         /* coefficients [m] */
  float mostSpinning, mostRolling; /* [N m s] */
} CairnContactTwist;

typedef struct CairnTwistImpulse {
  float spinning, rolling[2]; /* [N m s] */
} CairnTwistImpulse;

typedef struct CairnManifold {
  int32_t bodyA, bodyB; /* or CAIRN_WORLD */
  int32_t firstPoint;
  int8_t points;      /* 1 to 4 */
  int8_t tangents;    /* directions of friction, 0 to 2 */
  bool soft, twists;  /* points have a compliance; resist turning */
  uint8_t speeds;     /* bit i: bias of point i is a speed, not depth; CairnSettings::relax */
  int32_t sweepLimit; /* sweeps that it takes part in */
} CairnManifold;

/* A row of a joint: J v is to equal target; its impulse is in [lo, hi] where it is bounded. */
typedef struct CairnJointRow {
  float linearA[3];
  float target; /* [m/s] or [rad/s] */
  float angularA[3];
  float compliance; /* [1/kg], read if CairnJoint::soft */
  float linearB[3];
  float lo; /* [N s] or [N m s] */
  float angularB[3];
  float hi;
} CairnJointRow;

typedef struct CairnJoint {
  int32_t bodyA, bodyB; /* or CAIRN_WORLD */
  int32_t firstRow, rows;
  uint32_t bounded; /* bit i: row i has bounds */
  uint32_t angular; /* bit i: row i only turns */
  uint32_t errors;  /* bit i: row i takes back an error of position */
  float damping;    /* share of free motion that rows work against; 1: all */
  bool soft;        /* rows have a compliance */
  bool opposite;    /* linearB is -linearA, whatever it says: swept faster */
  int32_t sweepLimit;
} CairnJoint;

/* One step. Points, twists and rows are found by the ranges of manifolds and joints. */
typedef struct CairnProblem {
  const CairnBody* bodies;
  const CairnManifold* manifolds;
  const CairnContactPoint* points;
  const CairnContactTwist* twists; /* one per point, or none */
  const CairnJoint* joints;
  const CairnJointRow* jointRows;
  int32_t bodyCount, manifoldCount, pointCount, twistCount, jointCount, jointRowCount;
  float bounceSpeed; /* bodies that approach slower do not bounce [m/s] */
  float timeStep;    /* [s], or 0: tension, arms with substeps and weighed steps go by it */
} CairnProblem;

/* Impulses are read as the start, and written; velocities are written. One of each per point,
   twist, row and body of the problem. */
typedef struct CairnSolution {
  CairnContactImpulse* points;
  CairnTwistImpulse* twists;
  float* jointRows;
  CairnVelocity* velocities;
} CairnSolution;

/* Threads of your own: submit() has work(what) called once, now or later, on another thread, and
   returns at once. It must outlive the solver. */
typedef struct CairnJobs {
  void (*submit)(void (*work)(void*), void* what, void* context);
  void* context;
} CairnJobs;

/* Memory of your own: allocate() gives bytes at a multiple of alignment, a power of two, or NULL;
   free() is told both again. Called on all threads of the solver, at the same time where there are
   several. It must outlive the solver, and what jobs were given. */
typedef struct CairnMemory {
  void* (*allocate)(size_t bytes, size_t alignment, void* context);
  void (*free)(void* memory, size_t bytes, size_t alignment, void* context);
  void* context;
} CairnMemory;

typedef enum CairnMethod { cairnPgs, cairnPsor, cairnPgsSm } CairnMethod;
typedef enum CairnPath { cairnAuto, cairnFast, cairnReference } CairnPath;
typedef enum CairnBudgetKind { cairnUnlimited, cairnTime, cairnWork } CairnBudgetKind;

typedef struct CairnSettings {
  CairnMethod method;
  CairnPath path;
  int32_t kGs, kSm;  /* sweeps around a step, factorisations in it */
  bool steps, relax; /* relax: corrections of position leave no velocity; cairnMeanVelocities() */
  int32_t maxSweeps;
  bool geometricStiffness; /* inertia is raised where joints pull too hard for timeStep */
  int32_t substeps;        /* parts that the step is cut into, 1 to 64; see cairnMeanVelocities() */
  double tolerance, quietSpeed; /* [m/s] and [rad/s]; quietSpeed: of CairnIsland::quiet */
  double unitsPerMetre;         /* 100 where lengths are centimetres; 0: 1 */
  CairnBudgetKind budgetKind;
  int64_t budget;     /* nanoseconds, or units of work: 1 = 1 row relaxed */
  int32_t minSweeps;  /* even if the budget is spent; -1: by the budget */
  int32_t threads;    /* the caller's included; results do not depend on them */
  CairnJobs jobs;     /* submit NULL: oneTBB, if built with it, or threads */
  CairnMemory memory; /* all that a solver keeps; allocate NULL: operator new. Only at creation */
} CairnSettings;

typedef enum CairnStop {
  cairnNotStarted,
  cairnConverged,
  cairnStationary,
  cairnBrokeDown,
  cairnSweepLimit,
  cairnTimeSpent,
  cairnWorkSpent
} CairnStop;

/* Largest speed that takes back an error of position, and what is done of it [m/s], [rad/s]. */
typedef struct CairnCorrection {
  double asked, done;
} CairnCorrection;

typedef struct CairnReport {
  CairnStatus status;
  int32_t badBody, badManifold, badJoint; /* the first refused, or -1 */
  CairnStop stop;
  CairnPath path;                      /* what solved */
  double residualMax, residualAngular; /* how far the worst row is from its law [m/s], [rad/s] */
  int32_t sweeps, factorisations, stepsAccepted, stepsRestored, guarded, islandCount;
  int64_t work, elapsed;             /* units; nanoseconds */
  CairnCorrection depth, gap, angle; /* of contacts; joints; their rows that only turn */
} CairnReport;

/* Bodies that contacts and joints connect. */
typedef struct CairnIsland {
  int32_t firstBody, bodies, rows;
  int32_t quiet;      /* steps in a row that left all bodies below CairnSettings::quietSpeed */
  double speed, spin; /* largest of its bodies after the step [m/s], [rad/s] */
  int32_t sweeps, factorisations, stepsAccepted, stepsRestored;
  CairnStop stop;
  bool guarded;
  double residualBefore, residual, residualAngular;
  double strain; /* largest CairnBody::strain; above 2 the step is too long */
  int32_t strainedBody, enoughSubsteps; /* whose, or -1; substeps that bring it to 2, or 0 */
} CairnIsland;
CAIRN_API CairnBody cairnDefaultBody(void);
CAIRN_API CairnContactPoint cairnDefaultContactPoint(void);
CAIRN_API CairnManifold cairnDefaultManifold(void);
CAIRN_API CairnJointRow cairnDefaultJointRow(void);
CAIRN_API CairnJoint cairnDefaultJoint(void);
CAIRN_API CairnProblem cairnDefaultProblem(void);
CAIRN_API CairnSettings cairnDefaultSettings(void);

/* "threads is 0, must be 1 to 1024"; "" if all are in range. Returns its length, like snprintf. */
CAIRN_API size_t cairnDescribeSettings(const CairnSettings* settings, char* text, size_t size);

/* How a program sees the structs: cairnCreateSolver() compares it with what the library has. */
typedef struct CairnLayout {
  uint32_t version;
  uint32_t body, contactPoint, contactImpulse, contactTwist, twistImpulse, manifold, jointRow;
  uint32_t joint, problem, solution, settings, report, island;
} CairnLayout;

#define CAIRN_SIZE(type) ((uint32_t)sizeof(type))
static inline CairnLayout cairnLayout(void) {
  CairnLayout layout = {CAIRN_VERSION_MAJOR << 16 | CAIRN_VERSION_MINOR << 8 | CAIRN_VERSION_PATCH,
                        CAIRN_SIZE(CairnBody),
                        CAIRN_SIZE(CairnContactPoint),
                        CAIRN_SIZE(CairnContactImpulse),
                        CAIRN_SIZE(CairnContactTwist),
                        CAIRN_SIZE(CairnTwistImpulse),
                        CAIRN_SIZE(CairnManifold),
                        CAIRN_SIZE(CairnJointRow),
                        CAIRN_SIZE(CairnJoint),
                        CAIRN_SIZE(CairnProblem),
                        CAIRN_SIZE(CairnSolution),
                        CAIRN_SIZE(CairnSettings),
                        CAIRN_SIZE(CairnReport),
                        CAIRN_SIZE(CairnIsland)};
  return layout;
}

/* Solvers may run at the same time, one solver may not. */
typedef struct CairnSolver CairnSolver;

/* Fails with cairnWrongVersion unless major and minor version and all sizes are the library's. */
CAIRN_API CairnStatus cairnCreateSolver(CairnLayout layout, const CairnSettings* settings,
                                        CairnSolver** solver);
CAIRN_API void cairnDestroySolver(CairnSolver* solver); /* NULL: nothing happens */
/* Memory that it holds, and the most that it ever held, unless most is NULL. */
CAIRN_API size_t cairnBytes(const CairnSolver* solver, size_t* most);
CAIRN_API CairnStatus cairnSetSettings(CairnSolver* solver, const CairnSettings* settings);
/* Forgets what was learnt: the next step is that of a new solver. */
CAIRN_API void cairnReset(CairnSolver* solver);
/* Saves and loads: other knows of bodies and islands what solver does, and both find the order of
   their rows anew, so that from here on they give the same bits. */
CAIRN_API CairnStatus cairnCopyState(CairnSolver* solver, CairnSolver* other);

/* Solves one step. report may be NULL. A problem no larger than an earlier one is solved without
   allocating on cairnFast, but for a step on contacts and joints of other bodies than before. */
CAIRN_API CairnStatus cairnSolve(CairnSolver* solver, const CairnProblem* problem,
                                 const CairnSolution* solution, CairnReport* report);

/* Of the last step, one per body: velocities on average. With substeps or relax, bodies move by
   these over the step and keep those that were written; else they are the same. cairnWrongSize: not
   as many as it had bodies, or it was refused. */
CAIRN_API CairnStatus cairnMeanVelocities(const CairnSolver* solver, CairnVelocity* velocities,
                                          int32_t count);

/* Of the last step: one sentence; an island, 0 to islandCount - 1; the island of each body, -1 for
   none, until the next step. */
CAIRN_API size_t cairnDescribeReport(const CairnSolver* solver, char* text, size_t size);
CAIRN_API CairnStatus cairnGetIsland(const CairnSolver* solver, int32_t index, CairnIsland* island);
CAIRN_API const int32_t* cairnIslandOf(const CairnSolver* solver, int32_t* count);

/* For development builds: what is wrong or cannot be meant, a line each. Returns its length. */
CAIRN_API size_t cairnValidateStrictly(const CairnProblem* problem, const CairnSolution* solution,
                                       char* text, size_t size);

/* Writes the next step to a file, with its start. cairnRecordedFiles() counts those written. */
CAIRN_API CairnStatus cairnRecordNext(CairnSolver* solver, const char* path);
CAIRN_API int32_t cairnRecordedFiles(const CairnSolver* solver);

typedef struct CairnRecording CairnRecording;
CAIRN_API CairnStatus cairnLoadRecording(const char* path, CairnRecording** recording);
CAIRN_API void cairnFreeRecording(CairnRecording* recording);
CAIRN_API int32_t cairnRecordingBodies(const CairnRecording* recording);
/* Solves it from its start, with the settings of the solver. velocities: one per body, or NULL. */
CAIRN_API CairnStatus cairnSolveRecording(CairnSolver* solver, const CairnRecording* recording,
                                          CairnVelocity* velocities, CairnReport* report);

#ifdef __cplusplus
}
#endif

#endif
