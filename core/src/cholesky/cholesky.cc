// SPDX-License-Identifier: MIT
#include "cholesky/cholesky.h"

#include "cholesky/front_cholesky.h"
#include "simd/target.h"

namespace cairn {

struct BlockCholesky::Impl : detail::Placed {
  FrontCholesky<double> factor{simd::ChosenTarget()};
};

BlockCholesky::BlockCholesky() : impl_(std::make_unique<Impl>()) {}
BlockCholesky::~BlockCholesky() = default;
BlockCholesky::BlockCholesky(BlockCholesky&&) noexcept = default;
BlockCholesky& BlockCholesky::operator=(BlockCholesky&&) noexcept = default;

void BlockCholesky::Analyse(int bodies, std::span<const BodyPair> pairs) {
  impl_->factor.Analyse(bodies, 6, pairs, {}, FrontCholesky<double>::Workers::kOne);
}

double BlockCholesky::factor_flops() const { return impl_->factor.pattern().flops(); }
double BlockCholesky::factor_nonzeros() const { return impl_->factor.pattern().nonzeros(); }

BlockCholesky::Block BlockCholesky::diagonal(int body) {
  return Block(impl_->factor.diagonal(body));
}
BlockCholesky::Block BlockCholesky::upper(int pair) { return Block(impl_->factor.upper(pair)); }
void BlockCholesky::SetZero() { impl_->factor.SetZero(); }

bool BlockCholesky::Factorise() { return impl_->factor.Factorise(); }

void BlockCholesky::Solve(std::span<Vector6d> rhs) const {
  // vectors of six numbers lie next to each other without gaps
  static_assert(sizeof(Vector6d) == 6 * sizeof(double));
  if (!rhs.empty()) impl_->factor.Solve(std::span(rhs.front().data(), 6 * rhs.size()));
}

}  // namespace cairn
