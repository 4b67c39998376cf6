#pragma once
/// The numbers of an analysis of events by name, for files of any format.

#include <cstdint>
#include <string>
#include <vector>

#include "scintray/analysis/event_analysis.hpp"
#include "scintray/core/id_vector.hpp"

namespace scintray::analysis {

/// Meaning of a field: its unit ("1": a count, a share or an index; empty: text) and a description.
struct FieldMeaning {
  const char* name;
  const char* unit;
  const char* description;
};

/// Receiver of named numbers in groups. Names are unique within a group and of the characters a to z, digits,
/// _ and capital letters in units.
class FieldSink {
 public:
  FieldSink() = default;
  FieldSink(const FieldSink&) = delete;
  FieldSink& operator=(const FieldSink&) = delete;
  virtual ~FieldSink() = default;

  /// Fields up to the matching end_group() are in a group.
  virtual void begin_group(const std::string& name, const std::string& description) = 0;
  virtual void end_group() = 0;
  virtual void number(const FieldMeaning& field, double value) = 0;
  virtual void count(const FieldMeaning& field, std::int64_t value) = 0;
  virtual void text(const FieldMeaning& field, const std::string& value) = 0;
  /// Columns: all of one group have the same length, unless they are edges of bins.
  virtual void numbers(const FieldMeaning& field, const std::vector<double>& values) = 0;
  virtual void counts(const FieldMeaning& field, const std::vector<std::int64_t>& values) = 0;
  virtual void texts(const FieldMeaning& field, const std::vector<std::string>& values) = 0;
};

/// Passes every number of an analysis to a sink, with its standard error as the next field (`NAME_error`),
/// and the reasons for missing results as the texts `left_out`.
/// @param parts  names of the parts of the run
void list_fields(const EventAnalysis& analysis, const core::IdVector<core::PartId, std::string>& parts,
                 FieldSink& sink);

}  // namespace scintray::analysis
