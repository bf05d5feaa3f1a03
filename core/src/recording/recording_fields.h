// SPDX-License-Identifier: MIT
// The fields of everything in a recording, in the order of the file: the one place that knows it.
// Writer, reader and counter are shown the same fields.
#pragma once

#include "cairn/detail/recording.h"

namespace cairn {

template <class Io>
void Visit(Vector3& v, Io& io) {
  for (int k = 0; k < 3; ++k) io.F64(v[k]);
}

template <class Io, int n>
void Visit(float (&values)[n], Io& io) {
  for (float& value : values) io.F32(value);
}

template <class Io>
void Visit(Body& body, Io& io) {
  io.F64(body.inv_mass);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) io.F64(body.inv_inertia(i, j));
  }
  Visit(body.linear_factor, io);
  Visit(body.velocity.linear, io);
  Visit(body.velocity.angular, io);
  Visit(body.impulse, io);
  Visit(body.angular_impulse, io);
  io.U64(body.id);
}

template <class Io>
void Visit(Row& row, Io& io) {
  io.I32(row.body_a);
  io.I32(row.body_b);
  Visit(row.linear_a, io);
  Visit(row.angular_a, io);
  Visit(row.linear_b, io);
  Visit(row.angular_b, io);
  io.F64(row.target);
  io.F64(row.compliance);
  io.F64(row.lo);
  io.F64(row.hi);
  io.F64(row.friction);
  io.F64(row.relaxation);
  io.I32(row.parent);
  io.I32(row.host.max_sweeps);
}

template <class Io>
void Visit(Joint& joint, Io& io) {
  io.I32(joint.body_a);
  io.I32(joint.body_b);
  io.I32(joint.first_row);
  io.I32(joint.rows);
  io.U32(joint.bounded);
  io.U32(joint.angular);
  io.F32(joint.damping);
  io.I32(joint.host.max_sweeps);
  io.Flag(joint.soft);
  io.Flag(joint.opposite);
  io.Zeros(2);
}

template <class Io>
void Visit(JointRow& row, Io& io) {
  Visit(row.linear_a, io);
  io.F32(row.target);
  Visit(row.angular_a, io);
  io.F32(row.compliance);
  Visit(row.linear_b, io);
  io.F32(row.lo);
  Visit(row.angular_b, io);
  io.F32(row.hi);
}

template <class Io>
void Visit(Manifold& manifold, Io& io) {
  io.I32(manifold.body_a);
  io.I32(manifold.body_b);
  io.I32(manifold.first_point);
  io.I32(manifold.host.max_sweeps);
  io.Small(manifold.points, 1, Manifold::kMostPoints);
  io.Small(manifold.tangents, 0, 2);
  io.Flag(manifold.soft);
  io.Flag(manifold.twists);
}

template <class Io>
void Visit(ContactPoint& point, Io& io) {
  Visit(point.arm_a, io);
  Visit(point.arm_b, io);
  Visit(point.normal, io);
  Visit(point.tangent, io);
  io.F32(point.bias);
  io.F32(point.restitution);
  io.F32(point.friction);
  io.F32(point.compliance);
}

template <class Io>
void Visit(ContactImpulse& impulse, Io& io) {
  io.F32(impulse.normal);
  Visit(impulse.tangential, io);
  io.F32(impulse.heading);
  Visit(impulse.direction, io);
}

template <class Io>
void Visit(ContactTwist& twist, Io& io) {
  io.F32(twist.spinning);
  io.F32(twist.rolling);
  io.F32(twist.most_spinning);
  io.F32(twist.most_rolling);
}

template <class Io>
void Visit(TwistImpulse& impulse, Io& io) {
  io.F32(impulse.spinning);
  Visit(impulse.rolling, io);
}

template <class Io>
void Visit(ContactMotion& motion, Io& io) {
  Visit(motion.free_velocity, io);
  Visit(motion.free_spin, io);
  Visit(motion.start_velocity, io);
  Visit(motion.start_spin, io);
}

template <class Io>
void Visit(ContactLaw& law, Io& io) {
  io.F32(law.bounce_speed);
  io.Flag(law.host.spin_before_torques);
  io.Flag(law.host.bounded_apart);
  io.Zeros(2);
}

template <class Io>
void Visit(double& value, Io& io) {
  io.F64(value);
}

template <class Io>
void Visit(float& value, Io& io) {
  io.F32(value);
}

template <class Io>
void Visit(std::uint32_t& value, Io& io) {
  io.U32(value);
}

template <class Io>
void Visit(std::uint8_t& value, Io& io) {
  io.U8(value);
}

/// A budget as two numbers.
struct BudgetFields {
  Budget::Kind kind;
  std::int64_t amount;
};

inline BudgetFields Split(const Budget& budget) {
  switch (budget.kind()) {
    case Budget::Kind::kTime:
      return {budget.kind(), budget.time().count()};
    case Budget::Kind::kWork:
      return {budget.kind(), budget.work()};
    case Budget::Kind::kUnlimited:
      break;
  }
  return {Budget::Kind::kUnlimited, 0};
}

inline Budget Join(const BudgetFields& fields) {
  switch (fields.kind) {
    case Budget::Kind::kTime:
      return Budget::Time(std::chrono::nanoseconds(fields.amount));
    case Budget::Kind::kWork:
      return Budget::Work(fields.amount);
    case Budget::Kind::kUnlimited:
      break;
  }
  return Budget::Unlimited();
}

/// Which engine, as files of version 2 say it: an order of rows, of which three are those of the
/// reference.
enum class FileOrder { kAutomatic, kForward, kReverse, kSymmetric, kColoured };

inline FileOrder OrderOf(Path path) {
  if (path == Path::kAuto) return FileOrder::kAutomatic;
  return path == Path::kFast ? FileOrder::kColoured : FileOrder::kForward;
}
inline Path PathOf(FileOrder order) {
  if (order == FileOrder::kAutomatic) return Path::kAuto;
  return order == FileOrder::kColoured ? Path::kFast : Path::kReference;
}

template <class Io>
void Visit(Settings& settings, Io& io) {
  // names every field: a new one does not compile until it is part of the file
  auto& [method, path, k_gs, k_sm, steps, max_sweeps, substeps, relax, geometric_stiffness,
         tolerance, budget, threads, executor, acceleration, step_policy, proximal_joints, tuning] =
      settings;
  auto& [min_progress, min_sweeps, omega, proximal, refinements, quiet_speed, units_per_metre,
         lifted_friction, replay, spans, clock] = tuning;
  if (!steps) k_sm = 0;         // as files have it
  static_cast<void>(substeps);  // have sections of their own
  static_cast<void>(geometric_stiffness);
  static_cast<void>(relax);
  static_cast<void>(replay);
  static_cast<void>(quiet_speed);
  static_cast<void>(executor);
  static_cast<void>(spans);
  static_cast<void>(clock);
  // methods of matrices once had numbers here; contacts were refused to them
  constexpr auto kLastMethod = static_cast<Method>(4);
  io.Enum(method, kLastMethod);
  if (method > Method::kPgsSm) method = Method::kPgsSm;
  FileOrder order = OrderOf(path);
  io.Enum(order, FileOrder::kColoured);
  path = PathOf(order);
  io.I32(k_gs);
  io.I32(k_sm);
  io.I32(max_sweeps);
  io.I32(min_sweeps);
  io.F64(tolerance);
  io.F64(min_progress);
  BudgetFields fields = Split(budget);
  io.I64(fields.amount);
  io.Enum(fields.kind, Budget::Kind::kWork);
  io.Require(fields.kind != Budget::Kind::kUnlimited || fields.amount == 0);
  budget = Join(fields);
  io.I32(threads);
  io.Enum(lifted_friction, detail::LiftedFriction::kHold);
  io.Enum(step_policy, StepPolicy::kWeighed);
  io.F64(omega);
  io.F64(proximal);
  io.F64(proximal_joints);
  io.F64(units_per_metre);  // was active_tolerance, of matrices
  io.I32(refinements);
  io.Enum(acceleration, Acceleration::kNncg);
}

}  // namespace cairn
