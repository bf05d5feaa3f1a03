// SPDX-License-Identifier: MIT
#include "plan/colouring.h"

#include <bit>
#include <utility>

#include "problem/body_name.h"
#include "runtime/in_parts.h"

namespace cairn {
namespace {

/// Colours of joints and of contacts, and of those with the world, are apart.
int ColourKindOf(const Pair& pair) { return (pair.contact ? 2 : 0) + (pair.b == kWorld ? 1 : 0); }

std::uint64_t HashOf(std::uint64_t a, std::uint64_t b, bool contact) {
  const std::uint64_t mixed = (a * 0x9e3779b97f4a7c15u) ^ ((b + contact) * 0xc2b2ae3d27d4eb4fu);
  return mixed ^ (mixed >> 31);
}

}  // namespace

Colouring::Name Colouring::NameOf(const Pair& pair) const {
  const auto name = [this](int body) { return body == kWorld ? 0 : body_names_[body]; };
  const std::uint64_t a = name(pair.a), b = name(pair.b);
  return a > b ? Name{a, b, pair.contact} : Name{b, a, pair.contact};
}

int Colouring::FindKnown(const Name& name, size_t expected) const {
  // pairs mostly come in the order of the last call
  if (expected < known_.size() && known_[expected].name == name) return static_cast<int>(expected);
  const size_t mask = table_.size() - 1;
  for (size_t at = HashOf(name.a, name.b, name.contact) & mask;; at = (at + 1) & mask) {
    if (table_[at] == 0) return -1;
    if (known_[table_[at] - 1].name == name) return table_[at] - 1;
  }
}

void Colouring::Prepare() {
  size_t capacity = 64;
  while (capacity < 2 * known_.size()) capacity *= 2;
  table_.assign(capacity, 0);
  for (size_t i = 0; i < known_.size(); ++i) {
    const Name& name = known_[i].name;
    size_t at = HashOf(name.a, name.b, name.contact) & (capacity - 1);
    while (table_[at] != 0 && known_[table_[at] - 1].name != name) at = (at + 1) & (capacity - 1);
    // the first of those with one name is found; all pairs that nobody moves have one
    if (table_[at] == 0) table_[at] = static_cast<int>(i) + 1;
  }
}

int Colouring::Choose(const Pair& pair, int kind) {
  std::uint32_t taken = pair.a == kWorld ? 0 : masks_[pair.a].used[kind];
  if (pair.b != kWorld) taken |= masks_[pair.b].used[kind];
  const int lowest = std::countr_one(taken);
  return lowest < Colour::kOfKind ? Colour::First(kind) + lowest : Colour::Overflow(kind);
}

void Colouring::Occupy(const Pair& pair, int kind, int colour) {
  if (Colour::IsOverflow(colour)) return;
  const std::uint32_t bit = std::uint32_t{1} << Colour::PlaceOf(colour);
  if (pair.a != kWorld) masks_[pair.a].used[kind] |= bit;
  if (pair.b != kWorld) masks_[pair.b].used[kind] |= bit;
}

bool Colouring::IsOfHub(const Pair& pair, int colours) const {
  const int kind = ColourKindOf(pair);
  const auto is_hub = [&](int body) {
    return body != kWorld && std::popcount(masks_[body].used[kind]) >= colours;
  };
  return is_hub(pair.a) || is_hub(pair.b);
}

void Colouring::Recognise(std::span<const Body> bodies, std::span<const Pair> pairs, Crew* crew) {
  body_names_.resize(bodies.size());
  for (size_t i = 0; i < bodies.size(); ++i) {
    body_names_[i] = BodyNameOf(bodies[i], static_cast<int>(i));
  }
  masks_.assign(bodies.size(), {});
  colours_.resize(pairs.size());
  before_.resize(pairs.size());
  next_.resize(pairs.size());
  if (table_.empty()) Prepare();
  InParts(static_cast<int>(pairs.size()), kPairsOfPart, crew,
          [&](int first, int count) { RecogniseSome(pairs, first, count); });
}

void Colouring::RecogniseSome(std::span<const Pair> pairs, int first, int count) {
  // as if the pair before had just been found
  const int last = first > 0 ? FindKnown(NameOf(pairs[first - 1]), first - 1) : -1;
  size_t expected = last >= 0 ? static_cast<size_t>(last) + 1 : first;
  for (int i = first; i < first + count; ++i) {
    next_[i] = {NameOf(pairs[i]), -1, false};
    before_[i] = FindKnown(next_[i].name, expected);
    if (before_[i] >= 0) expected = static_cast<size_t>(before_[i]) + 1;
  }
}

void Colouring::Colour(std::span<const Pair> pairs) {
  KeepKnown(pairs);
  // the new ones
  for (size_t i = 0; i < pairs.size(); ++i) {
    const int kind = ColourKindOf(pairs[i]);
    if (colours_[i] < 0) {
      colours_[i] = Choose(pairs[i], kind);
      Occupy(pairs[i], kind, colours_[i]);
    }
    next_[i].colour = colours_[i];
  }
  known_.swap(next_);
}

void Colouring::KeepKnown(std::span<const Pair> pairs) {
  size_t expected = 0;
  for (size_t i = 0; i < pairs.size(); ++i) {
    colours_[i] = -1;
    int known = before_[i];
    // of some that share a name, the one behind the last that was found
    if (known >= 0 && known != static_cast<int>(expected)) {
      known = FindKnown(next_[i].name, expected);
    }
    before_[i] = -1;
    if (known < 0 || std::exchange(known_[known].again, true)) continue;
    before_[i] = known;
    expected = static_cast<size_t>(known) + 1;
    // unless two bodies swapped names, or can no longer move
    const int kind = ColourKindOf(pairs[i]), colour = known_[known].colour;
    if (Colour::IsOverflow(colour) || Colour::KindOf(colour) != kind) continue;
    const std::uint32_t bit = std::uint32_t{1} << Colour::PlaceOf(colour);
    const auto taken = [&](int body) { return body != kWorld && masks_[body].used[kind] & bit; };
    if (taken(pairs[i].a) || taken(pairs[i].b)) continue;
    colours_[i] = colour;
    Occupy(pairs[i], kind, colour);
  }
}

}  // namespace cairn
