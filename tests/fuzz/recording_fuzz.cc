// SPDX-License-Identifier: MIT
// Reads any bytes as a recording. What can be read says the same when it is written again, with the
// same bytes unless a setting is a former one, and is solved without harm, or refused.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <random>
#include <span>
#include <vector>

#include "cairn/detail/recording.h"
#include "cairn/solver.h"
#include "recording/recording_format.h"
#include "tests/core/support/recording_bytes.h"

namespace {

using cairn::test::Bytes;

constexpr int kMostSweeps = 12;

void Require(bool sound) {
  if (!sound) std::abort();
}

void Solve(cairn::Recording recording) {
  // no file may ask for more time or threads than a test has
  cairn::Settings& settings = recording.settings;
  settings.max_sweeps = std::min(settings.max_sweeps, kMostSweeps);
  settings.budget = cairn::Budget::Work(100'000);
  settings.threads = std::min(settings.threads, 1);
  settings.k_sm = std::min(settings.k_sm, 2);
  settings.tuning.refinements = std::min(settings.tuning.refinements, 2);
  settings.tuning.min_sweeps = std::min(settings.tuning.min_sweeps, kMostSweeps);
  std::vector<cairn::Velocity> velocities(recording.bodies.size());
  const cairn::Impulses start = recording.impulses();
  (void)cairn::Solver(settings).Solve(recording.problem(), start, velocities);
}

/// Where a section is in a file of the newest version.
struct Place {
  std::size_t begin, end;
};

/// @pre the file can be read
Place PlaceOf(const Bytes& file, const char* section) {
  const std::size_t entry = cairn::test::TableEntryOf(file, section);
  const std::size_t begin = cairn::test::NumberAt(file, entry + 8, 8);
  const std::size_t each = cairn::test::NumberAt(file, entry + 4, 4);
  return {begin, begin + each * cairn::test::NumberAt(file, entry + 16, 8)};
}

/// Settings that are gone (orders of rows, methods of matrices) are read as what took their place,
/// and written as that. So their section, with its checksum, may change once; nothing else may.
void RequireSameWhenWritten(std::span<const std::byte> bytes, const cairn::Recording& recording) {
  Bytes written, again;
  Require(cairn::Encode(recording, &written).ok());
  cairn::Recording read;
  Require(cairn::Decode(written, &read).ok());
  Require(cairn::Encode(read, &again).ok());
  Require(again == written);

  const Bytes file(bytes.begin(), bytes.end());
  if (cairn::test::NumberAt(file, 8, 4) != cairn::kRecordingVersion) return;
  Require(file.size() == written.size());
  const Place settings = PlaceOf(file, "SETT");
  const std::size_t head =
      cairn::kHeaderBytes + cairn::test::NumberAt(file, 12, 4) * cairn::kEntryBytes;
  const auto same = [&](std::size_t begin, std::size_t end) {
    return std::equal(file.begin() + begin, file.begin() + end, written.begin() + begin);
  };
  Require(same(head, settings.begin) && same(settings.end, file.size()));
}

}  // namespace

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);

namespace {

/// Changes the data of one section, its size perhaps too, and moves what is behind it.
/// @return the new number of bytes; 0 if there is no table to go by
std::size_t MutateSection(Bytes* bytes, std::size_t most, std::minstd_rand* random) {
  using cairn::test::NumberAt;
  using cairn::test::PutNumber;
  constexpr std::size_t kHeader = cairn::kHeaderBytes, kEntry = cairn::kEntryBytes;
  if (bytes->size() < kHeader) return 0;
  const std::size_t sections = NumberAt(*bytes, 12, 4);
  if (sections == 0 || sections > cairn::kMostSections) return 0;
  if (bytes->size() < kHeader + sections * kEntry) return 0;
  const std::size_t entry = kHeader + (*random)() % sections * kEntry;
  const std::size_t each = NumberAt(*bytes, entry + 4, 4);
  const std::size_t begin = std::min<std::size_t>(NumberAt(*bytes, entry + 8, 8), bytes->size());
  const std::uint64_t count = NumberAt(*bytes, entry + 16, 8);
  if (begin < kHeader + sections * kEntry) return 0;  // it would take the table away
  if (each == 0 || each > bytes->size() || count > (bytes->size() - begin) / each) return 0;

  const std::size_t size = count * each;
  std::vector<std::uint8_t> data(std::max(2 * size, 4 * each));
  std::memcpy(data.data(), bytes->data() + begin, size);
  std::size_t changed = LLVMFuzzerMutate(data.data(), size, data.size());
  if ((*random)() % 4 != 0) changed = size;  // counts have to agree with those of other sections
  changed = changed / each * each;
  if (bytes->size() - size + changed > most) return 0;

  Bytes result(bytes->begin(), bytes->begin() + static_cast<std::ptrdiff_t>(begin));
  const auto raw = std::as_bytes(std::span(data).first(changed));
  result.insert(result.end(), raw.begin(), raw.end());
  result.insert(result.end(), bytes->begin() + static_cast<std::ptrdiff_t>(begin + size),
                bytes->end());
  PutNumber(changed / each, entry + 16, 8, &result);
  for (std::size_t i = 0; i < sections; ++i) {
    const std::size_t at = kHeader + i * kEntry + 8;
    const std::uint64_t offset = NumberAt(result, at, 8);
    if (kHeader + i * kEntry > entry) PutNumber(offset - size + changed, at, 8, &result);
  }
  PutNumber(result.size(), 16, 8, &result);
  *bytes = std::move(result);
  return bytes->size();
}

}  // namespace

/// Of four changes, three are inside a section and one is anywhere; most of them with checksums
/// that are right, so that readers go on to what is behind them.
extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t most, unsigned seed) {
  std::minstd_rand random(seed);
  const auto raw = std::as_bytes(std::span(data, size));
  Bytes bytes(raw.begin(), raw.end());
  if (random() % 4 == 0 || MutateSection(&bytes, most, &random) == 0) {
    const std::size_t changed = LLVMFuzzerMutate(data, size, most);
    const auto anywhere = std::as_bytes(std::span(data, changed));
    bytes.assign(anywhere.begin(), anywhere.end());
  }
  if (random() % 16 != 0) cairn::test::RepairChecksums(&bytes);
  std::memcpy(data, bytes.data(), bytes.size());
  return bytes.size();
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto bytes = std::as_bytes(std::span(data, size));
  cairn::Recording recording;
  const cairn::RecordingStatus status = cairn::Decode(bytes, &recording);
  Require(status.ok() == status.message.empty());
  if (!status.ok()) return 0;

  RequireSameWhenWritten(bytes, recording);

  // Solving takes a hundred times as long: one in eight, the same each time. The byte is of a
  // checksum.
  if (std::to_integer<int>(bytes[cairn::kChecksumAt]) % 8 != 0) return 0;
  cairn::Recording rows;
  const cairn::Status written_out = cairn::WriteOutRows(recording, &rows);
  if (written_out == cairn::Status::kOk) Solve(std::move(rows));
  Solve(std::move(recording));
  return 0;
}
