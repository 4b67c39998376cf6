#include "entries.hpp"

#include <array>
#include <stdexcept>
#include <utility>

#include "exchange_entries.hpp"
#include "require.hpp"
#include "scintray/core/error.hpp"
#include "scintray/topography/detail/readers/formats.hpp"
#include "topography/made_up_maps.hpp"

namespace scintray::fuzz {

namespace {

using namespace scintray::test;

constexpr std::size_t kMostUnpacked = std::size_t{1} << 24;
/// deflate cannot pack more tightly (RFC 1951).
constexpr std::size_t kDeflate = 1032;

/// Calls `read`, whose map may have at most `most` points.
template <class Read>
bool expect_map_or_input_error(std::size_t most, Read read) {
  try {
    const topography::RawMap map = read();
    require(map.columns >= 1 && map.rows >= 1, "a map without points");
    require(map.values.size() == std::size_t{map.columns} * map.rows, "heights that do not fill the map");
    require(map.values.size() <= most, "more points than the file can hold");
    require(!map.pitch_x_um || *map.pitch_x_um > 0.0, "a pitch that is not positive");
    require(!map.height_unit_um || *map.height_unit_um > 0.0, "a height unit that is not positive");
    require(map.pitch_ratio >= 0.0, "a ratio of pitches that is negative or no number");
    return true;
  } catch (const core::InputError& error) {
    require_words(error);
    return false;
  }
}

/// One format; `bytes` a point at least, or a grid twice as large as its list.
template <bool (*Recognises)(std::string_view),
          topography::RawMap (*Parse)(std::string_view, const topography::ReadRequest&)>
bool run_format(const std::uint8_t* data, std::size_t size) {
  const std::string_view content(reinterpret_cast<const char*>(data), size);
  if (!Recognises(content)) return false;
  const auto read = [&](std::optional<std::string> channel) {
    return expect_map_or_input_error(size, [&] { return Parse(content, {"fuzz", std::move(channel)}); });
  };
  read("Height");
  return read({});
}

/// Zip archives unpack, so their bound is that of deflate.
bool run_x3p(const std::uint8_t* data, std::size_t size) {
  const std::string_view content(reinterpret_cast<const char*>(data), size);
  return topography::is_x3p(content) && expect_map_or_input_error(kDeflate * size + 1024, [&] {
           return topography::parse_x3p(content, {"fuzz", {}});
         });
}

/// The bytes are main.xml, in an archive that is otherwise sound.
bool run_x3p_xml(const std::uint8_t* data, std::size_t size) {
  MadeUpX3p made;
  made.xml = std::string(reinterpret_cast<const char*>(data), size);
  if (made.xml.empty()) return false;
  const std::string archive = x3p_file(made);
  return expect_map_or_input_error(archive.size(), [&] {
    return topography::parse_x3p(archive, {"fuzz", {}});
  });
}

bool run_gzip(const std::uint8_t* data, std::size_t size) {
  const std::string_view content(reinterpret_cast<const char*>(data), size);
  try {
    require(topography::gunzip(content, "fuzz", kMostUnpacked).size() <= kDeflate * size + 1024,
            "more than deflate packs");
    return true;
  } catch (const core::InputError&) {
    return false;
  }
}

/// Whatever the content states that it is, as in read_height_map.
bool run_any(const std::uint8_t* data, std::size_t size) {
  const std::string_view content(reinterpret_cast<const char*>(data), size);
  const topography::Format* format = topography::find_format(content);
  return format && expect_map_or_input_error(kDeflate * size + 1024, [&] {
           return format->parse(content, {"fuzz", {}});
         });
}

std::vector<std::string> gsf_seeds() {
  std::string header =
      "Gwyddion Simple Field 1.0\nXRes = 5\nYRes = 3\nXReal = 1e-5\nYReal = 3e-6\n"
      "XYUnits = m\nZUnits = m\nTitle = made up\n";
  header.append(4 - header.size() % 4, '\0');
  for (const double value : made_up_heights()) header += bytes_of(static_cast<float>(value));
  return {header};
}

std::vector<std::string> gwy_seeds() {
  MadeUpGwy old, masked;
  old.old = true;
  masked.channels = {{"Height", "nm"}, {"Phase", "deg"}};
  masked.mask = std::vector<double>(15, 1.0);
  return {gwy_file(), gwy_file(old), gwy_file(masked)};
}

std::vector<std::string> ibw_seeds() {
  MadeUpIbw bare, big;
  big.big_endian = true;
  bare.channels.resize(1);
  bare.labels = bare.asylum = false;
  return {ibw_file(), ibw_file(bare), ibw_file(big)};
}

std::vector<std::string> nanoscope_seeds() {
  MadeUpNanoscope wide;
  wide.bytes = 4;
  wide.channels.push_back({"Amplitude", "mV"});
  return {nanoscope_file(), nanoscope_file(wide)};
}

std::vector<std::string> picoview_seeds() {
  return {picoview_file(), picoview_file({{"Topography", "um"}}, false)};
}

std::vector<std::string> sdf_seeds() {
  return {sdf_text_file(), sdf_text_file("1 2 3 4 5 BAD 7 8 9 10 11 12 13 14 15\n"), sdf_binary_file()};
}

std::vector<std::string> x3p_seeds() {
  MadeUpX3p whole, listed;
  whole.type = "I";
  whole.valid = std::vector<bool>(15, true);
  whole.folder = "land/";
  whole.junk = true;
  listed.listed = true;
  const std::string plain = x3p_file(listed);
  const std::size_t begin = plain.find("<?xml"), end = plain.find("</p:ISO5436_2>") + 14;
  return {x3p_file(), x3p_file(whole), plain, zipped({{"main.xml", plain.substr(begin, end - begin)}}, true)};
}

std::vector<std::string> x3p_xml_seeds() {
  std::vector<std::string> result;
  for (const bool listed : {false, true}) {
    MadeUpX3p made;
    made.listed = listed;
    const std::string plain = x3p_file(made);
    const std::size_t begin = plain.find("<?xml"), end = plain.find("</p:ISO5436_2>") + 14;
    result.push_back(plain.substr(begin, end - begin));
  }
  return result;
}

std::vector<std::string> profiler_seeds() {
  return {
      "h=2 w=3\npixel size=3.5e-007 m\ndata unit=rad\nheight conversion factor (-> m)=6e-008\n1 2 3\n4 5 "
      "-6\n"};
}

std::vector<std::string> text_seeds() {
  return {"# Channel: a\n# Width: 30 um\n# Height: 4000 nm\n# Value units: nm\n1\t2,5\t3\n4\t5\t6.5e0\n",
          "1 2\n3 nan\n", "0 0 1\n1 0 2\n2 0 3\n0 1 4\n1 1 5\n2 1 6\n0 2 7\n1 2 8\n",
          "\xEF\xBB\xBF-1e300 +.5\n3 4e-300\n"};
}

std::vector<std::string> gzip_seeds() {
  std::vector<std::string> result;
  for (const std::string& seed : text_seeds()) result.push_back(gzip_file(seed));
  return result;
}

std::vector<std::string> all_seeds() {
  std::vector<std::string> result;
  for (const auto seeds : {gsf_seeds, gwy_seeds, ibw_seeds, nanoscope_seeds, picoview_seeds, sdf_seeds,
                           x3p_seeds, profiler_seeds, text_seeds})
    for (std::string& seed : seeds()) result.push_back(std::move(seed));
  return result;
}

/// A number of one byte becomes a double of eight, and a vector that grows holds twice its content.
constexpr std::size_t kPerByte = 32;

constexpr std::array<Entry, 16> kEntries{
    {{"gsf", run_format<topography::is_gsf, topography::parse_gsf>, gsf_seeds, kPerByte},
     {"gwy", run_format<topography::is_gwy, topography::parse_gwy>, gwy_seeds, kPerByte},
     {"ibw", run_format<topography::is_ibw, topography::parse_ibw>, ibw_seeds, kPerByte},
     {"nanoscope", run_format<topography::is_nanoscope, topography::parse_nanoscope>, nanoscope_seeds,
      kPerByte},
     {"picoview", run_format<topography::is_picoview, topography::parse_picoview>, picoview_seeds, kPerByte},
     {"sdf", run_format<topography::is_sdf, topography::parse_sdf>, sdf_seeds, kPerByte},
     {"x3p", run_x3p, x3p_seeds, kDeflate* kPerByte},
     {"x3p_xml", run_x3p_xml, x3p_xml_seeds, kPerByte},
     {"profiler", run_format<topography::is_profiler_matrix, topography::parse_profiler_matrix>,
      profiler_seeds, kPerByte},
     {"text", run_format<topography::is_number_text, topography::parse_number_text>, text_seeds, kPerByte},
     {"gzip", run_gzip, gzip_seeds, kDeflate * 2},
     {"davis", run_davis, davis_seeds, kPerByte},
     {"davis_reflectances", run_davis_reflectances, davis_reflectance_seeds, kPerByte},
     {"lbnl", run_lbnl, lbnl_seeds, kPerByte},
     {"dichroic", run_dichroic, dichroic_seeds, kPerByte},
     {"any", run_any, all_seeds, kDeflate* kPerByte}}};

}  // namespace

std::span<const Entry> entries() { return kEntries; }

}  // namespace scintray::fuzz
