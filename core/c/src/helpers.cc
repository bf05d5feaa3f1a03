// SPDX-License-Identifier: MIT
#include "cairn/cairn_helpers.h"

#include <memory>
#include <string>
#include <utility>

#include "cairn/joints.h"
#include "cairn/strict.h"
#include "convert.h"
#include "input.h"
#include "same_layout.h"

using namespace cairn;

CAIRN_SAME_SIZE(CairnContactOptions, ContactOptions);
CAIRN_SAME_FIELD(CairnContactOptions, erp, ContactOptions, erp);
CAIRN_SAME_FIELD(CairnContactOptions, maxPush, ContactOptions, max_push);
CAIRN_SAME_FIELD(CairnContactOptions, maxGap, ContactOptions, max_gap);
CAIRN_SAME_FIELD(CairnContactOptions, minBounce, ContactOptions, min_bounce);
CAIRN_SAME_FIELD(CairnContactOptions, frequency, ContactOptions, frequency);
CAIRN_SAME_FIELD(CairnContactOptions, dampingRatio, ContactOptions, damping_ratio);
CAIRN_SAME_SIZE(CairnTouch, Touch);
CAIRN_SAME_FIELD(CairnTouch, bodyB, Touch, body_b);
CAIRN_SAME_FIELD(CairnTouch, centreA, Touch, centre_a);
CAIRN_SAME_FIELD(CairnTouch, centreB, Touch, centre_b);
CAIRN_SAME_FIELD(CairnTouch, normal, Touch, normal);
CAIRN_SAME_FIELD(CairnTouch, friction, Touch, friction);
CAIRN_SAME_FIELD(CairnTouch, restitution, Touch, restitution);
CAIRN_SAME_FIELD(CairnTouch, id, Touch, id);
CAIRN_SAME_SIZE(CairnTouchPoint, TouchPoint);
CAIRN_SAME_FIELD(CairnTouchPoint, depth, TouchPoint, depth);
CAIRN_SAME_FIELD(CairnTouchPoint, feature, TouchPoint, feature);
CAIRN_SAME_SIZE(CairnJointAxis, JointAxis);
CAIRN_SAME_FIELD(CairnJointAxis, hi, JointAxis, hi);
CAIRN_SAME_FIELD(CairnJointAxis, speed, JointAxis, speed);
CAIRN_SAME_FIELD(CairnJointAxis, maxMotorForce, JointAxis, max_motor_force);
CAIRN_SAME_FIELD(CairnJointAxis, rest, JointAxis, rest);
CAIRN_SAME_FIELD(CairnJointAxis, frequency, JointAxis, frequency);
CAIRN_SAME_FIELD(CairnJointAxis, dampingRatio, JointAxis, damping_ratio);
CAIRN_SAME_FIELD(CairnJointAxis, maxSpringForce, JointAxis, max_spring_force);
CAIRN_SAME_SIZE(CairnJointKind, JointKind);
CAIRN_SAME_FIELD(CairnJointKind, twist, JointKind, twist);
CAIRN_SAME_FIELD(CairnJointKind, cone, JointKind, cone);
CAIRN_SAME_SIZE(CairnJointSide, JointSide);
CAIRN_SAME_FIELD(CairnJointSide, centre, JointSide, centre);
CAIRN_SAME_FIELD(CairnJointSide, anchor, JointSide, anchor);
CAIRN_SAME_FIELD(CairnJointSide, axes, JointSide, axes);
CAIRN_SAME_SIZE(CairnJointGear, JointGear);
CAIRN_SAME_FIELD(CairnJointGear, angle, JointGear, angle);
CAIRN_SAME_FIELD(CairnJointGear, teeth, JointGear, teeth);
CAIRN_SAME_SIZE(CairnPositionError, PositionError);
CAIRN_SAME_FIELD(CairnPositionError, takenBack, PositionError, taken_back);

/// As joints.h has it by default.
constexpr double kJointErp = 0.2;

struct CairnFrame : detail::Placed {
  /// @pre MemoryOfThread() is that of the owner
  CairnFrame(detail::Heap::Owner owner, const CairnFrameSettings& settings)
      : heap(std::move(owner)), joint_erp(settings.jointErp) {
    contacts.options() = c::Same<ContactOptions>(settings.contacts);
  }

  /// As new, but for its options.
  void Forget() {
    contacts = Contacts(contacts.options(), heap.get());
    joints = Joints(joint_erp, heap.get());
    bodies.clear();
    step = {};
    bodies_of_c = nullptr;
  }
  /// What starts the next frame. Nothing can be added before that is begun.
  void CopyFrom(const CairnFrame& other) {
    contacts = other.contacts;
    joints = other.joints;
    joint_erp = other.joint_erp;
    bodies.clear();
    step = {};
    bodies_of_c = nullptr;
  }

  detail::Heap::Owner heap;  ///< all of this lies in it, and itself
  double joint_erp;
  Contacts contacts{{}, heap.get()};
  Joints joints{joint_erp, heap.get()};
  Array<Body> bodies;
  StepInput step;
  const CairnBody* bodies_of_c = nullptr;
  c::Refusal refusal;  ///< of the last call
};

namespace {

bool SameLayout(const CairnHelperLayout& a, const CairnHelperLayout& b) {
  // the patch may differ
  return a.version >> 8 == b.version >> 8 && a.body == b.body && a.bodyD == b.bodyD &&
         a.frameSettings == b.frameSettings && a.step == b.step && a.touch == b.touch &&
         a.touchPoint == b.touchPoint && a.jointKind == b.jointKind && a.jointGear == b.jointGear;
}

/// What is refused before a value is looked at.
CairnStatus Refuse(CairnFrame* frame, CairnStatus status) {
  if (frame != nullptr) frame->refusal = {.status = status, .bad = {}};
  return status;
}

/// Calls @p change where nothing was refused. What it threw may have left contacts half added.
template <class Change>
CairnStatus Accept(CairnFrame* frame, const c::Refusal& refusal, const Change& change) {
  frame->refusal = refusal;
  if (refusal.status != cairnOk) return refusal.status;
  const CairnStatus status = c::Guarded([&] {
    change();
    return cairnOk;
  });
  if (status != cairnOk) frame->Forget();
  return status;
}

/// Calls @p add, which says what it refuses.
template <class Add>
CairnStatus AddTo(CairnFrame* frame, const Add& add) {
  // of a frame that was copied, helpers still know the other's bodies
  if (frame->bodies.empty()) return Refuse(frame, cairnNoSuchBody);
  const CairnStatus status =
      Accept(frame, {}, [&] { frame->refusal = c::RefusalOf(add(), cairnBadInput); });
  return status != cairnOk ? status : frame->refusal.status;
}

JointSide ToSide(const CairnJointSide& side) { return c::Same<JointSide>(side); }

/// One way to add a joint, which gives its place.
template <class Add>
CairnStatus AddJoint(CairnFrame* frame, int32_t* place, const Add& add) {
  return AddTo(frame, [&] {
    const int added = add(&frame->joints);
    const detail::BadValue& refused = frame->joints.refused();
    if (place != nullptr && !refused) *place = added;
    return refused;
  });
}

CairnJointKind ToC(const JointKind& kind) { return c::Same<CairnJointKind>(kind); }
JointAxis AxisOr(const CairnJointAxis* axis) {
  return axis == nullptr ? JointAxis{} : c::Same<JointAxis>(*axis);
}

}  // namespace

CairnContactOptions cairnDefaultContactOptions(void) {
  return c::Same<CairnContactOptions>(ContactOptions{});
}
CairnFrameSettings cairnDefaultFrameSettings(void) {
  return {.contacts = cairnDefaultContactOptions(), .jointErp = kJointErp, .memory = {}};
}
CairnStep cairnDefaultStep(void) {
  return {.bodies = nullptr,
          .bodiesD = nullptr,
          .bodyCount = 0,
          .timeStep = StepInput{}.time_step,
          .substeps = StepInput{}.substeps};
}
CairnTouch cairnDefaultTouch(void) { return c::Same<CairnTouch>(Touch{}); }
CairnTouchPoint cairnDefaultTouchPoint(void) { return c::Same<CairnTouchPoint>(TouchPoint{}); }
CairnJointAxis cairnDefaultJointAxis(void) { return c::Same<CairnJointAxis>(JointAxis{}); }
CairnJointKind cairnDefaultJointKind(void) { return ToC(JointKind{}); }
CairnJointSide cairnDefaultJointSide(void) { return c::Same<CairnJointSide>(JointSide{}); }
CairnJointGear cairnDefaultJointGear(void) { return c::Same<CairnJointGear>(JointGear{}); }

CairnJointKind cairnBallJoint(void) { return ToC(BallJoint()); }
CairnJointKind cairnHingeJoint(const CairnJointAxis* aboutX) {
  return ToC(HingeJoint(AxisOr(aboutX)));
}
CairnJointKind cairnSliderJoint(const CairnJointAxis* alongX) {
  return ToC(SliderJoint(AxisOr(alongX)));
}
CairnJointKind cairnFixedJoint(void) { return ToC(FixedJoint()); }
CairnJointKind cairnConeTwistJoint(double cone, const CairnJointAxis* twist) {
  return ToC(ConeTwistJoint(cone, AxisOr(twist)));
}

double cairnTwistOf(const CairnJointSide* a, const CairnJointSide* b) {
  if (a == nullptr || b == nullptr) return 0;
  return TwistOf(ToSide(*a), ToSide(*b));
}

CairnStatus cairnCreateFrame(CairnHelperLayout layout, const CairnFrameSettings* settings,
                             CairnFrame** frame) {
  return c::Guarded([&] {
    if (!SameLayout(layout, cairnHelperLayout())) return cairnWrongVersion;
    if (settings == nullptr || frame == nullptr) return cairnNullPointer;
    const CairnMemory& memory = settings->memory;
    if (memory.allocate != nullptr && memory.free == nullptr) return cairnNullPointer;
    const CairnStatus looked = c::FindBadSettings(*settings).status;
    if (looked != cairnOk) return looked;
    detail::Heap::Owner heap = c::HeapOf(memory);
    const detail::MemoryScope scope(heap.get());
    *frame = std::make_unique<CairnFrame>(std::move(heap), *settings).release();
    return cairnOk;
  });
}

void cairnDestroyFrame(CairnFrame* frame) { delete frame; }

size_t cairnDescribeFrameSettings(const CairnFrameSettings* settings, char* text, size_t size) {
  return c::Say(text, size, [&](std::string* said) {
    if (settings == nullptr) return cairnNullPointer;
    *said = Describe(c::FindBadSettings(*settings));
    return cairnOk;
  });
}

CairnStatus cairnSetContactOptions(CairnFrame* frame, const CairnContactOptions* options) {
  if (frame == nullptr || options == nullptr) return Refuse(frame, cairnNullPointer);
  const auto wanted = c::Same<ContactOptions>(*options);
  return Accept(frame, c::RefusalOf(detail::FindBad(wanted, ""), cairnBadSettings),
                [&] { frame->contacts.options() = wanted; });
}

size_t cairnFrameBytes(const CairnFrame* frame, size_t* most) {
  if (most != nullptr) *most = frame == nullptr ? 0 : frame->heap.get()->most_bytes();
  return frame == nullptr ? 0 : frame->heap.get()->bytes();
}

CairnStatus cairnBeginFrame(CairnFrame* frame, const CairnStep* step) {
  if (frame == nullptr || step == nullptr) return Refuse(frame, cairnNullPointer);
  const int32_t count = step->bodyCount;
  if (count < 0) return Refuse(frame, cairnWrongSize);
  const bool doubles = step->bodies == nullptr;
  if (count > 0 && doubles && step->bodiesD == nullptr) return Refuse(frame, cairnNullPointer);
  return Accept(frame, c::FindBadStep(*step), [&] {
    const auto size = static_cast<size_t>(count);
    doubles ? c::CopyBodies(std::span(step->bodiesD, size), &frame->bodies)
            : c::CopyBodies(std::span(step->bodies, size), &frame->bodies);
    frame->step = {frame->bodies, step->timeStep, step->substeps};
    frame->bodies_of_c = step->bodies;
    frame->contacts.Begin(frame->step);
    frame->joints.Begin(frame->step);
  });
}

CairnStatus cairnCopyFrame(const CairnFrame* frame, CairnFrame* other) {
  if (frame == nullptr || other == nullptr) return Refuse(other, cairnNullPointer);
  if (frame == other) return cairnOk;
  return Accept(other, {}, [&] { other->CopyFrom(*frame); });
}

CairnStatus cairnAddTouch(CairnFrame* frame, const CairnTouch* touch, const CairnTouchPoint* points,
                          int32_t count) {
  if (frame == nullptr || touch == nullptr) return Refuse(frame, cairnNullPointer);
  if (count < 0) return Refuse(frame, cairnWrongSize);
  if (count > 0 && points == nullptr) return Refuse(frame, cairnNullPointer);
  return AddTo(frame, [&] {
    frame->contacts.Add(c::Same<Touch>(*touch), c::Over<const TouchPoint>(points, count));
    return frame->contacts.refused();
  });
}

CairnStatus cairnAddJoint(CairnFrame* frame, const CairnJointKind* kind, const CairnJointSide* a,
                          const CairnJointSide* b, uint64_t id, int32_t* place) {
  if (frame == nullptr || kind == nullptr || a == nullptr || b == nullptr)
    return Refuse(frame, cairnNullPointer);
  return AddJoint(frame, place, [&](Joints* joints) {
    return joints->Add(c::Same<JointKind>(*kind), ToSide(*a), ToSide(*b), id);
  });
}

CairnStatus cairnAddDistance(CairnFrame* frame, const CairnJointAxis* length,
                             const CairnJointSide* a, const CairnJointSide* b, uint64_t id,
                             int32_t* place) {
  if (frame == nullptr || length == nullptr || a == nullptr || b == nullptr) {
    return Refuse(frame, cairnNullPointer);
  }
  return AddJoint(frame, place, [&](Joints* joints) {
    return joints->AddDistance(AxisOr(length), ToSide(*a), ToSide(*b), id);
  });
}

CairnStatus cairnAddGear(CairnFrame* frame, const CairnJointGear* a, const CairnJointGear* b,
                         uint64_t id, int32_t* place) {
  if (frame == nullptr || a == nullptr || b == nullptr) return Refuse(frame, cairnNullPointer);
  return AddJoint(frame, place, [&](Joints* joints) {
    return joints->AddGear(c::Same<JointGear>(*a), c::Same<JointGear>(*b), id);
  });
}

size_t cairnDescribeInput(const CairnFrame* frame, char* text, size_t size) {
  return c::Say(text, size, [&](std::string* said) {
    if (frame == nullptr) return cairnNullPointer;
    *said = Describe(frame->refusal);
    return cairnOk;
  });
}

CairnStatus cairnFrameProblem(CairnFrame* frame, CairnProblem* problem, CairnSolution* solution) {
  if (frame == nullptr || problem == nullptr || solution == nullptr) return cairnNullPointer;
  const ContactProblem made = ProblemOf(frame->step, frame->contacts, frame->joints);
  const Impulses start = StartOf(&frame->contacts, &frame->joints);
  const auto count = [](const auto& span) { return static_cast<int32_t>(span.size()); };
  *problem = {.bodies = frame->bodies_of_c,
              .manifolds = c::Over<const CairnManifold>(made.manifolds).data(),
              .points = c::Over<const CairnContactPoint>(made.points).data(),
              .twists = nullptr,
              .joints = c::Over<const CairnJoint>(made.joints).data(),
              .jointRows = c::Over<const CairnJointRow>(made.joint_rows).data(),
              .bodyCount = count(made.bodies),
              .manifoldCount = count(made.manifolds),
              .pointCount = count(made.points),
              .twistCount = 0,
              .jointCount = count(made.joints),
              .jointRowCount = count(made.joint_rows),
              .bounceSpeed = made.contact_law.bounce_speed,
              .timeStep = static_cast<float>(made.time_step)};
  solution->points = c::Over<CairnContactImpulse>(start.points).data();
  solution->twists = nullptr;
  solution->jointRows = start.joint_rows.data();
  return cairnOk;
}

CairnPositionErrors cairnFrameErrors(const CairnFrame* frame) {
  if (frame == nullptr) return {};
  const auto error = [](const PositionError& e) { return c::Same<CairnPositionError>(e); };
  return {.depth = error(frame->contacts.deepest()),
          .gap = error(frame->joints.worst_gap()),
          .angle = error(frame->joints.worst_angle())};
}

size_t cairnValidateFrame(CairnFrame* frame, char* text, size_t size) {
  return c::Say(text, size, [&](std::string* said) {
    if (frame == nullptr) return cairnNullPointer;
    const ContactProblem problem = ProblemOf(frame->step, frame->contacts, frame->joints);
    c::AppendFindings(problem, StartOf(&frame->contacts, &frame->joints), said);
    return cairnOk;
  });
}
