/* SPDX-License-Identifier: MIT */
/* Contacts of the helpers as a C program sees them: what falls comes to rest, or bounces. */
#include <stdlib.h>

#include "small_world.h"

/* The four lower corners of a box, on the one below it or on the ground. */
static void AddBoxOnBox(World* world, int box) {
  CairnTouch touch = cairnDefaultTouch();
  touch.bodyA = box;
  touch.bodyB = box > 0 ? box - 1 : CAIRN_WORLD;
  touch.id = (uint64_t)box + 1;
  memcpy(touch.centreA, world->things[box].position, sizeof touch.centreA);
  if (box > 0) memcpy(touch.centreB, world->things[box - 1].position, sizeof touch.centreB);
  const double face = box > 0 ? world->things[box - 1].position[1] + 0.5 : 0;
  CairnTouchPoint points[4];
  for (uint32_t p = 0; p < 4; ++p) {
    const double corner[3] = {p & 1 ? 0.5 : -0.5, -0.5, p & 2 ? 0.5 : -0.5};
    points[p] = cairnDefaultTouchPoint();
    PlaceOf(&world->things[box], corner, points[p].position);
    points[p].depth = face - points[p].position[1];
    points[p].feature = p;
  }
  CHECK(cairnAddTouch(world->frame, &touch, points, 4) == cairnOk);
}

static void ABoxStackComesToRest(void) {
  const CairnFrameSettings settings = cairnDefaultFrameSettings();
  World world;
  MakeWorld(&settings, 5, &world);
  for (int i = 0; i < 5; ++i) world.things[i].position[1] = 0.55 + 1.05 * i;
  for (int frame = 0; frame < 240; ++frame) {
    Begin(&world);
    for (int i = 0; i < 5; ++i) AddBoxOnBox(&world, i);
    End(&world);
  }
  const CairnPositionErrors errors = cairnFrameErrors(world.frame);
  CHECK(errors.depth.largest < 0.006 && errors.gap.largest == 0);
  for (int i = 0; i < 5; ++i) {
    CHECK(fabs(world.things[i].position[1] - (0.5 + i)) < 0.01 * (i + 1));
    for (int k = 0; k < 3; ++k) {
      CHECK(fabsf(world.bodies[i].velocity.linear[k]) < 1e-3f);
      CHECK(fabsf(world.bodies[i].velocity.angular[k]) < 1e-3f);
    }
  }
  /* by hand: the ground carries 5 kg */
  float ground = 0;
  for (int p = 0; p < 4; ++p) ground += world.solution.points[p].normal;
  CHECK(fabs(ground - 5 * 9.81 / 60) < 2e-3);
  CHECK(cairnValidateFrame(world.frame, NULL, 0) == 0);
  FreeWorld(&world);
}

/* Falls by 2 m, and rises to e^2 times that. */
static double HeightOfBounce(double restitution) {
  const CairnFrameSettings settings = cairnDefaultFrameSettings();
  World world;
  MakeWorld(&settings, 1, &world);
  world.things[0].position[1] = 2;
  double highest = 0;
  bool bounced = false;
  for (int frame = 0; frame < 130; ++frame) {
    Begin(&world);
    CairnTouch touch = cairnDefaultTouch();
    touch.bodyA = 0;
    touch.restitution = restitution;
    memcpy(touch.centreA, world.things[0].position, sizeof touch.centreA);
    CairnTouchPoint point = cairnDefaultTouchPoint();
    point.position[0] = world.things[0].position[0];
    point.depth = -world.things[0].position[1];
    CHECK(cairnAddTouch(world.frame, &touch, &point, 1) == cairnOk);
    End(&world);
    if (world.bodies[0].velocity.linear[1] > 0.1f) bounced = true;
    if (bounced && world.things[0].position[1] > highest) highest = world.things[0].position[1];
  }
  FreeWorld(&world);
  return highest;
}

static void ABallBouncesToTheSquareOfItsRestitution(void) {
  CHECK(fabs(HeightOfBounce(0.5) - 0.5) < 0.01);
  CHECK(fabs(HeightOfBounce(0.8) - 1.28) < 0.02);
  CHECK(HeightOfBounce(0) == 0);
}

/* A box on the ground, depth below it: what its points ask for. */
static CairnContactPoint OneBox(const CairnContactOptions* options, double depth, int* points) {
  const CairnFrameSettings settings = cairnDefaultFrameSettings();
  World world;
  MakeWorld(&settings, 1, &world);
  world.things[0].position[1] = 0.5 - depth;
  CHECK(cairnSetContactOptions(world.frame, options) == cairnOk);
  Begin(&world);
  AddBoxOnBox(&world, 0);
  CHECK(cairnFrameProblem(world.frame, &world.problem, &world.solution) == cairnOk);
  *points = world.problem.pointCount;
  const CairnContactPoint none = cairnDefaultContactPoint();
  const CairnContactPoint point = *points > 0 ? world.problem.points[0] : none;
  const CairnPositionErrors errors = cairnFrameErrors(world.frame);
  CHECK(fabs(errors.depth.largest - (depth > 0 ? depth : 0)) < 1e-12);
  CHECK(fabs(errors.depth.takenBack - (depth > 0 ? point.bias * kTimeStep : 0)) < 1e-8);
  FreeWorld(&world);
  return point;
}

/* By hand, with the formulas of cairn/contacts.h. */
static void ContactsBehaveAsTheirOptionsSay(void) {
  CairnContactOptions options = cairnDefaultContactOptions();
  int points = 0;
  CHECK(fabs(OneBox(&options, 0.105, &points).bias - 0.2 * 0.1 * 60) < 1e-6 && points == 4);
  CHECK(OneBox(&options, 0.004, &points).bias == 0);
  CHECK(fabs(OneBox(&options, -0.05, &points).bias + 0.05 * 60) < 1e-6); /* may close the gap */
  OneBox(&options, -0.11, &points);
  CHECK(points == 0);
  options.maxGap = 0.2;
  OneBox(&options, -0.11, &points);
  CHECK(points == 4);
  options.maxPush = 0.25;
  CHECK(OneBox(&options, 0.105, &points).bias == 0.25f);
  CHECK(OneBox(&options, 0.105, &points).compliance == 0);
  options.frequency = 10;
  options.dampingRatio = 1;
  const CairnContactPoint soft = OneBox(&options, 0.025, &points);
  /* J M^-1 J' = 1 + 6 (1/4 + 1/4) = 4, w = 2 pi 10: k = w^2 / 4, c = w / 2, h k / (c + h k) of
     the 2 cm beyond the slop */
  const double w = 20 * 3.14159265358979, stiff = w / 2 + kTimeStep * w * w / 4;
  CHECK(fabs(soft.compliance - 1 / (kTimeStep * stiff)) < 1e-6);
  options.maxPush = 3;
  CHECK(fabs(OneBox(&options, 0.025, &points).bias - 0.02 * w * w / 4 / stiff) < 1e-5);
}

/* The same pair starts from what it exerted, in whatever order; a new name from nothing. */
static void PointsStartFromTheLastFrame(void) {
  const CairnFrameSettings settings = cairnDefaultFrameSettings();
  World world;
  MakeWorld(&settings, 2, &world);
  for (int i = 0; i < 2; ++i) world.things[i].position[1] = 0.5 + i;
  Begin(&world);
  AddBoxOnBox(&world, 0);
  AddBoxOnBox(&world, 1);
  End(&world);
  const CairnContactImpulse first = world.solution.points[2];
  CHECK(first.normal > 0);
  Begin(&world);
  AddBoxOnBox(&world, 1);
  AddBoxOnBox(&world, 0);
  CHECK(cairnFrameProblem(world.frame, &world.problem, &world.solution) == cairnOk);
  CHECK(memcmp(&world.solution.points[4 + 2], &first, sizeof first) == 0);
  Begin(&world); /* a frame without box 0 forgets it */
  AddBoxOnBox(&world, 1);
  Begin(&world);
  AddBoxOnBox(&world, 0);
  CHECK(cairnFrameProblem(world.frame, &world.problem, &world.solution) == cairnOk);
  CHECK(world.problem.pointCount == 4 && world.solution.points[2].normal == 0);
  FreeWorld(&world);
}

static void StepStack(World* world, int frames) {
  for (int frame = 0; frame < frames; ++frame) {
    Begin(world);
    for (int i = 0; i < world->count; ++i) AddBoxOnBox(world, i);
    End(world);
  }
}

static void GoesBackToWhatWasSaved(void) {
  const CairnFrameSettings settings = cairnDefaultFrameSettings();
  World world, saved;
  MakeWorld(&settings, 5, &world);
  MakeWorld(&settings, 5, &saved);
  for (int i = 0; i < 5; ++i) world.things[i].position[1] = 0.55 + 1.05 * i;
  StepStack(&world, 40);
  CHECK(cairnCopyFrame(world.frame, saved.frame) == cairnOk);
  CHECK(cairnCopyState(world.solver, saved.solver) == cairnOk);
  memcpy(saved.things, world.things, sizeof world.things);
  memcpy(saved.bodies, world.bodies, sizeof world.bodies);
  StepStack(&world, 20);
  Thing after[kMostThings];
  memcpy(after, world.things, sizeof after);

  CHECK(cairnCopyFrame(saved.frame, world.frame) == cairnOk);
  CHECK(cairnCopyState(saved.solver, world.solver) == cairnOk);
  memcpy(world.things, saved.things, sizeof world.things);
  memcpy(world.bodies, saved.bodies, sizeof world.bodies);
  StepStack(&world, 20);
  CHECK(memcmp(after, world.things, sizeof after) == 0);

  /* what was copied begins anew before anything is added */
  CHECK(cairnCopyFrame(world.frame, saved.frame) == cairnOk);
  CairnTouch touch = cairnDefaultTouch();
  touch.bodyA = 0;
  CHECK(cairnAddTouch(saved.frame, &touch, NULL, 0) == cairnNoSuchBody);
  CHECK(cairnCopyFrame(NULL, saved.frame) == cairnNullPointer);
  CHECK(cairnCopyFrame(saved.frame, NULL) == cairnNullPointer);
  CHECK(cairnCopyFrame(saved.frame, saved.frame) == cairnOk);
  CHECK(cairnCopyState(NULL, saved.solver) == cairnNullPointer);
  CHECK(cairnCopyState(saved.solver, NULL) == cairnNullPointer);
  FreeWorld(&world);
  FreeWorld(&saved);
}

/* The last call to a frame was refused as said, and added nothing. */
static void Refused(CairnStatus status, CairnStatus expected, CairnFrame* frame, const char* said) {
  CHECK(status == expected);
  char text[100];
  CHECK(cairnDescribeInput(frame, text, sizeof text) == strlen(said));
  if (strcmp(text, said) != 0) printf("said: %s\n", text);
  CHECK(strcmp(text, said) == 0);
  CairnProblem problem;
  CairnSolution solution;
  CHECK(cairnFrameProblem(frame, &problem, &solution) == cairnOk);
  CHECK(problem.pointCount == 0 && problem.manifoldCount == 0 && problem.jointCount == 0);
}

static void NamesBadTouches(void) {
  const CairnFrameSettings settings = cairnDefaultFrameSettings();
  World world;
  MakeWorld(&settings, 2, &world);
  CairnFrame* frame = world.frame;
  CairnStep step = cairnDefaultStep();
  step.bodies = world.bodies;
  step.bodyCount = 2;
  step.timeStep = 0;
  Refused(cairnBeginFrame(frame, &step), cairnBadInput, frame,
          "step.timeStep is 0, must be finite, above 0");
  step.timeStep = kTimeStep;
  step.substeps = 65;
  Refused(cairnBeginFrame(frame, &step), cairnBadInput, frame,
          "step.substeps is 65, must be 1 to 64");
  step.substeps = 1;
  step.bodyCount = -1;
  Refused(cairnBeginFrame(frame, &step), cairnWrongSize, frame, cairnDescribe(cairnWrongSize));
  step.bodyCount = 2;
  step.bodies = NULL;
  Refused(cairnBeginFrame(frame, &step), cairnNullPointer, frame, cairnDescribe(cairnNullPointer));
  CHECK(cairnBeginFrame(NULL, &step) == cairnNullPointer);

  Begin(&world);
  CairnTouch touch = cairnDefaultTouch();
  touch.bodyA = 1;
  CairnTouchPoint points[2] = {cairnDefaultTouchPoint(), cairnDefaultTouchPoint()};
  points[1].depth = NAN;
  Refused(cairnAddTouch(frame, &touch, points, 2), cairnBadInput, frame,
          "points[1].depth is nan, must be finite");
  points[1].depth = 0;
  Refused(cairnAddTouch(frame, &touch, points, -2), cairnWrongSize, frame,
          cairnDescribe(cairnWrongSize));
  Refused(cairnAddTouch(frame, &touch, NULL, 2), cairnNullPointer, frame,
          cairnDescribe(cairnNullPointer));
  touch.friction = -1;
  Refused(cairnAddTouch(frame, &touch, points, 2), cairnBadInput, frame,
          "touch.friction is -1, must be finite, 0 or more");
  touch.friction = 0.5;
  touch.bodyB = 2;
  Refused(cairnAddTouch(frame, &touch, points, 2), cairnNoSuchBody, frame,
          "touch.bodyB is 2, must be -1 for the world, or below the count of bodies");
  touch.bodyB = 1;
  Refused(cairnAddTouch(frame, &touch, points, 2), cairnNoSuchBody, frame,
          "touch.bodyB is 1, must be another body than the first");
  touch.bodyB = CAIRN_WORLD;
  touch.centreB[0] = NAN; /* not looked at */
  CHECK(cairnAddTouch(frame, &touch, points, 2) == cairnOk);
  CHECK(cairnDescribeInput(frame, NULL, 0) == 0);
  CairnContactOptions options = cairnDefaultContactOptions();
  options.maxGap = -1;
  CHECK(cairnSetContactOptions(frame, &options) == cairnBadSettings);
  char text[100];
  cairnDescribeInput(frame, text, sizeof text);
  CHECK(strcmp(text, "maxGap is -1, must be 0 or more") == 0);

  touch.normal[1] = 2;
  CHECK(cairnAddTouch(frame, &touch, points, 1) == cairnOk);
  cairnValidateFrame(frame, text, sizeof text);
  CHECK(strcmp(text, "points[2].normal is (0, 2, 0), must be a unit vector\n") == 0);
  FreeWorld(&world);
}

static void RefusesOtherVersionsLayoutsAndSettings(void) {
  CairnFrameSettings settings = cairnDefaultFrameSettings();
  char text[100];
  CHECK(cairnDescribeFrameSettings(&settings, text, sizeof text) == 0 && text[0] == '\0');
  CairnFrame* frame = NULL;
  CairnHelperLayout layout = cairnHelperLayout();
  layout.jointKind -= 8;
  CHECK(cairnCreateFrame(layout, &settings, &frame) == cairnWrongVersion);
  layout = cairnHelperLayout();
  layout.version += 1 << 8;
  CHECK(cairnCreateFrame(layout, &settings, &frame) == cairnWrongVersion);
  CHECK(cairnCreateFrame(cairnHelperLayout(), NULL, &frame) == cairnNullPointer);
  settings.contacts.erp = 2;
  CHECK(cairnCreateFrame(cairnHelperLayout(), &settings, &frame) == cairnBadSettings);
  cairnDescribeFrameSettings(&settings, text, sizeof text);
  CHECK(strcmp(text, "contacts.erp is 2, must be 0 to 1") == 0);
  settings.contacts.erp = 0.2;
  settings.jointErp = NAN;
  CHECK(cairnCreateFrame(cairnHelperLayout(), &settings, &frame) == cairnBadSettings);
  cairnDescribeFrameSettings(&settings, text, sizeof text);
  CHECK(strcmp(text, "jointErp is nan, must be 0 to 1") == 0);
  CHECK(frame == NULL);
  cairnDestroyFrame(NULL);
  CHECK(cairnFrameErrors(NULL).gap.largest == 0 && cairnTwistOf(NULL, NULL) == 0);
}

/* What a program gave, and got back. */
typedef struct Counts {
  size_t bytes, most;
  int left; /* allocations until one fails */
} Counts;

static void* Give(size_t bytes, size_t alignment, void* context) {
  Counts* counts = context;
  if (counts->left-- == 0) return NULL;
  counts->bytes += bytes;
  if (counts->bytes > counts->most) counts->most = counts->bytes;
  return aligned_alloc(alignment, (bytes + alignment - 1) / alignment * alignment);
}

static void TakeBack(void* memory, size_t bytes, size_t alignment, void* context) {
  (void)alignment;
  ((Counts*)context)->bytes -= bytes;
  free(memory);
}

static CairnStatus BeginAndAdd(World* world, CairnFrame* frame) {
  CairnStep step = cairnDefaultStep();
  step.bodies = world->bodies;
  step.bodyCount = world->count;
  const CairnStatus begun = cairnBeginFrame(frame, &step);
  if (begun != cairnOk) return begun;
  const CairnJointKind kind = cairnHingeJoint(NULL);
  const CairnJointSide a = SideOf(world, 0, 0, 0, 0), b = SideOf(world, CAIRN_WORLD, 0, 0, 0);
  const CairnStatus joint = cairnAddJoint(frame, &kind, &a, &b, 1, NULL);
  if (joint != cairnOk) return joint;
  CairnTouch touch = cairnDefaultTouch();
  touch.bodyA = 0;
  touch.id = 1;
  const CairnTouchPoint point = cairnDefaultTouchPoint();
  return cairnAddTouch(frame, &touch, &point, 1);
}

static void TakesMemoryOfItsHost(void) {
  Counts counts = {0, 0, -1};
  CairnFrameSettings settings = cairnDefaultFrameSettings();
  World world;
  MakeWorld(&settings, 1, &world);
  settings.memory.allocate = Give;
  settings.memory.context = &counts;
  CairnFrame* frame = NULL;
  CHECK(cairnCreateFrame(cairnHelperLayout(), &settings, &frame) == cairnNullPointer);
  settings.memory.free = TakeBack;
  int failed = 0;
  for (int allocations = 0; allocations < 30; ++allocations) {
    frame = NULL;
    counts.left = allocations;
    CairnStatus status = cairnCreateFrame(cairnHelperLayout(), &settings, &frame);
    CHECK((status == cairnOk) == (frame != NULL));
    if (frame != NULL) status = BeginAndAdd(&world, frame);
    if (frame != NULL && status == cairnOk) status = BeginAndAdd(&world, frame);
    CHECK(status == cairnOk || status == cairnOutOfMemory);
    failed += status == cairnOutOfMemory;
    counts.left = -1;
    if (frame == NULL) continue;
    CairnProblem problem;
    CairnSolution solution;
    CHECK(cairnFrameProblem(frame, &problem, &solution) == cairnOk);
    CHECK(problem.bodyCount == (status == cairnOk) && problem.pointCount == problem.bodyCount);
    CHECK(BeginAndAdd(&world, frame) == cairnOk); /* as new */
    CHECK(cairnFrameProblem(frame, &problem, &solution) == cairnOk);
    CHECK(problem.bodyCount == 1 && problem.pointCount == 1 && problem.jointRowCount == 5);
    size_t most = 0;
    CHECK(cairnFrameBytes(frame, &most) == counts.bytes && most <= counts.most);
    cairnDestroyFrame(frame);
    CHECK(counts.bytes == 0);
  }
  CHECK(failed >= 10 && failed < 30);
  FreeWorld(&world);
}

int main(void) {
  ABoxStackComesToRest();
  ABallBouncesToTheSquareOfItsRestitution();
  ContactsBehaveAsTheirOptionsSay();
  PointsStartFromTheLastFrame();
  GoesBackToWhatWasSaved();
  NamesBadTouches();
  RefusesOtherVersionsLayoutsAndSettings();
  TakesMemoryOfItsHost();
  printf("%d failures\n", failures);
  return failures > 0;
}
