// SPDX-License-Identifier: MIT
#include "pack/block_frame.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>

#include "pack/manifold_pack.h"
#include "problem/locked_axes.h"
#include "problem/validate.h"
#include "runtime/in_parts.h"

namespace cairn {
namespace {

/// Bodies that one thread whitens, or writes back, at a time.
constexpr int kBodiesOfUnit = 256;
/// Velocities that one thread looks at, or brings to rest, at a time.
constexpr int kSlotsOfUnit = 1024;
/// Rows whose kinds one thread reads at a time.
constexpr int kRowsOfUnit = 1024;

constexpr int kNumbersOfBody = sizeof(simd::BodyLane) / sizeof(float);
constexpr int kNumbersOfMotion = sizeof(ContactMotion) / sizeof(float);

/// Looks at many groups of so many numbers for what is infinite, or none: zero times that is not
/// zero. One sum for each place, so that all of a group are added at once.
template <int kCount>
class Finiteness {
 public:
  void See(const float* numbers) {
    for (int i = 0; i < kCount; ++i) zeros_[i] += 0 * numbers[i];
  }
  bool all() const {
    return std::all_of(zeros_, zeros_ + kCount, [](float zero) { return zero == 0; });
  }

 private:
  float zeros_[kCount] = {};
};

/// Whether something holds for all indices below a number.
template <class Function>
bool HoldsForAll(size_t count, Crew* crew, const Function& holds) {
  std::atomic<bool> all{true};
  InParts(static_cast<int>(count), kRowsOfUnit, crew, [&](int first, int of_part) {
    for (int i = first; i < first + of_part; ++i) {
      if (!holds(i)) return all.store(false, std::memory_order_relaxed);
    }
  });
  return all;
}

bool AreValid(const ContactProblem& problem, Crew* crew) {
  return HoldsForAll(problem.joints.size(), crew,
                     [&](size_t i) {
                       return ValidateJoint(problem, static_cast<int>(i)) == Status::kOk;
                     }) &&
         HoldsForAll(problem.manifolds.size(), crew, [&](size_t i) {
           return ValidateManifold(problem, static_cast<int>(i)) == Status::kOk;
         });
}

/// The whole plan, stage by stage, with one kernel.
class Pass final : public StagedWork {
 public:
  Pass(BlockFrame* frame, simd::PairKernels::Kernel kernel) : frame_(frame), kernel_(kernel) {}
  int stages() const override { return static_cast<int>(frame_->plan().phases().size()); }
  int units(int stage) const override { return frame_->plan().phases()[stage].units; }
  void Do(int stage, int unit) override {
    const Plan& plan = frame_->plan();
    const Unit& of = plan.units()[plan.phases()[stage].first_unit + unit];
    kernel_(frame_->WorkOn(plan.groups()[of.group], of.first_block, of.blocks));
  }

 private:
  BlockFrame* frame_;
  simd::PairKernels::Kernel kernel_;
};

/// The worst of what several threads found.
class WorstResult {
 public:
  void Add(PackResult result) {
    int worst = worst_.load(std::memory_order_relaxed);
    const int now = static_cast<int>(result);
    while (now > worst && !worst_.compare_exchange_weak(worst, now)) continue;
  }
  PackResult get() const { return static_cast<PackResult>(worst_.load(std::memory_order_relaxed)); }

 private:
  std::atomic<int> worst_{static_cast<int>(PackResult::kDone)};
};

/// Floats hold its velocity and what it does to rows. Smaller masses than that would be none.
bool FitsFloats(const Body& given, const WhitenedBody& body) {
  constexpr double kMostVelocity = 1e18, kMost = 1e15, kLeast = 1e-15;
  const auto fits = [](double of_mass, double least, double most) {
    return (of_mass == 0) | ((of_mass >= least) & (of_mass <= most));
  };
  // one by one, none waits for another; comparisons with what is not a number are false
  bool all = fits(View(given.inv_inertia).trace(), kLeast * kLeast, kMost * kMost);
  for (int k = 0; k < 3; ++k) {
    all &= fits(body.linear[k], kLeast, kMost) & (std::abs(body.free.linear[k]) <= kMostVelocity) &
           (std::abs(body.free.angular[k]) <= kMostVelocity) &
           (std::abs(given.velocity.linear[k]) <= kMostVelocity) &
           (std::abs(given.velocity.angular[k]) <= kMostVelocity);
  }
  return all;
}

template <class T>
void CopyInParts(std::span<const T> from, Crew* crew, Array<T>* to) {
  to->resize(from.size());
  InParts(static_cast<int>(from.size()), kRowsOfUnit, crew, [&](int first, int count) {
    std::copy_n(from.begin() + first, count, to->begin() + first);
  });
}

}  // namespace

simd::PairWork BlockFrame::WorkOn(const Group& group, int first_block, int blocks) {
  // parts of a group are blocks of a large one, each a run
  const bool whole = blocks == group.blocks;
  const int first_run = group.first_run + (whole ? 0 : first_block - group.first_block);
  return {.blocks = plan_.blocks().data(),
          .runs = plan_.runs().data() + first_run,
          .run_count = whole ? group.runs : blocks,
          .first_block = first_block,
          .block_count = blocks,
          .data = blocks_.data.data(),
          .x = blocks_.x.data(),
          .bodies = blocks_.bodies.data(),
          .copies = plan_.copies().data(),
          .first_copy = plan_.first_copy(),
          .d_ratios = blocks_.d_ratios.data(),
          .errors = errors_.data()};
}

BlockPacker BlockFrame::PackerOf(const ContactProblem& problem) const {
  return {.problem = problem,
          .plan = plan_,
          .movable = movable_,
          .bodies = bodies_,
          .contact_bodies = contact_bodies_,
          .locked = locked_,
          .omega = omega_,
          .pack_row = pack_row_,
          .pack_joints = pack_joints_,
          .contacts = *contact_kernels_,
          .couple = kernels_->couple};
}

bool BlockFrame::SameJointsAndManifolds(const ContactProblem& problem, Crew* crew) const {
  // where their rows and points are is not part of the plan
  const auto same = [crew](const auto& now, const auto& planned) {
    return now.size() == planned.size() && HoldsForAll(now.size(), crew, [&](size_t i) {
             return now[i].body_a == planned[i].body_a && now[i].body_b == planned[i].body_b &&
                    IsOfKindOf(now[i], planned[i]);
           });
  };
  return same(problem.joints, planned_joints_) && same(problem.manifolds, planned_manifolds_);
}

PackResult BlockFrame::Begin(const ContactProblem& problem, double omega, const Impulses& impulses,
                             Crew* crew) {
  crew_ = crew;
  const PackResult whitened = WhitenBodies(problem, crew);
  if (whitened != PackResult::kDone) return whitened;
  if (!(problem.contact_law.bounce_speed >= 0)) return PackResult::kInvalid;
  if (!AreValid(problem, crew)) return PackResult::kInvalid;

  // the plan of the last frame, if nothing began or ended
  PackResult result = PackResult::kStalePlan;
  const bool alike = planned_ && omega == omega_ && problem.rows.size() == planned_rows_ &&
                     movable_now_ == movable_ && SameJointsAndManifolds(problem, crew);
  if (alike) result = Pack(problem, impulses, crew);
  if (result == PackResult::kStalePlan) {
    planned_ = MakePlan(problem, omega, impulses.rows, crew);
    if (!planned_) return PackResult::kInvalid;
    PackerOf(problem).Reserve(&blocks_);
    if (errors_.size() < plan_.blocks().size()) errors_.resize(plan_.blocks().size());
    result = Pack(problem, impulses, crew);
  }
  if (result == PackResult::kDone) Start(crew);
  return result;
}

bool BlockFrame::MakePlan(const ContactProblem& problem, double omega,
                          std::span<const double> impulses, Crew* crew) {
  movable_.swap(movable_now_);
  omega_ = omega;
  planned_rows_ = problem.rows.size();
  CopyInParts(problem.joints, crew, &planned_joints_);
  CopyInParts(problem.manifolds, crew, &planned_manifolds_);
  ++plan_number_;
  row_kinds_.resize(planned_rows_);
  std::atomic<bool> valid{true};
  InParts(static_cast<int>(planned_rows_), kRowsOfUnit, crew, [&](int first, int count) {
    for (int i = first; i < first + count; ++i) {
      if (ReadKind(problem, i, impulses[i], omega, &row_kinds_[i])) continue;
      valid.store(false, std::memory_order_relaxed);
    }
  });
  return valid && plan_.Make(problem, row_kinds_, movable_, crew);
}

PackResult BlockFrame::WhitenBodies(const ContactProblem& problem, Crew* crew) {
  const std::span<const Body> bodies = problem.bodies;
  const bool contacts = !problem.manifolds.empty() || !problem.joints.empty();
  if (contacts) contact_bodies_.resize(bodies.size());
  bodies_.resize(bodies.size());
  movable_now_.resize(bodies.size());
  WorstResult worst;
  std::atomic<bool> strained{false}, locked{false};
  InParts(static_cast<int>(bodies.size()), kBodiesOfUnit, crew, [&](int first, int count) {
    Finiteness<kNumbersOfMotion> motions;
    for (int i = first; i < first + count; ++i) {
      movable_now_[i] = MobilityOf(bodies[i]);
      if (bodies[i].strain > 0) strained.store(true, std::memory_order_relaxed);
      if (HasLockedAxes(bodies[i])) locked.store(true, std::memory_order_relaxed);
      if (!Whiten(bodies[i], &bodies_[i])) worst.Add(PackResult::kInvalid);
      if (!FitsFloats(bodies[i], bodies_[i])) worst.Add(PackResult::kOutOfRange);
      const ContactMotion* const motion = problem.motions.empty() ? nullptr : &problem.motions[i];
      if (motion != nullptr) motions.See(reinterpret_cast<const float*>(motion));
      if (contacts) contact_bodies_[i] = ContactBodyOf(bodies[i], bodies_[i], motion);
    }
    if (!motions.all()) worst.Add(PackResult::kOutOfRange);
  });
  strained_ = strained;
  locked_ = locked;
  return worst.get();
}

PackResult BlockFrame::Pack(const ContactProblem& problem, const Impulses& impulses, Crew* crew) {
  const BlockPacker packer = PackerOf(problem);
  WorstResult worst;
  const auto pack = [&](int unit) {
    const Unit& of = plan_.units()[unit];
    if (worst.get() != PackResult::kDone) return;
    worst.Add(packer.Pack(of.first_block, of.blocks, impulses, &blocks_));
  };
  ForUnits(static_cast<int>(plan_.units().size()), crew, pack);
  return worst.get();
}

void BlockFrame::Start(Crew* crew) {
  InParts(static_cast<int>(plan_.slots()), kSlotsOfUnit, crew, [&](int first, int count) {
    std::memset(static_cast<void*>(blocks_.bodies.data() + first), 0,
                count * sizeof(simd::BodyLane));
  });
  Pass pass(this, kernels_->start);
  crew->Run(&pass);
}

bool BlockFrame::IsFinite() const {
  // an impulse that is not finite has pushed a body
  std::atomic<bool> all{true};
  InParts(static_cast<int>(plan_.body_of_slot().size()), kSlotsOfUnit, crew_,
          [&](int first, int count) {
            Finiteness<kNumbersOfBody> velocities;
            for (int slot = first; slot < first + count; ++slot) {
              velocities.See(blocks_.bodies[slot].u);
            }
            if (!velocities.all()) all.store(false, std::memory_order_relaxed);
          },
          {SpanKind::kResults, 0, -1});
  return all;
}

void BlockFrame::End(const ContactProblem& problem, Crew* crew, const Impulses& impulses,
                     std::span<Velocity> velocities) const {
  const BlockPacker packer = PackerOf(problem);
  const auto write = [&](int unit) {
    const Unit& of = plan_.units()[unit];
    packer.WriteImpulses(of.first_block, of.blocks, blocks_, impulses);
  };
  ForUnits(static_cast<int>(plan_.units().size()), crew, write, {SpanKind::kResults});
  const auto write_velocities = [&](int first, int count) {
    packer.WriteVelocities(first, count, blocks_, velocities);
  };
  InParts(static_cast<int>(problem.bodies.size()), kBodiesOfUnit, crew, write_velocities,
          {SpanKind::kResults});
}

}  // namespace cairn
