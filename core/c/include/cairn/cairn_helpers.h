/* SPDX-License-Identifier: MIT */
/* Helpers for engines in C: from points of contact with a depth, and from joints with anchors,
   axes, limits, motors and springs, they make the manifolds, points, joints and rows of
   cairn/cairn.h, and start them from what the same ones exerted in the last frame. cairn/contacts.h
   and joints.h are the same for C++, with the formulas: both give the same bits. docs/c.md has an
   example.

   In each frame: cairnBeginFrame(), cairnAdd...() for each contact and joint, cairnFrameProblem(),
   then cairnSolve() or cairnSolveD(). A call that is refused adds nothing, and cairnDescribeInput()
   says why. Positions are in the world, in doubles; vectors in world axes, units SI. */
#ifndef CAIRN_CAIRN_HELPERS_H
#define CAIRN_CAIRN_HELPERS_H

#include <cairn/cairn.h>
#include <cairn/cairn_doubles.h>

#ifdef __cplusplus
extern "C" {
#endif

/* How contacts are to behave. */
typedef struct CairnContactOptions {
  double slop;         /* depth that is left as it is [m], >= 0: resting points stay in touch */
  double erp;          /* share of the depth beyond it taken back in a step, in [0, 1] */
  double maxPush;      /* most speed that depth is taken back with [m/s], >= 0 */
  double maxGap;       /* points further apart are left out [m], >= 0 */
  double minBounce;    /* bodies that approach slower do not bounce [m/s], >= 0 */
  double frequency;    /* of soft contacts, which ignore erp [Hz], >= 0; 0: hard */
  double dampingRatio; /* of soft contacts, >= 0; 1 is critical */
} CairnContactOptions;

typedef struct CairnFrameSettings {
  CairnContactOptions contacts;
  double jointErp;    /* share of an error that joints take back in a step, in [0, 1] */
  CairnMemory memory; /* all that a frame keeps; allocate NULL: operator new. Only at creation */
} CairnFrameSettings;

/* The step that contacts and joints are made for. */
typedef struct CairnStep {
  const CairnBody* bodies;   /* as they will be solved, by cairnSolve(); or NULL, and */
  const CairnBodyD* bodiesD; /* the same in doubles, for cairnSolveD() */
  int32_t bodyCount;
  double timeStep;  /* [s], > 0 */
  int32_t substeps; /* CairnSettings::substeps: bounces are counted by them */
} CairnStep;

/* Two bodies that touch, or may in this step. */
typedef struct CairnTouch {
  int32_t bodyA, bodyB;         /* or CAIRN_WORLD, one of them */
  double centreA[3];            /* of mass [m]; that of CAIRN_WORLD is not looked at */
  double centreB[3], normal[3]; /* normal: unit vector, from body b to body a */
  double friction;              /* coefficient, >= 0 */
  double restitution;           /* speed after a bounce over that before it, >= 0 */
  uint64_t id; /* names the two while they touch, and which is a; 0: no name, no warm start */
} CairnTouch;

typedef struct CairnTouchPoint {
  double position[3]; /* [m] */
  double depth;       /* overlap; below 0: a gap, which the step may close and no more [m] */
  uint32_t feature;   /* which point it is among those of its touch */
} CairnTouchPoint;

/* A direction in which two bodies may move against each other: along an axis [m, m/s, N], or about
   it [rad, rad/s, N m]. As it comes: free. Above 0 is body a along the axis, or turning about it by
   the right hand, as seen from body b. */
typedef struct CairnJointAxis {
  double lo, hi;         /* limits, lo <= hi, may be infinite; equal: held there */
  double speed;          /* that the motor wants */
  double maxMotorForce;  /* its largest force, >= 0; 0: no motor */
  double rest;           /* where the spring wants to be: a target */
  double frequency;      /* of the spring [Hz], >= 0; 0: no spring */
  double dampingRatio;   /* of the spring, >= 0; 1 is critical */
  double maxSpringForce; /* its largest force, > 0, may be infinite */
} CairnJointAxis;

/* All six ways: the point of a along the axes of b, the twist about their x axes, and the angle
   between these, at most cone [rad], >= 0; 0: they stay parallel, pi and more: free. */
typedef struct CairnJointKind {
  CairnJointAxis linear[3], twist;
  double cone;
} CairnJointKind;

/* What a joint holds of one body, at the start of the step, in the world. */
typedef struct CairnJointSide {
  int32_t body;      /* or CAIRN_WORLD, one of the two */
  double centre[3];  /* of mass [m]; that of CAIRN_WORLD is not looked at */
  double anchor[3];  /* a point of the body [m] */
  double axes[3][3]; /* x, y, z: unit vectors at right angles, right-handed, that turn with the
                        body. Those of both sides agree where all angles are 0 */
} CairnJointSide;

/* A wheel with teeth, about the x axis of its side, whose anchor is not looked at. */
typedef struct CairnJointGear {
  CairnJointSide side;
  double angle;  /* that it has turned by, whole turns aside: cairnTwistOf() its hinge [rad] */
  int32_t teeth; /* not 0; below 0 it turns the other way: a ring, a belt */
} CairnJointGear;

/* How far bodies are from where they should be, and how much of that the step is to take back. */
typedef struct CairnPositionError {
  double largest, takenBack; /* [m] or [rad] */
} CairnPositionError;

typedef struct CairnPositionErrors {
  CairnPositionError depth, gap, angle; /* of contacts; joints; their rows that only turn */
} CairnPositionErrors;

CAIRN_API CairnContactOptions cairnDefaultContactOptions(void);
CAIRN_API CairnFrameSettings cairnDefaultFrameSettings(void);
CAIRN_API CairnStep cairnDefaultStep(void);
CAIRN_API CairnTouch cairnDefaultTouch(void);
CAIRN_API CairnTouchPoint cairnDefaultTouchPoint(void);
CAIRN_API CairnJointAxis cairnDefaultJointAxis(void);
CAIRN_API CairnJointKind cairnDefaultJointKind(void); /* holds nothing */
CAIRN_API CairnJointSide cairnDefaultJointSide(void);
CAIRN_API CairnJointGear cairnDefaultJointGear(void);

/* Kinds that are often wanted. NULL is an axis as it comes. */
CAIRN_API CairnJointKind cairnBallJoint(void);
CAIRN_API CairnJointKind cairnHingeJoint(const CairnJointAxis* aboutX);
CAIRN_API CairnJointKind cairnSliderJoint(const CairnJointAxis* alongX);
CAIRN_API CairnJointKind cairnFixedJoint(void);
CAIRN_API CairnJointKind cairnConeTwistJoint(double cone, const CairnJointAxis* twist);

/* By which body a is twisted, as CairnJointKind::twist counts it [rad], in (-pi, pi]; whole turns
   are not known: the one within pi of the middle of the limits counts, or of the spring's rest. */
CAIRN_API double cairnTwistOf(const CairnJointSide* a, const CairnJointSide* b);

/* As CairnLayout, of these structs and of bodies. */
typedef struct CairnHelperLayout {
  uint32_t version;
  uint32_t body, bodyD, frameSettings, step, touch, touchPoint, jointKind, jointGear;
} CairnHelperLayout;

static inline CairnHelperLayout cairnHelperLayout(void) {
  CairnHelperLayout layout = {
      cairnLayout().version,          CAIRN_SIZE(CairnBody),      CAIRN_SIZE(CairnBodyD),
      CAIRN_SIZE(CairnFrameSettings), CAIRN_SIZE(CairnStep),      CAIRN_SIZE(CairnTouch),
      CAIRN_SIZE(CairnTouchPoint),    CAIRN_SIZE(CairnJointKind), CAIRN_SIZE(CairnJointGear)};
  return layout;
}

/* Makes one frame after another. Several may be used at the same time, one may not. */
typedef struct CairnFrame CairnFrame;

/* Fails with cairnWrongVersion unless major and minor version and all sizes are the library's. */
CAIRN_API CairnStatus cairnCreateFrame(CairnHelperLayout layout, const CairnFrameSettings* settings,
                                       CairnFrame** frame);
CAIRN_API void cairnDestroyFrame(CairnFrame* frame); /* NULL: nothing happens */
/* As cairnDescribeSettings(): "contacts.erp is 2, must be 0 to 1". */
CAIRN_API size_t cairnDescribeFrameSettings(const CairnFrameSettings* settings, char* text,
                                            size_t size);
/* From the next touch on: of soft ground, say. */
CAIRN_API CairnStatus cairnSetContactOptions(CairnFrame* frame, const CairnContactOptions* options);
/* As cairnBytes(). */
CAIRN_API size_t cairnFrameBytes(const CairnFrame* frame, size_t* most);

/* Bodies are copied. After cairnOutOfMemory, from this or cairnAdd...(), a frame is as new: begin
   again. One with no more contacts, joints and bodies than an earlier one allocates nothing. */
CAIRN_API CairnStatus cairnBeginFrame(CairnFrame* frame, const CairnStep* step);
/* Saves and loads: other, which is to be begun next, starts as frame would. */
CAIRN_API CairnStatus cairnCopyFrame(const CairnFrame* frame, CairnFrame* other);
/* More than four points become several manifolds. */
CAIRN_API CairnStatus cairnAddTouch(CairnFrame* frame, const CairnTouch* touch,
                                    const CairnTouchPoint* points, int32_t count);
/* id names the joint while it lives; 0: no name, no warm start. place, unless NULL, is its index in
   CairnProblem::joints, or -1: it holds nothing, and nothing was added. */
CAIRN_API CairnStatus cairnAddJoint(CairnFrame* frame, const CairnJointKind* kind,
                                    const CairnJointSide* a, const CairnJointSide* b, uint64_t id,
                                    int32_t* place);
/* An axis along the line between the anchors: a rod where it is held, a rope with a limit hi, a
   spring. axes of the sides are not looked at. */
CAIRN_API CairnStatus cairnAddDistance(CairnFrame* frame, const CairnJointAxis* length,
                                       const CairnJointSide* a, const CairnJointSide* b,
                                       uint64_t id, int32_t* place);
/* Teeth of two wheels on hinges of their own: as many of one pass as of the other. */
CAIRN_API CairnStatus cairnAddGear(CairnFrame* frame, const CairnJointGear* a,
                                   const CairnJointGear* b, uint64_t id, int32_t* place);

/* What the last call to the frame refused: "points[2].depth is nan, must be finite"; "" if nothing.
   Returns its length, like snprintf. */
CAIRN_API size_t cairnDescribeInput(const CairnFrame* frame, char* text, size_t size);

/* The frame as a problem, and where it starts: arrays of the frame's own, until it is begun or
   added to again, or destroyed; bodies are those of CairnStep. solution->velocities is left to you.
   After cairnSolve(), solution->jointRows from joints[place].firstRow on are what a joint exerted.
 */
CAIRN_API CairnStatus cairnFrameProblem(CairnFrame* frame, CairnProblem* problem,
                                        CairnSolution* solution);

/* Of contacts and joints added since cairnBeginFrame(); zeros for NULL. */
CAIRN_API CairnPositionErrors cairnFrameErrors(const CairnFrame* frame);

/* cairnValidateStrictly() of the frame, in doubles where its bodies are. */
CAIRN_API size_t cairnValidateFrame(CairnFrame* frame, char* text, size_t size);

#ifdef __cplusplus
}
#endif

#endif
