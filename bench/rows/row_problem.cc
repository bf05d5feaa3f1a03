// SPDX-License-Identifier: MIT
#include "rows/row_problem.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <limits>
#include <span>

#include "support/failure.h"

namespace cairn::cli {
namespace {

constexpr int kNoLimit = std::numeric_limits<int>::max();

/// Of all rows, the fewest sweeps that one is limited to, which is lifted.
int LiftLimits(Recording* recording) {
  int least = kNoLimit;
  const auto lift = [&least](int* limit) {
    least = std::min(least, *limit);
    *limit = kNoLimit;
  };
  for (Row& row : recording->rows) lift(&row.host.max_sweeps);
  for (Joint& joint : recording->joints) lift(&joint.host.max_sweeps);
  for (Manifold& manifold : recording->manifolds) lift(&manifold.host.max_sweeps);
  return least == kNoLimit ? 0 : least;
}

}  // namespace

bool IsRecording(const std::string& path) {
  std::array<char, 8> begin{};
  std::ifstream file(path, std::ios::binary);
  if (!file.read(begin.data(), begin.size())) return false;
  Recording none;
  return Decode(std::as_bytes(std::span(begin)), &none).fault != RecordingFault::kNotARecording;
}

std::shared_ptr<const RowProblem> LoadRowProblem(const std::string& path) {
  auto problem = std::make_shared<RowProblem>();
  if (const RecordingStatus status = Load(path, &problem->frame); !status.ok()) {
    throw Failure(kBadInput, fmt::format("'{}': {}", path, status.message));
  }
  problem->name = std::filesystem::path(path).stem().string();
  problem->source = problem->frame.source;
  problem->limited_sweeps = LiftLimits(&problem->frame);
  problem->first_contact = static_cast<int>(problem->frame.rows.size());
  for (const Joint& joint : problem->frame.joints) problem->first_contact += joint.rows;
  if (const Status status = WriteOutRows(problem->frame, &problem->rows); status != Status::kOk) {
    throw Failure(kBadInput, fmt::format("'{}' holds a frame that no solver takes: {}", path,
                                         Describe(status)));
  }
  if (problem->rows.rows.empty()) {
    throw Failure(kBadInput, fmt::format("'{}': no row and no contact, nothing to solve", path));
  }
  return problem;
}

RowProblem FromZero(const RowProblem& problem) {
  RowProblem copy = problem;
  for (Recording* recording : {&copy.frame, &copy.rows}) {
    std::fill(recording->row_impulses.begin(), recording->row_impulses.end(), 0);
    for (ContactImpulse& impulse : recording->point_impulses) impulse = {};
    for (TwistImpulse& impulse : recording->twist_impulses) impulse = {};
    for (float& impulse : recording->joint_impulses) impulse = 0;
  }
  return copy;
}

}  // namespace cairn::cli
