// SPDX-License-Identifier: MIT
#pragma once
#include "cairn/detail/cpp20.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cairn/contact_problem.h"
#include "cairn/settings.h"

namespace cairn {

/// One Solve() of a ContactProblem as it can be kept in a file and made again on any machine: the
/// problem, where it started and how it was solved. docs/recording.md has the layout of the file.
struct Recording {
  std::string source;       ///< Who recorded it, one line of text, 4096 bytes at most.
  std::int64_t frame = -1;  ///< Of the game, counted from 0; -1 if there is no such number.

  std::vector<Body> bodies;
  std::vector<Row> rows;
  std::vector<Manifold> manifolds;
  std::vector<ContactPoint> points;
  ContactLaw contact_law;
  std::vector<ContactMotion> motions;
  std::vector<ContactTwist> twists;
  std::vector<double> row_impulses;            ///< The start, one per row.
  std::vector<ContactImpulse> point_impulses;  ///< The start, one per point.
  std::vector<TwistImpulse> twist_impulses;    ///< The start, one per twist.
  std::vector<Joint> joints;
  std::vector<JointRow> joint_rows;
  std::vector<float> joint_errors;    ///< One per row of a joint, or none.
  std::vector<float> joint_impulses;  ///< The start, one per row of a joint.
  double time_step = 0;               ///< ContactProblem::time_step [s].

  /// The pointers among them are not kept: they are nullptr.
  Settings settings;
  /// What the clock decided, if the budget was a time.
  std::optional<Replay> replay;

  ContactProblem problem() const {
    return {bodies, rows,   manifolds,  points,       contact_law, motions,
            twists, joints, joint_rows, joint_errors, time_step};
  }
  /// The start, in the memory of the recording: a Solve() puts its results there.
  Impulses impulses() { return {row_impulses, point_impulses, twist_impulses, joint_impulses}; }
  /// Takes a copy of a problem and its start; memory is used again.
  void Assign(const ContactProblem& problem, const Impulses& start);
};

/// What is wrong with a recording.
enum class RecordingFault {
  kNone,
  kCannotOpen,      ///< The file cannot be opened or read.
  kCannotWrite,     ///< It cannot be created or written.
  kNotARecording,   ///< It begins with something else.
  kUnknownVersion,  ///< Written by a library of another time.
  kTooShort,        ///< It was cut.
  kTooLong,         ///< Something was appended.
  kChecksum,        ///< It was altered.
  kBadLayout,       ///< Sections or counts that do not fit the file, or one another.
  kBadValue,        ///< A value that no writer of this version writes.
};

struct [[nodiscard]] RecordingStatus {
  RecordingFault fault = RecordingFault::kNone;
  std::string
      message;  ///< One sentence for people, without a full stop; empty if nothing is wrong.

  bool ok() const { return fault == RecordingFault::kNone; }
};

/// The bytes of a file. The same recording gives the same bytes on any machine.
/// @param[out] bytes  are replaced; their memory is used again
RecordingStatus Encode(const Recording& recording, std::vector<std::byte>* bytes);

/// Reads the bytes of a file. What they say is believed only as far as there are bytes for it: it
/// asks for no more memory than a few times their number. Whether the problem can be solved is for
/// Solver::Solve() to say.
/// @param[out] recording  not touched if anything is wrong
RecordingStatus Decode(std::span<const std::byte> bytes, Recording* recording);

/// Writes a file: under another name first, so that there is never half of it.
RecordingStatus Save(const Recording& recording, const std::string& path);
/// Reads one. @param[out] recording  not touched if anything is wrong
RecordingStatus Load(const std::string& path, Recording* recording);

/// The same problem without joints and manifolds: their rows are written out, in double precision,
/// behind those it has. Status::kOk, or why it cannot be solved.
/// @param[out] rows  not touched unless the status is kOk
[[nodiscard]] Status WriteOutRows(const Recording& recording, Recording* rows);

}  // namespace cairn
