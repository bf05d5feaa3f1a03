// SPDX-License-Identifier: MIT
#include "worlds/variants.h"

#include <cairn/bullet/constraint_solver.h>

namespace cairn::bench {
namespace {

constexpr std::int64_t kWork = 40'000;

Variant Cairn(std::string name, std::string description, void (*set)(Settings*)) {
  return {std::move(name), std::move(description), [set]() -> std::unique_ptr<btConstraintSolver> {
            auto solver = std::make_unique<bullet::ConstraintSolver>();
            set(&solver->settings());
            return solver;
          }};
}

Variant Bullet(std::string name, std::string description, int iterations) {
  return {std::move(name), std::move(description),
          []() -> std::unique_ptr<btConstraintSolver> {
            return std::make_unique<btSequentialImpulseConstraintSolver>();
          },
          iterations};
}

}  // namespace

std::span<const Variant> CairnVariants() {
  static const Variant variants[] = {
      Cairn("cairn", "Cairn as it comes", [](Settings*) {}),
      Cairn("cairn-sweeps", "k_sm = 0: sweeps only", [](Settings* s) { s->k_sm = 0; }),
      Cairn("cairn-work", "Budget::Work(40000)",
            [](Settings* s) { s->budget = Budget::Work(kWork); }),
      Cairn("cairn-always", "StepPolicy::kAlways",
            [](Settings* s) { s->step_policy = StepPolicy::kAlways; }),
      Cairn("cairn-parts", "four substeps", [](Settings* s) { s->substeps = 4; })};
  return variants;
}

std::span<const Variant> BulletVariants() {
  static const Variant variants[] = {Bullet("bullet", "Bullet with the iterations of the world", 0),
                                     Bullet("bullet-10", "Bullet with 10 iterations", 10),
                                     Bullet("bullet-100", "Bullet with 100 iterations", 100)};
  return variants;
}

const Variant& ConvergedBullet() {
  static const Variant variant = Bullet("bullet-10000", "Bullet with 10,000 iterations", 10'000);
  return variant;
}

}  // namespace cairn::bench
