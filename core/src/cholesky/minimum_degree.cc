// SPDX-License-Identifier: MIT
#include "cholesky/minimum_degree.h"

#include <Eigen/OrderingMethods>

namespace cairn {

std::vector<int> MinimumDegreeOrder(const Eigen::SparseMatrix<double>& matrix) {
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order;
  Eigen::AMDOrdering<int>()(matrix, order);
  return {order.indices().begin(), order.indices().end()};
}

}  // namespace cairn
