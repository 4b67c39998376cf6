#include "detector_entries.hpp"

#include <array>
#include <cmath>
#include <cstring>

#include "corpus.hpp"
#include "require.hpp"
#include "scintray/config/columns.hpp"
#include "scintray/exchange/scene_draft.hpp"
#include "scintray/tables/bsdf_text.hpp"
#include "scratch_file.hpp"
#include "support/zipped.hpp"

namespace scintray::fuzz {

namespace {

std::vector<std::string> none() { return {}; }

/// An error of one of the scratch files has a place and words.
bool placed(const core::InputError& error, const std::filesystem::path& begins) {
  require(!error.problems().empty(), "an error without problems");
  for (const core::Problem& problem : error.problems())
    require(problem.where.file.starts_with(begins.string()) && !problem.what.empty(),
            "an error without place or words");
  return false;
}

bool run_bsdf(const std::uint8_t* data, std::size_t size) {
  try {
    const tables::Bsdf bsdf = tables::parse_bsdf({reinterpret_cast<const char*>(data), size}, "fuzz");
    const tables::BsdfAngles& angles = bsdf.angles;
    require(bsdf.values.size() == angles.specular.size() * angles.azimuth.size() * angles.radial.size(),
            "values that do not fill the table");
    for (const double value : bsdf.values)
      require(std::isfinite(value) && value >= 0.0, "a negative value, or one that is no number");
    return true;
  } catch (const core::InputError& error) {
    require_words(error);
    return false;
  }
}

/// Columns of a file, by names that the seeds have.
template <std::size_t N>
bool run_columns(const std::uint8_t* data, std::size_t size, const char* ending,
                 const std::array<const char*, N>& names) {
  const ScratchFile file(data, size, ending);
  try {
    const config::Columns columns =
        config::read_columns({file.path(), {}, {file.path().string()}}, {names.begin(), names.end()});
    require(columns.values.size() == N, "a wrong number of columns");
    for (const auto& column : columns.values)
      require(column.empty() || column.size() == columns.rows.size(), "columns of unequal length");
    return true;
  } catch (const core::InputError& error) {
    return placed(error, file.path());
  } catch (const core::SystemError&) {  // as HDF5 cannot read what is there
    return false;
  }
}

constexpr std::array<const char*, 4> kNames{"event", "x", "", "energy"};
constexpr std::array<const char*, 2> kColumnNumbers{"0", "2"};

bool run_csv(const std::uint8_t* data, std::size_t size) { return run_columns(data, size, ".csv", kNames); }
bool run_npz(const std::uint8_t* data, std::size_t size) { return run_columns(data, size, ".npz", kNames); }
bool run_npy(const std::uint8_t* data, std::size_t size) {
  return run_columns(data, size, ".npy", kColumnNumbers);
}
bool run_structured(const std::uint8_t* data, std::size_t size) {
  return run_columns(data, size, ".npy", kNames);
}

/// A .npy file: version 1, or the 4 bytes of length of version 2.
std::string npy(const std::string& descr, bool fortran, const std::string& shape, const std::string& values,
                char version = 1) {
  std::string header = "{'descr': " + descr + ", 'fortran_order': " + (fortran ? "True" : "False") +
                       ", 'shape': (" + shape + "), }";
  const std::size_t before = version == 1 ? 10 : 12;
  while ((before + header.size() + 1) % 64 != 0) header += ' ';
  header += '\n';
  std::string length(before - 8, '\0');
  length[0] = static_cast<char>(header.size() % 256);
  length[1] = static_cast<char>(header.size() / 256);
  return "\x93NUMPY" + std::string{version, '\0'} + length + header + values;
}

template <typename T>
std::string bytes(std::initializer_list<T> values) {
  std::string text(values.size() * sizeof(T), '\0');
  std::memcpy(text.data(), std::data(values), text.size());
  return text;
}

std::vector<std::string> npy_seeds() {
  return {npy("'<f8'", false, "2, 3", bytes({1.0, 2.0, 3.0, 4.0, 5.0, 6.0})),
          npy("'<f4'", true, "2, 3", bytes({1.0f, 2.0f, 3.0f, 4.0f, 5.0f, 6.0f}), 2),
          npy("'>i2'", false, "2, 1, 3", bytes<std::int16_t>({1, 2, 3, 4, 5, 6}))};
}

std::vector<std::string> structured_seeds() {
  std::string rows;
  for (int row = 0; row < 2; ++row)
    rows += bytes<std::int32_t>({row}) + bytes<double>({0.5}) + bytes({511.0f}) + bytes<char>({1});
  return {npy("[('event', '<i4'), ('x', '<f8'), ('energy', '<f4'), ('flag', '|b1')]", false, "2,", rows),
          npy("[('event', '<u8'), ('x', '<f8'), ('energy', '>f8')]", false, "1,",
              bytes<std::uint64_t>({7}) + bytes({0.5, 511.0}))};
}

std::vector<std::string> npz_seeds() {
  std::vector<std::pair<std::string, std::string>> arrays;
  for (const char* name : {"event.npy", "x.npy", "energy.npy"})
    arrays.emplace_back(name, npy("'<f8'", false, "2,", bytes({1.0, 2.0})));
  return {test::zipped(arrays), test::zipped(arrays, true)};
}

/// Which of the files of a GATE detector are the bytes; the others are the first of their corpus.
template <int Which>
bool run_gate(const std::uint8_t* data, std::size_t size) {
  struct File {
    const char *target, *name;
  };
  static constexpr std::array<File, 4> kFiles{{{"gate_macro", "main.mac"},
                                               {"gate_database", "Materials.db"},
                                               {"gate_materials", "Materials.xml"},
                                               {"gate_surfaces", "Surfaces.xml"}}};
  static const auto sound = [] {
    std::array<std::string, 4> contents;
    for (std::size_t k = 0; k < kFiles.size(); ++k) contents[k] = corpus(kFiles[k].target).at(0);
    return contents;
  }();
  const ScratchFolder folder;
  for (std::size_t k = 0; k < kFiles.size(); ++k)
    std::ofstream(folder.path() / kFiles[k].name, std::ios::binary)
        << (k == Which ? std::string(reinterpret_cast<const char*>(data), size) : sound[k]);
  try {
    exchange::gdml::GdmlImport options;
    options.tessellation = {1e3, 0.5};
    const exchange::SceneDraft scene =
        exchange::gate::draft_of_gate(folder.path() / kFiles[0].name, std::move(options));
    require(!scene.toml.empty(), "a scene without text");
    return true;
  } catch (const core::InputError& error) {
    return placed(error, folder.path());
  }
}

constexpr std::size_t kPerDetectorByte = 256, kDetectorAlways = std::size_t{1} << 20;
/// deflate's largest ratio (RFC 1951), of arrays of numbers.
constexpr std::size_t kPerPackedByte = 1032 * 64;
/// A few digits request volumes of a repeater up to the importer's own limits.
constexpr std::size_t kPerGateByte = 200'000;

constexpr Entry kDetectorEntries[] = {
    {"bsdf", run_bsdf, none, kPerDetectorByte, kDetectorAlways},
    {"columns_csv", run_csv, none, kPerDetectorByte, kDetectorAlways},
    {"columns_npy", run_npy, npy_seeds, kPerDetectorByte, kDetectorAlways},
    {"columns_structured", run_structured, structured_seeds, kPerDetectorByte, kDetectorAlways},
    {"columns_npz", run_npz, npz_seeds, kPerPackedByte, kDetectorAlways},
    {"gate_macro", run_gate<0>, none, kPerGateByte, kDetectorAlways},
    {"gate_database", run_gate<1>, none, kPerGateByte, kDetectorAlways},
    {"gate_materials", run_gate<2>, none, kPerGateByte, kDetectorAlways},
    {"gate_surfaces", run_gate<3>, none, kPerGateByte, kDetectorAlways}};

}  // namespace

std::span<const Entry> detector_entries() { return kDetectorEntries; }

}  // namespace scintray::fuzz
