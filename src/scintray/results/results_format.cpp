#include "scintray/results/results_format.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <numeric>

#include "scintray/results/results.hpp"

namespace scintray::results::format {

namespace {

constexpr std::array kFields = {
    // the run
    Field{"seed", "1", "seed of the random streams"},
    Field{"scene", "", "the complete scene file"},
    Field{"note", "", "warnings of the run, one a line"},
    Field{"sweep_keys", "", "swept keys, the slowest first"},
    Field{"media", "", "names of the media; absorbed_in_medium is in this order"},
    Field{"surfaces", "", "names of the surfaces; absorbed_at_surface is in this order"},
    Field{"parts", "", "names of the parts; columns called part are indices into this"},
    Field{"faces", "", "names of the faces as part:face; columns called face are indices into this"},
    Field{"fate_names", "", "names of the fates; the fate datasets are in this order"},
    // dimension scales
    Field{"row", "1", "number of the row"},
    Field{"index", "1", "number along a dimension, from 0"},
    Field{"index_2", "1", "number along another dimension, from 0"},
    Field{"index_3", "1", "number along another dimension, from 0"},
    Field{"index_4", "1", "number along another dimension, from 0"},
    Field{"index_5", "1", "number along another dimension, from 0"},
    Field{"index_6", "1", "number along another dimension, from 0"},
    Field{"fate", "", "name of each fate"},
    Field{"medium", "", "name of each medium"},
    Field{"surface", "", "name of each surface"},
    Field{"swept_key", "", "swept keys, the slowest first"},
    Field{"path_low_mm", "mm", "lower end of the bin of path length; the last bin has no upper end"},
    Field{"angle_low_deg", "deg", "lower end of the bin of angles"},
    Field{"sample", "1", "number of the sample within its row, from 0"},
    Field{"event_group", "1", "number of the group of events: of an event, its number modulo 64"},
    Field{"bin_0", "1", "number of the bin along axis_0"},
    Field{"bin_1", "1", "number of the bin along axis_1"},
    Field{"bin_2", "1", "number of the bin along axis_2"},
    Field{"bin_3", "1", "number of the bin along axis_3"},
    Field{"bin_4", "1", "number of the bin along axis_4"},
    Field{"bin_5", "1", "number of the bin along axis_5"},
    Field{"medium_index", "1", "index into history_media"},
    Field{"reflector_index", "1", "index into reflector_name"},
    Field{"channel_index", "1", "number of the channel"},
    // a point
    Field{"parameter_value", "see parameter_unit",
          "value of each swept key as a number; NaN for one that is no number"},
    Field{"parameter_unit", "", "unit of each value, as written"},
    Field{"parameters", "", "value of each swept key at this point, as written"},
    Field{"photons_requested", "1", "photons requested"},
    Field{"photons_traced", "1", "photons followed to their end"},
    Field{"birth_efficiency", "1",
          "photons that no sensor would convert, all but this share, were not traced; 1: all were traced"},
    Field{"fate_count", "1", "traced photons per fate"},
    Field{"fate_fraction", "1",
          "share of the emitted photons: fate_count / photons_traced where birth_efficiency is 1"},
    Field{"fate_error", "1", "standard error of fate_fraction"},
    Field{"events_with_photons", "1", "events of which photons were traced"},
    Field{"event_fate_products", "1",
          "sums over the events of the product of the photons with one fate and those with another"},
    Field{"condition", "", "conditions of [run] until"},
    Field{"goal", "see condition", "what was to be reached: a share, s, photons or events"},
    Field{"reached", "see condition", "what was reached; NaN: not known"},
    Field{"met", "1", "1: the condition ended the point"},
    Field{"absorbed_in_medium", "1", "photons absorbed in each medium"},
    Field{"absorbed_at_surface", "1", "photons absorbed at each surface"},
    Field{"absorbed_in_medium_event_squares", "1",
          "sums over the events of the square of the photons absorbed in each medium"},
    Field{"absorbed_in_medium_event_products", "1",
          "sums over the events of their product with the photons traced of the event"},
    Field{"absorbed_at_surface_event_squares", "1",
          "sums over the events of the square of the photons absorbed at each surface"},
    Field{"absorbed_at_surface_event_products", "1",
          "sums over the events of their product with the photons traced of the event"},
    Field{"shifter_absorbed", "1", "photons absorbed by the wavelength shifter"},
    Field{"shifter_emitted", "1", "of these, photons re-emitted; the others are absorbed"},
    Field{"shifter_additional", "1", "photons re-emitted beyond one for each of shifter_emitted"},
    Field{"energy_before", "eV", "energy of the photons re-emitted, when they were absorbed"},
    Field{"energy_after", "eV", "energy of all photons that were re-emitted"},
    Field{"energy_kept", "eV", "energy of the photons not re-emitted"},
    Field{"detected_path_histogram", "1",
          "detected photons per 10 mm of path length; the last bin is 500 mm and more"},
    Field{"scatterings", "1", "scatterings in media"},
    Field{"segments", "1", "straight path segments traced"},
    Field{"resolved_misses", "1", "ray queries resolved by the exact query"},
    Field{"lost", "1", "photons without a fate; zero in every sound run"},
    Field{"wall_seconds", "s", "computing time of the point"},
    // sensor_faces
    Field{"detected", "1", "photons detected by the sensor that came through the face"},
    Field{"unconverted", "1", "photons that reached the sensor through the face, not detected"},
    Field{"detected_event_squares", "1", "sums over the events of the square of detected"},
    Field{"detected_event_products", "1",
          "sums over the events of the product of detected and the photons traced of the event"},
    Field{"unconverted_event_squares", "1", "sums over the events of the square of unconverted"},
    Field{"unconverted_event_products", "1",
          "sums over the events of the product of unconverted and the photons traced of the event"},
    Field{"detected_unconverted_products", "1",
          "sums over the events of the product of detected and unconverted"},
    // exit_angles
    Field{"inside", "1", "crossings per equal bin of 0 to 90 deg, angle in the medium of the face's part"},
    Field{"outside", "1", "crossings per equal bin of 0 to 90 deg, angle in the medium beyond"},
    Field{"inside_group_sums", "1", "the same of each group of events: of an event, its number modulo 64"},
    Field{"outside_group_sums", "1", "the same of each group of events: of an event, its number modulo 64"},
    // tallies
    Field{"names", "", "meaning of each bin of the axis"},
    Field{"edges", "see group", "edges of the bins, one more than bins"},
    Field{"along", "1", "direction along which a position, start or direction is measured; zeros otherwise"},
    Field{"event_squares", "see group, squared", "sum over the events of the square of each event's score"},
    Field{"event_products", "see group",
          "sum over the events of the product of each event's score and the photons traced of it"},
    Field{"group_sums", "see group", "sum over each group of events: of an event, its number modulo 64"},
    Field{"beyond", "see group", "score outside the axes"},
    Field{"refractive_index", "1",
          "of the medium in which directions at the face are; 0 when there is no one index"},
    // energy
    Field{"events_requested", "1", "events requested"},
    Field{"events_traced", "1", "events traced to their end"},
    Field{"events_silent", "1", "of them, those without energy deposited in a scintillator"},
    Field{"started_keV", "keV", "energy of all particles at their start; 0 when not available"},
    Field{"deposited_keV", "keV", "energy deposited in scintillators, all events"},
    Field{"escaped_total_keV", "keV", "energy carried out of the scene, all events"},
    Field{"unseen_total_keV", "keV", "energy deposited in non-scintillating parts, all events"},
    // light_timing
    Field{"decay_ns", "ns", "decay time of each exponential of the emission"},
    Field{"rise_ns", "ns", "its rise time"},
    Field{"decay_share", "1", "its share of the light"},
    Field{"time_spread_ns", "ns", "standard deviation of the sensors' transit time or single photon time"},
    // omitted_effects
    Field{"effect", "", "physical effect that the numbers of this point do not include"},
    Field{"subject", "", "medium or sensor without it; empty: of the whole detector"},
    Field{"remedy", "", "what a scene states to include it; empty: there is no model of it"},
    Field{"in_resolution", "1", "1: it would change the energy resolution"},
    Field{"in_timing", "1", "1: it would change the coincidence time resolution"},
    Field{"in_fraction", "1", "1: it would change the detected fraction"},
    // events
    Field{"energy_keV", "keV", "energy deposited in scintillators"},
    Field{"escaped_keV", "keV", "energy carried out of the scene"},
    Field{"unseen_keV", "keV", "energy deposited in non-scintillating parts"},
    Field{"mean_x_mm", "mm", "mean of the deposits, weighted by energy, x"},
    Field{"mean_y_mm", "mm", "mean of the deposits, weighted by energy, y"},
    Field{"mean_z_mm", "mm", "mean of the deposits, weighted by energy, z"},
    Field{"main_part", "1", "part of the largest deposit, index into /parts; 4294967295: none"},
    Field{"photons_emitted", "1", "photons emitted"},
    Field{"photons_detected", "1", "photons detected by sensors"},
    Field{"first_signal", "1", "the event's first row of /signals; the next event's follow its last"},
    // signals
    Field{"event_row", "1", "row of /events"},
    Field{"channel", "1", "number of the channel within its point"},
    Field{"first_ns", "ns", "time of the first detected photon since the event; NaN: none"},
    Field{"charge", "photoelectrons", "charge after the sensor's response; NaN without a readout"},
    Field{"amplitude", "photoelectrons", "of the waveform; NaN without a readout"},
    Field{"pickoff_ns", "ns", "time by the readout's pick-off; NaN: none"},
    // photon_times, pulses
    Field{"samples", "see group", "one row for each row of /signals"},
    Field{"order", "1", "numbers n of the photons: 1 is the first"},
    Field{"period_ns", "ns", "time between samples"},
    Field{"first_sample_ns", "ns", "time of the first sample since the event"},
    // benches
    Field{"cell_polar_low_deg", "deg", "cell of directions: least angle to the normal"},
    Field{"cell_polar_high_deg", "deg", "cell of directions: largest angle to the normal"},
    Field{"cell_azimuth_low_deg", "deg", "cell of directions: azimuth from forward, lower edge"},
    Field{"cell_azimuth_high_deg", "deg", "cell of directions: azimuth from forward, upper edge"},
    Field{"cell_solid_angle_sr", "sr", "cell of directions: solid angle"},
    Field{"index_inside", "1", "refractive index of the medium that the light comes from"},
    Field{"index_outside", "1", "refractive index of the medium behind the surface"},
    Field{"rays", "1", "rays shot at each angle of incidence"},
    Field{"incidence_deg", "deg", "angles of incidence"},
    Field{"reflectance", "1", "share of the rays that is reflected, at each incidence"},
    Field{"reflectance_error", "1", "its standard error"},
    Field{"mean_slope_deg", "deg",
          "mean visible slope: mean angle of the facets hit first to the mean normal, at each incidence"},
    Field{"mean_slope_error_deg", "deg", "its standard error; 0: interpolated in a table"},
    Field{"directions_at_deg", "deg", "angle of incidence of the following datasets"},
    Field{"rays_reflected", "1", "rays reflected"},
    Field{"rays_transmitted", "1", "rays transmitted"},
    Field{"rays_absorbed", "1", "rays absorbed"},
    Field{"lobe_width", "1",
          "rms of the reflected rays' component across their mean direction, in the plane of incidence"},
    Field{"reflected_cells", "1", "reflected rays in each cell of directions"},
    Field{"transmitted_cells", "1", "transmitted rays in each cell of directions"},
    Field{"reflected_profile", "1", "reflected rays near the plane of incidence, bins of 1 deg from -90 deg"},
    Field{"transmitted_profile", "1",
          "transmitted rays near the plane of incidence, bins of 1 deg from -90 deg"},
    // channels
    Field{"channel_name", "",
          "name of each channel: a sensor's part, or part:face of a face that is a sensor"},
    Field{"channel_part", "1", "the sensor's part, index into /parts"},
    Field{"channel_x_mm", "mm", "centre of the faces through which light enters, x"},
    Field{"channel_y_mm", "mm", "centre of the faces through which light enters, y"},
    Field{"channel_z_mm", "mm", "centre of the faces through which light enters, z"},
    Field{"channel_normal_x", "1", "mean normal of these faces, into the sensor, x"},
    Field{"channel_normal_y", "1", "mean normal of these faces, into the sensor, y"},
    Field{"channel_normal_z", "1", "mean normal of these faces, into the sensor, z"},
    Field{"channel_area_mm2", "mm2", "area of these faces"},
    // moments
    Field{"count", "1", "photons counted"},
    Field{"sum", "see group", "sum over the photons"},
    Field{"sum_of_squares", "see group, squared", "sum over the photons of the square of each value"},
    Field{"events_counted", "1", "events in which photons have a value"},
    Field{"event_count_squares", "1", "sum over the events of the square of the number of their values"},
    Field{"event_sum_squares", "see group, squared",
          "sum over the events of the square of the sum of their values"},
    Field{"event_sum_products", "see group",
          "sum over the events of the sum of their values, times their number"},
    Field{"mean", "see group", "sum / count"},
    Field{"mean_error", "see group", "standard error of mean"},
    // photons
    Field{"point", "1", "index of the point of the sweep"},
    Field{"event", "1", "event number"},
    Field{"photon", "1", "photon number within the event; with seed and event, enough to replay it"},
    Field{"part", "1", "sensor's part, index into /parts"},
    Field{"face", "1", "face crossed, index into /faces"},
    Field{"x_mm", "mm", "position of detection, x"},
    Field{"y_mm", "mm", "position of detection, y"},
    Field{"z_mm", "mm", "position of detection, z"},
    Field{"direction_x", "1", "direction of travel at detection, x"},
    Field{"direction_y", "1", "direction of travel at detection, y"},
    Field{"direction_z", "1", "direction of travel at detection, z"},
    Field{"wavelength_nm", "nm", "wavelength in vacuum"},
    Field{"time_ns", "ns", "time of detection since the event"},
    Field{"path_mm", "mm", "path length since emission"},
    Field{"interactions", "1", "boundary interactions since emission"},
    // paths, path_steps
    Field{"path_fate", "1", "fate of the photon, index into /fate_names"},
    Field{"first_step", "1", "the path's first row of /path_steps; the next path's follow its last"},
    Field{"path_row", "1", "row of /paths"},
    Field{"step_x_mm", "mm", "where the path begins, bends or ends, x"},
    Field{"step_y_mm", "mm", "where the path begins, bends or ends, y"},
    Field{"step_z_mm", "mm", "where the path begins, bends or ends, z"},
    Field{"step_ns", "ns", "time since the event"},
    Field{"step_nm", "nm", "wavelength in vacuum, after the step"},
    Field{"step_text", "1", "what happened there, index into /step_texts"},
    Field{"step_texts", "", "step events of photon paths in words; step_text is an index into this"},
    // histories, traced_optics
    Field{"history_media", "",
          "media in which paths are recorded; columns with one number a medium are in "
          "this order"},
    Field{"history_gap_media", "", "media that fill gaps of surfaces too, where paths are not recorded"},
    Field{"history_transmitting", "",
          "reflectors that transmit light, and surfaces with them: they are not recorded"},
    Field{"reflector_surface", "",
          "surface of each reflector, a mixture's own; columns with one number a "
          "reflector are in this order"},
    Field{"reflector_stack", "", "stack of each reflector: the surface, or a component of its mixture"},
    Field{"reflector_name", "", "name of each reflector"},
    Field{"medium_path_mm", "mm", "path length in each medium"},
    Field{"absorption_depth", "1", "integral of 1 / absorption length along the path in each medium"},
    Field{"reflections", "1", "reflections at each reflector that were survived by its reflectance"},
    Field{"reflection_depth", "1", "sum of -ln(reflectance) over these reflections"},
    Field{"absorption_per_mm_least", "1/mm",
          "least 1 / absorption length of each medium in the wavelengths in use"},
    Field{"absorption_per_mm_most", "1/mm",
          "most 1 / absorption length of each medium in the wavelengths in use"},
    Field{"reflectance_least", "1", "least reflectance of each reflector in the wavelengths in use"},
    Field{"reflectance_most", "1", "most reflectance of each reflector in the wavelengths in use"},
};

}  // namespace

const Field& field(std::string_view name) {
  for (const Field& known : kFields)
    if (name == known.name) return known;
  throw core::InternalError("results file: no description of " + std::string(name));
}

void describe(core::h5::Group& group, const std::string& name) {
  const Field& known = field(name);
  group.set_attribute(name, "description", std::string(known.description));
  group.set_attribute(name, "unit", std::string(known.unit));
}

core::h5::File open_results(const std::filesystem::path& path) {
  core::h5::File file = core::h5::File::open(path);
  const core::h5::Group root = file.root();
  if (!has_format(root))
    throw core::InputError({{path.string()},
                            "this HDF5 file is not a ScintRay result",
                            "name a file that `scintray run` wrote"});
  const std::int64_t version = root.integer_attribute("", "version");
  constexpr std::int64_t kOldest = 1;
  if (version < kOldest || version > kResultsVersion)
    throw core::InputError({{path.string()},
                            "this result has format version " + std::to_string(version) +
                                " (written by ScintRay " + root.string_attribute("", "scintray_version") +
                                "), but this program reads versions " + std::to_string(kOldest) + " to " +
                                std::to_string(kResultsVersion),
                            version > kResultsVersion ? "use a newer ScintRay"
                                                      : "run the scene again, or use the older ScintRay"});
  return file;
}

bool has_format(const core::h5::Group& root) {
  return root.has_attribute("", "format") && root.string_attribute("", "format") == kFormat;
}

core::InputError damaged(const std::filesystem::path& path, const std::string& what) {
  return core::InputError({{path.string()},
                           "this result is inconsistent: " + what,
                           "copy it again from where it was made, or run again"});
}

core::InputError lacking(const std::filesystem::path& path, const std::string& what,
                         const std::string& hint) {
  return core::InputError({{path.string()}, what, hint});
}

namespace {

/// Name of a dimension that has none: one for each length, in order of appearance.
std::string index_name(std::vector<std::uint64_t>& lengths, std::uint64_t length) {
  auto at = std::find(lengths.begin(), lengths.end(), length);
  if (at == lengths.end()) at = lengths.insert(at, length);
  const auto number = at - lengths.begin() + 1;
  return number == 1 ? "index" : "index_" + std::to_string(number);
}

}  // namespace

void name_dimensions(core::h5::Group& group, const DimensionNames& names) {
  std::vector<std::uint64_t> lengths;
  for (const std::string& member : group.members()) {
    if (!group.has_dataset(member)) continue;
    const core::h5::Shape shape = group.shape(member);
    const auto named = names.find(member);
    for (unsigned k = 0; k < shape.size(); ++k) {
      if (group.has_scale(member, k)) continue;
      const std::string scale =
          named != names.end() && k < named->second.size() ? named->second[k] : index_name(lengths, shape[k]);
      if (!group.has(scale)) {
        std::vector<std::int64_t> indices(shape[k]);
        std::iota(indices.begin(), indices.end(), 0);
        put(group, scale, indices);
      }
      if (!group.has_scale(scale, 0)) group.make_scale(scale);
      if (scale != member) group.attach_scale(member, k, group, scale);
    }
  }
}

std::string numbered(std::size_t index) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%04zu", index);
  return text.data();
}

}  // namespace scintray::results::format
