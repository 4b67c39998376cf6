#include <map>
#include <numeric>

#include "scintray/analysis/analysis_fields.hpp"
#include "scintray/results/detail/columns.hpp"
#include "scintray/results/detail/file_ids.hpp"
#include "scintray/results/detail/point_groups.hpp"
#include "scintray/results/results_format.hpp"

namespace scintray::results::format {

namespace {

/// Fields of an analysis as datasets.
class GroupSink : public analysis::FieldSink {
 public:
  explicit GroupSink(core::h5::Group root) : open_{std::move(root)} {}
  /// Attaches scales to the dimensions of the outermost group.
  void finish() { name_dimensions(open_.front()); }

  void begin_group(const std::string& name, const std::string& description) override {
    open_.push_back(open_.back().create_group(name));
    open_.back().set_attribute("", "description", description);
  }
  void end_group() override {
    name_dimensions(open_.back());
    open_.pop_back();
  }
  void number(const analysis::FieldMeaning& field, double value) override {
    open_.back().write(field.name, std::vector<double>{value}, {});
    describe_field(field);
  }
  void count(const analysis::FieldMeaning& field, std::int64_t value) override {
    open_.back().write(field.name, std::vector<std::int64_t>{value}, {});
    describe_field(field);
  }
  void text(const analysis::FieldMeaning& field, const std::string& value) override {
    open_.back().set_attribute("", field.name, value);
  }
  void numbers(const analysis::FieldMeaning& field, const std::vector<double>& values) override {
    open_.back().write(field.name, values);
    describe_field(field);
  }
  void counts(const analysis::FieldMeaning& field, const std::vector<std::int64_t>& values) override {
    open_.back().write(field.name, values);
    describe_field(field);
  }
  void texts(const analysis::FieldMeaning& field, const std::vector<std::string>& values) override {
    open_.back().write_strings(field.name, values);
    describe_field(field);
  }

 private:
  void describe_field(const analysis::FieldMeaning& field) {
    open_.back().set_attribute(field.name, "description", std::string(field.description));
    open_.back().set_attribute(field.name, "unit", std::string(field.unit));
  }

  std::vector<core::h5::Group> open_;
};

}  // namespace

void put_event_analysis(core::h5::Group& point, const analysis::EventAnalysis& analysis,
                        const core::IdVector<core::PartId, std::string>& parts) {
  core::h5::Group group = point.create_group("analysis");
  group.set_attribute("", "description", std::string("analysis of the events, by the scene's [analysis]"));
  GroupSink sink(group);
  analysis::list_fields(analysis, parts, sink);
  sink.finish();
}

void put_channels(core::h5::Group& point, const std::vector<tally::ReadoutChannel>& channels) {
  core::h5::Group group = point.create_group("channels");
  group.set_attribute("", "description", std::string("readout channels of the sensors"));
  std::vector<std::string> names;
  std::vector<std::uint32_t> parts;
  for (const tally::ReadoutChannel& channel : channels) {
    names.push_back(channel.name);
    parts.push_back(to_file(channel.part));
  }
  put_text(group, "channel_name", names);
  put(group, "channel_part", parts);
  for_each_channel_number([&](const char* name, auto member) {
    std::vector<double> column;
    for (const tally::ReadoutChannel& channel : channels) column.push_back(member(channel));
    put(group, name, column);
  });
  std::vector<std::int64_t> numbers(channels.size());
  std::iota(numbers.begin(), numbers.end(), 0);
  put(group, "channel_index", numbers);
  DimensionNames dimensions;
  for (const std::string& member : group.members()) dimensions[member] = {"channel_index"};
  name_dimensions(group, dimensions);
}

}  // namespace scintray::results::format
