// Hands the optical photons that Geant4 11.4 would make over to ScintRay: one row for each burst of photons
// of a step, as G4QuasiScintillation and G4QuasiCerenkov describe it when they offload photons.
#pragma once

#include <fstream>
#include <string>

#include "G4VTrackingManager.hh"
#include "globals.hh"

struct G4QuasiOpticalData;

/// Tracking manager of G4QuasiOpticalPhoton: takes each such track, writes it as a row of a CSV file that
/// ScintRay reads as [source] type = "hits", and ends it. One object and one file for each thread.
class ScintRayTrackingManager : public G4VTrackingManager {
 public:
  /// @param file  CSV to write; the thread's number is put before its ending where there are several
  explicit ScintRayTrackingManager(const std::string& file);

  void HandOverOneTrack(G4Track* track) override;
  /// Writes what is buffered: an event is then complete in the file.
  void FlushEvent() override;

 private:
  /// Times of the scintillation of a burst, and numbers of its photons.
  struct Light {
    G4int scintillation = 0, cherenkov = 0;
    G4double decay = 0.0, rise = 0.0;
  };
  void write(const G4Track& track, const G4QuasiOpticalData& step, const Light& light);

  std::ofstream file_;
};
