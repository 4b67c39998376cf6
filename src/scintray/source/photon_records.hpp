#pragma once
/// Records of a photon, beside its state, that only some scenes require.

#include <cstdint>
#include <utility>
#include <vector>

#include "scintray/core/ids.hpp"
#include "scintray/optics/reflection_log.hpp"
#include "scintray/optics/wavelength_shifter.hpp"
#include "scintray/source/light_source.hpp"

namespace scintray::source {

/// Shifts of a photon by the wavelength shifter of one medium or one surface.
struct PhotonShifts {
  core::MediumId medium;  ///< none: the shifter is a surface's
  core::SurfaceId surface;
  optics::ShiftCount count;
};

/// Side tables of the present photon, one object for all photons of a block. They stay empty where no
/// wavelength shifter absorbs and no history is requested.
class PhotonRecords {
 public:
  /// @param reflections  whether reflections at reflectors are to be recorded
  explicit PhotonRecords(bool reflections = false) : records_reflections_(reflections) {}

  /// Resets the tables for the next photon.
  void clear() {
    shifts_.clear();
    reflections_.clear();
  }

  /// One entry for each medium or surface that shifted the photon so far.
  const std::vector<PhotonShifts>& shifts() const { return shifts_; }
  /// The entry of a medium or surface, added when there is none.
  optics::ShiftCount& shifts_of(core::MediumId medium) { return shifts_of(medium, {}); }
  optics::ShiftCount& shifts_of(core::SurfaceId surface) { return shifts_of({}, surface); }

  /// Adds a photon that a wavelength shifter re-emits in addition to the present one.
  void add_photon(const Photon& additional) { additional_.push_back(additional); }
  /// The photons re-emitted in addition so far, which are no longer held here.
  std::vector<Photon> take_additional() { return std::exchange(additional_, {}); }

  const optics::ReflectionLog& reflections() const { return reflections_; }
  /// Log of reflections; null when they are not recorded.
  optics::ReflectionLog* reflection_log() { return records_reflections_ ? &reflections_ : nullptr; }

 private:
  optics::ShiftCount& shifts_of(core::MediumId medium, core::SurfaceId surface) {
    for (PhotonShifts& known : shifts_)
      if (known.medium == medium && known.surface == surface) return known.count;
    return shifts_.emplace_back(PhotonShifts{medium, surface, {}}).count;
  }

  std::vector<PhotonShifts> shifts_;
  std::vector<Photon> additional_;
  optics::ReflectionLog reflections_;
  bool records_reflections_;
};

}  // namespace scintray::source
