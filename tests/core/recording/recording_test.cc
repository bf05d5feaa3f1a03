// SPDX-License-Identifier: MIT
// Recordings come back as they were, to the bit, and mean the same on every machine.
#include "cairn/detail/recording.h"

#include <gtest/gtest.h>

#include <bit>
#include <cstring>
#include <limits>

#include "cairn/solver.h"
#include "tests/core/support/manifold_problems.h"
#include "tests/core/support/recording_bytes.h"
#include "tests/core/support/recording_problems.h"
#include "tests/simd/ask_for.h"

namespace cairn {
namespace {

using test::Bytes;
using test::DataOf;
using test::EncodeAll;
using test::NumberAt;
using test::PutNumber;
using test::RandomRecording;
using test::TableEntryOf;

struct Answer {
  Report report;
  std::vector<double> rows;
  std::vector<ContactImpulse> points;
  std::vector<TwistImpulse> twists;
  std::vector<float> joint_rows;
  std::vector<Velocity> velocities;
};

Answer SolveAgain(const Recording& recording) {
  Answer answer{.report = {},
                .rows = recording.row_impulses,
                .points = recording.point_impulses,
                .twists = recording.twist_impulses,
                .joint_rows = recording.joint_impulses,
                .velocities = std::vector<Velocity>(recording.bodies.size())};
  Solver solver(recording.settings);
  if (recording.replay) solver.settings().tuning.replay = &*recording.replay;
  solver.Solve(recording.problem(), {answer.rows, answer.points, answer.twists, answer.joint_rows},
               answer.velocities, &answer.report);
  return answer;
}

testing::AssertionResult SameBits(const Answer& a, const Answer& b) {
  if (!a.report.ok() || !b.report.ok()) return testing::AssertionFailure() << "was not solved";
  const auto bits = [](const auto& x, const auto& y) {
    return x.size() == y.size() &&
           (x.empty() || std::memcmp(x.data(), y.data(), x.size() * sizeof x[0]) == 0);
  };
  if (!bits(a.rows, b.rows)) return testing::AssertionFailure() << "impulses of rows";
  if (!bits(a.twists, b.twists)) return testing::AssertionFailure() << "impulses of twists";
  if (!bits(a.joint_rows, b.joint_rows)) return testing::AssertionFailure() << "joints";
  if (!bits(a.velocities, b.velocities)) return testing::AssertionFailure() << "velocities";
  return test::SameBits(a.points, b.points);
}

Recording Decoded(const Bytes& bytes) {
  Recording recording;
  const RecordingStatus status = Decode(bytes, &recording);
  EXPECT_TRUE(status.ok()) << status.message;
  return recording;
}

TEST(Recording, ComesBackWithEveryBit) {
  for (int seed = 0; seed < 12; ++seed) {
    Recording recording = RandomRecording(seed);
    if (seed % 2 == 0) recording.replay = Replay{.work = 1234 + seed, .fits = {1, 0, 1}};
    const Bytes bytes = EncodeAll(recording);
    const Recording read = Decoded(bytes);
    EXPECT_TRUE(EncodeAll(read) == bytes);  // every field is in the bytes once
    EXPECT_EQ(read.source, recording.source);
    EXPECT_EQ(read.frame, recording.frame);
    EXPECT_EQ(read.replay, recording.replay);
    EXPECT_EQ(read.bodies.size(), recording.bodies.size());
    EXPECT_TRUE(SameBits(SolveAgain(read), SolveAgain(recording)));
  }
}

// A group that could not be solved because of what is in it is what one wants to see.
TEST(Recording, KeepsNumbersThatAreNone) {
  Recording recording = RandomRecording(1);
  const double payload = std::bit_cast<double>(0x7ff8000000c0ffeeu);
  recording.bodies[0].velocity.linear = {payload, -0.0, kInfinity};
  recording.rows[0].target = 5e-324;
  recording.points[0].bias = -std::numeric_limits<float>::infinity();
  const Recording read = Decoded(EncodeAll(recording));
  EXPECT_EQ(std::bit_cast<std::uint64_t>(read.bodies[0].velocity.linear.x()), 0x7ff8000000c0ffeeu);
  EXPECT_TRUE(std::signbit(read.bodies[0].velocity.linear.y()));
  EXPECT_EQ(read.bodies[0].velocity.linear.z(), kInfinity);
  EXPECT_EQ(read.rows[0].target, 5e-324);
  EXPECT_EQ(read.points[0].bias, recording.points[0].bias);
}

TEST(Recording, KeepsEverySettingButPointers) {
  Recording recording = RandomRecording(2);
  Replay replay;
  recording.settings = {.method = Method::kPsor,
                        .path = Path::kReference,
                        .k_gs = 7,
                        .k_sm = 3,
                        .max_sweeps = 11,
                        .tolerance = 1e-4,
                        .budget = Budget::Time(std::chrono::nanoseconds(1234567890123)),
                        .threads = 5,
                        .step_policy = StepPolicy::kAlways,
                        .proximal_joints = 1e-7,
                        .tuning = {.min_progress = 1e-7,
                                   .min_sweeps = 2,
                                   .omega = 1.25,
                                   .proximal = 1e-5,
                                   .refinements = 9,
                                   .lifted_friction = detail::LiftedFriction::kHold,
                                   .replay = &replay}};
  const Settings read = Decoded(EncodeAll(recording)).settings;
  EXPECT_EQ(read.method, Method::kPsor);
  EXPECT_EQ(read.path, Path::kReference);
  EXPECT_EQ(read.k_gs, 7);
  EXPECT_EQ(read.k_sm, 3);
  EXPECT_EQ(read.max_sweeps, 11);
  EXPECT_EQ(read.tolerance, 1e-4);
  EXPECT_EQ(read.tuning.min_progress, 1e-7);
  EXPECT_EQ(read.budget, recording.settings.budget);
  EXPECT_EQ(read.tuning.replay, nullptr);
  EXPECT_EQ(read.tuning.min_sweeps, 2);
  EXPECT_EQ(read.threads, 5);
  EXPECT_EQ(read.tuning.omega, 1.25);
  EXPECT_EQ(read.tuning.lifted_friction, detail::LiftedFriction::kHold);
  EXPECT_EQ(read.step_policy, StepPolicy::kAlways);
  EXPECT_EQ(read.tuning.proximal, 1e-5);
  EXPECT_EQ(read.proximal_joints, 1e-7);
  EXPECT_EQ(read.tuning.refinements, 9);
  for (const Budget& budget : {Budget::Unlimited(), Budget::Work(77)}) {
    recording.settings.budget = budget;
    EXPECT_EQ(Decoded(EncodeAll(recording)).settings.budget, budget);
  }
  for (const Path path : {Path::kAuto, Path::kFast}) {
    recording.settings.path = path;
    EXPECT_EQ(Decoded(EncodeAll(recording)).settings.path, path);
  }
  recording.settings.steps = false;
  EXPECT_EQ(Decoded(EncodeAll(recording)).settings.k_sm, 0);
  EXPECT_EQ(recording.settings.k_sm, 3);
}

// docs/recording.md has these numbers: files of others would break with them.
TEST(Recording, HasTheLayoutOfItsPage) {
  Recording recording = RandomRecording(3);
  recording.replay = Replay{.work = 5, .fits = {1}};
  const Bytes bytes = EncodeAll(recording);
  EXPECT_EQ(NumberAt(bytes, 0, 8), 0x0a1a0a0d4e524389u);
  EXPECT_EQ(NumberAt(bytes, 8, 4), 6u);
  EXPECT_EQ(NumberAt(bytes, 12, 4), 22u);
  EXPECT_EQ(NumberAt(bytes, 16, 8), bytes.size());
  const std::pair<const char*, unsigned> sizes[] = {
      {"INFO", 1},  {"FRAM", 8},   {"SETT", 104}, {"REPL", 1},  {"LAWS", 8},  {"BODY", 208},
      {"MOTN", 48}, {"ROWS", 160}, {"RIMP", 8},   {"MANI", 20}, {"PNTS", 64}, {"PIMP", 28},
      {"TWST", 16}, {"TIMP", 12},  {"JNTS", 36},  {"JROW", 64}, {"JIMP", 4},  {"STEP", 16},
      {"STRN", 8},  {"JERR", 4},   {"PSPD", 1},   {"RERR", 4}};
  std::size_t entry = 32, data = 32 + 32 * std::size(sizes);
  for (const auto& [name, size] : sizes) {
    EXPECT_EQ(TableEntryOf(bytes, name), entry) << name;
    EXPECT_EQ(NumberAt(bytes, entry + 4, 4), size) << name;
    EXPECT_EQ(DataOf(bytes, name), data) << name;
    data += size * NumberAt(bytes, entry + 16, 8);
    entry += 32;
  }
  EXPECT_EQ(data, bytes.size());
  const auto f64 = [&](std::size_t at) { return std::bit_cast<double>(NumberAt(bytes, at, 8)); };
  const std::size_t body = DataOf(bytes, "BODY") + 208;  // the second
  EXPECT_EQ(f64(body), recording.bodies[1].inv_mass);
  EXPECT_EQ(f64(body + 8 + 8 * 5), recording.bodies[1].inv_inertia(1, 2));
  EXPECT_EQ(f64(body + 80), recording.bodies[1].linear_factor.x());
  EXPECT_EQ(f64(body + 104), recording.bodies[1].velocity.linear.x());
  EXPECT_EQ(NumberAt(bytes, body + 200, 8), recording.bodies[1].id);
  const std::size_t row = DataOf(bytes, "ROWS");
  EXPECT_EQ(static_cast<int>(NumberAt(bytes, row, 4)), recording.rows[0].body_a);
  EXPECT_EQ(f64(row + 8), recording.rows[0].linear_a.x());
  EXPECT_EQ(f64(row + 104), recording.rows[0].target);
  EXPECT_EQ(f64(row + 120), recording.rows[0].lo);
  EXPECT_EQ(static_cast<int>(NumberAt(bytes, row + 152, 4)), recording.rows[0].parent);
  const std::size_t manifold = DataOf(bytes, "MANI");
  EXPECT_EQ(static_cast<int>(NumberAt(bytes, manifold + 16, 1)), recording.manifolds[0].points);
  const std::size_t joint = DataOf(bytes, "JNTS");
  EXPECT_EQ(static_cast<int>(NumberAt(bytes, joint + 12, 4)), recording.joints[0].rows);
  EXPECT_EQ(NumberAt(bytes, joint + 16, 4), recording.joints[0].bounded);
}

/// Of a recording without strains, and without errors that are taken back.
constexpr std::size_t kBytesOfStep = 16;

/// The file that a former version made of a recording whose last sections, so many of which that
/// version did not know, have as many bytes.
Bytes InVersion(int version, std::size_t unknown, std::size_t last_bytes, Bytes bytes) {
  const std::size_t new_entries = unknown * 32;  // entries at the end of the table
  const std::uint64_t sections = NumberAt(bytes, 12, 4) - unknown;
  bytes.resize(bytes.size() - last_bytes);
  const std::size_t end = 32 + 32 * sections;
  for (std::size_t entry = 32; entry < end; entry += 32) {
    PutNumber(NumberAt(bytes, entry + 8, 8) - new_entries, entry + 8, 8, &bytes);
  }
  const auto cut = bytes.begin() + static_cast<std::ptrdiff_t>(end);
  bytes.erase(cut, cut + static_cast<std::ptrdiff_t>(new_entries));
  PutNumber(static_cast<std::uint64_t>(version), 8, 4, &bytes);
  PutNumber(sections, 12, 4, &bytes);
  PutNumber(bytes.size(), 16, 8, &bytes);
  test::RepairChecksums(&bytes);
  return bytes;
}

TEST(Recording, OfVersion1IsRead) {
  Recording recording = RandomRecording(4);
  recording.joints.clear();
  recording.joint_rows.clear();
  recording.joint_impulses.clear();
  // joints, their rows and impulses, the step, strains, errors, speeds, errors of rows
  const Recording read = Decoded(InVersion(1, 8, kBytesOfStep, EncodeAll(recording)));
  EXPECT_TRUE(read.joints.empty());
  EXPECT_FALSE(read.settings.geometric_stiffness) << "nobody had it";
  recording.settings.geometric_stiffness = false;
  EXPECT_EQ(EncodeAll(read), EncodeAll(recording));
}

TEST(Recording, OfVersion2IsRead) {
  Recording recording = RandomRecording(5);
  const Recording read = Decoded(InVersion(2, 5, kBytesOfStep, EncodeAll(recording)));
  EXPECT_EQ(read.settings.substeps, 1);
  EXPECT_FALSE(read.settings.geometric_stiffness) << "nobody had it";
  recording.settings.geometric_stiffness = false;
  EXPECT_EQ(EncodeAll(read), EncodeAll(recording));
}

TEST(Recording, OfVersion3IsRead) {
  Recording recording = RandomRecording(5);
  recording.settings.geometric_stiffness = false;  // what is now a flag was 0
  const Recording read = Decoded(InVersion(3, 3, 0, EncodeAll(recording)));
  EXPECT_FALSE(read.settings.geometric_stiffness);
  EXPECT_EQ(EncodeAll(read), EncodeAll(recording));
}

TEST(Recording, OfVersion4IsRead) {
  const Recording recording = RandomRecording(5);
  EXPECT_EQ(EncodeAll(Decoded(InVersion(4, 3, 0, EncodeAll(recording)))), EncodeAll(recording));
}

TEST(Recording, OfVersion5IsRead) {
  const Recording recording = RandomRecording(5);
  EXPECT_EQ(EncodeAll(Decoded(InVersion(5, 1, 0, EncodeAll(recording)))), EncodeAll(recording));
}

TEST(Recording, KeepsWhatOfTargetsTakesBackErrors) {
  Recording recording = RandomRecording(6);
  recording.joint_errors.assign(recording.joint_rows.size(), 0);
  recording.joint_errors[1] = 0.75f;
  const Bytes bytes = EncodeAll(recording);
  EXPECT_EQ(std::bit_cast<float>(
                static_cast<std::uint32_t>(NumberAt(bytes, DataOf(bytes, "RERR") + 4, 4))),
            0.75f);
  const Recording read = Decoded(bytes);
  EXPECT_EQ(read.joint_errors, recording.joint_errors);
  EXPECT_EQ(read.problem().joint_errors.data(), read.joint_errors.data());
  EXPECT_EQ(EncodeAll(read), bytes);

  recording.joint_errors.pop_back();
  Bytes none;
  EXPECT_EQ(Encode(recording, &none).fault, RecordingFault::kBadValue);
}

TEST(Recording, KeepsWhichErrorsAreTakenBack) {
  Recording recording = RandomRecording(6);
  recording.settings.relax = true;
  recording.joints[1].errors = 0x80000005;
  recording.manifolds[0].speeds = 9;
  const Bytes bytes = EncodeAll(recording);
  EXPECT_EQ(NumberAt(bytes, DataOf(bytes, "STEP") + 13, 1), 1u);
  EXPECT_EQ(NumberAt(bytes, DataOf(bytes, "JERR") + 4, 4), 0x80000005u);
  EXPECT_EQ(NumberAt(bytes, DataOf(bytes, "PSPD"), 1), 9u);
  const Recording read = Decoded(bytes);
  EXPECT_TRUE(read.settings.relax);
  EXPECT_EQ(read.joints[0].errors, 0u);
  EXPECT_EQ(read.joints[1].errors, 0x80000005u);
  EXPECT_EQ(read.manifolds[0].speeds, 9);

  // no writer writes zeros alone
  Bytes zeros = bytes;
  PutNumber(0, DataOf(bytes, "JERR") + 4, 4, &zeros);
  test::RepairChecksums(&zeros);
  Recording none;
  EXPECT_EQ(Decode(zeros, &none).fault, RecordingFault::kBadValue);
}

TEST(Recording, KeepsTheStepAndWhatStrains) {
  Recording recording = RandomRecording(6);
  recording.time_step = 0.015;
  recording.settings.substeps = 3;
  recording.settings.geometric_stiffness = true;
  recording.bodies[1].strain = 7.5;
  const Bytes bytes = EncodeAll(recording);
  const std::size_t step = DataOf(bytes, "STEP"), strains = DataOf(bytes, "STRN");
  EXPECT_EQ(std::bit_cast<double>(NumberAt(bytes, step, 8)), 0.015);
  EXPECT_EQ(NumberAt(bytes, step + 8, 4), 3u);
  EXPECT_EQ(NumberAt(bytes, step + 12, 4), 1u);
  EXPECT_EQ(std::bit_cast<double>(NumberAt(bytes, strains + 8, 8)), 7.5);
  const Recording read = Decoded(bytes);
  EXPECT_EQ(read.time_step, 0.015);
  EXPECT_EQ(read.settings.substeps, 3);
  EXPECT_TRUE(read.settings.geometric_stiffness);
  EXPECT_EQ(read.bodies[1].strain, 7.5);
  EXPECT_EQ(read.bodies[0].strain, 0);
  EXPECT_EQ(EncodeAll(read), bytes);
  EXPECT_TRUE(SameBits(SolveAgain(read), SolveAgain(recording)));
}

TEST(Recording, WithSettingsOfFormerTimesIsReadAndWrittenAsWhatTookTheirPlace) {
  constexpr std::uint64_t kReverse = 2, kSymmetric = 3, kOfMatrices = 4;
  for (const std::uint64_t order : {kReverse, kSymmetric}) {
    Bytes file = EncodeAll(RandomRecording(3));
    PutNumber(kOfMatrices, DataOf(file, "SETT"), 4, &file);
    PutNumber(order, DataOf(file, "SETT") + 4, 4, &file);
    test::RepairChecksums(&file);
    const Recording read = Decoded(file);
    EXPECT_EQ(read.settings.method, Method::kPgsSm);
    EXPECT_EQ(read.settings.path, Path::kReference);
    const Bytes written = EncodeAll(read);
    EXPECT_FALSE(written == file);
    EXPECT_TRUE(EncodeAll(Decoded(written)) == written);
  }
}

TEST(Recording, IsSolvedToTheSameBitsOnEveryInstructionSet) {
  for (int seed = 0; seed < 4; ++seed) {
    Recording recording = RandomRecording(seed);
    recording.settings.step_policy = StepPolicy::kAlways;
    Bytes bytes;
    Answer recorded;
    {
      const test::AskFor scalar(simd::Target::kScalar);
      bytes = EncodeAll(recording);
      recorded = SolveAgain(recording);
    }
    EXPECT_GT(recorded.report.factorisations, 0);
    for (const simd::Target target : simd::SupportedTargets()) {
      const test::AskFor asked(target);
      EXPECT_TRUE(SameBits(SolveAgain(Decoded(bytes)), recorded)) << simd::TargetName(target);
    }
  }
}

// A frame that the clock ended on one machine is made again on another.
TEST(Recording, OfABudgetOfTimeIsMadeAgainByItsReplay) {
  Recording recording = RandomRecording(5);
  recording.settings.max_sweeps = 1 << 30;
  recording.settings.budget = Budget::Time(std::chrono::microseconds(300));
  const Answer recorded = SolveAgain(recording);
  recording.replay = recorded.report.replay;
  for (const simd::Target target : simd::SupportedTargets()) {
    const test::AskFor asked(target);
    EXPECT_TRUE(SameBits(SolveAgain(Decoded(EncodeAll(recording))), recorded));
  }
}

TEST(Recording, WithRowsWrittenOutHasTheSameSolution) {
  for (int seed = 0; seed < 6; ++seed) {
    Recording recording = RandomRecording(seed);
    recording.settings = test::PlainSweeps(30);  // in double precision, row by row
    Recording rows;
    ASSERT_EQ(WriteOutRows(recording, &rows), Status::kOk);
    EXPECT_TRUE(rows.manifolds.empty());
    EXPECT_TRUE(rows.joints.empty());
    EXPECT_EQ(rows.rows.size(), AllRows(recording.problem()));
    EXPECT_EQ(rows.row_impulses.size(), rows.rows.size());
    const Answer a = SolveAgain(recording), b = SolveAgain(rows);
    EXPECT_EQ(test::Distance(a.velocities, b.velocities), 0);
  }
  Recording bad = RandomRecording(0), untouched;
  bad.rows[0].body_a = 99;
  EXPECT_EQ(WriteOutRows(bad, &untouched), Status::kNoSuchBody);
  EXPECT_TRUE(untouched.rows.empty());
}

}  // namespace
}  // namespace cairn
