#pragma once
/// Tables of a results file: a group whose datasets are columns of equal length.

#include <algorithm>
#include <numeric>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "scintray/core/h5.hpp"
#include "scintray/results/detail/columns.hpp"
#include "scintray/results/detail/file_ids.hpp"
#include "scintray/results/results_format.hpp"

namespace scintray::results::format {

/// Type of the values of a column in the file.
template <typename Row, typename Member>
using ColumnValue =
    std::remove_cvref_t<decltype(to_file(std::declval<const std::invoke_result_t<Member, Row&>&>()))>;

/// Creates the dimension of a table's rows: their numbers.
inline void create_rows(core::h5::Group& group, std::uint64_t block) {
  group.create_stream<std::int64_t>("row", block);
  describe(group, "row");
  group.make_scale("row");
}

/// Appends the numbers of the rows from `first` to `last` - 1.
inline void append_rows(core::h5::Group& group, std::uint64_t first, std::uint64_t last) {
  std::vector<std::int64_t> numbers(last - first);
  std::iota(numbers.begin(), numbers.end(), static_cast<std::int64_t>(first));
  group.append("row", numbers);
}

/// Writer of rows; they are written in blocks, so memory is bounded.
template <typename Row>
class RowWriter {
 public:
  RowWriter() = default;
  /// Creates the group and its columns.
  RowWriter(core::h5::Group& root, const std::string& name, const std::string& description)
      : RowWriter(root, name, description, [](const std::string&) { return true; }) {}
  /// The same with the columns that `is_wanted` accepts.
  template <typename IsWanted>
  RowWriter(core::h5::Group& root, const std::string& name, const std::string& description,
            const IsWanted& is_wanted)
      : group_(root.create_group(name)) {
    group_->set_attribute("", "description", description);
    create_rows(*group_, kBlockRows);
    for_each_column(static_cast<const Row*>(nullptr), [&](const char* column, auto member) {
      written_.push_back(is_wanted(column));
      if (!written_.back()) return;
      group_->create_stream<ColumnValue<Row, decltype(member)>>(column, kBlockRows);
      describe(*group_, column);
      group_->attach_scale(column, 0, *group_, "row");
    });
  }

  bool exists() const { return group_.has_value(); }
  std::uint64_t rows() const { return rows_; }

  void add(const Row& row) {
    ++rows_;
    waiting_.push_back(row);
    if (waiting_.size() == kBlockRows) write_waiting();
  }

  void write_waiting() {
    if (waiting_.empty()) return;
    std::size_t number = 0;
    for_each_column(static_cast<const Row*>(nullptr), [&](const char* name, auto member) {
      if (!written_[number++]) return;
      std::vector<ColumnValue<Row, decltype(member)>> column;
      column.reserve(waiting_.size());
      for (const Row& row : waiting_) column.push_back(to_file(member(row)));
      group_->append(name, column);
    });
    append_rows(*group_, rows_ - waiting_.size(), rows_);
    waiting_.clear();
  }

 private:
  /// Rows kept in memory before they are written, and rows compressed together. While they are compressed,
  /// other threads trace the next ones, and would wait for larger blocks.
  static constexpr std::size_t kBlockRows = 8192;

  std::optional<core::h5::Group> group_;
  std::vector<bool> written_;  ///< by column, in the order of for_each_column
  std::vector<Row> waiting_;
  std::uint64_t rows_ = 0;
};

/// Writer of rows with an equal number of samples into the dataset "samples" of a group.
class SampleWriter {
 public:
  SampleWriter() = default;
  SampleWriter(core::h5::Group& root, const std::string& name, const std::string& description,
               std::size_t width)
      : group_(root.create_group(name)),
        width_(width),
        rows_(std::max<std::size_t>(1, kBlockSamples / width)) {
    group_->set_attribute("", "description", description);
    create_rows(*group_, rows_);
    group_->create_stream<float>("samples", rows_, width);
    describe(*group_, "samples");
    std::vector<std::int64_t> samples(width);
    std::iota(samples.begin(), samples.end(), 0);
    put(*group_, "sample", samples);
    group_->make_scale("sample");
    group_->attach_scale("samples", 0, *group_, "row");
    group_->attach_scale("samples", 1, *group_, "sample");
  }

  core::h5::Group& group() { return *group_; }
  std::size_t width() const { return width_; }

  /// Does nothing without a group.
  void add(const std::vector<float>& samples) {
    if (!group_) return;
    waiting_.insert(waiting_.end(), samples.begin(), samples.end());
    if (waiting_.size() >= rows_ * width_) write_waiting();
  }

  void write_waiting() {
    if (group_) {
      group_->append("samples", waiting_);
      const std::uint64_t rows = waiting_.size() / width_;
      append_rows(*group_, written_, written_ + rows);
      written_ += rows;
    }
    waiting_.clear();
  }

 private:
  /// Samples kept in memory before they are written, and samples compressed together: 1 MB.
  static constexpr std::size_t kBlockSamples = 262144;

  std::optional<core::h5::Group> group_;
  std::size_t width_ = 0, rows_ = 0;
  std::uint64_t written_ = 0;  ///< rows in the file
  std::vector<float> waiting_;
};

/// At most `count` rows from `offset` on, with the columns that `is_wanted` accepts. Empty (nullopt) when the
/// columns differ in length.
/// @param absent  values of the columns that are not read
template <typename Row, typename IsWanted>
std::optional<std::vector<Row>> read_rows(const core::h5::Group& group, std::uint64_t offset,
                                          std::uint64_t count, const Row& absent, const IsWanted& is_wanted) {
  std::vector<Row> rows;
  bool first = true, equal = true;
  for_each_column(static_cast<const Row*>(nullptr), [&](const char* name, auto member) {
    if (!is_wanted(name)) return;
    const auto column = group.read_part<ColumnValue<Row, decltype(member)>>(name, offset, count);
    if (first) rows.resize(column.size(), absent);
    first = false;
    equal = equal && column.size() == rows.size();
    for (std::size_t i = 0; i < std::min(column.size(), rows.size()); ++i)
      from_file(column[i], member(rows[i]));
  });
  if (!equal) return std::nullopt;
  return rows;
}

/// The same with all columns.
template <typename Row>
std::optional<std::vector<Row>> read_rows(const core::h5::Group& group, std::uint64_t offset,
                                          std::uint64_t count) {
  return read_rows(group, offset, count, Row(), [](const std::string&) { return true; });
}

}  // namespace scintray::results::format
