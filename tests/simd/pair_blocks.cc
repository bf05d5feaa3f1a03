// SPDX-License-Identifier: MIT
#include "pair_blocks.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include "simd/pairs/pair_reference.h"

namespace cairn::simd::test {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

// Lines of no block before and behind those of the blocks: offsets that are not 0, and something to
// hit for a kernel that goes too far.
constexpr int kMargin = 3;

bool IsFriction(RowBound bound) {
  return bound == RowBound::kFriction || bound == RowBound::kCutFriction;
}

void SetLane(Line* lines, int count, int lane, float value) {
  for (int i = 0; i < count; ++i) lines[i].lane[lane] = value;
}

int DataLines(const BlockSpec& spec) {
  int lines = PairLines(spec.form);
  for (const RowShape& row : spec.rows) lines += RowLines(spec.form, row);
  return lines;
}

void ShuffleBodies(Random* random, PairScene* scene) {
  std::vector<std::int32_t> slots(scene->bodies.size() - 1);
  bool like_last = false;
  for (std::size_t b = 0; b < scene->blocks.size(); ++b) {
    PairBlock& block = scene->blocks[b];
    // blocks that are alike share no body
    const int first = like_last ? 2 * kLanes : 0;
    if (!like_last) {
      std::iota(slots.begin(), slots.end(), 1);
      for (std::size_t i = slots.size() - 1; i > 0; --i) {
        std::swap(slots[i], slots[random->Index(static_cast<int>(i) + 1)]);
      }
    }
    for (int lane = 0; lane < block.lanes; ++lane) {
      block.a[lane] = slots[first + 2 * lane];
      block.b[lane] = block.form == PairForm::kSingle ? 0 : slots[first + 2 * lane + 1];
    }
    like_last = scene->runs[b].like_next;
  }
}

std::vector<char> NamedBodies(const PairScene& scene) {
  std::vector<char> named(scene.bodies.size(), 0);
  named[0] = 1;
  for (const PairBlock& block : scene.blocks) {
    for (int lane = 0; lane < block.lanes; ++lane) {
      named[block.a[lane]] = named[block.b[lane]] = 1;
    }
  }
  return named;
}

void FillBodies(float unused, Random* random, PairScene* scene) {
  const std::vector<char> named = NamedBodies(*scene);
  for (std::size_t i = 1; i < named.size(); ++i) {
    for (int k = 0; k < 8; ++k) {
      const float number = k % 4 == 3 ? 0 : random->Uniform(-1, 1);
      scene->bodies[i].u[k] = named[i] ? number : unused;
    }
  }
}

void FillBounds(RowBound bound, int lane, Random* random, Line* lines) {
  if (IsFriction(bound)) (lines++)->lane[lane] = random->Uniform(0, 1);
  if (bound != RowBound::kOwn && bound != RowBound::kCutFriction) return;
  const float lo = random->Uniform(-1, 0.2f), width = random->Uniform(0, 1);
  const int kind = random->Index(6);  // 0, 1: without an end; 2: without any width
  lines[0].lane[lane] = kind == 0 ? -kInfinity : lo;
  lines[1].lane[lane] = kind == 1 ? kInfinity : kind == 2 ? lo : lo + width;
}

void FillRow(int block, int index, int lane, Random* random, PairScene* scene) {
  const PairForm form = scene->blocks[block].form;
  const RowShape& row = scene->shapes[block][index];
  const RowView view = scene->View(block, index);

  // lines of three numbers in the order of PairForm; a row that only turns has no linear ones
  float d = 0;
  for (int i = 0; i < JacobianLines(form); ++i) {
    const bool linear = i / 3 == 0 || (form == PairForm::kJoint && i / 3 == 2);
    const float g = row.angular && linear ? 0 : random->Signed();
    view.g[i].lane[lane] = g;
    d += g * g;
  }
  if (row.soft) {
    const float compliance = random->Uniform(0, 1);
    view.compliance->lane[lane] = compliance;
    d += compliance;
  }
  view.target->lane[lane] = random->Uniform(-1, 1);
  float relaxation = 1;
  if (row.relaxed) relaxation = view.relaxation->lane[lane] = random->Uniform(0.5f, 1.5f);
  view.step->lane[lane] = relaxation / d;
  if (view.bounds) FillBounds(row.bound, lane, random, view.bounds);
  const float x = random->Uniform(-0.5f, 1);
  scene->X(block, index, lane) = random->Index(3) ? x : 0;
}

testing::AssertionResult SameFloats(const float* a, const float* b, int count) {
  if (std::memcmp(a, b, count * sizeof(float)) == 0) return testing::AssertionSuccess();
  testing::AssertionResult failure = testing::AssertionFailure();
  for (int i = 0; i < count; ++i) {
    if (std::memcmp(a + i, b + i, sizeof(float)) != 0) {
      failure << "\n  [" << i << "] " << a[i] << " and " << b[i];
    }
  }
  return failure;
}

}  // namespace

void PairScene::Couple(const PairKernels& kernels) {
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    blocks[i].rows = shapes[i].data();
    kernels.couple(blocks[i], PairOf(static_cast<int>(i)));
  }
}

void PairScene::Run(PairKernels::Kernel kernel) {
  Couple(ReferencePairKernels());
  PairWork work;
  work.blocks = blocks.data();
  work.runs = runs.data();
  work.run_count = static_cast<int>(runs.size());
  work.block_count = static_cast<int>(blocks.size());
  work.data = data.data();
  work.x = x.data();
  work.bodies = bodies.data();
  work.copies = copies.data();
  work.d_ratios = d_ratios.data();
  work.first_copy = static_cast<int>(bodies.size() - copies.size());
  work.errors = errors.data();
  work.sweep = sweep;
  work.hold_lifted = hold_lifted;
  kernel(work);
}

RowView PairScene::View(int block, int row) {
  const PairForm form = blocks[block].form;
  const std::vector<RowShape>& rows = shapes[block];
  Line* line = PairOf(block) + PairLines(form);
  for (int i = 0; i < row; ++i) line += RowLines(form, rows[i]);

  RowView view = {.g = line};
  line += JacobianLines(form);
  view.target = line++;
  view.step = line++;
  if (rows[row].soft) view.compliance = line++;
  if (rows[row].relaxed) view.relaxation = line++;
  if (BoundLines(rows[row].bound) > 0) view.bounds = line;
  view.coupling = view.g + CouplingLine(form, rows[row]);
  return view;
}

PairScene ZeroScene(const SceneSpec& spec) {
  PairScene scene;
  std::uint32_t data = kMargin, x = kMargin;
  for (const BlockSpec& from : spec.blocks) {
    PairBlock block = {};
    for (int lane = 0; lane < from.lanes; ++lane) {
      block.a[lane] = 2 * lane + 1;
      block.b[lane] = from.form == PairForm::kSingle ? 0 : 2 * lane + 2;
    }
    block.row_count = static_cast<std::int32_t>(from.rows.size());
    block.lanes = from.lanes;
    block.data = data;
    block.x = x;
    block.form = from.form;
    const auto index = static_cast<std::int32_t>(scene.blocks.size());
    scene.runs.push_back({index, 0, static_cast<std::int16_t>(from.lanes), from.like_next, false});
    scene.blocks.push_back(block);
    scene.shapes.push_back(from.rows);
    data += DataLines(from);
    x += block.row_count;
  }

  Line filler;
  std::fill(filler.lane, filler.lane + kLanes, spec.unused);
  scene.data.assign(data + kMargin, filler);
  scene.x.assign(x + kMargin, filler);
  for (const PairBlock& block : scene.blocks) {
    const BlockSpec& from = spec.blocks[&block - scene.blocks.data()];
    for (int lane = 0; lane < block.lanes; ++lane) {
      SetLane(&scene.data[block.data], DataLines(from), lane, 0);
      SetLane(&scene.x[block.x], block.row_count, lane, 0);
    }
  }
  scene.bodies.assign(spec.bodies + 1, BodyLane{});
  // what no pass leaves behind: errors count as never negative
  BlockError error;
  for (Line* line : {&error.max, &error.max_angular, &error.energy}) {
    std::fill(line->lane, line->lane + kLanes, -1.0f);
  }
  scene.errors.assign(scene.blocks.size(), error);
  return scene;
}

PairScene RandomScene(const SceneSpec& spec) {
  PairScene scene = ZeroScene(spec);
  Random random(spec.seed);
  ShuffleBodies(&random, &scene);
  FillBodies(spec.unused, &random, &scene);
  for (std::size_t i = 0; i < scene.blocks.size(); ++i) {
    const int block = static_cast<int>(i);
    for (int lane = 0; lane < scene.blocks[i].lanes; ++lane) {
      if (scene.blocks[i].form == PairForm::kContact) {
        const float s_a = random.Uniform(0.3f, 1.5f), s_b = random.Uniform(0.3f, 1.5f);
        const float r = std::sqrt(s_a * s_a + s_b * s_b);
        scene.PairOf(block)[0].lane[lane] = s_a / r;
        scene.PairOf(block)[1].lane[lane] = s_b / r;
      }
      for (int row = 0; row < scene.blocks[i].row_count; ++row) {
        FillRow(block, row, lane, &random, &scene);
      }
    }
  }
  return scene;
}

void CutRuns(unsigned seed, PairScene* scene) {
  Random random(seed);
  const auto bodies = static_cast<int>(scene->bodies.size());
  scene->runs.clear();
  std::vector<std::vector<LaneRun>> of_blocks(scene->blocks.size());
  for (std::size_t b = 0; b < scene->blocks.size(); ++b) {
    PairBlock& block = scene->blocks[b];
    for (int first = 0; first < block.lanes;) {
      const int left = std::min(block.lanes - first, 8);
      int lanes = 1 + random.Index(left);
      if (first + WidthOf(lanes) > kLanes) lanes = 1 + random.Index(std::min(left, 4));
      if (first + WidthOf(lanes) > kLanes) break;
      of_blocks[b].push_back({static_cast<std::int32_t>(b), static_cast<std::int16_t>(first),
                              static_cast<std::int16_t>(lanes), false, false});
      first += lanes;
    }
    // what no run took is not used
    block.lanes = of_blocks[b].back().first + of_blocks[b].back().lanes;
    for (const LaneRun& run : of_blocks[b]) {
      // any bodies, none twice
      const int from = 1 + random.Index(bodies - 2 * run.lanes);
      for (int lane = 0; lane < run.lanes; ++lane) {
        block.a[run.first + lane] = from + 2 * lane;
        if (block.form != PairForm::kSingle) block.b[run.first + lane] = from + 2 * lane + 1;
      }
    }
    for (int lane = block.lanes; lane < kLanes; ++lane) block.a[lane] = block.b[lane] = 0;
  }
  // runs of a block in their order, those of others in between
  for (bool any = true; any;) {
    any = false;
    for (std::vector<LaneRun>& runs : of_blocks) {
      if (runs.empty()) continue;
      any = true;
      if (random.Index(3) == 0) continue;
      scene->runs.push_back(runs.front());
      runs.erase(runs.begin());
    }
  }
}

void ShareBodies(unsigned seed, PairScene* scene) {
  Random random(seed);
  const auto bodies = static_cast<std::int32_t>(scene->bodies.size());
  for (LaneRun& run : scene->runs) {
    PairBlock& block = scene->blocks[run.block];
    if (run.lanes < 2 || random.Index(3) == 0) continue;
    // a body of no lane of the run, and how many lanes have it on one side or the other
    std::vector<char> named(scene->bodies.size(), 0);
    for (int lane = run.first; lane < run.first + run.lanes; ++lane) {
      named[block.a[lane]] = named[block.b[lane]] = 1;
    }
    const auto hub = static_cast<std::int32_t>(
        std::find(named.begin() + 1, named.begin() + bodies, 0) - named.begin());
    if (hub == bodies) continue;
    const int sharers = 2 + random.Index(run.lanes - 1);
    for (int lane = run.first; lane < run.first + sharers; ++lane) {
      const bool second = block.form != PairForm::kSingle && random.Index(2) == 0;
      (second ? block.b : block.a)[lane] = static_cast<std::int32_t>(scene->bodies.size());
      scene->copies.push_back({hub, ShareOfBody(sharers)});
      scene->bodies.push_back({});
    }
    run.copies = block.copies = true;
  }
  for (PairBlock& block : scene->blocks) {
    if (!block.copies) continue;
    block.d_ratios = static_cast<std::uint32_t>(scene->d_ratios.size());
    for (int i = 0; i < block.row_count; ++i) {
      Line& ratio = scene->d_ratios.emplace_back();
      for (float& of_lane : ratio.lane) of_lane = random.Uniform(1, 16);
    }
  }
}

std::vector<RowShape> Manifold(const ManifoldSpec& spec) {
  std::vector<RowShape> rows;
  for (int point = 0; point < spec.points; ++point) {
    rows.push_back({.bound = RowBound::kPush, .relaxed = spec.relaxed});
  }
  for (int point = 0; point < spec.points; ++point) {
    for (int i = 0; i < spec.friction_rows + spec.rolling_rows; ++i) {
      rows.push_back({.bound = RowBound::kFriction,
                      .relaxed = spec.relaxed,
                      .angular = i >= spec.friction_rows,
                      .parent = static_cast<std::int16_t>(point)});
    }
  }
  return rows;
}

std::vector<RowShape> RandomRows(int most, Random* random) {
  constexpr RowBound kBounds[] = {RowBound::kFree, RowBound::kPush, RowBound::kOwn,
                                  RowBound::kFriction, RowBound::kCutFriction};
  std::vector<RowShape> rows(1 + random->Index(most));
  int first_friction = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    RowShape& row = rows[i];
    row.bound = kBounds[random->Index(i == 0 ? 3 : 5)];
    row.soft = random->Index(3) == 0;
    row.angular = random->Index(3) == 0;
    row.relaxed = random->Index(3) == 0;
    if (random->Index(4) == 0) row.max_sweeps = 1 + random->Index(3);
    if (IsFriction(row.bound)) {
      row.parent = static_cast<std::int16_t>(random->Index(first_friction));
    } else if (first_friction == static_cast<int>(i)) {
      ++first_friction;
    }
  }
  return rows;
}

SceneSpec RandomSpec(unsigned seed) {
  constexpr PairForm kForms[] = {PairForm::kJoint, PairForm::kContact, PairForm::kSingle};
  Random random(seed);
  SceneSpec spec;
  spec.seed = seed;
  spec.bodies = 2 * kLanes + random.Index(30);
  spec.blocks.resize(1 + random.Index(6));
  for (BlockSpec& block : spec.blocks) {
    block.form = kForms[random.Index(3)];
    block.rows = RandomRows(20, &random);
    block.lanes = 1 + random.Index(kLanes);
  }
  return spec;
}

testing::AssertionResult SameBits(const PairScene& a, const PairScene& b) {
  for (std::size_t i = 0; i < a.blocks.size(); ++i) {
    const PairBlock& block = a.blocks[i];
    for (int row = 0; row < block.row_count; ++row) {
      const testing::AssertionResult same =
          SameFloats(a.x[block.x + row].lane, b.x[block.x + row].lane, block.lanes);
      if (!same)
        return testing::AssertionFailure()
               << "x of block " << i << " row " << row << same.message();
    }
    const Line BlockError::*const kParts[] = {&BlockError::max, &BlockError::max_angular,
                                              &BlockError::energy};
    for (const auto part : kParts) {
      const testing::AssertionResult same =
          SameFloats((a.errors[i].*part).lane, (b.errors[i].*part).lane, block.lanes);
      if (!same) return testing::AssertionFailure() << "errors of block " << i << same.message();
    }
  }
  for (std::size_t i = 0; i < a.bodies.size(); ++i) {
    const testing::AssertionResult same = SameFloats(a.bodies[i].u, b.bodies[i].u, 8);
    if (!same) return testing::AssertionFailure() << "body " << i << same.message();
  }
  return testing::AssertionSuccess();
}

testing::AssertionResult IsFinite(const PairScene& scene) {
  for (const PairBlock& block : scene.blocks) {
    for (int row = 0; row < block.row_count; ++row) {
      for (int lane = 0; lane < block.lanes; ++lane) {
        if (std::isfinite(scene.x[block.x + row].lane[lane])) continue;
        return testing::AssertionFailure() << "row " << row << " lane " << lane;
      }
    }
  }
  for (const BodyLane& body : scene.bodies) {
    if (!std::all_of(body.u, body.u + 8, [](float u) { return std::isfinite(u); })) {
      return testing::AssertionFailure() << "body " << &body - scene.bodies.data();
    }
  }
  return testing::AssertionSuccess();
}

}  // namespace cairn::simd::test
