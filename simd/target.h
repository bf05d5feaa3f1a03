// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace cairn::simd {

/// An instruction set that kernels are compiled for, worst to best. No CPU has both NEON and those
/// before it.
enum class Target { kScalar, kSse4, kAvx2, kAvx512, kNeon };

/// "scalar", "sse4", "avx2", "avx512" or "neon".
std::string_view TargetName(Target target);

/// The target of that name, if there is one.
std::optional<Target> FindTarget(std::string_view name);

/// What this CPU runs, worst to best. Never empty: scalar code runs everywhere.
std::vector<Target> SupportedTargets();

/// The last of SupportedTargets().
Target BestTarget();

/// The target that kernels use, and why.
struct TargetChoice {
  enum class Reason {
    kBest,         ///< Nothing was asked for: the best one.
    kAsked,        ///< The one asked for.
    kUnknown,      ///< What was asked for is no target: the best one instead.
    kUnsupported,  ///< What was asked for does not run on this CPU: the best one instead.
  };
  Target target = Target::kScalar;
  Reason reason = Reason::kBest;
  std::string asked;  ///< The name that was asked for, empty if none.

  /// Whether the user gets what the user wanted.
  bool honoured() const { return reason == Reason::kBest || reason == Reason::kAsked; }
};

/// Chooses among `supported` (worst to best, @pre not empty) by name; an empty name asks for
/// nothing.
TargetChoice ChooseTarget(std::string_view asked, const std::vector<Target>& supported);

/// The same for this CPU and the environment variable CAIRN_SIMD.
TargetChoice ChooseTarget();
/// Its target alone, without taking memory.
Target ChosenTarget();

}  // namespace cairn::simd
