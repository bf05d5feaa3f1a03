// SPDX-License-Identifier: MIT
#include "simd/target.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>

#include <hwy/targets.h>

namespace cairn::simd {
namespace {

struct Entry {
  Target target;
  std::string_view name;
  std::int64_t highway;  // bit in hwy::SupportedTargets()
};

// In the order of Target. Highway counts AVX-512 as AVX3, and knows a scalar bit that we do not ask
// for, because scalar code needs no support.
constexpr std::array<Entry, 5> kEntries = {{
    {Target::kScalar, "scalar", 0},
    {Target::kSse4, "sse4", HWY_SSE4},
    {Target::kAvx2, "avx2", HWY_AVX2},
    {Target::kAvx512, "avx512", HWY_AVX3},
    {Target::kNeon, "neon", HWY_NEON},
}};

}  // namespace

std::string_view TargetName(Target target) { return kEntries[static_cast<int>(target)].name; }

std::optional<Target> FindTarget(std::string_view name) {
  for (const Entry& entry : kEntries) {
    if (entry.name == name) return entry.target;
  }
  return std::nullopt;
}

namespace {

bool Runs(const Entry& entry) {
  // HWY_TARGETS are the targets this compiler builds, SupportedTargets() those this CPU runs, and
  // what all code is compiled for runs in any case: Highway counts NEON without AES as none.
  // Asking the CPU takes microseconds, and tens of them in a virtual machine.
  static const std::int64_t usable =
      (hwy::SupportedTargets() | static_cast<std::int64_t>(HWY_STATIC_TARGET)) & HWY_TARGETS;
  return entry.target == Target::kScalar || (usable & entry.highway) != 0;
}

std::string_view Asked() {
  const char* const asked = std::getenv("CAIRN_SIMD");
  return asked ? asked : "";
}

}  // namespace

std::vector<Target> SupportedTargets() {
  std::vector<Target> targets;
  for (const Entry& entry : kEntries) {
    if (Runs(entry)) targets.push_back(entry.target);
  }
  return targets;
}

Target BestTarget() { return std::find_if(kEntries.rbegin(), kEntries.rend(), Runs)->target; }

TargetChoice ChooseTarget(std::string_view asked, const std::vector<Target>& supported) {
  using Reason = TargetChoice::Reason;
  const Target best = supported.back();
  if (asked.empty()) return {best, Reason::kBest, {}};

  const std::optional<Target> found = FindTarget(asked);
  if (!found) return {best, Reason::kUnknown, std::string(asked)};
  const bool runs = std::find(supported.begin(), supported.end(), *found) != supported.end();
  if (!runs) return {best, Reason::kUnsupported, std::string(asked)};
  return {*found, Reason::kAsked, std::string(asked)};
}

TargetChoice ChooseTarget() { return ChooseTarget(Asked(), SupportedTargets()); }

Target ChosenTarget() {
  const std::optional<Target> found = FindTarget(Asked());
  return found && Runs(kEntries[static_cast<int>(*found)]) ? *found : BestTarget();
}

}  // namespace cairn::simd
