// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <unordered_map>

namespace cairn::frames {

/// By address of an instruction: how often it ran.
using StepCounts = std::unordered_map<std::uint64_t, std::uint64_t>;

/// What is between them counts.
struct Marks {
  void Begin() const;
  void End() const;
};

/// Runs a program in a process of its own, a copy of this one, and steps what is between its marks
/// one instruction at a time: some 100,000 a second. Linux on x86-64 alone.
/// @throws std::runtime_error  where that cannot be, or the program does not end well
StepCounts CountSteps(const std::function<void(const Marks&)>& program);

}  // namespace cairn::frames
