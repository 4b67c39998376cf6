#pragma once
/// Single photons of a [source] of photons.

#include <memory>

#include "scintray/source/light_source.hpp"

namespace scintray::test {

/// The light source of a specification, whose photons depend on their own stream alone.
class PhotonSource {
 public:
  PhotonSource(const scene_file::SourceSpec& spec, const scene::Scene& scene) {
    scene_file::SceneSpec whole;
    whole.source = spec;
    source_ = source::make_light_source(whole, scene);
  }
  source::Photon emit(const scene::Scene& scene, core::Rng& rng) const {
    return source_->emit(scene, {}, 0, rng);
  }
  operator const source::LightSource&() const { return *source_; }  // NOLINT(google-explicit-constructor)

 private:
  std::shared_ptr<const source::LightSource> source_;
};

}  // namespace scintray::test
