// SPDX-License-Identifier: MIT
#pragma once
#include "cairn/detail/cpp20.h"

#include <cstdint>
#include <span>
#include <string>

#include "cairn/contact_problem.h"
#include "cairn/detail/bad_value.h"
#include "cairn/detail/start_memory.h"

namespace cairn {

/// The step that contacts and joints are made for.
struct StepInput {
  std::span<const Body> bodies = {};  ///< Those of ContactProblem, as they will be solved.
  double time_step = 1 / 60.0;        ///< h [s], > 0
  int substeps = 1;                   ///< Settings::substeps: bounces are counted by them.
};

/// How contacts are to behave, in the words of engines.
struct ContactOptions {
  double slop = 0.005;    ///< Depth that is left as it is [m], >= 0: resting points stay in touch.
  double erp = 0.2;       ///< Share of the depth beyond the slop taken back in a step, in [0, 1].
  double max_push = 3;    ///< Most speed that depth is taken back with [m/s], >= 0.
  double max_gap = 0.1;   ///< Points further apart are left out [m], >= 0.
  double min_bounce = 1;  ///< Bodies that approach slower do not bounce [m/s], >= 0.
  /// Of soft contacts [Hz], taken as 1/4 of the rate of steps at most; 0: hard. With it, erp is not
  /// looked at.
  double frequency = 0;
  double damping_ratio = 10;  ///< Of soft contacts, >= 0. 1 is critical.
};

/// Two bodies that touch, or may in this step.
struct Touch {
  int body_a = kWorld, body_b = kWorld;
  /// Centres of mass [m]; that of kWorld is not looked at.
  Vector3 centre_a = {}, centre_b = {};
  Vector3 normal = {0, 1, 0};  ///< Unit vector, from b to a.
  double friction = 0.5;
  double restitution = 0;  ///< Speed after a bounce over that before it, >= 0.
  /// Names the two while they touch, and which of them is a; 0: no name, no warm start.
  std::uint64_t id = 0;
};

struct TouchPoint {
  Vector3 position = {};      ///< [m]
  double depth = 0;           ///< Overlap; below 0: a gap [m].
  std::uint32_t feature = 0;  ///< Which point it is among those of its Touch.
};

/// How far bodies are from where they should be, and how much of that this step is to take back.
/// Residuals know nothing of it; Report::depth and gap have what a Solve() was asked for, and did.
struct PositionError {
  double largest = 0, taken_back = 0;  ///< [m], or [rad].
};

/// Makes manifolds of what collision detection found, and starts points that were there in the last
/// frame from what they exerted then; those of which no body could move since, being asleep without
/// mass or left out, from what they exerted before. In each frame: Begin(), Add() for each Touch,
/// Solve() with manifolds(), points() and impulses(). A frame with no more points than an earlier
/// one allocates nothing.
///
/// The bias b of a point of depth d with approach speed -v0 before the step:
///   gap (d < 0):            b = d / h, so that the step may close the gap and no more;
///   0 <= d <= slop:         b = 0;
///   deeper:                 b = min(max_push, erp (d - slop) / h);
///   soft, deeper:           the same with erp = h k / (c + h k) and compliance 1 / (h (c + h k)),
///                           k = m (2 pi f)^2, c = 2 m 2 pi f damping_ratio, 1 / m = J M^-1 J',
///                           an implicit step of a spring and damper (Catto, "Soft Constraints",
///                           GDC 2011);
///   bounce, -v0 >= min_bounce, gap closes in this step: at least
///     b = sqrt(2 (e^2 E - g' gap)) - g' h / 2,   E = (v0 - g' h / 2)^2 / 2 + g' gap,
/// with g' how fast external impulses press the point together [m/s^2]. Steps v += -g' h, x += h v
/// keep E, so that the height after a bounce is e^2 times that before, at any time step. With
/// substeps E is that of their steps.
class Contacts {
 public:
  Contacts() = default;
  explicit Contacts(const ContactOptions& options, Memory* memory = nullptr);

  ContactOptions& options() { return options_; }

  /// Begins a frame. The bodies are looked at until the last Add(). Where memory ends, this and
  /// Add() throw std::bad_alloc, and have changed nothing.
  void Begin(const StepInput& step);
  /// More than Manifold::kMostPoints points become several manifolds. False, and nothing is added,
  /// where a value of these or of options() is out of its range: complaint() names it.
  bool Add(const Touch& touch, std::span<const TouchPoint> points);
  /// Why the last Add() was refused: "points[2].depth is nan, must be finite". Empty if it was not.
  std::string complaint() const { return Describe(refused_); }
  const detail::BadValue& refused() const { return refused_; }

  std::span<const Manifold> manifolds() const { return manifolds_; }
  std::span<const ContactPoint> points() const { return points_; }
  std::span<ContactImpulse> impulses() { return impulses_; }
  PositionError deepest() const { return deepest_; }  ///< Of the points added since Begin() [m].

 private:
  void AddPoint(const Touch& touch, const TouchPoint& from, Manifold* manifold);

  ContactOptions options_;
  StepInput step_;
  PositionError deepest_;
  detail::BadValue refused_;
  Array<Manifold> manifolds_;
  Array<ContactPoint> points_;
  Array<ContactImpulse> impulses_;
  detail::StartMemory memory_;
};

}  // namespace cairn
