#pragma once
/// Results of a run, as plain data: set by the simulation, written by results, read by analysis and report.
/// Ids are those of the scene until a point has ended, then those of the names in RunHeader.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "scintray/core/id_vector.hpp"
#include "scintray/core/ids.hpp"
#include "scintray/core/statistics.hpp"
#include "scintray/core/step_event.hpp"
#include "scintray/optics/decay_time.hpp"
#include "scintray/optics/wavelength_shifter.hpp"

namespace scintray::tally {

/// Sums over the events of an event source, of each its number of photons of one kind: of its square, and of
/// its product with the photons traced of the event. Zeros: no such photon, or not known.
struct EventShare {
  std::uint64_t squares = 0, products = 0;

  void add(std::uint64_t count, std::uint64_t photons) {
    squares += count * count;
    products += count * photons;
  }
  EventShare& operator+=(const EventShare& other) {
    squares += other.squares;
    products += other.products;
    return *this;
  }
  bool operator==(const EventShare&) const = default;
};

/// Groups of the events of an event source, by their numbers modulo this, for the errors of quantities that
/// are computed from several bins of a tally.
inline constexpr std::size_t kEventGroups = 64;

/// Sums over the events of an event source in which photons have a quantity: n photons of an event sum to s.
struct EventMoments {
  std::uint64_t events = 0;         ///< 0: photons are independent, or older than these sums
  std::uint64_t count_squares = 0;  ///< of n^2
  double squares = 0.0;             ///< of s^2
  double products = 0.0;            ///< of s n

  bool operator==(const EventMoments&) const = default;
};

/// Sums of a quantity over photons.
struct PhotonMoments : core::Moments {
  EventMoments of_events;

  /// Mean with its standard error: of independent photons, or of independent events where there are two or
  /// more (docs/physics.md, Estimates).
  core::Estimate mean() const;
};

/// Photons that reached one sensor through one face.
struct SensorFaceCount {
  core::PartId part;  ///< the sensor's
  core::FaceId face;  ///< the face crossed
  std::uint64_t detected = 0;
  std::uint64_t not_detected = 0;
  EventShare events_detected{}, events_not_detected{};
  std::uint64_t events_both = 0;  ///< sum over the events of detected times not detected
};
using SensorFaceId = core::Id<SensorFaceCount>;

/// An axis of a tally: bins of a number between edges, or names.
struct TallyAxis {
  std::string variable;            ///< "time", "position", "part", ...
  std::string unit;                ///< of the edges; "1" for plain numbers, empty for names
  std::vector<double> edges;       ///< bins + 1, rising; of a number
  std::vector<std::string> names;  ///< one per bin; of names
  std::array<double, 3> along{};   ///< of a position, start or direction: the axis of measurement

  std::size_t bins() const { return names.empty() ? edges.size() - 1 : names.size(); }
};

/// Events of an event source as what is independent in its photons: those of one event share its place. The
/// errors of shares are then those of the ratio of two sums over events (docs/physics.md, Estimates).
struct EventCounts {
  std::uint64_t all = 0;           ///< traced to their end; 0: photons are independent, or not known
  std::uint64_t with_photons = 0;  ///< of them, those with photons traced
  double photon_squares = 0.0;     ///< sum over the events of the square of the photons traced
};

/// Sums over the photons of a point, on a grid of axes (row-major, the last axis fastest).
struct TallyResult {
  std::string name;
  std::string type;   ///< "count", "crosstalk", "irradiance", ...
  std::string score;  ///< "photons", or the variable that is summed
  std::string unit;   ///< of the score, "1" for photons
  /// "part:face" of the faces to which it is bound. Read from results files for exit angles only.
  std::vector<std::string> faces;
  bool detected_only = false;  ///< only the last event of each photon that is detected in the end; likewise
  std::vector<TallyAxis> axes;
  std::vector<double> sum;             ///< per bin
  std::vector<double> sum_of_squares;  ///< per bin, of the contributions of each photon
  /// Per bin, over the events of an event source: of the square of an event's score, and of its product with
  /// the photons traced of the event. Empty: photons are independent, or older than these sums.
  std::vector<double> event_squares, event_products;
  /// Sums over the events of each of kEventGroups groups, of all bins; the groups one after the other. Empty:
  /// as above, or nothing is computed from several bins of the tally.
  std::vector<double> group_sums;
  EventCounts events;    ///< of these
  double outside = 0.0;  ///< score beyond the axes
  /// Refractive index, at the middle of the wavelengths in use, of the medium of its directions at faces; 0
  /// without such directions or for several media.
  double index = 0.0;

  std::size_t bins() const;
  /// True when quantities are computed from several bins together: crosstalk, divergence, light spread,
  /// etendue.
  bool is_grouped() const;
  /// Score of a bin with its standard error, from `photons` independent photons, or from the events. A bin
  /// of photons without any has the error of one.
  core::Estimate at(std::size_t bin, std::uint64_t photons) const;
  /// Score of a bin per photon, with its standard error: the ratio of two sums over the photons, or over the
  /// events, so that the fluctuation of the number of photons is in it as far as it matters.
  core::Estimate per_photon(std::size_t bin, std::uint64_t photons) const;
};

/// Energy balance of the events of a point, keV.
struct EnergyBalance {
  std::uint64_t events_requested = 0;  ///< 0: a source of photons, for which the rest is zero too
  std::uint64_t events = 0;            ///< traced to their end
  std::uint64_t silent = 0;            ///< of them, without a deposit in a scintillator
  double started = 0.0;                ///< initial, of all particles; 0 when not available (lists of hits)
  double deposited = 0.0;              ///< in scintillators
  double escaped = 0.0;                ///< carried out of the scene
  double non_scintillating = 0.0;      ///< in non-scintillating parts
  core::Moments detected;              ///< photons detected per event with a deposit in a scintillator
};

/// Time distribution of a detected photon without its propagation: emission and the sensors' time spread.
struct LightTiming {
  std::vector<optics::DecayComponent> decay;
  double time_spread_ns = 0.0;  ///< standard deviation
};

/// A physical effect that a result does not include, because its definitions have no numbers for it or
/// because there is no model of it.
struct OmittedEffect {
  std::string effect;   ///< "intrinsic resolution"
  std::string subject;  ///< the medium or sensor without it; empty: of the whole detector
  std::string remedy;   ///< what a scene states to include it; empty: no model of it exists
  /// Figures that it would change: energy resolution, coincidence time resolution, detected fraction.
  bool in_resolution = false, in_timing = false, in_fraction = false;
};

/// What is known of a point before its first photon, beside its scene.
struct PointFacts {
  std::optional<LightTiming> light_timing;  ///< of an event source, where it is the same for all light
  /// Empty list: everything that is modelled is included. Nothing: a file from before they were recorded.
  std::optional<std::vector<OmittedEffect>> omitted;
  /// Upper bound of the efficiency of every sensor, with which photons were drawn at their birth: the others,
  /// which no sensor would have converted, were not traced. 1: all were. Fates and what is derived from them
  /// are those of the traced photons, a random sample of all but in one respect: each detected photon stands
  /// for this many photons of the sample, and the rest of it reached the sensor as well but was not detected.
  double birth_efficiency = 1.0;
};

/// A condition of [run] until at the end of a point.
struct UntilCondition {
  std::string quantity;  ///< "relative_error", "absolute_error", "wall_time" (s), "photons" or "events"
  double goal = 0.0, reached = 0.0;  ///< reached: not a number for an error that is not known
  bool met = false;                  ///< it ended the point
};

/// What [run] until stated of a point, and what was reached.
struct UntilResult {
  core::Fate fate = core::Fate::detected;  ///< whose share the errors are of, where `of` is empty
  std::vector<UntilCondition> conditions;
  std::string of;          ///< the result that the errors are of, as "CTR"; empty: the share of the fate
  std::string unit = "1";  ///< of its absolute error

  /// True when a condition ended the point; else all photons or events of its source were traced.
  bool ended() const;
  /// False when the point ended by the clock: another run ends after other photons.
  bool is_reproducible() const;
};

/// Sums over the events of a point, from which the errors of its fates follow.
struct EventFates {
  /// Sums over the events of the product of the numbers of photons with two fates.
  using Products = std::array<std::array<std::uint64_t, core::kFateCount>, core::kFateCount>;

  std::uint64_t events = 0;  ///< with photons traced; 0: photons are independent, or older than these sums
  Products products{};       ///< symmetric

  /// Adds an event by its photons of each fate; nothing without photons.
  void add(const std::array<std::uint64_t, core::kFateCount>& fates);
  EventFates& operator+=(const EventFates& other);
  /// Sum over the events of the square of the photons traced.
  double photon_squares() const;
  bool operator==(const EventFates&) const = default;
};

/// One traced point of a sweep (a run without a sweep has one point).
struct PointResult : PointFacts {
  std::vector<std::string> parameters;  ///< value of each swept key, as written ("2 mm")
  std::uint64_t photons_requested = 0;  ///< for events, the number emitted by those traced
  std::uint64_t emitted = 0;            ///< photons, those that were not traced included
  std::uint64_t photons = 0;            ///< of them, those traced to their end
  bool complete = false;                ///< false when interrupted
  EnergyBalance energy;
  std::array<std::uint64_t, core::kFateCount> fates{};  ///< by fate_index
  EventFates event_fates;                               ///< of an event source
  std::optional<UntilResult> until;                     ///< with [run] until
  core::IdVector<core::MediumId, std::uint64_t> absorbed_in_medium;
  core::IdVector<core::SurfaceId, std::uint64_t> absorbed_at_surface;
  core::IdVector<core::MediumId, EventShare> events_in_medium;    ///< of those absorbed there
  core::IdVector<core::SurfaceId, EventShare> events_at_surface;  ///< likewise
  core::IdVector<core::MediumId, optics::ShiftCount> shifted_in_medium;
  core::IdVector<core::SurfaceId, optics::ShiftCount> shifted_at_surface;
  std::vector<SensorFaceCount> sensor_faces;
  std::vector<TallyResult> tallies;
  PhotonMoments interactions;      ///< boundary interactions per photon
  PhotonMoments detected_path_mm;  ///< path length of detected photons
  PhotonMoments detected_time_ns;  ///< time from emission, plus emission time, of detected photons
  PhotonMoments detected_interactions;
  std::array<std::uint64_t, 51> detected_path_histogram{};  ///< 10 mm bins, last: 500 mm and more
  std::uint64_t scatterings = 0;                            ///< bulk scatterings
  std::uint64_t segments = 0;                               ///< straight segments traced
  std::uint64_t resolved_misses = 0;                        ///< ray queries resolved by the exact query
  std::uint64_t lost = 0;  ///< photons without a fate: zero, tested in every run
  double wall_seconds = 0.0;

  std::uint64_t count(core::Fate fate) const { return fates[core::fate_index(fate)]; }
  /// Sum over all wavelength shifters.
  optics::ShiftCount shifted() const;
  /// Share of the emitted photons with a fate. With a birth efficiency b below 1 and n photons traced: b
  /// detected / n, (not detected + (1 - b) detected) / n, and count / n for any other fate. Their sum is 1.
  /// The error is that of independent photons, or of independent events where there are two or more
  /// (event_fates); at least that of one photon where none or all have the fate.
  core::Estimate fraction(core::Fate fate) const;
  /// Share of the emitted photons that some of the detected photons represent, with the error of independent
  /// photons.
  core::Estimate detected_fraction(std::uint64_t detected) const;
  /// Share of the emitted photons that reach a sensor and are not detected, from the counts there.
  core::Estimate not_detected_fraction(std::uint64_t not_detected, std::uint64_t detected) const;
  /// The same of one face of a sensor, with errors as those of fraction().
  core::Estimate detected_fraction(const SensorFaceCount& at) const;
  core::Estimate not_detected_fraction(const SensorFaceCount& at) const;
  /// Share of the emitted photons that are absorbed in a medium, or at a surface, with errors as those of
  /// fraction(); zero for one that the point does not have.
  core::Estimate absorbed_fraction(core::MediumId medium) const;
  core::Estimate absorbed_fraction(core::SurfaceId surface) const;
  /// Upper bound of the error of any fraction from cut photons: cut photons / photons.
  double cut_bias_bound() const;
  /// Its events as what is independent; `all` is 0 for a source of photons.
  EventCounts event_counts() const;

 private:
  core::Estimate share_of(std::uint64_t count, const EventShare& events) const;
};

/// One detected photon, as streamed to the results file when a list is requested.
struct DetectedPhoton {
  std::uint32_t point = 0;
  std::uint64_t event = 0;
  std::uint64_t photon = 0;  ///< index within the event; determines the photon together with the seed
  core::PartId part;         ///< sensor part
  core::FaceId face;         ///< face crossed
  std::array<float, 3> position_mm{};
  std::array<float, 3> direction{};
  float wavelength_nm = 0;
  float time_ns = 0;
  float path_mm = 0;
  std::uint32_t interactions = 0;
};

/// Header of a run: its scene, seed, swept keys and names.
struct RunHeader {
  std::string title;
  std::string version;  ///< ScintRay version
  std::string scene_file;
  std::string scene_text;  ///< the whole scene file, so that the results are self-contained
  std::uint64_t seed = 0;
  std::vector<std::string> sweep_keys;  ///< swept keys, slowest first
  core::IdVector<core::MediumId, std::string> media;
  core::IdVector<core::SurfaceId, std::string> surfaces;
  core::IdVector<core::PartId, std::string> parts;
  core::IdVector<core::FaceId, std::string> faces;  ///< "part:face"
  std::string note;                                 ///< warnings issued, one per line
};

/// A whole run.
struct RunResult {
  RunHeader header;
  std::vector<PointResult> points;
  std::string partial_reason;  ///< reason of an early end of the run; empty for a complete one
  /// True when every point was traced to its end and none is missing.
  bool complete() const;
  /// False when its events come from a response map.
  bool traced_photons() const;
};

}  // namespace scintray::tally
