// SPDX-License-Identifier: MIT
// Colours: apart where bodies meet, kept while a pair lives, and known from the history alone.
#include "plan/colouring.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include "tests/core/support/block_problems.h"

namespace cairn {
namespace {

using Pairs = std::vector<Pair>;

Pair Between(int a, int b, simd::PairForm form) {
  Pair pair{};
  pair.a = a;
  pair.b = b;
  pair.form = form;
  pair.contact = form == simd::PairForm::kContact;
  return pair;
}
Pair Contact(int a, int b) { return Between(a, b, simd::PairForm::kContact); }
Pair Joint(int a, int b) { return Between(a, b, simd::PairForm::kJoint); }

std::vector<Body> Named(int count) {
  std::vector<Body> bodies(count);
  for (int i = 0; i < count; ++i) bodies[i].id = 1000 + static_cast<std::uint64_t>(i);
  return bodies;
}

/// All that a plan asks of it.
void Update(const std::vector<Body>& bodies, const Pairs& pairs, Crew* crew, Colouring* colouring) {
  colouring->Recognise(bodies, pairs, crew);
  colouring->Colour(pairs);
  colouring->Prepare();
}

std::vector<int> ColoursOf(Colouring* colouring, const std::vector<Body>& bodies,
                           const Pairs& pairs) {
  Crew alone(1);
  Update(bodies, pairs, &alone, colouring);
  return {colouring->colours().begin(), colouring->colours().end()};
}

std::vector<int> Ints(std::span<const int> numbers) { return {numbers.begin(), numbers.end()}; }

/// No two pairs of one colour share a body, and each colour is one of the kind of its pair.
void ExpectApart(const Pairs& pairs, const std::vector<int>& colours) {
  ASSERT_EQ(pairs.size(), colours.size());
  std::set<std::pair<int, int>> seen;
  for (size_t i = 0; i < pairs.size(); ++i) {
    if (Colour::IsOverflow(colours[i])) continue;
    const int kind = (pairs[i].contact ? 2 : 0) + (pairs[i].b == kWorld ? 1 : 0);
    EXPECT_EQ(Colour::KindOf(colours[i]), kind);
    for (int body : {pairs[i].a, pairs[i].b}) {
      if (body == kWorld) continue;
      EXPECT_TRUE(seen.emplace(colours[i], body).second) << "colour " << colours[i];
    }
  }
}

/// Pairs that begin and end at random among some bodies, each once.
class Crowd {
 public:
  Crowd(int bodies, std::uint64_t seed) : bodies_(bodies), random_(seed) {}

  const Pairs& Next() {
    std::erase_if(pairs_, [this](const Pair&) { return random_.Index(10) == 0; });
    for (int i = 0; i < bodies_ / 2; ++i) Begin();
    return pairs_;
  }

 private:
  void Begin() {
    const int a = random_.Index(bodies_), other = random_.Index(bodies_ + 1);
    const int b = other == bodies_ || other == a ? kWorld : other;
    const Pair pair = random_.Index(3) == 0 ? Joint(a, b) : Contact(a, b);
    const bool there = std::any_of(pairs_.begin(), pairs_.end(), [&pair](const Pair& p) {
      return std::minmax(p.a, p.b) == std::minmax(pair.a, pair.b) && p.contact == pair.contact;
    });
    if (there) return;
    pairs_.insert(pairs_.begin() + random_.Index(static_cast<int>(pairs_.size()) + 1), pair);
  }

  int bodies_;
  test::Random random_;
  Pairs pairs_;
};

TEST(Colours, OfAChainAreTwo) {
  Colouring colouring;
  const Pairs chain = {Contact(0, 1), Contact(1, 2), Contact(2, 3), Contact(3, 4)};
  const int first = Colour::First(2);
  EXPECT_EQ(ColoursOf(&colouring, Named(5), chain),
            (std::vector<int>{first, first + 1, first, first + 1}));
}

TEST(Colours, OfEachKindAreTheirOwnAndInTheOrderOfASweep) {
  Colouring colouring;
  const Pairs pairs = {Contact(0, kWorld), Contact(0, 1), Joint(0, kWorld), Joint(0, 1)};
  EXPECT_EQ(
      ColoursOf(&colouring, Named(2), pairs),
      (std::vector<int>{Colour::First(3), Colour::First(2), Colour::First(1), Colour::First(0)}));
}

TEST(Colours, AreApartAndKeptWhileAPairLives) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const std::vector<Body> bodies = Named(40);
    Crowd crowd(40, seed);
    Colouring colouring;
    std::map<std::tuple<int, int, bool>, int> before;
    int kept = 0;
    for (int frame = 0; frame < 200; ++frame) {
      const Pairs& pairs = crowd.Next();
      const std::vector<int> colours = ColoursOf(&colouring, bodies, pairs);
      ExpectApart(pairs, colours);
      std::map<std::tuple<int, int, bool>, int> now;
      for (size_t i = 0; i < pairs.size(); ++i) {
        const std::tuple name(pairs[i].a, pairs[i].b, pairs[i].contact);
        now[name] = colours[i];
        EXPECT_FALSE(Colour::IsOverflow(colours[i]));
        if (before.count(name) == 0) continue;
        EXPECT_EQ(before[name], colours[i]) << "frame " << frame;
        ++kept;
      }
      before = std::move(now);
    }
    EXPECT_GT(kept, 10000);
  }
}

TEST(Colours, DependOnTheHistoryAlone) {
  Crowd first(30, 7), second(30, 7);
  const std::vector<Body> bodies = Named(30);
  Colouring a, b;
  for (int frame = 0; frame < 50; ++frame) {
    EXPECT_EQ(ColoursOf(&a, bodies, first.Next()), ColoursOf(&b, bodies, second.Next()));
  }
}

// A pair that goes for one frame is new when it comes back, and takes the lowest colour.
TEST(Colours, AreForgottenWhenAPairEnds) {
  const std::vector<Body> bodies = Named(3);
  Colouring colouring;
  EXPECT_EQ(ColoursOf(&colouring, bodies, {Contact(0, 1), Contact(1, 2)}).back(),
            Colour::First(2) + 1);
  EXPECT_EQ(ColoursOf(&colouring, bodies, {Contact(1, 2)}).back(), Colour::First(2) + 1);
  EXPECT_EQ(ColoursOf(&colouring, bodies, {}).size(), 0u);
  EXPECT_EQ(ColoursOf(&colouring, bodies, {Contact(1, 2)}).back(), Colour::First(2));
}

TEST(Colours, BeyondThirtyTwoAreTheOverflowUntilOneIsFree) {
  const std::vector<Body> bodies = Named(41);
  Pairs star;
  for (int i = 1; i <= 40; ++i) star.push_back(Contact(i, 0));
  Colouring colouring;
  std::vector<int> colours = ColoursOf(&colouring, bodies, star);
  for (int i = 0; i < 40; ++i) {
    EXPECT_EQ(colours[i], i < 32 ? Colour::First(2) + i : Colour::Overflow(2));
  }
  star.erase(star.begin() + 5);
  colours = ColoursOf(&colouring, bodies, star);
  ExpectApart(star, colours);
  EXPECT_EQ(std::ranges::count(colours, Colour::Overflow(2)), 7);
  EXPECT_EQ(colours[31], Colour::First(2) + 5) << "the first that waited";
}

TEST(Colours, OfManyMakeABodyAHub) {
  const std::vector<Body> bodies = Named(41);
  Pairs star;
  for (int i = 1; i <= 20; ++i) star.push_back(Contact(i, 0));
  star.push_back(Contact(1, 2));
  star.push_back(Joint(1, 0));
  Colouring colouring;
  (void)ColoursOf(&colouring, bodies, star);
  EXPECT_TRUE(colouring.IsOfHub(star[0], 20));
  EXPECT_FALSE(colouring.IsOfHub(star[0], 21));
  EXPECT_FALSE(colouring.IsOfHub(star[20], 3)) << "its bodies have two each";
  EXPECT_FALSE(colouring.IsOfHub(star[21], 2)) << "of joints there is one";
}

TEST(Colours, FollowTheNamesOfBodiesWhenTheyAreRenumbered) {
  const std::vector<Body> bodies = Named(30);
  Crowd crowd(30, 3);
  Colouring colouring;
  for (int frame = 0; frame < 10; ++frame) (void)ColoursOf(&colouring, bodies, crowd.Next());
  const Pairs pairs = crowd.Next();
  const std::vector<int> colours = ColoursOf(&colouring, bodies, pairs);

  // body i becomes body 29 - i, a pair is named from its other end, the last one comes first
  std::vector<Body> turned(bodies.rbegin(), bodies.rend());
  Pairs renumbered;
  for (Pair pair : pairs) {
    pair.a = 29 - pair.a;
    if (pair.b != kWorld) pair.b = 29 - pair.b;
    if (pair.b != kWorld) std::swap(pair.a, pair.b);
    renumbered.insert(renumbered.begin(), pair);
  }
  std::vector<int> again = ColoursOf(&colouring, turned, renumbered);
  std::reverse(again.begin(), again.end());
  EXPECT_EQ(colours, again);
}

// Names that lie make colours change, but never let two pairs of a colour meet.
TEST(Colours, AreApartWhateverBodiesAreCalled) {
  const std::uint64_t unnamed = std::uint64_t{1} << 63;
  test::Random random(5);
  Crowd crowd(20, 11);
  Colouring colouring;
  for (int frame = 0; frame < 200; ++frame) {
    std::vector<Body> bodies(20);
    for (Body& body : bodies) {
      const auto name = static_cast<std::uint64_t>(random.Index(6));
      body.id = name < 3 ? name : unnamed + name;
    }
    const Pairs& pairs = crowd.Next();
    ExpectApart(pairs, ColoursOf(&colouring, bodies, pairs));
  }
}

TEST(Colours, OfBodiesWithoutNamesGoByTheirPlace) {
  const std::vector<Body> bodies(3);
  Colouring colouring;
  (void)ColoursOf(&colouring, bodies, {Contact(0, 1), Contact(1, 2)});
  EXPECT_EQ(ColoursOf(&colouring, bodies, {Contact(2, 1)}).back(), Colour::First(2) + 1);
}

TEST(Colouring, SaysWhereEachPairWasBefore) {
  const std::vector<Body> bodies = Named(6);
  Colouring colouring;
  Crew alone(1);
  Update(bodies, {Contact(0, 1), Contact(1, 2), Joint(1, 2), Contact(3, kWorld)}, &alone,
         &colouring);
  EXPECT_EQ(std::vector<int>(4, -1), Ints(colouring.before()));
  Update(bodies, {Contact(3, kWorld), Contact(4, 5), Contact(2, 1), Joint(1, 2)}, &alone,
         &colouring);
  EXPECT_EQ((std::vector<int>{3, -1, 1, 2}), Ints(colouring.before()));
}

// One after the other: each where it is expected, behind the last that was found, or the first of
// its name, if nobody was found there. More pairs than one thread looks at at a time.
TEST(Colouring, FindsPairsThatShareANameInTheOrderOfTheList) {
  std::mt19937 random(5);
  const auto below = [&random](int most) { return static_cast<int>(random() % most); };
  std::vector<Body> bodies(600);
  for (size_t i = 0; i < bodies.size(); ++i) bodies[i].id = 1 + i / 3;
  Pairs pairs;
  while (pairs.size() < 9000) pairs.push_back(Contact(below(600), kWorld));
  const auto name = [&bodies](const Pair& pair) { return bodies[pair.a].id; };
  Colouring colouring;
  Crew crew(3);
  Pairs last;
  for (int call = 0; call < 12; ++call) {
    std::vector<int> expected;
    std::vector<char> found(last.size());
    size_t next = 0;
    for (const Pair& pair : pairs) {
      const bool there = next < last.size() && name(last[next]) == name(pair);
      const auto first = std::find_if(last.begin(), last.end(),
                                      [&](const Pair& known) { return name(known) == name(pair); });
      const size_t at = there ? next : static_cast<size_t>(first - last.begin());
      if (at == last.size() || std::exchange(found[at], 1) != 0) {
        expected.push_back(-1);
        continue;
      }
      expected.push_back(static_cast<int>(at));
      next = at + 1;
    }
    Update(bodies, pairs, &crew, &colouring);
    EXPECT_EQ(Ints(colouring.before()), expected) << call;
    last = pairs;
    for (int event = 0; event < 30; ++event) {
      pairs.erase(pairs.begin() + below(static_cast<int>(pairs.size())));
      pairs.insert(pairs.begin() + below(static_cast<int>(pairs.size())),
                   Contact(below(600), kWorld));
    }
  }
}

TEST(Colouring, FindsAPlaceOnceEvenWhereBodiesShareAName) {
  std::vector<Body> bodies = Named(4);
  bodies[2].id = bodies[0].id;
  const Pairs pairs = {Contact(0, 1), Contact(2, 1), Contact(0, 3), Contact(2, 3)};
  Colouring colouring;
  for (int call = 0; call < 3; ++call) {
    const std::vector<int> colours = ColoursOf(&colouring, bodies, pairs);
    ExpectApart(pairs, colours);
    std::vector<int> before = Ints(colouring.before());
    std::erase(before, -1);
    std::sort(before.begin(), before.end());
    EXPECT_EQ(std::adjacent_find(before.begin(), before.end()), before.end());
  }
}

}  // namespace
}  // namespace cairn
