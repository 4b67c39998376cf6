#include "scintray/analysis/analysis_fields.hpp"

#include <cmath>
#include <functional>
#include <utility>

namespace scintray::analysis {

namespace {

using core::Estimate;

/// A group of a sink as long as it lives.
class Group {
 public:
  Group(FieldSink& sink, const std::string& name, const std::string& description) : sink_(sink) {
    sink_.begin_group(name, description);
  }
  Group(const Group&) = delete;
  Group& operator=(const Group&) = delete;
  ~Group() { sink_.end_group(); }

 private:
  FieldSink& sink_;
};

constexpr const char* kErrorOf = "standard error of the field before it";

std::int64_t whole(std::size_t value) { return static_cast<std::int64_t>(value); }

void estimate(FieldSink& sink, const FieldMeaning& field, const Estimate& value) {
  sink.number(field, value.value);
  const std::string name = std::string(field.name) + "_error";
  sink.number({name.c_str(), field.unit, kErrorOf}, value.error);
}

template <typename Items, typename ValueOf>
std::vector<double> column(const Items& items, const ValueOf& value_of) {
  std::vector<double> values;
  for (const auto& item : items) values.push_back(static_cast<double>(value_of(item)));
  return values;
}

template <typename Items, typename ValueOf>
std::vector<std::int64_t> whole_column(const Items& items, const ValueOf& value_of) {
  std::vector<std::int64_t> values;
  for (const auto& item : items) values.push_back(static_cast<std::int64_t>(value_of(item)));
  return values;
}

template <typename Items, typename ValueOf>
void estimates(FieldSink& sink, const FieldMeaning& field, const Items& items, const ValueOf& value_of) {
  sink.numbers(field, column(items, [&](const auto& item) { return value_of(item).value; }));
  const std::string name = std::string(field.name) + "_error";
  sink.numbers({name.c_str(), field.unit, kErrorOf},
               column(items, [&](const auto& item) { return value_of(item).error; }));
}

void histogram(FieldSink& sink, const Histogram& bins, const std::string& name, const char* unit,
               const std::string& description) {
  const Group group(sink, name, description);
  sink.numbers({"edges", unit, "edges of the bins, one more than bins"}, bins.edges());
  sink.numbers({"bin_counts", "1", "pulses in each bin"}, bins.counts);
  sink.number({"below", "1", "pulses under the first bin"}, bins.below);
  sink.number({"above", "1", "pulses at or over the end of the last bin"}, bins.above);
}

void photopeak(FieldSink& sink, const Photopeak& peak, const char* unit) {
  const Group group(sink, "photopeak", "fit of the photopeak");
  sink.text({"status", "", "trusted, or why not"}, status_name(peak.status));
  sink.text({"reason", "", "of a status other than trusted"}, peak.reason);
  if (!peak.has_numbers()) return;
  estimate(sink, {"position", unit, "position of the peak"}, peak.fit.position);
  estimate(sink, {"sigma", unit, "standard deviation of the peak"}, peak.fit.sigma);
  estimate(sink, {"peak_events", "1", "pulses in the peak"}, peak.fit.events);
  estimate(sink, {"resolution_fwhm", "1", "energy resolution: full width at half maximum over position"},
           peak.fit.relative_fwhm);
  sink.number({"chi_square", "1", "of the fit"}, peak.fit.goodness.chi2);
  sink.number({"degrees_of_freedom", "1", "of the fit"}, peak.fit.goodness.degrees);
  sink.number({"p_value", "1", "of the fit"}, peak.fit.goodness.p_value);
}

void spread(FieldSink& sink, const std::string& name, const std::string& description, const char* unit,
            const Spread& values) {
  const Group group(sink, name, description);
  sink.count({"values", "1", "number of values"}, whole(values.count));
  estimate(sink, {"mean", unit, "mean of the values"}, values.mean);
  estimate(sink, {"quantile_fwhm", unit, "width between the quantiles that enclose the FWHM of a Gaussian"},
           values.quantile_fwhm);
  if (!values.fit.converged) return;
  estimate(sink, {"gaussian_fwhm", unit, "FWHM of the fitted Gaussian"}, values.gaussian_fwhm);
  sink.number({"p_value", "1", "of the Gaussian"}, values.fit.goodness.p_value);
}

void depth_fields(FieldSink& sink, const DepthCurve& curve) {
  const Group group(sink, "light_against_depth", "light in slices of depth");
  sink.text({"value_is", "", "photopeak or mean"}, curve.points.front().from_peak ? "photopeak" : "mean");
  sink.numbers({"depth_mm", "mm", "mean depth of the slice"},
               column(curve.points, [](const DepthPoint& at) { return at.depth_mm; }));
  sink.counts({"slice_events", "1", "events in the slice"},
              whole_column(curve.points, [](const DepthPoint& at) { return at.count; }));
  estimates(sink, {"light", "see light_unit", "light of the slice"}, curve.points,
            [](const DepthPoint& at) { return at.value; });
  estimates(sink, {"relative", "1", "the same over that of the slice in the middle of the depths"},
            curve.relative, [](const Estimate& value) { return value; });
  estimate(sink, {"slope_per_mm", "1/mm", "relative change per mm, of the straight line"},
           curve.relative_slope_per_mm);
}

void doi_fields(FieldSink& sink, const DoiAnalysis& doi) {
  const Group group(sink, "depth_of_interaction", "estimated against true depth");
  sink.text({"ratio", "", "of the light of the two ends"},
            doi.ratio == EndRatio::share ? "A / (A + B)" : "ln(A / B)");
  spread(sink, "residual", "estimated minus true depth", "mm", doi.residual);
  sink.numbers({"depth_mm", "mm", "true depth of the slice"},
               column(doi.slices, [](const DoiSlice& at) { return at.depth_mm; }));
  sink.counts({"slice_events", "1", "events in the slice"},
              whole_column(doi.slices, [](const DoiSlice& at) { return at.count; }));
  estimates(sink, {"bias_mm", "mm", "mean of estimated minus true depth"}, doi.slices,
            [](const DoiSlice& at) { return at.bias_mm; });
  estimates(sink, {"fwhm_mm", "mm", "2.355 times its standard deviation"}, doi.slices,
            [](const DoiSlice& at) { return at.fwhm_mm; });
}

void confusion_fields(FieldSink& sink, const std::string& name, const Confusion& confusion) {
  const Group group(sink, name, "assignment of events to layers");
  std::vector<std::int64_t> truth, assigned;
  for (std::size_t i = 0; i < confusion.counts.size(); ++i) {
    truth.push_back(whole(i / confusion.classes));
    assigned.push_back(whole(i % confusion.classes));
  }
  sink.counts({"true_layer", "1", "layer of the interaction"}, truth);
  sink.counts({"assigned_layer", "1", "layer that the event is assigned to"}, assigned);
  sink.counts({"layer_events", "1", "events of that pair of layers"},
              whole_column(confusion.counts, [](std::uint64_t count) { return count; }));
  estimate(sink, {"share_right", "1", "share of the events assigned to their layer"},
           confusion.share_right());
}

using NameOf = std::function<std::string(core::PartId)>;

void flood_fields(FieldSink& sink, const FloodMap& flood, const NameOf& name_of) {
  const Group group(sink, "flood_map", "positions of events by Anger logic, and the crystals found in them");
  estimate(sink, {"share_right", "1", "share of the events assigned to the part of their interaction"},
           flood.share_right);
  sink.count({"crystals_without_peak", "1", "parts that own no peak"}, whole(flood.crystals_without_peak));
  sink.number({"peak_to_valley", "1", "mean over neighbours; 0 without neighbours"}, flood.peak_to_valley);
  sink.number({"worst_peak_to_valley", "1", "of the least separated neighbours"}, flood.worst_peak_to_valley);
  {
    const Group peaks(sink, "peaks", "peaks of the map, the highest first");
    sink.numbers({"x_mm", "mm", "position"},
                 column(flood.peaks, [](const FloodPeak& peak) { return peak.position_mm[0]; }));
    sink.numbers({"y_mm", "mm", "position"},
                 column(flood.peaks, [](const FloodPeak& peak) { return peak.position_mm[1]; }));
    sink.counts({"assigned_events", "1", "events assigned to the peak"},
                whole_column(flood.peaks, [](const FloodPeak& peak) { return peak.events; }));
    std::vector<std::string> owners;
    for (const FloodPeak& peak : flood.peaks)
      owners.push_back(flood.crystals.empty() ? "" : name_of(flood.crystals[peak.owner]));
    sink.texts({"owner", "", "part in which most of its events interacted"}, owners);
  }
  const FloodGrid& grid = flood.grid;
  const Group cells(sink, "map", "events in cells, row by row from the lowest y");
  sink.count({"columns", "1", "cells along x"}, whole(grid.columns));
  sink.count({"rows", "1", "cells along y"}, whole(grid.rows));
  for (const auto& [name, value] : {std::pair("x_low_mm", grid.x_low), std::pair("x_high_mm", grid.x_high),
                                    std::pair("y_low_mm", grid.y_low), std::pair("y_high_mm", grid.y_high)})
    sink.number({name, "mm", "end of the cells"}, value);
  sink.numbers({"cell_events", "1", "events in each cell"}, grid.counts);
  sink.counts({"peak_of_cell", "1", "index of the peak that the cell is assigned to"},
              whole_column(flood.peak_of_cell, [](std::uint32_t peak) { return peak; }));
}

void part_fields(FieldSink& sink, const std::vector<PartLight>& parts, const char* unit,
                 const NameOf& name_of) {
  const Group group(sink, "parts", "light of the events of each part, by their largest deposit");
  std::vector<std::string> names, status;
  for (const PartLight& part : parts) {
    names.push_back(name_of(part.part));
    status.emplace_back(status_name(part.peak.status));
  }
  sink.texts({"part_name", "", "name of the part"}, names);
  sink.counts({"pulses", "1", "events of the part with light"},
              whole_column(parts, [](const PartLight& part) { return part.pulses; }));
  estimates(sink, {"mean_light", unit, "mean light of a pulse"}, parts,
            [](const PartLight& part) { return part.mean_light; });
  estimates(sink, {"light_per_keV", "see light_unit, per keV", "light over deposited energy"}, parts,
            [](const PartLight& part) { return part.light_per_keV; });
  sink.texts({"status", "", "of the fit of its photopeak: trusted, or why not"}, status);
  const auto number_of = [](const PartLight& part, const Estimate& value) {
    return part.peak.has_numbers() ? value : Estimate{std::nan(""), std::nan("")};
  };
  estimates(sink, {"position", unit, "position of the photopeak; NaN without a fit"}, parts,
            [&](const PartLight& part) { return number_of(part, part.peak.fit.position); });
  estimates(sink, {"resolution_fwhm", "1", "energy resolution; NaN without a fit"}, parts,
            [&](const PartLight& part) { return number_of(part, part.peak.fit.relative_fwhm); });
}

void order_columns(FieldSink& sink, const std::string& name, const std::string& description,
                   const std::vector<OrderTiming>& timings) {
  const Group group(sink, name, description);
  sink.counts({"n", "1", "number of the photon, from 1"},
              whole_column(timings, [](const OrderTiming& timing) { return timing.n; }));
  estimates(sink, {"mean_ns", "ns", "mean time"}, timings,
            [](const OrderTiming& timing) { return timing.mean_ns; });
  estimates(sink, {"ctr_fwhm_ns", "ns", "coincidence time resolution of two such detectors"}, timings,
            [](const OrderTiming& timing) { return timing.ctr_fwhm_ns; });
}

void timing_fields(FieldSink& sink, const EventAnalysis& analysis) {
  const auto add = [&](const std::string& name, const std::string& description, const auto& values) {
    if (values) spread(sink, name, description, "ns", *values);
  };
  add("coincidence", "time difference of two such detectors", analysis.pair_difference_ns);
  add("coincidence_first_photon", "the same by the first photon", analysis.first_photon_difference_ns);
  add("end_difference", "time of the near end minus that of the far end", analysis.end_difference_ns);
  if (analysis.timing_against_depth) {
    const std::vector<TimingSlice>& slices = analysis.timing_against_depth->slices;
    const Group group(sink, "timing_against_depth",
                      "time and coincidence time resolution in slices of depth");
    sink.numbers({"depth_mm", "mm", "mean depth of the slice"},
                 column(slices, [](const TimingSlice& at) { return at.depth_mm; }));
    sink.counts({"slice_events", "1", "events in the slice"},
                whole_column(slices, [](const TimingSlice& at) { return at.count; }));
    estimates(sink, {"mean_ns", "ns", "mean time"}, slices, [](const TimingSlice& at) { return at.mean_ns; });
    estimates(sink, {"ctr_fwhm_ns", "ns", "coincidence time resolution"}, slices,
              [](const TimingSlice& at) { return at.ctr_fwhm_ns; });
  }
  if (!analysis.orders) return;
  order_columns(sink, "nth_photon", "timing by the n-th photon", analysis.orders->single);
  if (!analysis.orders->average.empty())
    order_columns(sink, "mean_of_first_n", "timing by the mean of the first n photons",
                  analysis.orders->average);
  if (!analysis.orders_bound) return;
  const Group group(sink, "timing_bound", "lower bound on the coincidence time resolution");
  sink.numbers({"first_ns", "ns", "by the first n photons, in the order of nth_photon"},
               analysis.orders_bound->first_ns);
  sink.number({"all_ns", "ns", "by all photons"}, analysis.orders_bound->all_ns);
}

}  // namespace

void list_fields(const EventAnalysis& analysis, const core::IdVector<core::PartId, std::string>& parts,
                 FieldSink& sink) {
  const NameOf name_of = [&](core::PartId part) {
    return parts.contains(part) ? parts[part] : std::string();
  };
  const char* unit = analysis.has_readout ? "photoelectrons" : "photons";
  sink.count({"events", "1", "events of the point"}, whole(analysis.events));
  sink.count({"pulses", "1", "events with light in a channel"}, whole(analysis.pulses));
  sink.count({"selected", "1", "pulses in flood map, depth of interaction and timing"},
             whole(analysis.selected));
  sink.text({"selection", "", "which pulses these are"}, analysis.selection);
  sink.text({"light_unit", "", "unit of light: photoelectrons of charge, or photons"}, unit);
  sink.texts({"left_out", "", "analyses that were left out, each with its reason"}, analysis.left_out);
  if (analysis.pulses == 0) return;
  estimate(sink, {"mean_light", unit, "mean light of a pulse"}, analysis.mean_light);
  estimate(sink, {"light_per_keV", "see light_unit, per keV", "light over deposited energy"},
           analysis.light_per_keV);
  if (analysis.mean_depth_mm) estimate(sink, {"mean_depth_mm", "mm", "mean depth"}, *analysis.mean_depth_mm);
  if (analysis.spectrum) histogram(sink, *analysis.spectrum, "spectrum", unit, "light of pulses");
  photopeak(sink, analysis.peak, unit);
  part_fields(sink, analysis.parts, unit, name_of);
  if (analysis.light_against_depth) depth_fields(sink, *analysis.light_against_depth);
  if (analysis.doi) doi_fields(sink, *analysis.doi);
  if (analysis.layers_by_ratio)
    confusion_fields(sink, "layers_by_ratio", analysis.layers_by_ratio->confusion);
  if (analysis.layers_by_flood) confusion_fields(sink, "layers_by_flood", *analysis.layers_by_flood);
  if (analysis.flood) flood_fields(sink, *analysis.flood, name_of);
  timing_fields(sink, analysis);
}

}  // namespace scintray::analysis
