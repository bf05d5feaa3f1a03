// SPDX-License-Identifier: MIT
#include "pack/manifold_pack.h"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <utility>

#include "cairn/detail/prefetch.h"
#include "pack/numbers_of.h"

namespace cairn {
namespace {

using simd::WholeQuads;

// a point and an impulse are rows of floats, in the order that kernels read
static_assert(sizeof(ContactPoint) == simd::kPointNumbers * sizeof(float));
static_assert(offsetof(ContactPoint, arm_b) == simd::kArmB * sizeof(float));
static_assert(offsetof(ContactPoint, normal) == simd::kNormal * sizeof(float));
static_assert(offsetof(ContactPoint, tangent) == simd::kTangent * sizeof(float));
static_assert(offsetof(ContactPoint, bias) == simd::kBias * sizeof(float));
static_assert(offsetof(ContactPoint, restitution) == simd::kRestitution * sizeof(float));
static_assert(offsetof(ContactPoint, friction) == simd::kFriction * sizeof(float));
static_assert(offsetof(ContactPoint, compliance) == simd::kCompliance * sizeof(float));
static_assert(sizeof(ContactImpulse) == simd::kStartStride * sizeof(float));
static_assert(offsetof(ContactImpulse, heading) == 3 * sizeof(float));
static_assert(Manifold::kMostPoints == simd::kMostPoints);
static_assert(sizeof(ContactTwist) == simd::kTwistNumbers * sizeof(float));
static_assert(offsetof(ContactTwist, rolling) == sizeof(float));
static_assert(offsetof(ContactTwist, most_spinning) == simd::kMostSpinning * sizeof(float));
static_assert(sizeof(TwistImpulse) == simd::kTwistRows * sizeof(float));
static_assert(Manifold::kTwistRows == simd::kTwistRows);

// a point with friction has two rows or more
static_assert(simd::kDirectionLines <= 2 * 2);

const Manifold& ManifoldOf(const BlockPacker& packer, int block, int lane) {
  return packer.problem.manifolds[packer.plan.pair(block, lane).index];
}

void PrefetchImpulses(std::span<const ContactImpulse> impulses, const Manifold& manifold) {
  Prefetch(&impulses[manifold.first_point], manifold.points * sizeof(ContactImpulse));
}

/// Calls function(manifold) for those of a block, if there is such a block.
template <class Function>
void ForManifolds(const BlockPacker& packer, int block, const Function& function) {
  if (block >= static_cast<int>(packer.plan.blocks().size())) return;
  if (packer.plan.pair(block, 0).source != RowSource::kManifold) return;
  for (int lane = 0; lane < packer.plan.blocks()[block].lanes; ++lane) {
    function(ManifoldOf(packer, block, lane));
  }
}

}  // namespace

simd::ContactBody ContactBodyOf(const Body& body, const WhitenedBody& whitened,
                                const ContactMotion* motion) {
  simd::ContactBody result;
  const auto put = [](const auto& from, float* to) {
    for (int k = 0; k < static_cast<int>(from.size()); ++k) {
      to[k] = static_cast<float>(from.data()[k]);
    }
  };
  put(whitened.linear, result.linear);
  put(whitened.angular, result.angular);
  if (motion != nullptr) {
    static_assert(sizeof(*motion) == sizeof(result.free) + sizeof(result.start));
    std::memcpy(result.free, motion, sizeof(*motion));
    return result;
  }
  put(View(whitened.free.linear), result.free);
  put(View(whitened.free.angular), result.free + 3);
  put(View(body.velocity.linear), result.start);
  put(View(body.velocity.angular), result.start + 3);
  return result;
}

PackResult PackManifolds(const BlockPacker& packer, int index, const Impulses& start,
                         BlockData* blocks) {
  ForManifolds(packer, index + 1, [&](const Manifold& next) {
    Prefetch(&packer.problem.points[next.first_point], next.points * sizeof(ContactPoint));
    PrefetchImpulses(start.points, next);
  });
  const simd::PairBlock& block = packer.plan.blocks()[index];
  const Manifold& first = ManifoldOf(packer, index, 0);
  const ContactLaw& law = packer.problem.contact_law;
  simd::ContactLanes lanes{.form = block.form,
                           .points = first.points,
                           .tangents = first.tangents,
                           .soft = first.soft,
                           .twists = first.twists,
                           .bounce_speed = law.bounce_speed,
                           .spin_before_torques = law.host.spin_before_torques,
                           .bounded_apart = law.host.bounded_apart,
                           .lanes = WholeQuads(block.lanes)};
  SeenBodies bodies(packer, index);
  for (int lane = 0; lane < lanes.lanes; ++lane) {
    // unused lanes do what the first one does
    const int used = lane < block.lanes ? lane : 0;
    const Pair& pair = packer.plan.pair(index, used);
    const Manifold& manifold = packer.problem.manifolds[pair.index];
    lanes.a[lane] = bodies.Of(used, pair, manifold.body_a);
    lanes.b[lane] = bodies.Of(used, pair, manifold.body_b);
    lanes.second_moves[lane] = pair.a != manifold.body_a;
    lanes.point[lane] = NumbersOf(packer.problem.points[manifold.first_point]);
    lanes.start[lane] = NumbersOf(std::as_const(start.points[manifold.first_point]));
    if (!first.twists) continue;
    lanes.twist[lane] = NumbersOf(packer.problem.twists[manifold.first_point]);
    lanes.twist_start[lane] = NumbersOf(std::as_const(start.twists[manifold.first_point]));
  }
  const bool fits =
      packer.contacts.pack(lanes, blocks->data.data() + block.data, blocks->x.data() + block.x,
                           blocks->directions.data() + DirectionsOf(block));
  return fits ? PackResult::kDone : PackResult::kOutOfRange;
}

void WriteManifolds(const BlockPacker& packer, int index, const BlockData& blocks,
                    const Impulses& impulses) {
  ForManifolds(packer, index + 1,
               [&](const Manifold& next) { PrefetchImpulses(impulses.points, next); });
  const simd::PairBlock& block = packer.plan.blocks()[index];
  const Manifold& first = ManifoldOf(packer, index, 0);
  simd::ContactResults results{.points = first.points,
                               .tangents = first.tangents,
                               .lanes = block.lanes,
                               .x = blocks.x.data() + block.x,
                               .directions = blocks.directions.data() + DirectionsOf(block)};
  for (int lane = 0; lane < block.lanes; ++lane) {
    const Manifold& manifold = ManifoldOf(packer, index, lane);
    results.to[lane] = NumbersOf(impulses.points[manifold.first_point]);
  }
  packer.contacts.unpack(results);

  const simd::Line* const twists = results.x + first.points * (1 + first.tangents);
  for (int lane = 0; lane < block.lanes && first.twists; ++lane) {
    const Manifold& manifold = ManifoldOf(packer, index, lane);
    const simd::Line* twist = twists;
    for (int p = 0; p < manifold.points; ++p, twist += simd::kTwistRows) {
      const ContactTwist& limits = packer.problem.twists[manifold.first_point + p];
      const auto x = [&](int k, float most) {
        return std::clamp(twist[k].lane[lane], -most, most);
      };
      impulses.twists[manifold.first_point + p] = {
          .spinning = x(0, limits.most_spinning),
          .rolling = {x(1, limits.most_rolling), x(2, limits.most_rolling)}};
    }
  }
}

}  // namespace cairn
