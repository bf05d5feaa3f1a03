/* SPDX-License-Identifier: MIT */
/* Each kind of joint of the helpers holds what it should, in a C program. */
#include "small_world.h"

static const double kPi = 3.14159265358979;

static const CairnFrameSettings* Settings(void) {
  static CairnFrameSettings settings;
  settings = cairnDefaultFrameSettings();
  return &settings;
}

/* One thing on a joint with the world, whose anchor and axes are those of the world's origin. */
static void RunOnJoint(World* world, const CairnJointKind* kind, const double anchor[3],
                       int frames) {
  for (int frame = 0; frame < frames; ++frame) {
    Begin(world);
    const CairnJointSide a = SideOf(world, 0, anchor[0], anchor[1], anchor[2]);
    const CairnJointSide b = SideOf(world, CAIRN_WORLD, 0, 0, 0);
    int32_t place = -2;
    CHECK(cairnAddJoint(world->frame, kind, &a, &b, 1, &place) == cairnOk && place == 0);
    End(world);
  }
}

static double Length(const double a[3], const double b[3]) {
  return sqrt((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) +
              (a[2] - b[2]) * (a[2] - b[2]));
}

static const double kLever[3] = {-1, 0, 0}, kNowhere[3] = {0, 0, 0};

static void ABallSwingsAboutItsPoint(void) {
  World world;
  MakeWorld(Settings(), 1, &world);
  world.things[0].position[0] = 1;
  const CairnJointKind ball = cairnBallJoint();
  RunOnJoint(&world, &ball, kLever, 30);
  CHECK(fabs(Length(world.things[0].position, kNowhere) - 1) < 0.02);
  CHECK(world.things[0].position[1] < -0.5); /* it fell */
  CHECK(cairnFrameErrors(world.frame).gap.largest < 0.05);
  FreeWorld(&world);
}

/* The motor turns it at 1 rad/s to its limit. */
static void AHingeTurnsByItsMotorToItsLimit(void) {
  World world;
  MakeWorld(Settings(), 1, &world);
  CairnJointAxis axis = cairnDefaultJointAxis();
  axis.lo = 0;
  axis.hi = 1.5;
  axis.speed = 1;
  axis.maxMotorForce = 50;
  const CairnJointKind hinge = cairnHingeJoint(&axis);
  RunOnJoint(&world, &hinge, kNowhere, 60);
  CairnJointSide a = SideOf(&world, 0, 0, 0, 0), b = SideOf(&world, CAIRN_WORLD, 0, 0, 0);
  CHECK(fabs(cairnTwistOf(&a, &b) - 1) < 1e-2);
  CHECK(fabs(world.things[0].axes[0][0] - 1) < 1e-4);
  RunOnJoint(&world, &hinge, kNowhere, 60);
  a = SideOf(&world, 0, 0, 0, 0);
  CHECK(fabs(cairnTwistOf(&a, &b) - 1.5) < 1e-2);
  CHECK(Length(world.things[0].position, kNowhere) < 1e-2);
  /* the motor does not push against the limit */
  CHECK(world.problem.jointRowCount == 7);
  const float* impulses = world.solution.jointRows;
  CHECK(fabs(impulses[5]) < 1e-3 && fabs(impulses[6]) < 1e-3);
  FreeWorld(&world);
}

/* Along y, by axes of both sides that are turned. */
static void ASliderFallsToItsLimit(void) {
  World world;
  MakeWorld(Settings(), 1, &world);
  CairnJointAxis axis = cairnDefaultJointAxis();
  axis.lo = -0.5;
  const CairnJointKind slider = cairnSliderJoint(&axis);
  for (int frame = 0; frame < 90; ++frame) {
    Begin(&world);
    CairnJointSide a = SideOf(&world, 0, 0.3, 0, 0), b = SideOf(&world, CAIRN_WORLD, 0.3, 0, 0);
    const double up[3][3] = {{0, 1, 0}, {0, 0, 1}, {1, 0, 0}};
    memcpy(b.axes, up, sizeof up);
    for (int k = 0; k < 3; ++k)
      memcpy(a.axes[k], world.things[0].axes[(k + 1) % 3], sizeof a.axes[k]);
    CHECK(cairnAddJoint(world.frame, &slider, &a, &b, 1, NULL) == cairnOk);
    End(&world);
  }
  const double expected[3] = {0, -0.5, 0};
  CHECK(Length(world.things[0].position, expected) < 0.01);
  for (int k = 0; k < 3; ++k) CHECK(fabs(world.things[0].axes[k][k] - 1) < 1e-4);
  FreeWorld(&world);
}

static void AFixedJointHoldsALever(void) {
  World world;
  MakeWorld(Settings(), 1, &world);
  world.things[0].position[0] = 1;
  const CairnJointKind fixed = cairnFixedJoint();
  RunOnJoint(&world, &fixed, kLever, 120);
  const double expected[3] = {1, 0, 0};
  CHECK(Length(world.things[0].position, expected) < 5e-3);
  for (int k = 0; k < 3; ++k) CHECK(fabs(world.things[0].axes[k][k] - 1) < 1e-4);
  FreeWorld(&world);
}

static void AConeStopsASwing(void) {
  World world;
  MakeWorld(Settings(), 1, &world);
  world.things[0].position[0] = 1;
  CairnJointAxis twist = cairnDefaultJointAxis();
  twist.lo = -0.3;
  twist.hi = 0.3;
  const CairnJointKind cone = cairnConeTwistJoint(0.5, &twist);
  RunOnJoint(&world, &cone, kLever, 120);
  CHECK(fabs(acos(world.things[0].axes[0][0]) - 0.5) < 0.02); /* its weight leans on the cone */
  world.gravity = 0;
  world.bodies[0].velocity.angular[0] = 2;
  RunOnJoint(&world, &cone, kLever, 120);
  const CairnJointSide a = SideOf(&world, 0, 0, 0, 0), b = SideOf(&world, CAIRN_WORLD, 0, 0, 0);
  CHECK(fabs(cairnTwistOf(&a, &b)) < 0.33);
  FreeWorld(&world);
}

/* All six ways by hand: held in x, z and turns, a spring in y that sags by g / (2 pi f)^2. */
static void ASpringOfSixWaysCarriesAWeight(void) {
  World world;
  MakeWorld(Settings(), 1, &world);
  CairnJointKind kind = cairnFixedJoint();
  kind.linear[1] = cairnDefaultJointAxis();
  kind.linear[1].frequency = 2;
  kind.linear[1].dampingRatio = 1;
  kind.linear[1].rest = 0.25;
  RunOnJoint(&world, &kind, kNowhere, 240);
  CHECK(fabs(world.things[0].position[1] - (0.25 - 9.81 / (16 * kPi * kPi))) < 1e-3);
  kind.linear[1].maxSpringForce = 5; /* less than it weighs */
  RunOnJoint(&world, &kind, kNowhere, 60);
  CHECK(world.things[0].position[1] < -1);
  FreeWorld(&world);
}

/* A servo: the twist has a target, with a frequency. */
static void AServoTurnsToItsTarget(void) {
  World world;
  MakeWorld(Settings(), 1, &world);
  CairnJointAxis axis = cairnDefaultJointAxis();
  axis.rest = 0.7;
  axis.frequency = 4;
  const CairnJointKind hinge = cairnHingeJoint(&axis);
  RunOnJoint(&world, &hinge, kNowhere, 120);
  const CairnJointSide a = SideOf(&world, 0, 0, 0, 0), b = SideOf(&world, CAIRN_WORLD, 0, 0, 0);
  CHECK(fabs(cairnTwistOf(&a, &b) - 0.7) < 1e-2);
  FreeWorld(&world);
}

/* A rod from the side, and a rope that is slack at first. */
static void ADistanceIsARodOrARope(void) {
  for (int rope = 0; rope < 2; ++rope) {
    World world;
    MakeWorld(Settings(), 1, &world);
    world.things[0].position[0] = rope ? 0.5 : 1;
    CairnJointAxis length = cairnDefaultJointAxis();
    length.hi = 1;
    if (!rope) length.lo = 1;
    double longest = 0;
    for (int frame = 0; frame < 180; ++frame) {
      Begin(&world);
      const CairnJointSide a = SideOf(&world, 0, 0, 0, 0);
      const CairnJointSide b = SideOf(&world, CAIRN_WORLD, 0, 0, 0);
      CHECK(cairnAddDistance(world.frame, &length, &a, &b, 1, NULL) == cairnOk);
      End(&world);
      const double now = Length(world.things[0].position, kNowhere);
      if (!rope) CHECK(fabs(now - 1) < 0.02);
      if (now > longest) longest = now;
    }
    CHECK(fabs(longest - 1) < 0.02);
    FreeWorld(&world);
  }
}

/* Twenty teeth drive ten: the second turns back, twice as fast. */
static void GearsPassOnTurns(void) {
  World world;
  MakeWorld(Settings(), 2, &world);
  world.things[1].position[1] = 3;
  CairnJointAxis motor = cairnDefaultJointAxis();
  motor.speed = 1;
  motor.maxMotorForce = 100;
  const CairnJointKind hinges[2] = {cairnHingeJoint(&motor), cairnHingeJoint(NULL)};
  for (int frame = 0; frame < 60; ++frame) {
    Begin(&world);
    CairnJointGear gears[2];
    for (int i = 0; i < 2; ++i) {
      const CairnJointSide a = SideOf(&world, i, 0, 0, 0);
      const CairnJointSide b = SideOf(&world, CAIRN_WORLD, 0, 3 * i, 0);
      CHECK(cairnAddJoint(world.frame, &hinges[i], &a, &b, (uint64_t)i + 1, NULL) == cairnOk);
      gears[i] = cairnDefaultJointGear();
      gears[i].side = a;
      gears[i].angle = cairnTwistOf(&a, &b);
      gears[i].teeth = i == 0 ? 20 : 10;
    }
    int32_t place = -2;
    CHECK(cairnAddGear(world.frame, &gears[0], &gears[1], 3, &place) == cairnOk && place == 2);
    End(&world);
  }
  CHECK(fabs(world.bodies[0].velocity.angular[0] - 1) < 1e-3);
  CHECK(fabs(world.bodies[1].velocity.angular[0] + 2) < 1e-3);
  FreeWorld(&world);
}

static void AKindThatHoldsNothingIsNone(void) {
  World world;
  MakeWorld(Settings(), 1, &world);
  Begin(&world);
  const CairnJointKind kind = cairnDefaultJointKind();
  const CairnJointSide a = SideOf(&world, 0, 0, 0, 0), b = SideOf(&world, CAIRN_WORLD, 0, 0, 0);
  int32_t place = 7;
  CHECK(cairnAddJoint(world.frame, &kind, &a, &b, 1, &place) == cairnOk && place == -1);
  End(&world);
  CHECK(world.problem.jointCount == 0 && world.problem.jointRowCount == 0);
  FreeWorld(&world);
}

/* A joint that gapes by 10 cm takes a fifth of that back, and starts from what it exerted. */
static void JointsSayHowFarTheyGapeAndStartWarm(void) {
  CairnFrameSettings settings = cairnDefaultFrameSettings();
  CHECK(settings.jointErp == 0.2);
  settings.jointErp = 0.5;
  World world;
  MakeWorld(&settings, 1, &world);
  world.things[0].position[0] = 0.1;
  const CairnJointKind ball = cairnBallJoint();
  RunOnJoint(&world, &ball, kNowhere, 1);
  const CairnPositionErrors errors = cairnFrameErrors(world.frame);
  CHECK(fabs(errors.gap.largest - 0.1) < 1e-9 && fabs(errors.gap.takenBack - 0.05) < 1e-9);
  CHECK(errors.angle.largest == 0 && errors.depth.largest == 0);
  CHECK(fabs(world.things[0].position[0] - 0.05) < 1e-4);
  const float exerted = world.solution.jointRows[1];
  CHECK(fabs(exerted - 9.81 / 60) < 1e-3);
  Begin(&world);
  const CairnJointSide a = SideOf(&world, 0, 0, 0, 0), b = SideOf(&world, CAIRN_WORLD, 0, 0, 0);
  CHECK(cairnAddJoint(world.frame, &ball, &a, &b, 2, NULL) == cairnOk); /* nobody's name */
  CHECK(cairnAddJoint(world.frame, &ball, &a, &b, 1, NULL) == cairnOk);
  CHECK(cairnFrameProblem(world.frame, &world.problem, &world.solution) == cairnOk);
  CHECK(world.solution.jointRows[1] == 0 && world.solution.jointRows[4] == exerted);
  FreeWorld(&world);
}

static void Said(CairnFrame* frame, CairnStatus status, const char* said) {
  char text[100];
  cairnDescribeInput(frame, text, sizeof text);
  CHECK(status != cairnOk);
  if (strcmp(text, said) != 0) printf("said: %s\n", text);
  CHECK(strcmp(text, said) == 0);
}

static void NamesBadJoints(void) {
  World world;
  MakeWorld(Settings(), 2, &world);
  CairnFrame* frame = world.frame;
  Begin(&world);
  CairnJointSide a = SideOf(&world, 0, 0, 0, 0), b = SideOf(&world, 1, 0, 0, 0);
  int32_t place = 7;
  CairnJointKind kind = cairnFixedJoint();
  kind.linear[1].lo = 3;
  Said(frame, cairnAddJoint(frame, &kind, &a, &b, 1, &place),
       "kind.linear[1].lo is 3, must be at most hi");
  kind = cairnConeTwistJoint(-1, NULL);
  Said(frame, cairnAddJoint(frame, &kind, &a, &b, 1, &place), "kind.cone is -1, must be 0 or more");
  kind = cairnHingeJoint(NULL);
  kind.twist.maxSpringForce = 0;
  Said(frame, cairnAddJoint(frame, &kind, &a, &b, 1, &place),
       "kind.twist.maxSpringForce is 0, must be above 0");
  kind = cairnBallJoint();
  b.axes[2][1] = NAN;
  Said(frame, cairnAddJoint(frame, &kind, &a, &b, 1, &place), "b.axes is nan, must be finite");
  b = SideOf(&world, 0, 0, 0, 0);
  Said(frame, cairnAddJoint(frame, &kind, &a, &b, 1, &place),
       "b.body is 0, must be another body than the first");
  b.body = -2;
  Said(frame, cairnAddJoint(frame, &kind, &a, &b, 1, &place),
       "b.body is -2, must be -1 for the world, or below the count of bodies");
  b.body = 1;
  CairnJointAxis length = cairnDefaultJointAxis();
  length.frequency = INFINITY;
  Said(frame, cairnAddDistance(frame, &length, &a, &b, 1, &place),
       "length.frequency is inf, must be finite, 0 or more");
  CairnJointGear gears[2] = {cairnDefaultJointGear(), cairnDefaultJointGear()};
  gears[0].side = a;
  gears[1].side = b;
  gears[1].teeth = 0;
  Said(frame, cairnAddGear(frame, &gears[0], &gears[1], 1, &place),
       "b.teeth is 0, must be another number than 0");
  CHECK(cairnAddGear(frame, &gears[0], NULL, 1, &place) == cairnNullPointer);
  CHECK(place == 7);
  CHECK(cairnFrameProblem(frame, &world.problem, &world.solution) == cairnOk);
  CHECK(world.problem.jointCount == 0);
  FreeWorld(&world);
}

int main(void) {
  ABallSwingsAboutItsPoint();
  AHingeTurnsByItsMotorToItsLimit();
  ASliderFallsToItsLimit();
  AFixedJointHoldsALever();
  AConeStopsASwing();
  ASpringOfSixWaysCarriesAWeight();
  AServoTurnsToItsTarget();
  ADistanceIsARodOrARope();
  GearsPassOnTurns();
  AKindThatHoldsNothingIsNone();
  JointsSayHowFarTheyGapeAndStartWarm();
  NamesBadJoints();
  printf("%d failures\n", failures);
  return failures > 0;
}
