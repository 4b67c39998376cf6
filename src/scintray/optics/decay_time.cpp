#include "scintray/optics/decay_time.hpp"

#include "scintray/core/error.hpp"
#include "scintray/core/sampling.hpp"

namespace scintray::optics {

double sample_decay(const std::vector<DecayComponent>& components, core::Rng& rng) {
  double u = rng.uniform();
  for (const DecayComponent& component : components) {
    if (u < component.fraction || &component == &components.back()) {
      if (component.profile == TimeProfile::delta) return component.decay_ns;
      double time = component.decay_ns * core::sample_exponential(rng);
      if (component.rise_ns > 0.0) time += component.rise_ns * core::sample_exponential(rng);
      return time;
    }
    u -= component.fraction;
  }
  throw core::InternalError("a decay without components was sampled");
}

}  // namespace scintray::optics
