/// The analysis of events as dictionaries of numbers and arrays.

#include "scintray/analysis/event_analysis.hpp"

#include "scintray/core/words.hpp"
#include "scintray/python/detail/bindings.hpp"
#include "scintray/results/results.hpp"
#include "scintray/scene_file/analysis.hpp"
#include "scintray/simulation/analyze_results.hpp"
#include "scintray/simulation/reweight.hpp"

namespace scintray::python {

namespace {

using namespace analysis;

py::dict histogram(const Histogram& of) {
  py::dict entry;
  entry["edges"] = array_of(of.edges());
  entry["counts"] = array_of(of.counts);
  entry["below"] = of.below;
  entry["above"] = of.above;
  return entry;
}

/// @param bins  over which the density is evaluated, so that it can be drawn
py::dict peak_fit(const PeakFit& fit, const Histogram& bins) {
  py::dict entry;
  entry["converged"] = fit.converged;
  entry["position"] = estimate(fit.position);
  entry["sigma"] = estimate(fit.sigma);
  entry["events"] = estimate(fit.events);
  entry["relative_fwhm"] = estimate(fit.relative_fwhm);
  entry["p_value"] = fit.goodness.p_value;
  entry["histogram"] = histogram(bins);
  std::vector<double> expected;
  for (std::size_t i = 0; fit.converged && i < bins.counts.size(); ++i)
    expected.push_back(fit.model.expected(bins.edge(i), bins.edge(i + 1)));
  entry["expected"] = array_of(std::move(expected));
  return entry;
}

py::dict photopeak(const Photopeak& peak) {
  py::dict entry = peak_fit(peak.fit, peak.fitted);
  entry["status"] = status_name(peak.status);
  entry["reason"] = peak.reason;
  entry["locates_peak"] = peak.locates_peak();
  return entry;
}

py::dict spread(const Spread& of) {
  py::dict entry = peak_fit(of.fit, of.fitted);
  entry["count"] = of.count;
  entry["mean"] = estimate(of.mean);
  entry["gaussian_fwhm"] = estimate(of.gaussian_fwhm);
  entry["quantile_fwhm"] = estimate(of.quantile_fwhm);
  return entry;
}

py::dict line(const StraightLine& of) {
  py::dict entry;
  entry["offset"] = estimate(of.offset);
  entry["slope"] = estimate(of.slope);
  entry["p_value"] = of.goodness.p_value;
  return entry;
}

py::dict depth_curve_of(const DepthCurve& curve) {
  py::dict entry;
  std::vector<double> depth;
  std::vector<std::uint64_t> count;
  std::vector<core::Estimate> value;
  bool from_peak = !curve.points.empty();
  for (const DepthPoint& point : curve.points) {
    depth.push_back(point.depth_mm);
    count.push_back(point.count);
    value.push_back(point.value);
    from_peak = from_peak && point.from_peak;
  }
  entry["depth_mm"] = array_of(std::move(depth));
  entry["count"] = array_of(std::move(count));
  entry["value"] = estimates(value);
  entry["relative"] = estimates(curve.relative);
  entry["from_peak"] = from_peak;
  entry["line"] = line(curve.line);
  entry["relative_slope_per_mm"] = estimate(curve.relative_slope_per_mm);
  return entry;
}

py::dict flood_of(const FloodMap& map, const core::IdVector<core::PartId, std::string>& parts) {
  const FloodGrid& grid = map.grid;
  const std::vector<py::ssize_t> shape{static_cast<py::ssize_t>(grid.rows),
                                       static_cast<py::ssize_t>(grid.columns)};
  py::dict entry;
  entry["counts"] = array_of(grid.counts, shape);
  entry["peak_of_cell"] = array_of(map.peak_of_cell, shape);
  entry["extent_mm"] = py::make_tuple(grid.x_low, grid.x_high, grid.y_low, grid.y_high);
  std::vector<double> positions;
  std::vector<std::uint64_t> events;
  std::vector<std::string> owners, crystals;
  for (const core::PartId crystal : map.crystals) crystals.push_back(parts[crystal]);
  for (const FloodPeak& peak : map.peaks) {
    positions.insert(positions.end(), peak.position_mm.begin(), peak.position_mm.end());
    events.push_back(peak.events);
    owners.push_back(crystals.empty() ? "" : crystals.at(peak.owner));
  }
  entry["peak_mm"] = array_of(std::move(positions), {static_cast<py::ssize_t>(map.peaks.size()), 2});
  entry["peak_events"] = array_of(std::move(events));
  entry["peak_part"] = owners;
  entry["parts"] = crystals;
  entry["share_right"] = estimate(map.share_right);
  entry["peak_to_valley"] = map.peak_to_valley;
  entry["worst_peak_to_valley"] = map.worst_peak_to_valley;
  entry["smoothing_mm"] = map.smoothing_mm;
  return entry;
}

py::dict doi_of(const DoiAnalysis& doi) {
  py::dict entry;
  entry["calibration_ratio"] = array_of(doi.calibration.ratio);
  entry["calibration_depth_mm"] = array_of(doi.calibration.depth_mm);
  entry["line"] = line(doi.line);
  entry["residual"] = spread(doi.residual);
  std::vector<double> depth;
  std::vector<core::Estimate> bias, fwhm;
  for (const DoiSlice& slice : doi.slices) {
    depth.push_back(slice.depth_mm);
    bias.push_back(slice.bias_mm);
    fwhm.push_back(slice.fwhm_mm);
  }
  entry["depth_mm"] = array_of(std::move(depth));
  entry["bias_mm"] = estimates(bias);
  entry["fwhm_mm"] = estimates(fwhm);
  return entry;
}

py::dict orders_of(const std::vector<OrderTiming>& orders) {
  std::vector<std::uint64_t> n, events;
  std::vector<core::Estimate> mean, ctr;
  for (const OrderTiming& of : orders) {
    n.push_back(of.n);
    events.push_back(of.events);
    mean.push_back(of.mean_ns);
    ctr.push_back(of.ctr_fwhm_ns);
  }
  py::dict entry;
  entry["n"] = array_of(std::move(n));
  entry["events"] = array_of(std::move(events));
  entry["mean_ns"] = estimates(mean);
  entry["ctr_fwhm_ns"] = estimates(ctr);
  return entry;
}

py::dict timing_depth_of(const TimingDepth& timing) {
  std::vector<double> depth;
  std::vector<core::Estimate> mean, ctr;
  for (const TimingSlice& slice : timing.slices) {
    depth.push_back(slice.depth_mm);
    mean.push_back(slice.mean_ns);
    ctr.push_back(slice.ctr_fwhm_ns);
  }
  py::dict entry;
  entry["depth_mm"] = array_of(std::move(depth));
  entry["mean_ns"] = estimates(mean);
  entry["ctr_fwhm_ns"] = estimates(ctr);
  entry["line"] = line(timing.line);
  return entry;
}

py::dict analysis_of(const EventAnalysis& of, const core::IdVector<core::PartId, std::string>& parts) {
  py::dict entry;
  entry["events"] = of.events;
  entry["pulses"] = of.pulses;
  entry["selected"] = of.selected;
  entry["selection"] = of.selection;
  entry["light_unit"] = of.has_readout ? "photoelectrons" : "photons";
  entry["spectrum"] = optional(of.spectrum, histogram);
  entry["photopeak"] = photopeak(of.peak);
  entry["mean_light"] = estimate(of.mean_light);
  entry["light_per_keV"] = estimate(of.light_per_keV);
  entry["light_against_depth"] = optional(of.light_against_depth, depth_curve_of);
  entry["doi"] = optional(of.doi, doi_of);
  entry["flood"] = optional(of.flood, [&](const FloodMap& map) { return flood_of(map, parts); });
  entry["ctr"] = optional(of.pair_difference_ns, spread);
  entry["ctr_quoted"] =
      optional(of.pair_difference_ns, [](const Spread& pairs) { return estimate(quoted_fwhm(pairs)); });
  entry["ctr_first_photon"] = optional(of.first_photon_difference_ns, spread);
  entry["end_difference"] = optional(of.end_difference_ns, spread);
  entry["timing_against_depth"] = optional(of.timing_against_depth, timing_depth_of);
  entry["ctr_by_order"] =
      optional(of.orders, [](const OrderAnalysis& orders) { return orders_of(orders.single); });
  entry["ctr_by_average"] =
      optional(of.orders, [](const OrderAnalysis& orders) { return orders_of(orders.average); });
  entry["left_out"] = of.left_out;
  return entry;
}

/// The analysis of the events of a point by [analysis] of a text, or of the run's scene.
py::dict analyze(RunData& data, std::size_t point, const std::optional<std::string>& settings) {
  const tally::RunHeader& header = data.result.header;
  EventAnalysis result;
  data.read_all_events();
  if (point >= data.events.size())
    throw core::InputError(
        core::Problem{{header.scene_file},
                      "this result has no events to analyze",
                      "run a scene whose [source] is an event source: gamma_events, gammas or hits"});
  WatchedWork work;
  raise_if(work.run([&] {
    const scene_file::AnalysisSpec spec =
        settings ? scene_file::analysis_of_text(*settings, "the settings of the analysis")
                 : scene_file::analysis_of_text(header.scene_text, header.scene_file);
    const EventColumns& events = data.events[point];
    AnalysisSetup setup = simulation::analysis_setup(spec, events.channels, header.parts);
    setup.photon_order = events.photon_order;
    setup.light_timing = data.result.points.at(point).light_timing;
    EventCollector collector(std::move(setup));
    for (std::size_t row = 0; row < events.size(); ++row) {
      if (work.stop.load()) throw core::Cancelled("the analysis was stopped");
      collector.add(events.record(row, static_cast<std::uint32_t>(point)));
    }
    result = collector.finish();
  }));
  return analysis_of(result, header.parts);
}

constexpr core::Word<simulation::OpticalProperty> kProperties[] = {
    {"absorption_length", simulation::OpticalProperty::absorption_length},
    {"reflectance", simulation::OpticalProperty::reflectance}};

/// A point for other absorption lengths or reflectances, from the histories of a file.
py::list reweight(const std::string& path, const std::string& property, const std::string& name, bool times,
                  std::vector<double> values) {
  std::vector<simulation::ReweightedPoint> points;
  {
    const py::gil_scoped_release released;
    simulation::PropertyScan scan;
    scan.property = core::find_word(kProperties, property).value();
    scan.name = name;
    scan.times = times;
    scan.values = std::move(values);
    points = simulation::reweight_results(path, results::read_results(path), {scan});
  }
  py::list entries;
  for (const simulation::ReweightedPoint& point : points) {
    py::dict entry;
    entry["point"] = point.point;
    entry["value"] = point.values.at(0);
    entry["traced"] = estimate(point.traced_fraction);
    entry["detected"] = estimate(point.light.detected_fraction);
    entry["relative"] = estimate(point.light.relative);
    entry["effective_photons"] = point.light.effective_photons;
    entry["valid"] = point.light.valid;
    entry["reason"] = point.light.reason;
    entries.append(entry);
  }
  return entries;
}

}  // namespace

void add_analysis(py::module_& module) {
  module.def("analyze", &analyze);
  module.def("reweight", &reweight);
}

}  // namespace scintray::python
