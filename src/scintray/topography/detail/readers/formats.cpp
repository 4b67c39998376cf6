#include "scintray/topography/detail/readers/formats.hpp"

#include <array>

#include "scintray/core/text.hpp"

namespace scintray::topography {

namespace {

constexpr std::array<Format, 9> kFormats{
    {{"Gwyddion simple field (.gsf)", is_gsf, parse_gsf},
     {"Gwyddion (.gwy)", is_gwy, parse_gwy},
     {"Nanoscope (.spm, .001)", is_nanoscope, parse_nanoscope},
     {"PicoView (.mi)", is_picoview, parse_picoview},
     {"ISO 25178-71 (.sdf)", is_sdf, parse_sdf},
     {"ISO 25178-72 (.x3p)", is_x3p, parse_x3p},
     {"profiler's matrix", is_profiler_matrix, parse_profiler_matrix},
     {"numbers as text (matrix, x y z list, Gwyddion's export)", is_number_text, parse_number_text},
     // The magic number of an Igor wave is weak, so it comes last.
     {"Igor wave (.ibw)", is_ibw, parse_ibw}}};

}  // namespace

std::span<const Format> formats() { return kFormats; }

const Format* find_format(std::string_view content) {
  for (const Format& format : kFormats)
    if (format.recognises(content)) return &format;
  return nullptr;
}

std::string format_names() {
  return core::list_of(kFormats, ", ", [](const Format& format) { return format.name; });
}

}  // namespace scintray::topography
