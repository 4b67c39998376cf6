#include "scintray/core/id.hpp"

#include <doctest/doctest.h>

#include <cstring>
#include <string>
#include <type_traits>
#include <unordered_set>

#include "scintray/core/id_vector.hpp"
#include "scintray/core/ids.hpp"

using namespace scintray::core;

namespace {

using Colour = Id<struct ColourTag>;
using Shape = Id<struct ShapeTag>;

}  // namespace

TEST_CASE("An id is 32 bits of plain data, and mixes with no integer and no id of another kind") {
  static_assert(sizeof(Colour) == 4 && std::is_trivially_copyable_v<Colour>);
  static_assert(!std::is_convertible_v<std::uint32_t, Colour> && !std::is_convertible_v<int, Colour>);
  static_assert(!std::is_convertible_v<Colour, std::uint32_t> && !std::is_convertible_v<Colour, bool>);
  static_assert(std::is_constructible_v<Colour, std::uint32_t> && std::is_constructible_v<Colour, int>);
  static_assert(!std::is_constructible_v<Colour, double>);
  static_assert(!std::is_constructible_v<Colour, Shape> && !std::is_convertible_v<Colour, Shape>);
  static_assert(!std::is_same_v<PartId, RegionId> && !std::is_constructible_v<PartId, RegionId>);
  static_assert(Colour(std::size_t{7}).index() == 7);
}

TEST_CASE("An id is none until it is given an index") {
  const Colour unset;
  CHECK_FALSE(unset.has_value());
  CHECK((unset == Colour::none()));
  const Colour red(0), green(1);
  CHECK(red.has_value());
  CHECK(green.index() == 1);
  CHECK((red != green));
  CHECK((red != Colour::none()));
}

TEST_CASE("Ids are ordered by their index, none last, and can be hashed") {
  CHECK((Colour(0) < Colour(1)));
  CHECK((Colour(4'000'000'000u) < Colour::none()));
  std::unordered_set<Colour> known{Colour(3), Colour::none(), Colour(3), Colour(4)};
  CHECK(known.size() == 3);
  CHECK(known.contains(Colour::none()));
  CHECK_FALSE(known.contains(Colour(5)));
}

TEST_CASE("An id that was copied as bytes is the same id") {
  for (const Colour id : {Colour(17), Colour::none()}) {
    Colour copy(1);
    std::memcpy(static_cast<void*>(&copy), &id, sizeof id);
    CHECK((copy == id));
  }
}

TEST_CASE("An id vector is indexed by ids of its kind, which it gives out in order") {
  IdVector<Colour, std::string> names;
  CHECK(names.empty());
  const Colour next = names.next_id();
  const Colour red = names.push_back("red");
  const Colour green = names.emplace_back(5, 'g');
  CHECK((red == next));
  CHECK(names[red] == "red");
  CHECK(names[green] == "ggggg");
  names[red] += "dish";
  CHECK(names.values() == std::vector<std::string>{"reddish", "ggggg"});
  CHECK(names.contains(green));
  CHECK_FALSE(names.contains(names.next_id()));
  CHECK_FALSE(names.contains(Colour::none()));

  std::vector<std::uint32_t> indices;
  for (const Colour id : names.ids()) indices.push_back(id.index());
  CHECK(indices == std::vector<std::uint32_t>{0, 1});
  CHECK(names.ids().size() == 2);
}

TEST_CASE("An id vector of truth values can be written through") {
  IdVector<Shape, bool> round(3, false);
  round[Shape(1)] = true;
  CHECK(round.values() == std::vector<bool>{false, true, false});
  CHECK((round == IdVector<Shape, bool>{false, true, false}));
  round.resize(4, true);
  CHECK(round[Shape(3)]);
}
