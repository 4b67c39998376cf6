#pragma once
/// Names, units and descriptions of the datasets of a results file, for its writer and its reader.

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "scintray/core/error.hpp"
#include "scintray/core/h5.hpp"

namespace scintray::results::format {

inline constexpr const char* kFormat = "scintray-results";

/// One dataset of the file.
struct Field {
  const char* name;
  const char* unit;  ///< "1" for counts and fractions, "" for text
  const char* description;
};

/// The description of dataset `name` ("photons", "path_mm"); InternalError when it has none, so that no
/// dataset is written without one.
const Field& field(std::string_view name);

/// Sets `description` and `unit` on a dataset just written.
void describe(core::h5::Group& group, const std::string& name);

/// Opens a result; InputError when this program cannot read it.
core::h5::File open_results(const std::filesystem::path& path);

/// True when the root states that the file is a ScintRay result.
bool has_format(const core::h5::Group& root);

/// The error of an inconsistent results file.
core::InputError damaged(const std::filesystem::path& path, const std::string& what);
/// The error of a result without a record that its run did not request.
core::InputError lacking(const std::filesystem::path& path, const std::string& what, const std::string& hint);

/// Writes a dataset with its description and unit.
inline void put_text(core::h5::Group& group, const std::string& name,
                     const std::vector<std::string>& values) {
  group.write_strings(name, values);
  describe(group, name);
}
template <typename T>
void put(core::h5::Group& group, const std::string& name, const std::vector<T>& values) {
  group.write(name, values);
  describe(group, name);
}
/// A scalar.
template <typename T>
void put(core::h5::Group& group, const std::string& name, T value) {
  group.write(name, std::vector<T>{value}, {});
  describe(group, name);
}

/// Names of the dimensions of datasets of a group.
using DimensionNames = std::map<std::string, std::vector<std::string>, std::less<>>;

/// Attaches a dimension scale to every dimension of a group's datasets without one, so that readers of
/// netCDF, such as xarray, open the group. A scale is the dataset of the group with the name of the
/// dimension; where there is none it is written, with indices from 0.
/// @param names  of dimensions; others are named index, index_2, ..., one for each length
void name_dimensions(core::h5::Group& group, const DimensionNames& names = {});

/// "0007": name of the group of a point or tally.
std::string numbered(std::size_t index);

}  // namespace scintray::results::format
