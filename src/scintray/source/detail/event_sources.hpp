#pragma once
/// The event sources: one class for each type of [source] with energy deposits.

#include <cstdint>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

#include "scintray/source/detail/gamma/decay.hpp"
#include "scintray/source/detail/gamma/transport.hpp"
#include "scintray/source/detail/origin.hpp"
#include "scintray/source/event.hpp"

namespace scintray::source {

/// Each event deposits an energy from the spectrum at one point, uniform over the origin, at time 0: the
/// method of E. Roncali and S. R. Cherry 2013, Phys. Med. Biol. 58 2185, section 2.2. Where the light depends
/// on the electrons, there is a deposit for each electron of a gamma of that energy of which nothing escapes;
/// energies beyond the range of gamma transport are of one electron. Immutable.
class SpectrumEventSource : public EventSource {
 public:
  /// Throws InputError as Origin does, and when a medium of the origin does not scintillate.
  /// @param cherenkov  the deposits emit Cherenkov light
  SpectrumEventSource(const scene_file::SpectrumSpec& spec, std::uint64_t events, bool cherenkov,
                      const scene::Scene& scene);

  std::uint64_t events() const override { return events_; }
  Event make(const scene::Scene& scene, std::uint64_t number, core::Rng& rng) const override;

 private:
  Origin origin_;
  double energy_keV_ = 0.0;
  std::optional<core::CurveSampler> spectrum_;
  std::optional<GammaTransport> gammas_;  ///< in the regions where electrons matter; nothing: in none
  std::uint64_t events_ = 0;
};

/// Events of gammas that start at an origin and deposit energy along their transport. Immutable.
class GammaEventSource : public EventSource {
 public:
  /// Throws InputError as Origin and GammaTransport do, and for decays of 176Lu without lutetium at the
  /// origin, or without a part that scintillates.
  GammaEventSource(const scene_file::EmitterSpec& spec, std::uint64_t events, const scene::Scene& scene);

  std::uint64_t events() const override { return events_; }
  Event make(const scene::Scene& scene, std::uint64_t number, core::Rng& rng) const override;

  /// Initial state of an event.
  struct Start {
    Place place;
    std::vector<Gamma> gammas;
    std::vector<double> electrons_keV;  ///< deposited at the place, of one electron each

    /// Energy deposited at the place.
    double local_keV() const { return std::accumulate(electrons_keV.begin(), electrons_keV.end(), 0.0); }
  };
  Start start(const scene::Scene& scene, core::Rng& rng) const;

 private:
  Place sample_place(const scene::Scene& scene, core::Rng& rng) const;
  void add_pair(Gamma gamma, core::Rng& rng, std::vector<Gamma>& gammas) const;
  void check_lutetium(const scene_file::EmitterSpec& spec, const scene::Scene& scene) const;

  std::optional<Origin> origin_;
  scene_file::PlaneSpec plane_;  ///< where there is no origin
  scene_file::Emission emission_;
  double energy_keV_ = 0.0;
  scene_file::DirectionSpec direction_;
  double acollinearity_sigma_rad_ = 0.0;
  DecaySampler decay_;
  GammaTransport transport_;
  std::uint64_t events_ = 0;
};

/// One row of a list of hits.
struct Hit {
  std::uint64_t event = 0;
  core::Vec3 position = core::Vec3::Zero();  ///< world, mm
  double energy_keV = 0.0;
  double time_ns = 0.0;   ///< as in the file; 0 when it has no times
  std::uint64_t row = 0;  ///< line of a CSV file; else place in the columns, from 0
  std::optional<ParticleStep> step{};
};

/// Hits of the columns named by the specification, or of those in memory, in their order. Throws InputError
/// with the first invalid rows (an event number that is not a whole number from 0 on, a negative energy), for
/// missing columns and columns of unequal length, and for columns in memory that were not set.
std::vector<Hit> read_hits(const scene_file::HitsSpec& spec);
/// Origin of hits, for messages: the name of the file, or "the calling program".
std::string origin_of_hits(const scene_file::HitsSpec& spec);

/// Numbers of rows of a list of hits, and of those with a warning.
struct HitsReport {
  std::uint64_t rows = 0;
  std::uint64_t outside = 0;       ///< hits outside every part; their energy counts as non-scintillating
  std::uint64_t out_of_order = 0;  ///< hits of an event that follow hits of another; assigned to it
  std::vector<std::string> first_outside, first_out_of_order;  ///< descriptions of the first few
};

/// Events of a list of hits, in the order of their numbers there. Times count from an event's first hit.
/// Hits outside every part, and in parts that do not scintillate, count as non-scintillating. Immutable.
class HitsEventSource : public EventSource {
 public:
  /// @param most  largest number of events; 0 for all
  /// Throws InputError as read_hits does, and when no hit lies in a part that scintillates.
  /// @param cherenkov  steps emit Cherenkov light, also in media that do not scintillate
  HitsEventSource(const scene_file::HitsSpec& spec, std::uint64_t most, const scene::Scene& scene,
                  bool cherenkov = false);

  std::uint64_t events() const override { return events_.size(); }
  Event make(const scene::Scene& scene, std::uint64_t number, core::Rng& rng) const override;
  bool has_steps() const override { return has_steps_; }

  const HitsReport& report() const { return report_; }
  /// The report as warnings; empty without any.
  std::vector<std::string> notes() const;

 private:
  void count_out_of_order(const std::vector<Hit>& hits);
  void add(const Hit& hit, const scene::Scene& scene);

  std::vector<Event> events_;
  HitsReport report_;
  bool cherenkov_ = false, has_steps_ = false;
};

}  // namespace scintray::source
