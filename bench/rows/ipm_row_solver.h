// SPDX-License-Identifier: MIT
#pragma once

#include "cairn/mixed_lcp.h"
#include "rows/row_solver.h"

namespace cairn::cli {

/// Cairn's interior point method on the matrix of a frame. Its bounds stay where they are: frames
/// with friction are refused.
class IpmRowSolver : public RowSolver {
 public:
  explicit IpmRowSolver(const LcpOptions& options) : options_(options) {}

  std::string Prepare(const RowProblem& problem) override;
  void IterateUntil(const RowLimit& limit) override;
  RowOutcome Result() override;

 private:
  LcpOptions options_;
  const RowProblem* problem_ = nullptr;
  BoxedLcp boxed_;
  Eigen::VectorXd start_;
  LcpOutcome outcome_;
};

}  // namespace cairn::cli
