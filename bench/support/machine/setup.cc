// SPDX-License-Identifier: MIT
#include "support/machine/setup.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sched.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string_view>
#include <vector>

#include "support/command_line.h"
#include "support/failure.h"
#include "support/json_number.h"

namespace cairn::cli {
namespace {

/// What solvers that are made from now on read.
constexpr const char* kTargetVariable = "CAIRN_SIMD";

std::vector<int> UsableCores() {
  cpu_set_t set;
  CPU_ZERO(&set);
  std::vector<int> cores;
  if (sched_getaffinity(0, sizeof set, &set) != 0) return cores;
  for (int core = 0; core < CPU_SETSIZE; ++core) {
    if (CPU_ISSET(core, &set)) cores.push_back(core);
  }
  return cores;
}

void PinTo(int core) {
  cpu_set_t set;
  CPU_ZERO(&set);
  if (core < CPU_SETSIZE) CPU_SET(core, &set);
  if (sched_setaffinity(0, sizeof set, &set) == 0) return;
  const std::string why = errno == EINVAL ? "there is no such core here" : std::strerror(errno);
  throw Failure(kUsage, fmt::format("--pin {}: {}; this process may use the cores {}", core, why,
                                    fmt::join(UsableCores(), ", ")));
}

std::vector<std::string_view> NamesOf(const std::vector<simd::Target>& targets) {
  std::vector<std::string_view> names;
  for (const simd::Target target : targets) names.push_back(simd::TargetName(target));
  return names;
}

void ForceTarget(const std::string& name) {
  using Reason = simd::TargetChoice::Reason;
  const std::vector<simd::Target> supported = simd::SupportedTargets();
  const simd::TargetChoice choice = simd::ChooseTarget(name, supported);
  if (!choice.honoured()) {
    throw Failure(kUsage, fmt::format("--simd '{}' {}; this machine has {}", name,
                                      choice.reason == Reason::kUnknown ? "is no target"
                                                                        : "does not run here",
                                      fmt::join(NamesOf(supported), ", ")));
  }
  setenv(kTargetVariable, name.c_str(), 1);
}

}  // namespace

Setup ParseSetup(const std::string& threads, const std::string& simd, const std::string& core) {
  Setup setup{.threads = ParseInt("--threads", threads, 1, 1024, "threads that Cairn may use"),
              .simd = simd,
              .pinned = {}};
  if (core.empty()) return setup;
  setup.pinned = ParseInt("--pin", core, 0, 65535, "a core, counted from 0");
  if (setup.threads > 1) {
    throw Failure(kUsage, fmt::format("--pin {} with --threads {}: all threads would share that "
                                      "core; leave one of the two out",
                                      core, threads));
  }
  return setup;
}

void Apply(const Setup& setup) {
  setup.simd.empty() ? WarnOfTarget() : ForceTarget(setup.simd);
  if (setup.pinned) PinTo(*setup.pinned);
}

std::string WhyNotTarget() {
  const simd::TargetChoice choice = simd::ChooseTarget();
  if (choice.honoured()) return "";
  const bool unknown = choice.reason == simd::TargetChoice::Reason::kUnknown;
  return fmt::format("CAIRN_SIMD='{}' {} has: {}", choice.asked,
                     unknown ? "is no target, this CPU" : "does not run on this CPU, which",
                     fmt::join(NamesOf(simd::SupportedTargets()), " "));
}

void WarnOfTarget(std::string_view program) {
  const std::string why = WhyNotTarget();
  if (why.empty()) return;
  fmt::print(stderr, "{}: {}; Cairn takes {}\n", program, why,
             simd::TargetName(simd::ChosenTarget()));
}

ForcedTarget::ForcedTarget(simd::Target target) {
  if (const char* const before = std::getenv(kTargetVariable)) before_ = before;
  setenv(kTargetVariable, std::string(simd::TargetName(target)).c_str(), 1);
}

ForcedTarget::~ForcedTarget() {
  before_ ? setenv(kTargetVariable, before_->c_str(), 1) : unsetenv(kTargetVariable);
}

std::string Describe(const Setup& setup) {
  return fmt::format("{} thread{} for Cairn, {}", setup.threads, setup.threads == 1 ? "" : "s",
                     setup.pinned ? fmt::format("pinned to core {}", *setup.pinned)
                                  : std::string("not pinned to a core"));
}

nlohmann::ordered_json ToJson(const Setup& setup) {
  return {{"threads", setup.threads},
          {"simd_asked_for", setup.simd.empty() ? nlohmann::ordered_json(nullptr)
                                                : nlohmann::ordered_json(setup.simd)},
          {"pinned_to_core", Maybe(setup.pinned)}};
}

}  // namespace cairn::cli
