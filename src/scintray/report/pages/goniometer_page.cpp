#include "scintray/report/pages/pages.hpp"

#include <fmt/format.h>

#include <cmath>

#include "scintray/report/pages/detail/html_parts.hpp"
#include "scintray/report/pages/page.hpp"
#include "scintray/report/plots/detail/hemisphere_map.hpp"
#include "scintray/report/plots/goniometer_plots.hpp"
#include "scintray/report/text/format.hpp"

namespace scintray::report {

namespace {

constexpr const char* kGoniometerStyle = R"css(
.pair { display: grid; grid-template-columns: repeat(auto-fill, minmax(18rem, 22rem)); gap: 1.5rem; }
figure { margin-top: 1.25rem; }
.note { color: var(--soft); font-size: .9rem; max-width: 48rem; }
)css";

std::string angle_text(double rad) { return compact(rad / core::kDegree, 5) + " deg"; }

std::string in_degrees(const core::Estimate& angle) {
  return with_error({angle.value / core::kDegree, angle.error / core::kDegree});
}

std::string share_table(const std::vector<analysis::GoniometerReading>& readings) {
  std::string out = scroll_area("reflectance by incidence") +
                    "<table>\n<thead><tr><th class=\"n\">incidence</th><th class=\"n\">reflected</th>"
                    "<th class=\"n\">transmitted</th><th class=\"n\">absorbed</th></tr></thead>\n<tbody>\n";
  for (const analysis::GoniometerReading& reading : readings) {
    out += "<tr><th class=\"n\">" + angle_text(reading.settings.incidence_rad) + "</th>";
    for (const core::Estimate& share :
         {reading.reflectance(), reading.transmittance(), reading.absorptance()})
      out += "<td class=\"n\">" + with_error(share) + "</td>";
    out += "</tr>\n";
  }
  return out + "</tbody>\n</table></div>\n";
}

std::string lobe_row(const std::string& name, const analysis::Lobe& lobe) {
  if (lobe.rays == 0) return "";
  return fmt::format(
      "<tr><th>{}</th><td class=\"n\">{}</td><td class=\"n\">{}</td><td class=\"n\">{}</td><td "
      "class=\"n\">{}</td></tr>\n",
      name, in_degrees(lobe.in_plane_rad), in_degrees(lobe.across_rad),
      fixed(std::asin(std::min(1.0, lobe.width_in_plane)) / core::kDegree, 2),
      fixed(std::asin(std::min(1.0, lobe.width_across)) / core::kDegree, 2));
}

std::string lobe_table(const analysis::GoniometerReading& reading) {
  return scroll_area("directions") +
         "<table>\n<thead><tr><th>light</th><th class=\"n\">mean direction in plane, "
         "deg</th>"
         "<th class=\"n\">out of plane, deg</th><th class=\"n\">rms width in plane, deg</th><th "
         "class=\"n\">rms width across, deg</th></tr></thead>\n<tbody>\n" +
         lobe_row("reflected", reading.reflected_lobe) + lobe_row("transmitted", reading.transmitted_lobe) +
         "</tbody>\n</table></div>\n";
}

/// Polar angle of light refracted at a flat face; below 0 under total reflection.
double refracted_rad(const optics::IndexPair& index, optics::Side side, double incidence_rad) {
  const double sine = std::sin(incidence_rad) * index.on(side) / index.on(optics::other(side));
  return sine < 1.0 ? std::asin(sine) : -1.0;
}

std::string reading_section(const analysis::SampleSurface& sample, const analysis::GoniometerReading& reading,
                            const std::optional<Overlay>& overlay) {
  const analysis::GoniometerSettings& s = reading.settings;
  std::string out =
      "<section>\n<h2>Incidence " + angle_text(s.incidence_rad) + "</h2>\n" + lobe_table(reading);
  Plot plot = profile_plot("In-plane profile at " + angle_text(s.incidence_rad));
  if (reading.reflected > 0)
    plot.series.push_back(profile_series("reflected", reading.reflected_directions, s));
  if (reading.transmitted > 0)
    plot.series.push_back(profile_series("transmitted", reading.transmitted_directions, s));
  if (overlay) plot.series.push_back(measured_series("measured: " + overlay->name, overlay->scaled.profile));
  if (!plot.series.empty()) {
    out += fmt::format(
        "<figure><figcaption>In-plane profile <span>within {} of the plane of incidence, bins of 1 "
        "deg</span></figcaption>\n{}</figure>\n",
        angle_text(s.profile_half_width_rad), chart(plot));
  }
  if (overlay) out += "<p class=\"note\">" + escape_html(overlay_text(*overlay)) + "</p>\n";
  out += "<div class=\"pair\">\n";
  const auto map = [&](const char* name, const analysis::DirectionCounts& counts, double mark) {
    out += std::string("<figure><figcaption>") + name + "</figcaption>\n" +
           hemisphere_map(counts, s.rays, mark, std::string(name) + " light over the hemisphere") +
           "</figure>\n";
  };
  if (reading.reflected > 0) map("Reflected", reading.reflected_directions, s.incidence_rad);
  if (reading.transmitted > 0)
    map("Transmitted", reading.transmitted_directions, refracted_rad(sample.index, s.side, s.incidence_rad));
  return out + "</div>\n</section>\n";
}

std::string notes(const analysis::SampleSurface& sample, const analysis::GoniometerSettings& s) {
  std::string out =
      "<h2>How to read this</h2>\n<p class=\"note\">Shares are of the " + grouped(s.rays) +
      " rays shot at each angle, in unpolarised light, with their binomial standard errors. Densities are "
      "shares per steradian, so that their integral over the hemisphere is the share reflected or "
      "transmitted. Angles are from the normal of the side that the light leaves on; forward is the side of "
      "the mirror direction. Widths are the root mean square of the direction's component across the mean "
      "direction, as the angle of that sine. In the maps the distance from the centre is the polar angle "
      "(circles at 30, 60 and 90 deg), forward is to the right, the cross is the direction of light from a "
      "flat face, and colours span three decades of density.</p>\n<p class=\"note\">Seed " +
      std::to_string(s.seed) + ".</p>\n";
  if (!sample.sources.empty()) {
    out += "<h2>Sources of the surface</h2>\n<ul>\n";
    for (const std::string& source : sample.sources) out += "<li>" + escape_html(source) + "</li>\n";
    out += "</ul>\n";
  }
  for (const std::string& warning : sample.warnings)
    out += "<p class=\"note\">Warning: " + escape_html(warning) + "</p>\n";
  return out;
}

}  // namespace

std::string sample_text(const analysis::SampleSurface& sample, optics::Side side) {
  return fmt::format("{} (n {:.4f}) to {} (n {:.4f}), {:g} nm, light from {}", sample.place.inside,
                     sample.index.inside, sample.place.outside, sample.index.outside,
                     sample.place.wavelength_nm, side == optics::Side::inside ? "inside" : "outside");
}

std::string overlay_text(const Overlay& overlay) {
  const analysis::MeasuredProfile& profile = overlay.scaled.profile;
  return fmt::format(
      "The measurement was multiplied by {:.4g}, which gives it the area under the reflected profile between "
      "{:g} and {:g} deg (trapezoids over the measured angles). Root mean square difference: {:.2f} % of "
      "the profile's largest value.",
      overlay.scaled.factor, profile.angle_deg.front(), profile.angle_deg.back(), 100.0 * overlay.scaled.rms);
}

std::string goniometer_page(const analysis::SampleSurface& sample,
                            const std::vector<analysis::GoniometerReading>& readings,
                            const std::optional<Overlay>& overlay) {
  const analysis::GoniometerSettings& settings = readings.front().settings;
  std::string body = "<h2>Where the light goes</h2>\n" + share_table(readings);
  for (const analysis::GoniometerReading& reading : readings)
    body += reading_section(sample, reading, overlay);
  return html_page("Goniometer: " + sample.place.surface, sample_text(sample, settings.side),
                   hemisphere_map_style() + kGoniometerStyle, body + notes(sample, settings));
}

}  // namespace scintray::report
