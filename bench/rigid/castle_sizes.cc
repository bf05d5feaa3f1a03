// SPDX-License-Identifier: MIT
#include "rigid/castle_sizes.h"

#include "rigid/contact_matrix.h"
#include "rigid/nearest_rows.h"

namespace cairn::bench {

std::span<const CastleSize> CastleSizes() {
  static constexpr CastleSize kSizes[] = {
      {7, 18, 58},        {8, 45, 2.9e3},      {8, 48, 2.4e3},     {235, 1044, 4.6e4},
      {449, 1821, 4.2e4}, {907, 5832, 5.1e7},  {948, 7344, 6.1e7}, {966, 8220, 7.2e7},
      {976, 8745, 8.6e7}, {977, 9534, 1.03e8},
  };
  return kSizes;
}

SizedCastle MakeSizedCastle(const ContactFrame& frame, const CastleSize& size, ContactModel model) {
  const ContactFrame rows =
      NearestRows(frame, {.contacts = size.inequalities, .frictions = size.equations});
  const ContactFrame bilateral = WithCompliance(ApplyModel(rows, ContactModel::kBilateral), 0);
  SizedCastle castle;
  castle.compliance = FindCompliance(ToBoxed(bilateral.problem()).M, size.condition);
  castle.frame = WithCompliance(ApplyModel(rows, model), castle.compliance.share);
  return castle;
}

}  // namespace cairn::bench
