#pragma once
/// Comparison of two results files, number by number.

#include <doctest/doctest.h>

#include <bit>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "scintray/core/error.hpp"
#include "scintray/core/h5.hpp"

namespace scintray::test {

/// Differences of two groups, "points/0000/fate_count"; `compared` counts the datasets. Wall times may
/// differ. All kinds of numbers in results are exact as double: 64-bit integers there are far below 2^53.
inline void find_differences(const core::h5::Group& a, const core::h5::Group& b, const std::string& at,
                             std::vector<std::string>& found, std::size_t& compared) {
  const auto differs = [&](const std::string& what) { found.push_back(at + what); };
  for (const std::string& name : a.attributes("")) {
    if (!b.has_attribute("", name)) {
      differs("@" + name);
      continue;
    }
    try {
      if (a.string_attribute("", name) != b.string_attribute("", name)) differs("@" + name);
    } catch (const core::Error&) {
      if (a.double_attribute("", name) != b.double_attribute("", name)) differs("@" + name);
    }
  }
  if (a.members() != b.members()) return differs("(members)");
  for (const std::string& name : a.members()) {
    try {
      const core::h5::Group inner = a.open_group(name);
      find_differences(inner, b.open_group(name), at + name + "/", found, compared);
      continue;
    } catch (const core::Error&) {  // a dataset
    }
    ++compared;
    if (name == "wall_seconds") continue;
    if (a.shape(name) != b.shape(name)) {
      differs(name + " (shape)");
      continue;
    }
    try {
      if (a.read_strings(name) != b.read_strings(name)) differs(name);
      continue;
    } catch (const core::Error&) {  // numbers
    }
    const auto x = a.read<double>(name), y = b.read<double>(name);
    for (std::size_t i = 0; i < x.size(); ++i)
      if (std::bit_cast<std::uint64_t>(x[i]) != std::bit_cast<std::uint64_t>(y[i])) {
        differs(name + "[" + std::to_string(i) + "]");
        break;
      }
  }
}

/// Checks that two results files are the same, to the last bit, but for wall times.
/// @param least  number of datasets that they have at least
inline void check_same_results(const std::filesystem::path& a, const std::filesystem::path& b,
                               std::size_t least = 31) {
  std::vector<std::string> found;
  std::size_t compared = 0;
  find_differences(core::h5::File::open(a).root(), core::h5::File::open(b).root(), "", found, compared);
  for (const std::string& difference : found) CAPTURE(difference);
  INFO(a.string() << " and " << b.string());
  CHECK(found == std::vector<std::string>());
  CHECK(compared >= least);
}

}  // namespace scintray::test
