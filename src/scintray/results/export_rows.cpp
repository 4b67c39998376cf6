#include "scintray/results/results.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <functional>
#include <iterator>
#include <optional>
#include <vector>

#include "scintray/core/error.hpp"
#include "scintray/core/h5.hpp"
#include "scintray/core/output_file.hpp"
#include "scintray/core/text.hpp"
#include "scintray/core/words.hpp"
#include "scintray/results/results_format.hpp"

namespace scintray::results {

namespace {

constexpr std::uint64_t kBlockRows = 65536;

/// Forms of exported rows.
enum class RowForm { csv, npy, lh5 };
constexpr core::Word<RowForm> kForms[] = {
    {".csv", RowForm::csv}, {".npy", RowForm::npy}, {".lh5", RowForm::lh5}};

/// The columns of a table of a results file.
class RowSource {
 public:
  RowSource(const std::filesystem::path& path, const std::string& table)
      : file_(format::open_results(path)), table_(open(path, table)) {
    for (const std::string& name : table_.members()) {
      if (name == "row" || !table_.has_dataset(name)) continue;
      const core::h5::Shape shape = table_.shape(name);
      if (shape.size() == 1 && shape[0] == rows()) names_.push_back(name);
    }
  }

  const std::vector<std::string>& names() const { return names_; }
  std::uint64_t rows() const { return table_.shape("row").at(0); }
  std::string unit(const std::string& name) const {
    return table_.has_attribute(name, "unit") ? table_.string_attribute(name, "unit") : "1";
  }

  /// Passes the columns on, block by block.
  void each_block(const std::function<void(const std::vector<std::vector<double>>&)>& pass) const {
    for (std::uint64_t first = 0; first < rows(); first += kBlockRows) {
      std::vector<std::vector<double>> columns;
      for (const std::string& name : names_)
        columns.push_back(table_.read_part<double>(name, first, kBlockRows));
      pass(columns);
    }
  }

 private:
  core::h5::Group open(const std::filesystem::path& path, const std::string& table) const {
    const core::h5::Group root = file_.root();
    std::vector<std::string> tables;
    for (const std::string& name : root.members())
      if (!root.has_dataset(name) && root.open_group(name).has("row")) tables.push_back(name);
    if (std::find(tables.begin(), tables.end(), table) == tables.end())
      throw core::InputError(
          {{path.string()},
           "this result has no table \"" + table + "\"",
           tables.empty() ? "lists of photons need photon_list = true in [run], events an event source"
                          : "it has " + core::list_of(tables)});
    return root.open_group(table);
  }

  core::h5::File file_;
  core::h5::Group table_;
  std::vector<std::string> names_;
};

void write_csv(const RowSource& rows, const std::filesystem::path& path) {
  core::OutputFile file(path, core::Container::plain, "the rows");
  file.write(core::list_of(rows.names(), ",") + "\n");
  rows.each_block([&](const std::vector<std::vector<double>>& columns) {
    fmt::memory_buffer text;
    for (std::size_t i = 0; i < columns.front().size(); ++i)
      for (std::size_t k = 0; k < columns.size(); ++k)
        fmt::format_to(std::back_inserter(text), "{}{}", columns[k][i], k + 1 < columns.size() ? ',' : '\n');
    file.write({text.data(), text.size()});
  });
  file.commit();
}

/// Bytes of a number, the least significant first.
void append_bytes(std::string& bytes, double value) {
  const auto bits = std::bit_cast<std::uint64_t>(value);
  for (int byte = 0; byte < 8; ++byte) bytes += static_cast<char>(bits >> (8 * byte) & 0xff);
}

/// A structured array, of version 2 of the format, whose header may be long (numpy.lib.format).
void write_npy(const RowSource& rows, const std::filesystem::path& path) {
  std::string header = "{'descr': [";
  for (const std::string& name : rows.names()) header += "('" + name + "', '<f8'), ";
  header += "], 'fortran_order': False, 'shape': (" + std::to_string(rows.rows()) + ",), }";
  constexpr std::size_t kAlignment = 64, kBefore = 12;
  while ((kBefore + header.size() + 1) % kAlignment != 0) header += ' ';
  header += '\n';
  std::string head("\x93NUMPY\x02\x00", 8);
  for (int byte = 0; byte < 4; ++byte) head += static_cast<char>(header.size() >> (8 * byte) & 0xff);
  core::OutputFile file(path, core::Container::plain, "the rows", head);
  file.write(head + header);
  rows.each_block([&](const std::vector<std::vector<double>>& columns) {
    std::string bytes;
    for (std::size_t i = 0; i < columns.front().size(); ++i)
      for (const std::vector<double>& column : columns) append_bytes(bytes, column[i]);
    file.write(bytes);
  });
  file.commit();
}

void write_lh5(const RowSource& rows, const std::string& table, const std::filesystem::path& path) {
  core::h5::File file = core::h5::File::create(path);
  core::h5::Group root = file.root();
  core::h5::Group group = root.create_group(table);
  group.set_attribute("", "datatype", "table{" + core::list_of(rows.names(), ",") + "}");
  for (const std::string& name : rows.names()) {
    group.create_stream<double>(name);
    group.set_attribute(name, "datatype", std::string("array<1>{real}"));
    // A number without a unit has no attribute of that name.
    if (const std::string unit = rows.unit(name); unit != "1") group.set_attribute(name, "units", unit);
  }
  rows.each_block([&](const std::vector<std::vector<double>>& columns) {
    for (std::size_t k = 0; k < columns.size(); ++k) group.append(rows.names()[k], columns[k]);
  });
  file.commit();
}

}  // namespace

std::uint64_t export_rows(const std::filesystem::path& results, const std::string& table,
                          const std::filesystem::path& output) {
  const std::optional<RowForm> form = core::find_word(kForms, output.extension().string());
  if (!form)
    throw core::InputError({{output.string()},
                            "rows of results are written as .csv, .npy or .lh5",
                            "name a file with one of these extensions, as: -o photons.npy"});
  const RowSource rows(results, table);
  if (rows.names().empty())
    throw core::InputError({{results.string()}, "the table \"" + table + "\" has no columns of numbers", ""});
  if (*form == RowForm::csv) write_csv(rows, output);
  if (*form == RowForm::npy) write_npy(rows, output);
  if (*form == RowForm::lh5) write_lh5(rows, table, output);
  return rows.rows();
}

}  // namespace scintray::results
