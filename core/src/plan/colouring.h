// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>

#include "cairn/contact_problem.h"
#include "cairn/detail/memory.h"
#include "plan/pairs.h"
#include "runtime/crew.h"

namespace cairn {

/// When in a sweep a pair is relaxed. Pairs of one colour share no movable body.
struct Colour {
  /// Of each kind of pair: joints, joints with the world, contacts, contacts with the world. Kinds
  /// follow each other in a sweep: what cannot give way has the last word.
  static constexpr int kOfKind = 32;
  static constexpr int kKinds = 4;
  /// Each kind begins with its overflow, pairs that have no colour: they may share bodies.
  static constexpr int kPlaces = 1 + kOfKind;
  static constexpr int kCount = kKinds * kPlaces;

  static constexpr int Overflow(int kind) { return kind * kPlaces; }
  static constexpr int First(int kind) { return Overflow(kind) + 1; }
  static constexpr int KindOf(int colour) { return colour / kPlaces; }
  static constexpr bool IsOverflow(int colour) { return colour % kPlaces == 0; }
  /// Of a colour among those of its kind, from 0 on. -1: overflow.
  static constexpr int PlaceOf(int colour) { return colour % kPlaces - 1; }
};

/// Gives every pair of bodies a colour that it keeps as long as it lives: colours change where
/// pairs begin and end, and nowhere else. A pair is known by the names of its bodies (Body::id, or
/// their place in the problem) and by being a contact or not.
class Colouring {
 public:
  /// The colour of each pair, in three parts: what several threads can do, what one can, and what
  /// nobody needs before the next time. Depends on the pairs of this and of earlier times alone:
  /// those that are known keep theirs, new ones take the lowest that is free, in their order.
  void Recognise(std::span<const Body> bodies, std::span<const Pair> pairs, Crew* crew);
  void Colour(std::span<const Pair> pairs);
  void Prepare();

  std::span<const int> colours() const { return colours_; }
  /// Whether one of its bodies has pairs of so many colours of this kind, or more.
  bool IsOfHub(const Pair& pair, int colours) const;
  /// Where each pair was in the list of the last call, -1 for those that have just begun; no place
  /// twice, even where bodies share a name.
  std::span<const int> before() const { return before_; }

 private:
  using Masks = std::uint32_t[Colour::kKinds];
  struct Name {
    std::uint64_t a, b;
    bool contact;
    friend bool operator==(const Name&, const Name&) = default;
  };
  /// A pair of the last call: its colour, kept if the pair is there again.
  struct Known {
    Name name;
    int colour;
    bool again;  ///< found in this call
  };

  Name NameOf(const Pair& pair) const;
  /// Names of pairs, and which known ones they may be, into next_ and before_.
  void RecogniseSome(std::span<const Pair> pairs, int first, int count);
  /// @param expected  where it is looked for first
  int FindKnown(const Name& name, size_t expected) const;
  void KeepKnown(std::span<const Pair> pairs);
  int Choose(const Pair& pair, int kind);
  void Occupy(const Pair& pair, int kind, int colour);

  Array<Known> known_, next_;
  Array<int> table_;  ///< open addressing into known_: place + 1, or 0
  Array<std::uint64_t> body_names_;
  Array<int> colours_, before_;
  struct BodyMasks {
    Masks used;
  };
  Array<BodyMasks> masks_;  ///< by body: colours taken
};

}  // namespace cairn
