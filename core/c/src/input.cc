// SPDX-License-Identifier: MIT
#include "input.h"

#include <cmath>

#include "same_layout.h"

namespace cairn::c {
namespace {

/// A name of C++ as C has it: maxPush of max_push.
std::string NameOfC(const char* name) {
  std::string of_c;
  for (bool upper = false; *name != '\0'; ++name) {
    if (*name != '_') of_c += upper ? static_cast<char>(*name - 'a' + 'A') : *name;
    upper = *name == '_';
  }
  return of_c;
}

}  // namespace

Refusal RefusalOf(const detail::BadValue& bad, CairnStatus status) {
  if (!bad) return {};
  return {bad.names_body ? cairnNoSuchBody : status, bad};
}

std::string Describe(const Refusal& refusal) {
  if (refusal.status == cairnOk) return "";
  if (!refusal.bad) return cairnDescribe(refusal.status);
  detail::BadValue of_c = refusal.bad;
  const std::string field = NameOfC(of_c.field);
  of_c.field = field.c_str();
  return detail::Describe(of_c);
}

Refusal FindBadSettings(const CairnFrameSettings& settings) {
  detail::BadValue bad = detail::FindBadErp(settings.jointErp, "joint_erp");
  if (!bad) bad = detail::FindBad(Same<ContactOptions>(settings.contacts), "contacts");
  return RefusalOf(bad, cairnBadSettings);
}

Refusal FindBadStep(const CairnStep& step) {
  if (!(step.timeStep > 0 && std::isfinite(step.timeStep))) {
    return {cairnBadInput, {"step", -1, "timeStep", step.timeStep, "finite, above 0"}};
  }
  if (step.substeps < 1 || step.substeps > 64) {
    const auto substeps = static_cast<double>(step.substeps);
    return {cairnBadInput, {"step", -1, "substeps", substeps, "1 to 64"}};
  }
  return {};
}

}  // namespace cairn::c
