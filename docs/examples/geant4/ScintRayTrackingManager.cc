#include "ScintRayTrackingManager.hh"

#include "G4CerenkovQuasiTrackInfo.hh"
#include "G4Event.hh"
#include "G4EventManager.hh"
#include "G4Exception.hh"
#include "G4PhysicalConstants.hh"
#include "G4QuasiOpticalData.hh"
#include "G4ScintillationQuasiTrackInfo.hh"
#include "G4SystemOfUnits.hh"
#include "G4Threading.hh"
#include "G4Track.hh"

namespace {

std::string file_of_thread(const std::string& file) {
  const G4int thread = G4Threading::G4GetThreadId();
  const std::size_t dot = file.rfind('.');
  if (thread < 0 || dot == std::string::npos) return file;
  return file.substr(0, dot) + "_" + std::to_string(thread) + file.substr(dot);
}

}  // namespace

ScintRayTrackingManager::ScintRayTrackingManager(const std::string& file) : file_(file_of_thread(file)) {
  file_.precision(12);
  file_ << "event,x,y,z,time,energy,dx,dy,dz,beta,beta_end,charge,scintillation_photons,cherenkov_photons,"
           "decay,rise\n";
  if (!file_)
    G4Exception("ScintRayTrackingManager", "ScintRay01", FatalException,
                ("cannot write " + file + ": check the folder").c_str());
}

void ScintRayTrackingManager::HandOverOneTrack(G4Track* track) {
  // The information lies under the number of the model that made the track.
  const G4VAuxiliaryTrackInformation* const info =
      track->GetAuxiliaryTrackInformation(track->GetCreatorModelID());
  if (const auto* scintillation = G4ScintillationQuasiTrackInfo::Cast(info)) {
    const G4QuasiOpticalData step = scintillation->GetQuasiOpticalData();
    write(*track, step, {step.num_photons, 0, scintillation->GetScintTime(), scintillation->GetRiseTime()});
  } else if (const auto* cherenkov = G4CerenkovQuasiTrackInfo::Cast(info)) {
    const G4QuasiOpticalData step = cherenkov->GetQuasiOpticalData();
    write(*track, step, {0, step.num_photons, 0.0, 0.0});
  } else {
    G4Exception("ScintRayTrackingManager", "ScintRay02", JustWarning,
                "a quasi-optical photon without its data: it makes no light");
  }
  track->SetTrackStatus(fStopAndKill);
  delete track;
}

void ScintRayTrackingManager::FlushEvent() { file_.flush(); }

void ScintRayTrackingManager::write(const G4Track& track, const G4QuasiOpticalData& step,
                                    const Light& light) {
  const G4Event* const event = G4EventManager::GetEventManager()->GetConstCurrentEvent();
  const G4ThreeVector& start = track.GetPosition();
  const auto beta = [](G4double velocity) { return velocity / CLHEP::c_light; };
  file_ << event->GetEventID();
  for (const G4double length : {start.x(), start.y(), start.z()}) file_ << ',' << length / CLHEP::mm;
  file_ << ',' << track.GetGlobalTime() / CLHEP::ns << ",0";  // the number of photons is that of Geant4
  for (const G4double length : {step.delta_position.x(), step.delta_position.y(), step.delta_position.z()})
    file_ << ',' << length / CLHEP::mm;
  file_ << ',' << beta(step.pre_velocity) << ',' << beta(step.pre_velocity + step.delta_velocity) << ','
        << step.charge / CLHEP::eplus << ',' << light.scintillation << ',' << light.cherenkov << ','
        << light.decay / CLHEP::ns << ',' << light.rise / CLHEP::ns << '\n';
}
