/* SPDX-License-Identifier: MIT */
/* The interface of C as a C program sees it. Argument: a folder to write to. */
#include <cairn/cairn.h>
#include <cairn/cairn_doubles.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <threads.h>

static int failures = 0;

#define CHECK(condition)                                               \
  do {                                                                 \
    if (!(condition)) {                                                \
      printf("%s:%d: not true: %s\n", __FILE__, __LINE__, #condition); \
      ++failures;                                                      \
    }                                                                  \
  } while (0)

/* A box of 2 kg that rests on the ground on four corners, and one that hangs from it. */
typedef struct Scene {
  CairnBody bodies[2];
  CairnManifold manifold;
  CairnContactPoint points[4];
  CairnContactImpulse impulses[4];
  CairnJoint joint;
  CairnJointRow rows[3];
  float rowImpulses[3];
  CairnVelocity velocities[2];
  CairnProblem problem;
  CairnSolution solution;
} Scene;

static void MakeScene(Scene* scene) {
  memset(scene, 0, sizeof *scene);
  for (int i = 0; i < 2; ++i) {
    scene->bodies[i] = cairnDefaultBody();
    scene->bodies[i].invMass = 0.5f;
    for (int k = 0; k < 3; ++k) scene->bodies[i].invInertia[4 * k] = 3;
    scene->bodies[i].impulse[1] = -2 * 9.81f / 60;
    scene->bodies[i].id = (uint64_t)i + 1;
  }
  scene->manifold = cairnDefaultManifold();
  scene->manifold.bodyA = 0;
  scene->manifold.points = 4;
  for (int p = 0; p < 4; ++p) {
    CairnContactPoint* point = &scene->points[p];
    *point = cairnDefaultContactPoint();
    point->armA[0] = p & 1 ? 0.5f : -0.5f;
    point->armA[1] = -0.5f;
    point->armA[2] = p & 2 ? 0.5f : -0.5f;
    point->normal[1] = 1;
    point->friction = 0.5f;
  }
  scene->joint = cairnDefaultJoint();
  scene->joint.bodyA = 1;
  scene->joint.bodyB = 0;
  scene->joint.rows = 3;
  scene->joint.opposite = true;
  for (int k = 0; k < 3; ++k) {
    scene->rows[k] = cairnDefaultJointRow();
    scene->rows[k].linearA[k] = 1;
    scene->rows[k].linearB[k] = -1;
  }
  scene->problem = cairnDefaultProblem();
  scene->problem.bodies = scene->bodies;
  scene->problem.bodyCount = 2;
  scene->problem.manifolds = &scene->manifold;
  scene->problem.manifoldCount = 1;
  scene->problem.points = scene->points;
  scene->problem.pointCount = 4;
  scene->problem.joints = &scene->joint;
  scene->problem.jointCount = 1;
  scene->problem.jointRows = scene->rows;
  scene->problem.jointRowCount = 3;
  scene->solution.points = scene->impulses;
  scene->solution.jointRows = scene->rowImpulses;
  scene->solution.velocities = scene->velocities;
}

static CairnSolver* MakeSolver(void) {
  const CairnSettings settings = cairnDefaultSettings();
  CairnSolver* solver = NULL;
  CHECK(cairnCreateSolver(cairnLayout(), &settings, &solver) == cairnOk);
  return solver;
}

static void SolvesBodiesContactsAndJoints(void) {
  CairnSolver* solver = MakeSolver();
  Scene scene;
  MakeScene(&scene);
  CairnReport report;
  CHECK(cairnSolve(solver, &scene.problem, &scene.solution, &report) == cairnOk);
  /* by hand: the ground carries both, the joint what hangs */
  float ground = 0;
  for (int p = 0; p < 4; ++p) ground += scene.impulses[p].normal;
  CHECK(fabsf(ground - 4 * 9.81f / 60) < 4e-3f);
  CHECK(fabsf(scene.rowImpulses[1] - 2 * 9.81f / 60) < 4e-3f);
  CHECK(fabsf(scene.velocities[1].linear[1]) < 2e-3f);
  CHECK(report.status == cairnOk && report.stop == cairnConverged && report.path == cairnFast);
  CHECK(report.badBody == -1 && report.residualMax <= 1e-3 && report.elapsed > 0);
  CHECK(report.islandCount == 1);
  CairnIsland island;
  CHECK(cairnGetIsland(solver, 0, &island) == cairnOk);
  CHECK(island.firstBody == 0 && island.bodies == 2 && island.rows == 4 * 3 + 3);
  CHECK(cairnGetIsland(solver, 1, &island) == cairnWrongSize);
  int32_t count = 0;
  const int32_t* island_of = cairnIslandOf(solver, &count);
  CHECK(count == 2 && island_of[0] == 0 && island_of[1] == 0);
  char text[50];
  CHECK(cairnDescribeReport(solver, text, sizeof text) == strlen("converged"));
  CHECK(strcmp(text, "converged") == 0);
  cairnDestroySolver(solver);
}

/* The joint asks for half a metre a second, and gets it. Strain 8 is 4 times too much: two substeps
   have a quarter each. */
static void ReportsWhatIsTakenBackAndStrain(void) {
  CairnSolver* solver = MakeSolver();
  Scene scene;
  MakeScene(&scene);
  scene.rows[0].target = 0.5f;
  scene.joint.errors = 1;
  scene.points[2].bias = 0.25f;
  scene.bodies[1].strain = 8;
  CairnReport report;
  CHECK(cairnSolve(solver, &scene.problem, &scene.solution, &report) == cairnOk);
  CHECK(fabs(report.gap.asked - 0.5) < 1e-6 && fabs(report.gap.done - 0.5) < 1e-3);
  CHECK(fabs(report.depth.asked - 0.25) < 1e-6 && fabs(report.depth.done - 0.25) < 1e-3);
  CHECK(report.angle.asked == 0 && report.angle.done == 0);
  CairnIsland island;
  CHECK(cairnGetIsland(solver, 0, &island) == cairnOk);
  CHECK(island.strain == 8 && island.strainedBody == 1 && island.enoughSubsteps == 2);
  scene.bodies[1].strain = 0;
  CHECK(cairnSolve(solver, &scene.problem, &scene.solution, &report) == cairnOk);
  CHECK(cairnGetIsland(solver, 0, &island) == cairnOk);
  CHECK(island.strain == 0 && island.strainedBody == -1 && island.enoughSubsteps == 0);
  cairnDestroySolver(solver);
}

static void SolvesBodiesInDoubles(void) {
  CairnSolver* solver = MakeSolver();
  Scene scene;
  MakeScene(&scene);
  CairnBodyD bodies[2];
  CairnVelocityD velocities[2];
  for (int i = 0; i < 2; ++i) {
    bodies[i] = cairnDefaultBodyD();
    bodies[i].invMass = 0.5;
    for (int k = 0; k < 3; ++k) bodies[i].invInertia[4 * k] = 3;
    bodies[i].impulse[1] = -2 * 9.81 / 60;
  }
  scene.problem.bodies = NULL;
  CHECK(cairnSolveD(solver, &scene.problem, bodies, &scene.solution, velocities, NULL) == cairnOk);
  CHECK(fabs(scene.rowImpulses[1] - 2 * 9.81 / 60) < 4e-3);
  CHECK(fabs(velocities[1].linear[1]) < 2e-3);
  cairnDestroySolver(solver);
}

static void RefusesOtherVersionsAndLayouts(void) {
  const CairnSettings settings = cairnDefaultSettings();
  CairnSolver* solver = NULL;
  CairnLayout layout = cairnLayout();
  CHECK(layout.version == cairnVersion());
  layout.joint += 4;
  CHECK(cairnCreateSolver(layout, &settings, &solver) == cairnWrongVersion);
  layout = cairnLayout();
  layout.version += 1 << 8;
  CHECK(cairnCreateSolver(layout, &settings, &solver) == cairnWrongVersion);
  CHECK(solver == NULL);
  CHECK(cairnCreateSolver(cairnLayout(), NULL, &solver) == cairnNullPointer);
  layout = cairnLayout();
  layout.version += 1; /* a patch changes no struct */
  CHECK(cairnCreateSolver(layout, &settings, &solver) == cairnOk);
  cairnDestroySolver(solver);
  cairnDestroySolver(NULL);
}

static void NamesBadSettings(void) {
  CairnSettings settings = cairnDefaultSettings();
  char text[100];
  CHECK(cairnDescribeSettings(&settings, text, sizeof text) == 0 && text[0] == '\0');
  settings.threads = 0;
  CairnSolver* solver = NULL;
  CHECK(cairnCreateSolver(cairnLayout(), &settings, &solver) == cairnBadSettings);
  cairnDescribeSettings(&settings, text, sizeof text);
  CHECK(strcmp(text, "threads is 0, must be 1 to 1024") == 0);
  CHECK(cairnDescribeSettings(&settings, text, 8) == strlen("threads is 0, must be 1 to 1024"));
  CHECK(strcmp(text, "threads") == 0);
  solver = MakeSolver();
  CHECK(cairnSetSettings(solver, &settings) == cairnBadSettings);
  settings.threads = 2;
  CHECK(cairnSetSettings(solver, &settings) == cairnOk);
  settings.budgetKind = (CairnBudgetKind)7;
  CHECK(cairnSetSettings(solver, &settings) == cairnBadSettings);
  cairnDescribeSettings(&settings, text, sizeof text);
  CHECK(strcmp(text, "budgetKind is 7, must be one of CairnBudgetKind") == 0);
  cairnDestroySolver(solver);
}

/* One change of a good scene is refused as said, and nothing is written. */
static void Refused(CairnSolver* solver, Scene* scene, CairnStatus expected, const char* sentence) {
  scene->velocities[0].linear[0] = 77;
  CairnReport report;
  CHECK(cairnSolve(solver, &scene->problem, &scene->solution, &report) == expected);
  CHECK(report.status == expected);
  CHECK(scene->velocities[0].linear[0] == 77);
  char text[200];
  cairnDescribeReport(solver, text, sizeof text);
  if (strstr(text, sentence) == NULL) printf("said: %s\n", text);
  CHECK(strstr(text, sentence) != NULL);
}

static void RefusesBadProblems(void) {
  CairnSolver* solver = MakeSolver();
  Scene scene;
  MakeScene(&scene);
  scene.bodies[1].velocity.linear[2] = NAN;
  Refused(solver, &scene, cairnNotFinite, "body 1: velocity.linear is nan, must be finite");
  MakeScene(&scene);
  scene.problem.points = NULL;
  Refused(solver, &scene, cairnNullPointer, "points is null, where pointCount is ");
  MakeScene(&scene);
  scene.solution.jointRows = NULL;
  Refused(solver, &scene, cairnNullPointer,
          "jointRows of the solution is null, where jointRowCount is ");
  MakeScene(&scene);
  scene.problem.pointCount = 0;
  scene.problem.twistCount = -5;
  Refused(solver, &scene, cairnWrongSize, "twistCount is -5, must be at least 0");
  MakeScene(&scene);
  scene.problem.jointCount = -1;
  Refused(solver, &scene, cairnWrongSize, "jointCount is -1, must be at least 0");
  MakeScene(&scene);
  scene.manifold.firstPoint = 1;
  Refused(solver, &scene, cairnWrongSize, "manifold 0");
  MakeScene(&scene);
  scene.joint.bodyA = 7;
  Refused(solver, &scene, cairnNoSuchBody, "joint 0");
  /* with the status of the step before, and nothing of its report */
  MakeScene(&scene);
  scene.manifold.firstPoint = 1;
  Refused(solver, &scene, cairnWrongSize, "manifold 0");
  MakeScene(&scene);
  scene.problem.jointCount = -1;
  Refused(solver, &scene, cairnWrongSize, "jointCount is -1, must be at least 0");
  int32_t count = 7;
  CHECK(cairnIslandOf(solver, &count) == NULL && count == 0);
  MakeScene(&scene);
  scene.problem.bodyCount = 0;
  Refused(solver, &scene, cairnEmptyProblem, "no bodies");
  CHECK(cairnSolve(NULL, &scene.problem, &scene.solution, NULL) == cairnNullPointer);
  MakeScene(&scene);
  CHECK(cairnSolve(solver, &scene.problem, &scene.solution, NULL) == cairnOk);
  cairnDestroySolver(solver);
}

static void FindsWhatCannotBeMeant(void) {
  Scene scene;
  MakeScene(&scene);
  char text[200];
  CHECK(cairnValidateStrictly(&scene.problem, &scene.solution, text, sizeof text) == 0);
  scene.solution.velocities = NULL;
  cairnValidateStrictly(&scene.problem, &scene.solution, text, sizeof text);
  CHECK(strcmp(text, "velocities is null, where bodyCount is 2\n") == 0);
  MakeScene(&scene);
  scene.points[2].normal[1] = 2;
  cairnValidateStrictly(&scene.problem, &scene.solution, text, sizeof text);
  CHECK(strcmp(text, "points[2].normal is (0, 2, 0), must be a unit vector\n") == 0);
}

/* A job system: one thread for each job, joined at the end. */
typedef struct Job {
  void (*work)(void*);
  void* what;
} Job;
typedef struct Pool {
  thrd_t threads[64];
  Job jobs[64];
  int count;
} Pool;

static int RunJob(void* job) {
  ((Job*)job)->work(((Job*)job)->what);
  return 0;
}

static void Submit(void (*work)(void*), void* what, void* context) {
  Pool* pool = context;
  if (pool->count == 64) return; /* a job that is never called is none that is waited for */
  Job* job = &pool->jobs[pool->count];
  job->work = work;
  job->what = what;
  thrd_create(&pool->threads[pool->count++], RunJob, job);
}

/* Piles of many bodies: enough rows for threads. */
static void TakesThreadsOfItsHost(void) {
  enum { kPiles = 500 };
  static CairnBody bodies[kPiles];
  static CairnManifold manifolds[kPiles];
  static CairnContactPoint points[4 * kPiles];
  static CairnContactImpulse impulses[2][4 * kPiles];
  static CairnVelocity velocities[2][kPiles];
  Scene scene;
  MakeScene(&scene);
  for (int i = 0; i < kPiles; ++i) {
    bodies[i] = scene.bodies[0];
    bodies[i].id = (uint64_t)i + 1;
    bodies[i].velocity.linear[0] = 0.01f * (float)i;
    manifolds[i] = scene.manifold;
    manifolds[i].bodyA = i;
    manifolds[i].firstPoint = 4 * i;
    memcpy(&points[4 * i], scene.points, sizeof scene.points);
  }
  CairnProblem problem = cairnDefaultProblem();
  problem.bodies = bodies;
  problem.manifolds = manifolds;
  problem.points = points;
  problem.bodyCount = problem.manifoldCount = kPiles;
  problem.pointCount = 4 * kPiles;
  Pool pool = {.count = 0};
  for (int run = 0; run < 2; ++run) {
    CairnSettings settings = cairnDefaultSettings();
    settings.threads = run == 0 ? 1 : 2;
    settings.jobs.submit = Submit;
    settings.jobs.context = &pool;
    CairnSolver* solver = NULL;
    CHECK(cairnCreateSolver(cairnLayout(), &settings, &solver) == cairnOk);
    const CairnSolution solution = {impulses[run], NULL, NULL, velocities[run]};
    CHECK(cairnSolve(solver, &problem, &solution, NULL) == cairnOk);
    cairnDestroySolver(solver);
  }
  CHECK(pool.count > 0);
  for (int i = 0; i < pool.count; ++i) thrd_join(pool.threads[i], NULL);
  CHECK(memcmp(velocities[0], velocities[1], sizeof velocities[0]) == 0);
  CHECK(memcmp(impulses[0], impulses[1], sizeof impulses[0]) == 0);

  /* jobs that are set later are asked, also while those of before never come */
  Pool never = {.count = 64}, later = {.count = 0};
  CairnSettings settings = cairnDefaultSettings();
  settings.threads = 2;
  settings.jobs.submit = Submit;
  settings.jobs.context = &never;
  CairnSolver* solver = NULL;
  CHECK(cairnCreateSolver(cairnLayout(), &settings, &solver) == cairnOk);
  const CairnSolution solution = {impulses[0], NULL, NULL, velocities[0]};
  CHECK(cairnSolve(solver, &problem, &solution, NULL) == cairnOk);
  settings.jobs.context = &later;
  CHECK(cairnSetSettings(solver, &settings) == cairnOk);
  CHECK(cairnSolve(solver, &problem, &solution, NULL) == cairnOk);
  CHECK(later.count > 0);
  cairnDestroySolver(solver);
  for (int i = 0; i < later.count; ++i) thrd_join(later.threads[i], NULL);
}

static void RecordsAndSolvesAgain(const char* folder) {
  char path[1000];
  snprintf(path, sizeof path, "%s/c_test.cairn", folder);
  remove(path);
  CairnSolver* solver = MakeSolver();
  Scene scene;
  MakeScene(&scene);
  CHECK(cairnRecordNext(solver, path) == cairnOk);
  CHECK(cairnSolve(solver, &scene.problem, &scene.solution, NULL) == cairnOk);
  CHECK(cairnRecordedFiles(solver) == 1);
  CHECK(cairnSolve(solver, &scene.problem, &scene.solution, NULL) == cairnOk);
  CHECK(cairnRecordedFiles(solver) == 1);

  CairnRecording* recording = NULL;
  CHECK(cairnLoadRecording("/no/such/file", &recording) == cairnBadFile);
  CHECK(cairnLoadRecording(path, &recording) == cairnOk);
  CHECK(cairnRecordingBodies(recording) == 2);
  MakeScene(&scene);
  cairnReset(solver);
  CHECK(cairnSolve(solver, &scene.problem, &scene.solution, NULL) == cairnOk);
  for (int run = 0; run < 2; ++run) { /* a recording keeps its start */
    CairnVelocity velocities[2];
    CairnReport report;
    cairnReset(solver);
    CHECK(cairnSolveRecording(solver, recording, velocities, &report) == cairnOk);
    CHECK(memcmp(velocities, scene.velocities, sizeof velocities) == 0);
    CHECK(report.islandCount == 1);
  }
  cairnFreeRecording(recording);
  cairnDestroySolver(solver);
}

/* 1 N s in four parts: 1/4, 2/4, 3/4 and 1 m/s, 5/8 m/s on average. */
static void SaysHowFastBodiesWereOnAverage(void) {
  CairnSettings settings = cairnDefaultSettings();
  settings.substeps = 4;
  CairnBody body = cairnDefaultBody();
  body.invMass = 1;
  body.impulse[1] = -1;
  CairnProblem problem = cairnDefaultProblem();
  problem.bodies = &body;
  problem.bodyCount = 1;
  problem.timeStep = 1.0f / 60;
  CairnVelocity velocity, mean;
  CairnSolution solution = {NULL, NULL, NULL, &velocity};
  CairnSolver* solver = NULL;
  CHECK(cairnCreateSolver(cairnLayout(), &settings, &solver) == cairnOk);
  CHECK(cairnSolve(solver, &problem, &solution, NULL) == cairnOk);
  CHECK(velocity.linear[1] == -1);
  CHECK(cairnMeanVelocities(solver, &mean, 2) == cairnWrongSize);
  CHECK(cairnMeanVelocities(solver, NULL, 1) == cairnNullPointer);
  CHECK(cairnMeanVelocities(solver, &mean, 1) == cairnOk);
  CHECK(mean.linear[1] == -0.625f);
  settings.substeps = 1;
  CHECK(cairnSetSettings(solver, &settings) == cairnOk);
  CHECK(cairnSolve(solver, &problem, &solution, NULL) == cairnOk);
  CHECK(cairnMeanVelocities(solver, &mean, 1) == cairnOk);
  CHECK(mean.linear[1] == -1);
  cairnDestroySolver(solver);
}

/* What a game puts to sleep: the two of the scene rest, then one is thrown up. */
static void SaysForHowLongIslandsWereQuiet(void) {
  CairnSolver* solver = MakeSolver();
  Scene scene;
  MakeScene(&scene);
  CairnIsland island;
  for (int step = 1; step <= 3; ++step) {
    CHECK(cairnSolve(solver, &scene.problem, &scene.solution, NULL) == cairnOk);
    CHECK(cairnGetIsland(solver, 0, &island) == cairnOk);
    CHECK(island.quiet == step && island.speed < 0.02 && island.spin < 0.02);
  }
  scene.bodies[0].velocity.linear[1] = scene.bodies[1].velocity.linear[1] = 3;
  CHECK(cairnSolve(solver, &scene.problem, &scene.solution, NULL) == cairnOk);
  CHECK(cairnGetIsland(solver, 0, &island) == cairnOk);
  CHECK(island.quiet == 0 && fabs(island.speed - (3 - 9.81 / 60)) < 2e-3);
  CairnSettings settings = cairnDefaultSettings();
  CHECK(settings.quietSpeed == 0.05);
  CHECK(settings.unitsPerMetre == 0);
  settings.quietSpeed = 5;
  CHECK(cairnSetSettings(solver, &settings) == cairnOk);
  CHECK(cairnSolve(solver, &scene.problem, &scene.solution, NULL) == cairnOk);
  CHECK(cairnGetIsland(solver, 0, &island) == cairnOk && island.quiet == 1);
  cairnDestroySolver(solver);
}

/* Depth, and a joint that gapes: both move their bodies by 0.3 m/s, and leave them at rest. */
static void TakesErrorsBackWithoutVelocity(void) {
  CairnSettings settings = cairnDefaultSettings();
  settings.tolerance = 1e-4;
  Scene scene;
  for (int pass = 0; pass < 4; ++pass) {
    settings.relax = pass > 0;
    const bool kept = pass > 1; /* what is no error stays a speed */
    CairnSolver* solver = NULL;
    CHECK(cairnCreateSolver(cairnLayout(), &settings, &solver) == cairnOk);
    MakeScene(&scene);
    for (int p = 0; p < 4; ++p) scene.points[p].bias = 0.3f;
    scene.manifold.speeds = kept ? 15 : 0;
    scene.rows[0].target = 0.3f;
    scene.joint.errors = pass == 3 ? 0 : 1;
    CHECK(cairnSolve(solver, &scene.problem, &scene.solution, NULL) == cairnOk);
    CairnVelocity means[2];
    CHECK(cairnMeanVelocities(solver, means, 2) == cairnOk);
    CHECK(fabsf(means[0].linear[1] - 0.3f) < 1e-3f);
    const bool rises = !settings.relax || kept, opens = !settings.relax || pass == 3;
    CHECK(fabsf(scene.velocities[0].linear[1] - (rises ? 0.3f : 0)) < 1e-3f);
    const float* const ends[2] = {scene.velocities[0].linear, scene.velocities[1].linear};
    CHECK(fabsf(ends[1][0] - ends[0][0] - (opens ? 0.3f : 0)) < 1e-3f);
    CHECK(fabsf(means[1].linear[0] - means[0].linear[0] - 0.3f) < 1e-3f);
    cairnDestroySolver(solver);
  }
}

/* What a program gave, and got back. */
typedef struct Counts {
  size_t bytes, most;
  int blocks, left; /* left: allocations until one fails */
} Counts;

static void* Give(size_t bytes, size_t alignment, void* context) {
  Counts* counts = context;
  if (counts->left-- == 0) return NULL;
  counts->bytes += bytes;
  if (counts->bytes > counts->most) counts->most = counts->bytes;
  ++counts->blocks;
  return aligned_alloc(alignment, (bytes + alignment - 1) / alignment * alignment);
}

static void TakeBack(void* memory, size_t bytes, size_t alignment, void* context) {
  Counts* counts = context;
  CHECK((uintptr_t)memory % alignment == 0);
  counts->bytes -= bytes;
  --counts->blocks;
  free(memory);
}

static void TakesMemoryOfItsHost(void) {
  Counts counts = {0, 0, 0, -1};
  CairnSettings settings = cairnDefaultSettings();
  settings.memory.allocate = Give;
  settings.memory.context = &counts;
  CairnSolver* solver = NULL;
  CHECK(cairnCreateSolver(cairnLayout(), &settings, &solver) == cairnNullPointer); /* no free() */
  settings.memory.free = TakeBack;
  CHECK(cairnCreateSolver(cairnLayout(), &settings, &solver) == cairnOk);
  CHECK(counts.bytes > 0 && cairnBytes(solver, NULL) == counts.bytes);
  Scene scene;
  MakeScene(&scene);
  for (int i = 0; i < 3; ++i) {
    CHECK(cairnSolve(solver, &scene.problem, &scene.solution, NULL) == cairnOk);
    size_t most = 0;
    CHECK(cairnBytes(solver, &most) == counts.bytes && most == counts.most);
  }
  cairnDestroySolver(solver);
  CHECK(counts.bytes == 0 && counts.blocks == 0);
  size_t most = 1;
  CHECK(cairnBytes(NULL, &most) == 0 && most == 0);

  /* memory that ends */
  counts.left = 0;
  solver = NULL;
  CHECK(cairnCreateSolver(cairnLayout(), &settings, &solver) == cairnOutOfMemory && solver == NULL);
  counts.left = -1;
  CHECK(cairnCreateSolver(cairnLayout(), &settings, &solver) == cairnOk);
  counts.left = 2;
  CHECK(cairnSolve(solver, &scene.problem, &scene.solution, NULL) == cairnOutOfMemory);
  counts.left = -1;
  CHECK(cairnSolve(solver, &scene.problem, &scene.solution, NULL) == cairnOk);
  cairnDestroySolver(solver);
  CHECK(counts.bytes == 0 && counts.blocks == 0);
}

static void EveryStatusHasASentence(void) {
  for (int status = cairnOk; status <= cairnBadInput; ++status) {
    if (status == cairnOverflow + 1) status = cairnWrongVersion;
    CHECK(strlen(cairnDescribe((CairnStatus)status)) > 5);
    CHECK(strcmp(cairnDescribe((CairnStatus)status), "unknown status") != 0);
  }
  CHECK(strcmp(cairnDescribe((CairnStatus)50), "unknown status") == 0);
}

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  SolvesBodiesContactsAndJoints();
  ReportsWhatIsTakenBackAndStrain();
  SolvesBodiesInDoubles();
  RefusesOtherVersionsAndLayouts();
  NamesBadSettings();
  RefusesBadProblems();
  FindsWhatCannotBeMeant();
  TakesThreadsOfItsHost();
  RecordsAndSolvesAgain(argv[1]);
  SaysHowFastBodiesWereOnAverage();
  SaysForHowLongIslandsWereQuiet();
  TakesErrorsBackWithoutVelocity();
  TakesMemoryOfItsHost();
  EveryStatusHasASentence();
  printf("%d failures\n", failures);
  return failures > 0;
}
