// Attribution of samples of the program counter to kinds of work.

#include <doctest/doctest.h>

#include <numeric>

#include "clock.hpp"
#include "profile.hpp"
#include "spread.hpp"
#include "work_kind.hpp"

using namespace scintray::bench;

namespace {

double share_of(const WorkShares& work, WorkKind kind) { return work.shares[static_cast<std::size_t>(kind)]; }

}  // namespace

TEST_CASE("The source file of the innermost function that has a kind decides, also when it is inlined") {
  const std::string root = "/somewhere/src/scintray/";
  CHECK(kind_of_code({{"step", root + "transport/step.cpp"}}) == WorkKind::propagation);
  CHECK(kind_of_code({{"uniform", root + "core/philox.hpp"}, {"step", root + "transport/step.cpp"}}) ==
        WorkKind::random);
  // A vector does the work of its caller.
  CHECK(kind_of_code({{"dot", "/usr/include/eigen3/Eigen/src/Core/Dot.h"},
                      {"dot", root + "core/plain_vec.hpp"},
                      {"fresnel", root + "optics/fresnel.cpp"},
                      {"step", root + "transport/step.cpp"}}) == WorkKind::surface);
  CHECK(kind_of_code({{"hit", root + "scene/accelerator.cpp"}}) == WorkKind::ray_query);
  CHECK(kind_of_code({{"add", root + "tally/block_tally.cpp"}}) == WorkKind::tally);
  CHECK(kind_of_code({{"end", root + "tally/event_tally.cpp"}}) == WorkKind::readout);
  CHECK(kind_of_code({{"main", "/somewhere/tools/benchmark/main.cpp"}}) == WorkKind::other);
  CHECK(kind_of_code({}) == WorkKind::other);
}

TEST_CASE(
    "Without line tables the namespace of the function decides, not those of its result and arguments") {
  const auto kind = [](const std::string& function) { return kind_of_code({{function, ""}}); };
  CHECK(kind("scintray::optics::Surface::interact(scintray::core::Rng&) const") == WorkKind::surface);
  CHECK(kind("scintray::core::Rng::bits()") == WorkKind::random);
  CHECK(kind("scintray::optics::Ray scintray::transport::(anonymous "
             "namespace)::go<scintray::scene::Scene>(int)") == WorkKind::propagation);
  CHECK(kind("scintray::scene::Accelerator::find_exit(scintray::core::Vec3 const&) const") ==
        WorkKind::ray_query);
  CHECK(kind("scintray::scene::Scene::locate(scintray::core::Vec3 const&) const") == WorkKind::propagation);
  CHECK(kind("std::vector<scintray::optics::Ray>::push_back(int)") == WorkKind::other);
  CHECK(kind("??") == WorkKind::other);
}

TEST_CASE("Libraries have kinds of their own") {
  CHECK(kind_of_library("libembree3.so.3") == WorkKind::ray_query);
  CHECK(kind_of_library("libm.so.6") == WorkKind::elementary);
  CHECK(kind_of_library("libmvec.so.1") == WorkKind::elementary);
  CHECK(kind_of_library("libmuparser.so.2") == WorkKind::other);
  CHECK(kind_of_library("libc.so.6") == WorkKind::other);
}

TEST_CASE("Shares are those of the samples, and sum up to 1") {
  const std::map<std::uintptr_t, CodePlace> places{
      {10, {"libm.so.6", {}}}, {20, {"", {{"step", "/x/src/scintray/transport/step.cpp"}}}}, {30, {"", {}}}};
  const WorkShares work = attribute({10, 20, 20, 30}, places);
  CHECK(work.samples == 4);
  CHECK(work.lines);
  CHECK(share_of(work, WorkKind::elementary) == 0.25);
  CHECK(share_of(work, WorkKind::propagation) == 0.5);
  CHECK(share_of(work, WorkKind::other) == 0.25);
  CHECK(std::accumulate(work.shares.begin(), work.shares.end(), 0.0) == 1.0);
  CHECK_FALSE(attribute({10}, places).lines);
  CHECK(attribute({}, places).samples == 0);
}

TEST_CASE(
    "The program counter is sampled where the thread works, and its addresses are found in the program") {
  const auto work = [] {
    const double start = clock_seconds(CLOCK_THREAD_CPUTIME_ID);
    while (clock_seconds(CLOCK_THREAD_CPUTIME_ID) < start + 0.1) spread_of(std::vector<double>(1000, 1.0));
  };
  const std::vector<std::uintptr_t> samples = sample_program_counter(work);
  REQUIRE_FALSE(samples.empty());
  const auto places = find_code(samples);
  bool sorted_here = false;
  for (const auto& [address, place] : places)
    for (const CodeFrame& frame : place.frames)
      sorted_here = sorted_here || frame.function.find("sort") != std::string::npos ||
                    frame.function.find("spread_of") != std::string::npos;
  CHECK(sorted_here);
  CHECK(attribute(samples, places).samples == samples.size());
}
