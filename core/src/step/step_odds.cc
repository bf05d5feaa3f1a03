// SPDX-License-Identifier: MIT
#include "step/step_odds.h"

#include <algorithm>
#include <limits>

#include "runtime/logarithm.h"

namespace cairn {
namespace {

/// Weight of the newest measurement, and of the first one against what is thought without.
constexpr double kNewest = 0.3, kFirst = 0.7;
/// By which what is known of steps fades in a frame without.
constexpr double kFade = 0.01;
/// What a further step of a frame is expected to do, of the first.
constexpr double kLater = 0.5;
/// Frames after which the power of sweeps is measured again, in one without steps if need be.
constexpr int kMeasureAgain = 64;
/// How many times what the k_gs sweeps in its place gain a step has to gain on average for islands
/// to begin with steps, and for those that have them to go on. Steps gain less on arches and
/// dominoes, more on towers, bridges and chains.
constexpr double kBegins = 3, kGoesOn = 2.4;
/// The same for small stacks, and for tiny ones: steps that come and go keep those rocking.
constexpr double kSmallBegins = 2, kSmallGoesOn = 1.6, kTinyBegins = 1.5, kTinyGoesOn = 1.2;
/// Errors that let heavy loads fall and beams of joints bend where sweeps leave them in frame after
/// frame [m/s] or [rad/s]: what gravity adds in a step at 60 Hz, and less in shorter ones. And
/// those of stacks that rock.
constexpr double kGross = 0.15, kRough = 0.005;
/// What that ratio is taken to be at least and at most, so that a contact that came in one frame
/// does not outweigh many others.
constexpr double kLeastRatio = 1, kMostRatio = 30;
/// So many trials have an equal share in the mean; later ones have that of the last of these.
constexpr int kEqualTrials = 4;
/// Frames between two trials, while steps pay and, at most, while they do not: half a second at 60
/// Hz and more.
constexpr int kLeastPause = 2, kPause = 16, kMostPause = 32;
/// Most steps in a sixtieth of a second; shorter ones count as if they were not.
constexpr double kMostPace = 64;
constexpr double kLeastPower = 0.05, kMostPower = 20;
/// The same of logarithms: what is more is rounding.
constexpr double kMostCut = 8;

void Learn(double measured, bool* known, double* mean) {
  *mean += (*known ? kNewest : kFirst) * (measured - *mean);
  *known = true;
}

}  // namespace

double StepOdds::PricesLeft(double gain) {
  // a step has to cut more than the power() of left / (left - price), what sweeps do meanwhile
  if (gain <= 0) return std::numeric_limits<double>::infinity();
  return -1 / ExpMinusOne(-gain);
}

double StepOdds::PowerOf(int from, int to, double share) {
  if (from <= 0 || to <= from) return 0;
  if (!(share > 0)) return std::numeric_limits<double>::infinity();
  return -Log(share) / Log(static_cast<double>(to) / from);
}

void StepOdds::LearnSweeps(double power) {
  Learn(std::clamp(power, kLeastPower, kMostPower), &power_known_, &power_);
  age_ = 0;
}

void StepOdds::LearnStep(int steps, double share) {
  Cut& cut = steps == 0 ? first_ : later_;
  Learn(std::clamp(-Log(share), -kMostCut, kMostCut), &cut.known, &cut.cut);
}

void StepOdds::LearnGains(double with_step, double alone, Size size, bool needed) {
  carries_ = with_step > kCarries * alone;
  const double ratio = with_step <= kLeastRatio * std::max(alone, 0.0) ? kLeastRatio
                       : with_step >= kMostRatio * alone               ? kMostRatio
                                                                       : with_step / alone;
  const bool first = trials_ == 0;
  if (trials_ < kEqualTrials) ++trials_;
  ratio_ += (Log(ratio) - ratio_) / trials_;
  const bool goes_on = (pays_ && !first) || needed;
  const bool small = size != Size::kMany, tiny = size == Size::kFewest && stays_rough();
  const double begins = tiny ? kTinyBegins : small ? kSmallBegins : kBegins;
  const double least = !goes_on ? begins : tiny ? kTinyGoesOn : small ? kSmallGoesOn : kGoesOn;
  pays_ = ratio_ > Log(least);
  // what is piled up now, or begins to sag, asks for steps soon
  const int most_pause = static_cast<int>(kMostPause * pace_);
  trial_pause_ = pays_ ? kPause : std::clamp(2 * trial_pause_, kLeastPause, most_pause);
  trial_age_ = 0;
}

void StepOdds::Expect(double cut) {
  expected_ = cut;
  if (!first_.known) first_.cut = expected_;
  if (!later_.known) later_.cut = kLater * expected_;
}

void StepOdds::EndFrame(int stepped_bodies, double error, double time_step) {
  pace_ = time_step > 0 ? std::clamp(1 / (60 * time_step), 1.0, kMostPace) : 1;
  if (stepped_bodies == 0) {
    gross_frames_ = pace_ * error > kGross ? std::min(gross_frames_ + 1, kGrossFrames) : 0;
    rough_frames_ = error > kRough ? std::min(rough_frames_ + 1, kRoughFrames) : 0;
  }
  frames_ = std::min(frames_ + 1, kYoung);
  ++age_;
  ++trial_age_;
  stepped_bodies_ = stepped_bodies;
  frames_without_ = stepped_bodies > 0 ? 0 : std::min(kLate, frames_without_ + 1);
  if (stepped_bodies > 0) return;
  if (stale()) age_ = 0;
  first_.cut += kFade * (expected_ - first_.cut);
  later_.cut += kFade * (kLater * expected_ - later_.cut);
}

void StepOdds::EndSteps(bool kept) {
  plain_frames_ = kept ? 0 : std::min(plain_frames_ + 1, kEased);
  if (kept) {
    eased_frames_ = std::min(eased_frames_ + 1, kEased);
  } else if (!is_young() && plain_frames_ == kEased) {
    eased_frames_ = 0;
  }
}

double StepOdds::share() const {
  return only_looks() ? 1 : std::min(1.0, (eased_frames_ + 1.0) / kEased);
}

bool StepOdds::stale() const { return age_ >= (power_known_ ? kMeasureAgain : 1); }

}  // namespace cairn
