// SPDX-License-Identifier: MIT
#include "micro/links.h"

#include <algorithm>

#include "scenes/random.h"
#include "simd/pairs/pair_block.h"

namespace cairn::micro {
namespace {

constexpr int kChain = 17;  // bodies of a chain

using Block = std::vector<Link>;

/// Boxes on a lattice, and the links that each has with those before it.
class Lattice {
 public:
  Lattice(SceneKind kind, int size) : kind_(kind) {
    sides_ = kind == SceneKind::kJoint ? Eigen::Vector3i(kChain, size, size)
                                       : Eigen::Vector3i(size, size, size);
  }

  Eigen::Vector3i Cell(int body) const {
    const int i = body - 1, plane = sides_.x() * sides_.y();
    return {i % sides_.x(), i % plane / sides_.x(), i / plane};
  }

  std::vector<Link> Links() const {
    bench::Random random(1);
    std::vector<Link> links;
    const int axes = kind_ == SceneKind::kJoint ? 1 : 3;
    const Eigen::Vector3i strides(1, sides_.x(), sides_.x() * sides_.y());
    for (int body = 1; body <= sides_.prod(); ++body) {
      for (int axis = 0; axis < axes; ++axis) {
        const int layout = kind_ == SceneKind::kMixedContact ? random.Bits() % 4 : 0;
        if (kind_ == SceneKind::kStaticContact) {
          links.push_back({body, 0, axis, layout});
        } else if (Cell(body)[axis] > 0) {
          links.push_back({body - strides[axis], body, axis, layout});
        }
      }
    }
    std::stable_sort(links.begin(), links.end(),
                     [this](const Link& a, const Link& b) { return ColourOf(a) < ColourOf(b); });
    return links;
  }

 private:
  /// Links of one colour share no body.
  int ColourOf(const Link& link) const {
    if (kind_ == SceneKind::kStaticContact) return link.axis;
    return 2 * link.axis + Cell(link.b)[link.axis] % 2;
  }

  SceneKind kind_;
  Eigen::Vector3i sides_;
};

bool Fits(const Block& block, const Link& link) {
  return block.front().layout == link.layout &&
         std::none_of(block.begin(), block.end(), [&](const Link& other) {
           return link.a == other.a || link.a == other.b || link.b == other.a ||
                  (link.b == other.b && link.b != 0);
         });
}

/// The links of full blocks, a block after the other as they get full.
std::vector<Link> FillBlocks(const std::vector<Link>& links, size_t count) {
  std::vector<Link> filled;
  std::vector<Block> open;
  for (const Link& link : links) {
    if (filled.size() == count) break;
    const auto block = std::find_if(open.begin(), open.end(),
                                    [&](const Block& candidate) { return Fits(candidate, link); });
    if (block == open.end()) {
      open.push_back({link});
      continue;
    }
    block->push_back(link);
    if (block->size() < simd::kLanes) continue;
    filled.insert(filled.end(), block->begin(), block->end());
    open.erase(block);
  }
  return filled;
}

}  // namespace

LinkedBodies MakeLinks(SceneKind kind, int count) {
  LinkedBodies result;
  int size = 1;
  while (result.links.size() < static_cast<size_t>(count)) {
    result.links = FillBlocks(Lattice(kind, ++size).Links(), count);
  }

  const Lattice lattice(kind, size);
  result.cells = {Eigen::Vector3i::Zero()};
  std::vector<int> number;
  const auto renumber = [&](int* body) {
    if (*body == 0) return;
    if (number.size() <= static_cast<size_t>(*body)) number.resize(*body + 1, 0);
    int& known = number[*body];
    if (known == 0) {
      known = static_cast<int>(result.cells.size());
      result.cells.push_back(lattice.Cell(*body));
    }
    *body = known;
  };
  for (Link& link : result.links) {
    renumber(&link.a);
    renumber(&link.b);
  }
  return result;
}

}  // namespace cairn::micro
