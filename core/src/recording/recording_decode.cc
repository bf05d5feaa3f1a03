// SPDX-License-Identifier: MIT
#include <algorithm>
#include <bit>
#include <limits>
#include <optional>
#include <utility>

#include "recording/crc32.h"
#include "recording/recording_format.h"

namespace cairn {
namespace {

using Bytes = std::span<const std::byte>;

RecordingStatus Fault(RecordingFault fault, std::string message) {
  return {fault, std::move(message)};
}

std::string Text(std::uint64_t number) { return std::to_string(number); }

/// Takes numbers, lowest byte first. @pre there are as many bytes as are asked for
class Reader {
 public:
  explicit Reader(Bytes bytes) : bytes_(bytes) {}

  void F64(double& value) { value = std::bit_cast<double>(Take(8)); }
  void F32(float& value) { value = std::bit_cast<float>(static_cast<std::uint32_t>(Take(4))); }
  void I32(int& value) { value = static_cast<std::int32_t>(U32()); }
  void U32(std::uint32_t& value) { value = U32(); }
  void I64(std::int64_t& value) { value = static_cast<std::int64_t>(Take(8)); }
  void U64(std::uint64_t& value) { value = Take(8); }
  void U8(std::uint8_t& value) { value = static_cast<std::uint8_t>(Take(1)); }
  void Flag(bool& value) {
    const std::uint64_t number = Take(1);
    in_range_ = in_range_ && number <= 1;
    value = number == 1;
  }
  void Small(std::int8_t& value, int least, int most) {
    value = static_cast<std::int8_t>(Take(1));
    in_range_ = in_range_ && value >= least && value <= most;
  }
  template <class E>
  void Enum(E& value, E last) {
    const std::uint32_t number = U32();
    const bool known = number <= static_cast<std::uint32_t>(last);
    in_range_ = in_range_ && known;
    value = known ? static_cast<E>(number) : E{};
  }
  void Zeros(int count) { in_range_ = Take(count) == 0 && in_range_; }
  void Require(bool sound) { in_range_ = in_range_ && sound; }

  std::uint32_t U32() { return static_cast<std::uint32_t>(Take(4)); }
  std::uint64_t U64() { return Take(8); }
  bool in_range() const { return in_range_; }

 private:
  std::uint64_t Take(int count) {
    std::uint64_t value = 0;
    for (int i = 0; i < count; ++i) {
      value |= std::to_integer<std::uint64_t>(bytes_[i]) << (8 * i);
    }
    bytes_ = bytes_.subspan(count);
    return value;
  }

  Bytes bytes_;
  bool in_range_ = true;
};

/// What the table says of a section, once it was checked.
struct Entry {
  std::uint32_t entry_size;
  std::uint64_t count;
  Bytes bytes;
};

/// The frame of a file: what is where.
class Layout {
 public:
  explicit Layout(Bytes file) : file_(file) {}

  RecordingStatus Read();
  const std::optional<Entry>& section(Section section) const { return sections_[section]; }
  std::uint32_t version() const { return version_; }

 private:
  RecordingStatus ReadHeader();
  RecordingStatus ReadEntry(Bytes entry);
  std::string NameOf(Bytes entry) const;

  Bytes file_;
  std::uint32_t count_ = 0;
  std::uint64_t next_ = 0;  ///< where the next section begins
  int first_free_ = 0;      ///< sections come in their order
  std::uint32_t version_ = kRecordingVersion;
  int known_ = kSections;  ///< sections of the version: the first ones
  std::array<std::optional<Entry>, kSections> sections_;
};

RecordingStatus TooShort(std::uint64_t has, std::uint64_t needs) {
  return Fault(RecordingFault::kTooShort, "the file was cut: it has " + Text(has) + " bytes, " +
                                              Text(needs - has) + " too few");
}

RecordingStatus Layout::ReadHeader() {
  const std::size_t magic = std::min(file_.size(), kRecordingMagic.size());
  for (std::size_t i = 0; i < magic; ++i) {
    if (std::to_integer<unsigned char>(file_[i]) != kRecordingMagic[i]) {
      return Fault(RecordingFault::kNotARecording, "this is no recording of Cairn");
    }
  }
  if (file_.size() < kHeaderBytes) return TooShort(file_.size(), kHeaderBytes);
  Reader reader(file_.subspan(kRecordingMagic.size()));
  version_ = reader.U32();
  if (version_ < kOldestVersion || version_ > kRecordingVersion) {
    return Fault(RecordingFault::kUnknownVersion,
                 "version " + Text(version_) + " of recordings is not known; this library reads " +
                     Text(kOldestVersion) + " to " + Text(kRecordingVersion));
  }
  known_ = SectionsOf(version_);
  count_ = reader.U32();
  const std::uint64_t length = reader.U64();
  const std::uint32_t checksum = reader.U32();
  const std::uint32_t rest = reader.U32();
  if (count_ > kMostSections) {
    return Fault(RecordingFault::kBadLayout, "the header speaks of " + Text(count_) +
                                                 " sections, there are " + Text(kMostSections) +
                                                 " at most");
  }
  next_ = kHeaderBytes + count_ * kEntryBytes;
  if (file_.size() < next_) return TooShort(file_.size(), std::max(length, next_));
  const Bytes table = file_.subspan(kHeaderBytes, count_ * kEntryBytes);
  if (checksum != Crc32(table, Crc32(file_.first(kChecksumAt))) || rest != 0) {
    return Fault(RecordingFault::kChecksum,
                 "the checksum of the header is wrong: the file was altered");
  }
  if (file_.size() < length) return TooShort(file_.size(), length);
  if (file_.size() > length) {
    return Fault(RecordingFault::kTooLong,
                 "the file has " + Text(file_.size() - length) + " bytes too many at its end");
  }
  return {};
}

std::string Layout::NameOf(Bytes entry) const {
  std::string name;
  for (int i = 0; i < 4; ++i) {
    const char letter = std::to_integer<char>(entry[i]);
    name += letter >= ' ' && letter <= '~' ? letter : '?';
  }
  return name;
}

RecordingStatus Layout::ReadEntry(Bytes bytes) {
  const std::string name = NameOf(bytes);
  Reader reader(bytes.subspan(4));
  Entry entry{.entry_size = reader.U32(), .count = 0, .bytes = {}};
  const std::uint64_t offset = reader.U64();
  entry.count = reader.U64();
  const std::uint32_t checksum = reader.U32();
  if (reader.U32() != 0) {
    return Fault(RecordingFault::kBadLayout,
                 "the entry of section " + name + " in the table does not end with zeros");
  }
  if (offset != next_) {
    return Fault(RecordingFault::kBadLayout, "section " + name + " begins at byte " + Text(offset) +
                                                 " instead of " + Text(next_));
  }
  const std::uint64_t left = file_.size() - next_;
  const bool fits =
      entry.count == 0 || (entry.entry_size > 0 && entry.count <= left / entry.entry_size);
  if (!fits || entry.count > std::numeric_limits<int>::max()) {
    return Fault(RecordingFault::kBadLayout, "section " + name + " speaks of " + Text(entry.count) +
                                                 " entries of " + Text(entry.entry_size) +
                                                 " bytes, where " + Text(left) + " bytes are left");
  }
  entry.bytes = file_.subspan(next_, entry.count * entry.entry_size);
  next_ += entry.bytes.size();
  if (Crc32(entry.bytes) != checksum) {
    return Fault(RecordingFault::kChecksum,
                 "the checksum of section " + name + " is wrong: the file was altered");
  }
  const auto end = kSectionNames.begin() + known_;
  const auto known = std::find(kSectionNames.begin(), end, name);
  if (known == end) {
    return Fault(RecordingFault::kBadLayout,
                 "section " + name + " is not known in version " + Text(version_));
  }
  const auto section = static_cast<int>(known - kSectionNames.begin());
  if (section < first_free_) {
    return Fault(RecordingFault::kBadLayout,
                 "section " + name + " is there twice or not in its place");
  }
  first_free_ = section + 1;
  sections_[section] = entry;
  return {};
}

RecordingStatus Layout::Read() {
  RecordingStatus status = ReadHeader();
  for (std::uint32_t i = 0; i < count_ && status.ok(); ++i) {
    status = ReadEntry(file_.subspan(kHeaderBytes + i * kEntryBytes, kEntryBytes));
  }
  if (!status.ok()) return status;
  if (next_ != file_.size()) {
    return Fault(RecordingFault::kBadLayout,
                 Text(file_.size() - next_) + " bytes of the file are in no section");
  }
  for (int i = 0; i < known_; ++i) {
    if (sections_[i] || i == kReplay) continue;
    return Fault(RecordingFault::kBadLayout,
                 "section " + std::string(kSectionNames[i]) + " is missing");
  }
  return {};
}

/// Reads sections until one of them is wrong.
class Contents {
 public:
  explicit Contents(const Layout& layout) : layout_(layout) {}

  template <class T>
  void Read(Section section, std::vector<T>* entries) {
    // the version knew none
    if (!layout_.section(section) || !CheckSize(section, EntrySize<T>())) return;
    const Entry& entry = *layout_.section(section);
    entries->resize(entry.count);
    Reader reader(entry.bytes);
    for (std::size_t i = 0; i < entries->size(); ++i) {
      Visit((*entries)[i], reader);
      if (!reader.in_range()) return Refuse(section, i);
    }
  }
  /// Fields that are left out where all of them are 0.
  template <class T>
  void ReadIfUsed(Section section, std::vector<T>* fields) {
    Read(section, fields);
    const auto is_used = [](const T& field) { return field != 0; };
    if (!status_.ok() || fields->empty()) return;
    if (std::none_of(fields->begin(), fields->end(), is_used)) Refuse(section, 0);
  }
  template <class T>
  void ReadOne(Section section, T* value) {
    std::vector<T> values;
    Read(section, &values);
    if (!status_.ok()) return;
    if (values.size() != 1) return Refuse(section, 0);
    *value = values[0];
  }
  void ReadReplay(std::optional<Replay>* replay) {
    if (!layout_.section(kReplay) || !CheckSize(kReplay, 1)) return;
    const Bytes bytes = layout_.section(kReplay)->bytes;
    if (bytes.size() < 8) return Refuse(kReplay, 0);
    Reader reader(bytes);
    replay->emplace();
    reader.I64((*replay)->work);
    (*replay)->fits.resize(bytes.size() - 8);
    for (std::uint8_t& fit : (*replay)->fits) {
      reader.U8(fit);
      if (fit > 1) return Refuse(kReplay, &fit - (*replay)->fits.data() + 8);
    }
  }
  void Expect(Section section, std::size_t expected) {
    if (!status_.ok() || !layout_.section(section)) return;
    if (layout_.section(section)->count == expected) return;
    status_ =
        Fault(RecordingFault::kBadLayout, "section " + std::string(kSectionNames[section]) +
                                              " has " + Text(layout_.section(section)->count) +
                                              " entries, where " + Text(expected) + " belong");
  }
  const RecordingStatus& status() const { return status_; }

 private:
  bool CheckSize(Section section, std::size_t size) {
    if (!status_.ok()) return false;
    const std::uint32_t has = layout_.section(section)->entry_size;
    if (has == size) return true;
    status_ = Fault(RecordingFault::kBadLayout, "entries of section " +
                                                    std::string(kSectionNames[section]) + " have " +
                                                    Text(has) + " bytes instead of " + Text(size));
    return false;
  }
  void Refuse(Section section, std::size_t entry) {
    status_ = Fault(RecordingFault::kBadValue, "entry " + Text(entry) + " of section " +
                                                   std::string(kSectionNames[section]) +
                                                   " has a value that is out of range");
  }

  const Layout& layout_;
  RecordingStatus status_;
};

}  // namespace

RecordingStatus Decode(std::span<const std::byte> bytes, Recording* recording) {
  Layout layout(bytes);
  if (RecordingStatus status = layout.Read(); !status.ok()) return status;
  Contents contents(layout);
  Recording read;
  FrameNumber frame;
  std::vector<std::uint8_t> source;
  contents.Read(kSource, &source);
  contents.ReadOne(kFrame, &frame);
  contents.ReadOne(kSettings, &read.settings);
  contents.ReadReplay(&read.replay);
  contents.ReadOne(kLaw, &read.contact_law);
  contents.Read(kBodies, &read.bodies);
  contents.Read(kMotions, &read.motions);
  contents.Read(kRows, &read.rows);
  contents.Read(kRowImpulses, &read.row_impulses);
  contents.Read(kManifolds, &read.manifolds);
  contents.Read(kPoints, &read.points);
  contents.Read(kPointImpulses, &read.point_impulses);
  contents.Read(kTwists, &read.twists);
  contents.Read(kTwistImpulses, &read.twist_impulses);
  contents.Read(kJoints, &read.joints);
  contents.Read(kJointRows, &read.joint_rows);
  contents.Read(kJointImpulses, &read.joint_impulses);
  std::vector<StepFields> step;
  contents.Read(kStep, &step);
  std::vector<double> strains;
  std::vector<std::uint32_t> errors;
  std::vector<std::uint8_t> speeds;
  contents.ReadIfUsed(kStrains, &strains);
  contents.ReadIfUsed(kJointErrors, &errors);
  contents.ReadIfUsed(kPointSpeeds, &speeds);
  contents.Read(kJointRowErrors, &read.joint_errors);
  contents.Expect(kMotions, read.motions.empty() ? 0 : read.bodies.size());
  contents.Expect(kRowImpulses, read.rows.size());
  contents.Expect(kPointImpulses, read.points.size());
  contents.Expect(kTwists, read.twists.empty() ? 0 : read.points.size());
  contents.Expect(kTwistImpulses, read.twists.size());
  contents.Expect(kJointImpulses, read.joint_rows.size());
  contents.Expect(kJointRowErrors, read.joint_errors.empty() ? 0 : read.joint_rows.size());
  contents.Expect(kStep, 1);
  contents.Expect(kStrains, strains.empty() ? 0 : read.bodies.size());
  contents.Expect(kJointErrors, errors.empty() ? 0 : read.joints.size());
  contents.Expect(kPointSpeeds, speeds.empty() ? 0 : read.manifolds.size());
  if (!contents.status().ok()) return contents.status();
  if (source.size() > kMostSourceBytes) {
    return Fault(RecordingFault::kBadLayout,
                 "section INFO is longer than " + Text(kMostSourceBytes) + " bytes");
  }
  read.source.assign(source.begin(), source.end());
  read.frame = frame.frame;
  // as those were solved that do not say
  read.settings.geometric_stiffness = false;
  if (layout.version() < kVersionOfUnits) read.settings.tuning.units_per_metre = 0;
  for (const StepFields& fields : step) {
    read.time_step = fields.time_step;
    read.settings.substeps = fields.substeps;
    read.settings.geometric_stiffness = fields.geometric_stiffness;
    read.settings.relax = fields.relax;
  }
  for (std::size_t i = 0; i < strains.size(); ++i) read.bodies[i].strain = strains[i];
  for (std::size_t i = 0; i < errors.size(); ++i) read.joints[i].errors = errors[i];
  for (std::size_t i = 0; i < speeds.size(); ++i) read.manifolds[i].speeds = speeds[i];
  *recording = std::move(read);
  return {};
}

}  // namespace cairn
