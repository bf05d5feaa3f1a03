// SPDX-License-Identifier: MIT
#pragma once
#include "cairn/detail/cpp20.h"

#include <cstddef>
#include <cstdint>
#include <span>

#include "cairn/contact_problem.h"
#include "cairn/detail/memory.h"
#include "cairn/report.h"

namespace cairn::simd {
struct RaisedInertia;
}

namespace cairn {

/// Share of the usual of an error of position that joints take back in a step, for the larger
/// Body::strain of the bodies they hold. A strained link is far along its turn within a step, and
/// where joints pull that hard to close a gap they throw light bodies: a taut bridge of planks has
/// to turn them to become any shorter. So the pace of corrections follows that of the turn, 2 pi /
/// (h omega) with h omega = sqrt(strain), from sqrt(8) rad a step on: on 3,000 worlds of heavy
/// loads that lets 3 fly apart instead of 14.
double ShareOfErp(double strain);

/// Geometric stiffness: keeps heavy loads on light jointed bodies stable at long time steps.
///
/// A link under tension T that its joint holds at a distance r from its centre of mass turns like a
/// spring of stiffness T r. Velocities that are integrated with steps of length h blow up where
/// h^2 T r / I passes 4, however well the joints are solved; better solved joints only get there
/// sooner. Here the inertia I about such an axis is raised as far as it takes, and bodies below the
/// threshold stay as they are, to the bit.
///
///     stiffness.Apply(h, bodies);                     // before a solve
///     solver.Solve(problem, impulses, velocities);    // with those bodies
///     stiffness.Learn(h, problem, impulses, report);  // after it
///
/// Solver does that itself (Settings::geometric_stiffness), but for problems with motions.
///
/// After Andrews, Teichmann, Kry, "Geometric stiffness for real-time constrained multibody
/// dynamics", 2017, and Tournier, Nesme, Gilles, Faure, "Stable constrained dynamics", 2015. Other
/// than there the threshold is twice as careful, what was needed fades over some steps instead of
/// ending at once, only tension counts, not compression, spin gains no momentum as inertia rises
/// and is damped the more the faster it is, and errors are taken back more slowly where bodies are
/// strained, see ShareOfErp().
class GeometricStiffness {
 public:
  /// A body whose inertia was raised.
  struct Raised {
    int body;          ///< Its place.
    Matrix3 response;  ///< What torques change its spin by, relative to before.
    Matrix3 carried;   ///< What is left of its spin where inertia was raised since the last step.

    /// What its spin changes by over this step, before any impulse [rad/s]. Raised inertia would
    /// lend weight to spin that it did not have when it came about, and throw what stops it.
    Vector3 Damp(double time_step, const Vector3& spin) const;
  };

  /// Raises the inertia of the bodies whose joints pull too hard for a step of that length [s], in
  /// Body::inv_inertia, and writes Body::strain of all. Velocities are left to the caller, see
  /// Raised; valid until the next call. @p jointed: by body, 0 for those that no joint holds in
  /// this step, which are left alone at once, and not after it; none: not known
  std::span<const Raised> RaiseInertia(double time_step, std::span<Body> bodies,
                                       std::span<const char> jointed = {});
  /// The same, and damps Body::velocity.
  void Apply(double time_step, std::span<Body> bodies, std::span<const char> jointed = {});
  /// The same for bodies of a problem, which says who is held by a joint. It need not be valid.
  void Apply(double time_step, const ContactProblem& problem, std::span<Body> bodies) {
    FindJointed(problem);
    Apply(time_step, bodies, jointed_);
  }
  /// Remembers what joints of a solved problem pull with: those of three rows along directions at
  /// right angles to each other that pull and push alike, or of two where bodies cannot move
  /// across. What sweeps alone leave on an island is not yet its tension, so there it is averaged
  /// over some steps. Islands that touch nothing but themselves are left alone: raised inertia
  /// would take from their angular momentum. Does nothing if the report is not ok(). What is known
  /// of bodies without joints is forgotten; that of bodies which are not there, or cannot move,
  /// is kept until they are back, as they may be asleep.
  void Learn(double time_step, const ContactProblem& problem, const Impulses& impulses,
             const Report& report);
  /// Forgets all tension.
  void Reset() {
    memories_.clear();
    absent_.clear();
  }
  /// Nothing is remembered of any body.
  bool empty() const { return memories_.empty() && absent_.empty(); }

 private:
  /// Of a body, by its id or place.
  struct Memory {
    std::uint64_t key = 0;
    int place = 0;             ///< of the body in the last problem
    Matrix3 stiffness = {};    ///< K [N m], world axes
    Matrix3 arms = {};         ///< of joints: simd::RaisedInertia [N^2 m^2], likewise
    Vector3 held = {};         ///< about principal axes [N m]
    double held_ratio = 0;     ///< the largest of these over moments
    Vector3 kept = {1, 1, 1};  ///< moments over raised moments, in the last step
    double inv_mass = 0;       ///< who it is
    double inv_inertia = 0;    ///< sum of its inverse moments, not lowered
    bool seen = false, absent = false;
  };
  static constexpr std::uint64_t kNobody = 0;
  /// A matrix that is its own transpose.
  struct Symmetric {
    double xx = 0, yx = 0, zx = 0, yy = 0, zy = 0, zz = 0;
    Matrix3 Whole() const;
  };
  /// Over the joints of a body.
  struct Sums {
    Symmetric stiffness, arms;
  };
  /// A body that may be above the threshold, and what is remembered of it.
  struct Strained {
    int body;
    Memory* memory;
  };

  /// Writes strained_, and Body::strain of all.
  void FindStrained(double time_step, std::span<Body> bodies, std::span<const char> jointed);
  void TakeRaised(const simd::RaisedInertia& lanes, std::size_t lane, const Strained& strained,
                  std::span<Body> bodies);
  void FindAnchored(const ContactProblem& problem, const Report& report);
  /// @param arm  from its centre of mass; @param force  [N]
  void Add(int body, const Vector3& arm, const Vector3& force);
  void FindJointed(const ContactProblem& problem);
  void FindPulled(double time_step, const ContactProblem& problem, const Impulses& impulses);
  bool IsPulled(int body) const {
    return body != kWorld && pull_[static_cast<std::size_t>(body)] > 0;
  }
  bool IsAnchored(int body) const {
    return body != kWorld && anchored_[static_cast<std::size_t>(body)] != 0;
  }
  void AddJoints(double time_step, const ContactProblem& problem, const Impulses& impulses);
  /// The same for three rows of a joint; see AreWorldAxes().
  void AddAlongWorldAxes(double time_step, const Joint& joint, const JointRow* rows,
                         const float* impulse);
  void AddRows(double time_step, const ContactProblem& problem, const Impulses& impulses);
  void Remember(double time_step, std::span<const Body> bodies);

  /// Of a body and its place. Bodies mostly keep their places.
  Memory* Find(const Body& body, int place);
  Memory* FindMoved(std::uint64_t key);
  Memory* FindAbsent(std::uint64_t key);
  void NotePlaces(std::span<const Body> bodies);
  /// Remembers bodies again that were absent.
  void Recall(std::span<const Body> bodies, std::span<const char> jointed);
  void KeepAbsent();

  Array<Memory> memories_;
  Array<Memory> absent_;         ///< of bodies that were not in the last problem, by key
  Array<std::uint64_t> key_at_;  ///< by place: key of the body there, or kNobody
  Array<int> memory_at_;         ///< by place: in memories_, -1 for none
  Array<int> by_key_;            ///< memories_ by key, ascending; empty until asked for
  Array<Memory*> known_;         ///< by body: what is remembered of it, while that is learnt
  Array<Memory> fresh_;          ///< those that are new
  Array<Strained> strained_;
  Array<Raised> raised_;
  Array<char> stepped_;           ///< by body: a subspace step was kept on its island
  Array<char> anchored_islands_;  ///< by island: something of it touches what does not move
  Array<char> anchored_;          ///< by body: its island is
  Array<char> jointed_;           ///< by body: there is a joint of it
  Array<double> pull_;            ///< by body: whether joints may pull too hard
  Array<int> pulled_;             ///< bodies with an entry in sums_
  Array<int> place_;              ///< by body: in pulled_, -1 for none
  Array<Sums> sums_;              ///< of pulled_
};

}  // namespace cairn
