#include "scintray/report/pages/detail/sections.hpp"

#include <vector>

#include "scintray/report/pages/detail/html_parts.hpp"
#include "scintray/report/text/format.hpp"
#include "scintray/report/text/sweep_view.hpp"

namespace scintray::report {

namespace {

struct ShiftRow {
  std::string where;  ///< "in LSO", "at phosphor"
  optics::ShiftCount count;

  std::string kept() const { return grouped(count.absorbed - count.emitted); }
  /// Energy after shifting over energy before, of the light re-emitted.
  std::string energy_share() const {
    return count.emitted == 0 ? "-" : fixed(100.0 * count.after_eV / count.before_eV, 2) + " %";
  }
};

std::vector<ShiftRow> shift_rows(const tally::RunHeader& header, const tally::PointResult& point) {
  std::vector<ShiftRow> rows;
  const auto add = [&](const std::string& word, const auto& names, const auto& counts) {
    for (const auto id : counts.ids())
      if (counts[id].absorbed > 0) rows.push_back({word + names.at(id), counts[id]});
  };
  add("in ", header.media, point.shifted_in_medium);
  add("at ", header.surfaces, point.shifted_at_surface);
  return rows;
}

}  // namespace

std::string shift_lines(const tally::RunHeader& header, const tally::PointResult& point) {
  std::string text;
  for (const ShiftRow& row : shift_rows(header, point))
    text += "Wavelength shifting " + row.where + ": " + grouped(row.count.absorbed) + " times absorbed, " +
            grouped(row.count.emitted) + " times re-emitted with " + row.energy_share() + " of the energy, " +
            row.kept() + " kept.\n";
  return text;
}

std::string shift_section(const tally::RunResult& run) {
  std::string rows;
  for (const tally::PointResult& point : run.points)
    for (const ShiftRow& row : shift_rows(run.header, point))
      rows += "<tr>" + cell(point_label(point), "th") + cell(row.where) +
              number_cell(grouped(row.count.absorbed)) + number_cell(grouped(row.count.emitted)) +
              number_cell(row.kept()) + number_cell(row.energy_share()) + "</tr>\n";
  if (rows.empty()) return "";
  return section(
      "Wavelength shifting",
      table({"point", "where", "absorbed by the shifter", "re-emitted", "kept", "energy after / before"},
            rows, 2) +
          "<p>A photon may be absorbed and re-emitted several times; one that is kept counts as "
          "absorbed there. Energies are those of the photons re-emitted.</p>\n");
}

}  // namespace scintray::report
