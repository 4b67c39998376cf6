// Tables whose building was stopped and resumed have the bits of one that was not.
#include <doctest/doctest.h>

#include "scintray/core/journal.hpp"
#include "scintray/topography/build_table.hpp"
#include "scintray/topography/preparation.hpp"
#include "scintray/topography/synthesis.hpp"
#include "support/shared.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::optics;
using namespace scintray::topography;
using namespace scintray::test;

namespace {

constexpr IndexPair kPair{1.82, 1.0};

void check_same(const DirectionQuantiles& a, const DirectionQuantiles& b) {
  CHECK(a.polar == b.polar);
  CHECK(a.azimuth == b.azimuth);
  CHECK(a.rays == b.rays);
}

void check_same(const SurfaceTable& a, const SurfaceTable& b) {
  CHECK(a.provenance().cut == b.provenance().cut);
  CHECK(a.provenance().unconverged == b.provenance().unconverged);
  CHECK(a.provenance().reciprocity == b.provenance().reciprocity);
  REQUIRE(a.slices().size() == b.slices().size());
  for (std::size_t i = 0; i < a.slices().size(); ++i)
    for (const Side side : {Side::inside, Side::outside}) {
      const auto &x = a.slices()[i].nodes(side), &y = b.slices()[i].nodes(side);
      REQUIRE(x.size() == y.size());
      for (std::size_t k = 0; k < x.size(); ++k) {
        CHECK(x[k].incidence_rad == y[k].incidence_rad);
        CHECK(x[k].reflectance == y[k].reflectance);
        CHECK(x[k].reflectance_error == y[k].reflectance_error);
        CHECK(x[k].absorptance == y[k].absorptance);
        CHECK(x[k].mean_slope_rad == y[k].mean_slope_rad);
        CHECK(x[k].traced_incidence_rad == y[k].traced_incidence_rad);
        CHECK(x[k].rays == y[k].rays);
        check_same(x[k].reflected, y[k].reflected);
        check_same(x[k].transmitted, y[k].transmitted);
      }
    }
}

}  // namespace

TEST_CASE("A table that was stopped again and again is the one of an uninterrupted process") {
  SynthesisRecipe recipe = ground_recipe();
  recipe.columns = recipe.rows = 64;
  recipe.pitch_um = 0.25;
  const HeightField field = make_height_field(synthesize(recipe));
  TableSettings settings;
  settings.incidence_step_rad = 30.0 * kDegree;
  settings.azimuth_step_rad = 90.0 * kDegree;
  settings.rays = 50;
  TableSettings directional = settings, reciprocal = settings;
  directional.directional = true;
  settings.target_error = 0.02;
  reciprocal.reciprocal = true;
  const std::vector<SpectralPoint> spectrum{{0.0, kPair}};
  for (const TableSettings& of : {settings, directional, reciprocal}) {
    const SurfaceTable whole = build_table(field, spectrum, of);
    const JournalSettings journal{scratch_folder("resumed_table") / "t.journal", JournalStart::resume};
    std::optional<SurfaceTable> resumed;
    int stops = 0;
    for (std::size_t before = 0; !resumed; ++stops) {
      REQUIRE(stops < 200);
      Journal pieces(journal, "table");
      CHECK(pieces.pieces() >= before);  // nothing of before is lost
      before = pieces.pieces();
      std::size_t left = before + 7;  // nodes until the next stop
      try {
        resumed = build_table(
            field, spectrum, of, {}, [&](double) { return left-- > 0; }, &pieces);
      } catch (const TableStopped&) {
        CHECK(pieces.pieces() > before);
      }
    }
    CHECK(stops > 2);
    check_same(whole, *resumed);
  }
}
