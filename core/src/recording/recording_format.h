// SPDX-License-Identifier: MIT
// The frame of a recording: header, table of sections, sections. docs/recording.md shows it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "recording/recording_fields.h"

namespace cairn {

/// Written, and the oldest that is read: it knew no joints. The second knew no substeps, the third
/// no geometric stiffness, the fourth not which errors are taken back, the fifth not what of
/// targets.
inline constexpr std::uint32_t kRecordingVersion = 6, kOldestVersion = 1;
/// Where earlier ones have Tuning::units_per_metre there is something else.
inline constexpr std::uint32_t kVersionOfUnits = 4;
/// No text begins like that, and whatever rewrites line ends destroys it.
inline constexpr std::array<unsigned char, 8> kRecordingMagic = {0x89, 'C',  'R',  'N',
                                                                 '\r', '\n', 0x1a, '\n'};
inline constexpr std::size_t kHeaderBytes = 32, kEntryBytes = 32;
inline constexpr std::size_t kChecksumAt = 24;  ///< In the header, of what is before it.
inline constexpr std::uint32_t kMostSections = 64;
inline constexpr std::size_t kMostSourceBytes = 4096;

/// In the order of the file.
enum Section {
  kSource,
  kFrame,
  kSettings,
  kReplay,
  kLaw,
  kBodies,
  kMotions,
  kRows,
  kRowImpulses,
  kManifolds,
  kPoints,
  kPointImpulses,
  kTwists,
  kTwistImpulses,
  kJoints,
  kJointRows,
  kJointImpulses,
  kStep,
  kStrains,
  kJointErrors,
  kPointSpeeds,
  kJointRowErrors,
  kSections
};
/// That a version knows: the first ones.
inline constexpr int SectionsOf(std::uint32_t version) {
  constexpr int kKnown[] = {kJoints, kStep, kJointErrors, kJointErrors, kJointRowErrors, kSections};
  return kKnown[version - kOldestVersion];
}

inline constexpr std::array<std::string_view, kSections> kSectionNames = {
    "INFO", "FRAM", "SETT", "REPL", "LAWS", "BODY", "MOTN", "ROWS", "RIMP", "MANI", "PNTS",
    "PIMP", "TWST", "TIMP", "JNTS", "JROW", "JIMP", "STEP", "STRN", "JERR", "PSPD", "RERR"};

/// Adds up the bytes of fields.
class FieldCounter {
 public:
  void F64(const double&) { bytes_ += 8; }
  void F32(const float&) { bytes_ += 4; }
  void I32(const int&) { bytes_ += 4; }
  void I64(const std::int64_t&) { bytes_ += 8; }
  void U32(const std::uint32_t&) { bytes_ += 4; }
  void U64(const std::uint64_t&) { bytes_ += 8; }
  void U8(const std::uint8_t&) { bytes_ += 1; }
  void Flag(const bool&) { bytes_ += 1; }
  void Small(const std::int8_t&, int, int) { bytes_ += 1; }
  template <class E>
  void Enum(const E&, E) {
    bytes_ += 4;
  }
  void Zeros(int count) { bytes_ += count; }
  void Require(bool) {}

  std::size_t bytes() const { return bytes_; }

 private:
  std::size_t bytes_ = 0;
};

/// Bytes of an entry of that type in the file.
template <class T>
std::size_t EntrySize() {
  T entry{};
  FieldCounter counter;
  Visit(entry, counter);
  return counter.bytes();
}

/// How long the step is, how it is cut, whether that is too long for tension, and whether errors
/// are taken back without velocity.
struct StepFields {
  double time_step = 0;
  int substeps = 1;
  bool geometric_stiffness = false, relax = false;
};

template <class Io>
void Visit(StepFields& step, Io& io) {
  io.F64(step.time_step);
  io.I32(step.substeps);
  io.Flag(step.geometric_stiffness);
  io.Flag(step.relax);
  io.Zeros(2);
}

struct FrameNumber {
  std::int64_t frame = -1;
};

template <class Io>
void Visit(FrameNumber& number, Io& io) {
  io.I64(number.frame);
}

}  // namespace cairn
