// SPDX-License-Identifier: MIT
#include "rigid/rigid_list.h"

#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <utility>

#include "rigid/castle.h"
#include "rigid/contact_matrix.h"
#include "rigid/contact_model.h"

namespace cairn::bench {
namespace {

using problems::Generator;
using problems::Parameter;
using problems::Problem;
using problems::Source;

constexpr int kLastFrame = 600;
/// As stiff as the large ones of the ten sizes.
constexpr double kFrameCompliance = 1e-6;

Parameter ModelParameter() {
  return {.name = "model",
          .help =
              "friction: 0 none, 1 never slips (two equations per contact), 2 slips beyond "
              "bounds that Bullet's impulses give",
          .value = 1,
          .min = 0,
          .max = 2};
}

ContactModel ToModel(double value) { return static_cast<ContactModel>(std::lround(value)); }

std::string Name(ContactModel model) {
  switch (model) {
    case ContactModel::kNormals:
      return "normals";
    case ContactModel::kBilateral:
      return "bilateral";
    case ContactModel::kPyramid:
      return "pyramid";
  }
  return {};
}

std::string ToText(double value) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.3g", value);
  return text;
}

std::unique_ptr<Source> Single(std::string name, std::string source, const ContactFrame& frame) {
  Problem problem;
  problem.name = std::move(name);
  problem.source = std::move(source);
  problem.lcp = ToBoxed(frame.problem());
  return std::make_unique<problems::SingleProblem>(std::move(problem));
}

std::unique_ptr<Source> MakeCastle(int number, const std::vector<double>& values) {
  const ContactModel model = ToModel(values[0]);
  const SizedCastle castle =
      MakeSizedCastle(CastleFrame(kImpactFrame), CastleSizes()[number - 1], model);
  return Single("castle-" + std::to_string(number) + "-" + Name(model),
                "castle scene, frame " + std::to_string(kImpactFrame) +
                    ", rows near the ball, E = " + ToText(castle.compliance.share) +
                    " diag(J M^-1 J'), condition " + ToText(castle.compliance.condition) +
                    " if bilateral",
                castle.frame);
}

std::unique_ptr<Source> MakeCastleFrame(int frame, const std::vector<double>& values) {
  const ContactModel model = ToModel(values[0]);
  return Single("castle-frame-" + std::to_string(frame) + "-" + Name(model),
                "castle scene, all contacts, E = " + ToText(values[1]) + " diag(J M^-1 J')",
                WithCompliance(ApplyModel(CastleFrame(frame), model), values[1]));
}

}  // namespace

std::vector<Generator> RigidGenerators() {
  return {
      {.name = "castle",
       .help = "Contacts around the ball that hits the castle, as many and as badly conditioned "
               "as in the ten problems of the talk",
       .size_help = "number of the problem",
       .size = 4,
       .min_size = 1,
       .max_size = static_cast<int>(CastleSizes().size()),
       .parameters = {ModelParameter()},
       .make = MakeCastle},
      {.name = "castle-frame",
       .help = "All contacts of the castle in one frame",
       .size_help = "number of the frame",
       .size = kImpactFrame,
       .min_size = 0,
       .max_size = kLastFrame,
       .parameters = {ModelParameter(),
                      {.name = "compliance",
                       .help = "E of each row, relative to its entry of diag(J M^-1 J')",
                       .value = kFrameCompliance,
                       .min = 0,
                       .max = 1}},
       .make = MakeCastleFrame}};
}

}  // namespace cairn::bench
