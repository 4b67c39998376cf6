#include "scintray/detector/avalanche_model.hpp"

namespace scintray::detector {

namespace {

class ProportionalProcess : public AvalancheProcess {
 public:
  void fire(std::vector<Carrier>& carriers, double, core::Rng&, const AvalancheSink& deliver) const override {
    for (const Carrier& carrier : carriers) deliver(carrier.time_ns, 1.0, carrier.cause);
  }
};

}  // namespace

std::unique_ptr<const AvalancheProcess> ProportionalModel::on(const SensorFace&) const {
  return std::make_unique<const ProportionalProcess>();
}

}  // namespace scintray::detector
