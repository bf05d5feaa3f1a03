// SPDX-License-Identifier: MIT
#include "micro/pair_scene.h"

#include <algorithm>
#include <cmath>

#include "micro/sound.h"

namespace cairn::micro {
namespace {

using Eigen::Vector3d;
using simd::kLanes;
using simd::Line;
using simd::PairForm;
using simd::RowBound;

/// Writes the numbers of one lane, line after line.
class LaneWriter {
 public:
  LaneWriter(Line* line, int lane) : line_(line), lane_(lane) {}
  void Add(double value) { (line_++)->lane[lane_] = static_cast<float>(value); }
  void Add(const Vector3d& v) {
    for (const double value : v) Add(value);
  }

 private:
  Line* line_;
  int lane_;
};

int LinesOf(PairForm form, const std::vector<simd::RowShape>& layout) {
  int lines = simd::PairLines(form);
  for (const simd::RowShape& row : layout) lines += simd::RowLines(form, row);
  return lines;
}

void WriteRow(const RowScene& scene, const RowScene::Pair& pair, int index, LaneWriter* writer) {
  const SceneRow& row = scene.rows[pair.first_row + index];
  const SceneBody &a = scene.bodies[pair.a], &b = scene.bodies[pair.b];
  const Vector3d angular_a = a.root.transpose() * row.angular_a;
  const Vector3d angular_b = b.root.transpose() * row.angular_b;
  if (scene.form == PairForm::kContact) {
    writer->Add(std::sqrt(a.inv_mass + b.inv_mass) * row.linear);
    writer->Add(angular_a);
    writer->Add(angular_b);
  } else {
    writer->Add(std::sqrt(a.inv_mass) * row.linear);
    writer->Add(angular_a);
    if (scene.form == PairForm::kJoint) {
      writer->Add(-std::sqrt(b.inv_mass) * row.linear);
      writer->Add(angular_b);
    }
  }
  writer->Add(row.target);
  writer->Add(row.step);
  const RowBound bound = scene.layouts[pair.layout][index].bound;
  if (bound == RowBound::kOwn) writer->Add(-row.limit);
  if (bound == RowBound::kOwn || bound == RowBound::kFriction) writer->Add(row.limit);
  writer->Add(0);  // the coupling, which is filled in later
}

/// As Plan has it: they may be relaxed together.
bool Alike(const simd::PairBlock& a, const simd::PairBlock& b) {
  if (a.form != b.form || a.rows != b.rows) return false;
  std::vector<std::int32_t> bodies(a.a, a.a + kLanes);
  if (a.form != PairForm::kSingle) bodies.insert(bodies.end(), a.b, a.b + kLanes);
  const auto shared = [&bodies](std::int32_t body) {
    return std::find(bodies.begin(), bodies.end(), body) != bodies.end();
  };
  return std::none_of(b.a, b.a + kLanes, shared) &&
         (b.form == PairForm::kSingle || std::none_of(b.b, b.b + kLanes, shared));
}

}  // namespace

PairScene::PairScene(const RowScene& scene)
    : layouts_(scene.layouts), rows_(static_cast<int>(scene.rows.size())) {
  for (size_t first = 0; first < scene.pairs.size(); first += kLanes) {
    AddBlock(scene, static_cast<int>(first));
  }
  for (size_t i = 0; i < blocks_.size(); ++i) {
    const bool alike = i + 1 < blocks_.size() && Alike(blocks_[i], blocks_[i + 1]);
    runs_.push_back({static_cast<int>(i), 0, kLanes, alike, false});
  }
  bodies_.resize(scene.bodies.size());
  errors_.resize(blocks_.size());
}

void PairScene::AddBlock(const RowScene& scene, int first_pair) {
  const RowScene::Pair* const pairs = &scene.pairs[first_pair];
  const std::vector<simd::RowShape>& layout = layouts_[pairs->layout];
  simd::PairBlock block = {};
  block.rows = layout.data();
  block.row_count = static_cast<int>(layout.size());
  block.lanes = kLanes;
  block.data = static_cast<std::uint32_t>(data_.size());
  block.x = static_cast<std::uint32_t>(x_.size());
  block.form = scene.form;
  data_.resize(data_.size() + LinesOf(scene.form, layout));
  x_.resize(x_.size() + layout.size());

  for (int lane = 0; lane < kLanes; ++lane) {
    const RowScene::Pair& pair = pairs[lane];
    block.a[lane] = pair.a;
    block.b[lane] = pair.b;
    LaneWriter writer(&data_[block.data], lane);
    if (scene.form == PairForm::kContact) {
      const double a = scene.bodies[pair.a].inv_mass, b = scene.bodies[pair.b].inv_mass;
      writer.Add(std::sqrt(a / (a + b)));
      writer.Add(std::sqrt(b / (a + b)));
    }
    for (int i = 0; i < block.row_count; ++i) WriteRow(scene, pair, i, &writer);
  }
  simd::PairKernelsFor(simd::Target::kScalar).couple(block, &data_[block.data]);
  blocks_.push_back(block);
}

void PairScene::Reset() {
  std::fill(x_.begin(), x_.end(), Line{});
  std::fill(bodies_.begin(), bodies_.end(), simd::BodyLane{});
}

simd::PairWork PairScene::Work() {
  return {.blocks = blocks_.data(),
          .runs = runs_.data(),
          .run_count = static_cast<int>(runs_.size()),
          .block_count = static_cast<int>(blocks_.size()),
          .data = data_.data(),
          .x = x_.data(),
          .bodies = bodies_.data(),
          .errors = errors_.data()};
}

size_t PairScene::bytes_per_sweep() const {
  const int sides = blocks_.front().form == PairForm::kSingle ? 1 : 2;
  return (data_.size() + x_.size()) * sizeof(Line) +
         blocks_.size() * kLanes * sides * sizeof(simd::BodyLane);
}

size_t PairScene::working_set() const {
  return (data_.size() + x_.size()) * sizeof(Line) + blocks_.size() * sizeof(simd::PairBlock) +
         bodies_.size() * sizeof(simd::BodyLane);
}

std::vector<float> PairScene::Impulses() const {
  std::vector<float> impulses;
  for (const simd::PairBlock& block : blocks_) {
    for (int lane = 0; lane < block.lanes; ++lane) {
      for (int i = 0; i < block.row_count; ++i) impulses.push_back(x_[block.x + i].lane[lane]);
    }
  }
  return impulses;
}

double PairScene::MeasuredEnergy() const {
  double energy = 0;
  for (const simd::BlockError& error : errors_) {
    for (const float part : error.energy.lane) energy += part;
  }
  return energy;
}

bool PairScene::IsSound() const {
  return std::all_of(x_.begin(), x_.end(), [](const Line& line) { return AllSound(line.lane); }) &&
         std::all_of(bodies_.begin(), bodies_.end(),
                     [](const simd::BodyLane& body) { return AllSound(body.u); });
}

}  // namespace cairn::micro
