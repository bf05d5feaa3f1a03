// SPDX-License-Identifier: MIT
#include "rigid/contact_model.h"

#include <algorithm>
#include <utility>

#include "rigid/contact_matrix.h"

namespace cairn::bench {
namespace {

bool IsEquation(const Row& row) {
  return row.parent == kNoRow && row.lo == -kInfinity && row.hi == kInfinity;
}

/// A friction row with bounds of its own.
Row Freed(const ContactFrame& frame, Row row, ContactModel model) {
  if (model == ContactModel::kPyramid) {
    const double most = row.friction * std::max(0.0, frame.impulses[row.parent]);
    row.lo = std::max(row.lo, -most);
    row.hi = std::min(row.hi, most);
  } else {
    row.lo = -kInfinity;
    row.hi = kInfinity;
  }
  row.parent = kNoRow;
  return row;
}

}  // namespace

ContactFrame ApplyModel(const ContactFrame& frame, ContactModel model) {
  ContactFrame equations{.bodies = frame.bodies, .rows = {}, .impulses = {}}, rest;
  for (size_t i = 0; i < frame.rows.size(); ++i) {
    Row row = frame.rows[i];
    if (row.parent != kNoRow) {
      if (model == ContactModel::kNormals) continue;
      row = Freed(frame, row, model);
    }
    ContactFrame& place = IsEquation(row) ? equations : rest;
    place.rows.push_back(row);
    place.impulses.push_back(frame.impulses[i]);
  }
  equations.rows.insert(equations.rows.end(), rest.rows.begin(), rest.rows.end());
  equations.impulses.insert(equations.impulses.end(), rest.impulses.begin(), rest.impulses.end());
  return equations;
}

ContactFrame WithCompliance(const ContactFrame& frame, double share) {
  ContactFrame result = frame;
  const Eigen::VectorXd diagonal = ContactDiagonal(frame.problem());
  for (size_t i = 0; i < result.rows.size(); ++i) {
    result.rows[i].compliance = share * diagonal[static_cast<Eigen::Index>(i)];
  }
  return result;
}

int Equations(const ContactFrame& frame) {
  return static_cast<int>(std::count_if(frame.rows.begin(), frame.rows.end(), IsEquation));
}

}  // namespace cairn::bench
