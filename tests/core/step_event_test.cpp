#include "scintray/core/step_event.hpp"

#include <doctest/doctest.h>

#include <set>
#include <string>

#include "scintray/core/error.hpp"

using namespace scintray;
using namespace scintray::core;

TEST_CASE("The final step events are the fates, each with its name and its place") {
  std::set<std::string> names;
  for (int i = 0; i < kFateCount; ++i) {
    CHECK(is_final(fate_at(i)));
    CHECK(fate_index(fate_at(i)) == static_cast<std::size_t>(i));
    names.insert(fate_name(fate_at(i)));
  }
  CHECK(names.size() == static_cast<std::size_t>(kFateCount));
  for (int i = 0; i < kFirstFate; ++i) {
    CHECK_FALSE(is_final(static_cast<StepEvent>(i)));
    CHECK_THROWS_AS(fate_name(static_cast<StepEvent>(i)), InternalError);
  }
}
