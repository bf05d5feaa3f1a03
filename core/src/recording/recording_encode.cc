// SPDX-License-Identifier: MIT
#include <algorithm>
#include <bit>
#include <limits>

#include "recording/crc32.h"
#include "recording/recording_format.h"

namespace cairn {
namespace {

/// Appends numbers, lowest byte first.
class Writer {
 public:
  explicit Writer(std::vector<std::byte>* bytes) : bytes_(bytes) {}

  void F64(double value) { Put(std::bit_cast<std::uint64_t>(value), 8); }
  void F32(float value) { Put(std::bit_cast<std::uint32_t>(value), 4); }
  void I32(int value) { Put(static_cast<std::uint32_t>(value), 4); }
  void U32(std::uint32_t value) { Put(value, 4); }
  void I64(std::int64_t value) { Put(static_cast<std::uint64_t>(value), 8); }
  void U64(std::uint64_t value) { Put(value, 8); }
  void U8(std::uint8_t value) { Put(value, 1); }
  void Flag(bool value) { Put(value ? 1 : 0, 1); }
  void Small(std::int8_t value, int least, int most) {
    in_range_ = in_range_ && value >= least && value <= most;
    Put(static_cast<std::uint8_t>(value), 1);
  }
  template <class E>
  void Enum(E value, E last) {
    in_range_ = in_range_ && value >= E{} && value <= last;
    I32(static_cast<int>(value));
  }
  void Zeros(int count) { bytes_->resize(bytes_->size() + count); }

  void Require(bool sound) { in_range_ = in_range_ && sound; }

  /// Every value is one that a reader takes.
  bool in_range() const { return in_range_; }

 private:
  void Put(std::uint64_t value, int count) {
    std::byte parts[8];
    for (int i = 0; i < count; ++i) parts[i] = static_cast<std::byte>(value >> (8 * i));
    bytes_->insert(bytes_->end(), parts, parts + count);
  }

  std::vector<std::byte>* bytes_;
  bool in_range_ = true;
};

/// Writes sections, one after the other, and their entries in the table.
class SectionWriter {
 public:
  explicit SectionWriter(std::vector<std::byte>* bytes) : bytes_(bytes), writer_(bytes) {}

  /// @param entries  of a type that has fields
  template <class T>
  void Add(Section section, std::span<const T> entries) {
    Begin(section);
    for (T entry : entries) Visit(entry, writer_);
    End(EntrySize<T>(), entries.size());
  }
  void AddReplay(const Replay& replay) {
    Begin(kReplay);
    writer_.I64(replay.work);
    for (const std::uint8_t fit : replay.fits) writer_.U8(fit);
    End(1, 8 + replay.fits.size());
  }

  bool in_range() const { return writer_.in_range(); }
  const std::vector<std::byte>& table() const { return table_; }

 private:
  void Begin(Section section) {
    section_ = section;
    begin_ = bytes_->size();
  }
  void End(std::size_t entry_size, std::size_t count) {
    Writer entry(&table_);
    for (const char letter : kSectionNames[section_]) entry.U8(static_cast<std::uint8_t>(letter));
    entry.U32(static_cast<std::uint32_t>(entry_size));
    entry.U64(begin_);
    entry.U64(count);
    entry.U32(Crc32(std::span(*bytes_).subspan(begin_)));
    entry.U32(0);
  }

  std::vector<std::byte>* bytes_;
  Writer writer_;
  std::vector<std::byte> table_;
  Section section_ = kSource;
  std::size_t begin_ = 0;
};

RecordingStatus Unfit(const char* what) { return {RecordingFault::kBadValue, what}; }

/// What a reader would refuse.
RecordingStatus Check(const Recording& recording) {
  constexpr auto kMost = static_cast<std::size_t>(std::numeric_limits<int>::max());
  for (const std::size_t count :
       {recording.bodies.size(), recording.rows.size(), recording.manifolds.size(),
        recording.points.size(), recording.joints.size(), recording.joint_rows.size()}) {
    if (count > kMost)
      return Unfit("the problem has more bodies, rows or points than an int counts");
  }
  if (recording.row_impulses.size() != recording.rows.size() ||
      recording.point_impulses.size() != recording.points.size()) {
    return Unfit("the start does not have one impulse per row and one per point");
  }
  if (!recording.twists.empty() && recording.twists.size() != recording.points.size()) {
    return Unfit("there is neither one twist per point nor none");
  }
  if (recording.twist_impulses.size() != recording.twists.size()) {
    return Unfit("the start does not have one impulse per twist");
  }
  if (recording.joint_impulses.size() != recording.joint_rows.size()) {
    return Unfit("the start does not have one impulse per row of a joint");
  }
  if (!recording.joint_errors.empty() &&
      recording.joint_errors.size() != recording.joint_rows.size()) {
    return Unfit("there is neither one error per row of a joint nor none");
  }
  if (!recording.motions.empty() && recording.motions.size() != recording.bodies.size()) {
    return Unfit("there is neither one motion per body nor none");
  }
  if (recording.source.size() > kMostSourceBytes)
    return Unfit("the source is longer than 4096 bytes");
  return {};
}

/// Fields that few problems use: none if all are 0.
template <class Field, class Entry>
std::vector<Field> FieldsOf(const std::vector<Entry>& entries, Field Entry::*field) {
  const auto is_used = [field](const Entry& entry) { return entry.*field != 0; };
  std::vector<Field> fields;
  if (std::none_of(entries.begin(), entries.end(), is_used)) return fields;
  for (const Entry& entry : entries) fields.push_back(entry.*field);
  return fields;
}

void AddSections(const Recording& recording, SectionWriter* to) {
  const auto text = reinterpret_cast<const std::uint8_t*>(recording.source.data());
  const FrameNumber frame{recording.frame};
  to->Add(kSource, std::span(text, recording.source.size()));
  to->Add(kFrame, std::span(&frame, 1));
  to->Add(kSettings, std::span(&recording.settings, 1));
  if (recording.replay) to->AddReplay(*recording.replay);
  to->Add(kLaw, std::span(&recording.contact_law, 1));
  to->Add(kBodies, std::span(recording.bodies));
  to->Add(kMotions, std::span(recording.motions));
  to->Add(kRows, std::span(recording.rows));
  to->Add(kRowImpulses, std::span(recording.row_impulses));
  to->Add(kManifolds, std::span(recording.manifolds));
  to->Add(kPoints, std::span(recording.points));
  to->Add(kPointImpulses, std::span(recording.point_impulses));
  to->Add(kTwists, std::span(recording.twists));
  to->Add(kTwistImpulses, std::span(recording.twist_impulses));
  to->Add(kJoints, std::span(recording.joints));
  to->Add(kJointRows, std::span(recording.joint_rows));
  to->Add(kJointImpulses, std::span(recording.joint_impulses));
  const StepFields step{recording.time_step, recording.settings.substeps,
                        recording.settings.geometric_stiffness, recording.settings.relax};
  to->Add(kStep, std::span(&step, 1));
  const auto add = [to](Section section, const auto& fields) {
    to->Add(section, std::span(fields.data(), fields.size()));
  };
  add(kStrains, FieldsOf(recording.bodies, &Body::strain));
  add(kJointErrors, FieldsOf(recording.joints, &Joint::errors));
  add(kPointSpeeds, FieldsOf(recording.manifolds, &Manifold::speeds));
  add(kJointRowErrors, recording.joint_errors);
}

}  // namespace

RecordingStatus Encode(const Recording& recording, std::vector<std::byte>* bytes) {
  if (RecordingStatus status = Check(recording); !status.ok()) return status;
  const std::uint32_t sections = recording.replay ? kSections : kSections - 1;
  const std::size_t head = kHeaderBytes + sections * kEntryBytes;
  bytes->assign(head, std::byte{});
  SectionWriter writer(bytes);
  AddSections(recording, &writer);
  if (!writer.in_range()) return Unfit("a setting or a manifold is out of its range");

  std::vector<std::byte> front;
  Writer header(&front);
  for (const unsigned char byte : kRecordingMagic) header.U8(byte);
  header.U32(kRecordingVersion);
  header.U32(sections);
  header.U64(bytes->size());
  header.U32(Crc32(writer.table(), Crc32(front)));
  header.U32(0);
  front.insert(front.end(), writer.table().begin(), writer.table().end());
  std::copy(front.begin(), front.end(), bytes->begin());
  return {};
}

}  // namespace cairn
