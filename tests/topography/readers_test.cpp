/// Each format, from a small file made up byte by byte.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "made_up_maps.hpp"
#include "map_files.hpp"
#include "scintray/core/error.hpp"
#include "scintray/topography/height_map.hpp"
#include "support/shared.hpp"
#include "support/words.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::topography;
using namespace scintray::test;

namespace {

std::filesystem::path written(const std::string& name, const std::string& content) {
  static const auto folder = scratch_folder("readers");
  std::ofstream(folder / name, std::ios::binary) << content;
  return folder / name;
}

/// Never runs the program gwyddion, so that the answer is the same where it is installed.
ReadOptions channel(const std::optional<std::string>& name = {}) {
  ReadOptions options;
  options.channel = name;
  options.query_gwyddion = false;
  return options;
}

HeightMap read(const std::string& content, const ReadOptions& options = channel()) {
  return read_height_map(written("map", content), options);
}

/// All that is wrong, and its hints.
std::string complaint_about(const std::string& content, const ReadOptions& options = channel()) {
  std::string all;
  for (const Problem& problem : problems_of([&] { read(content, options); })) {
    CHECK_FALSE(problem.where.file.empty());
    all += problem.text() + "\n";
  }
  return all;
}

/// The map that every made-up file holds: pitch 2 x 1 um, heights in um times `scale`.
void check_made_up(const HeightMap& map, double scale = 1.0) {
  REQUIRE(map.columns == kMadeUpColumns);
  REQUIRE(map.rows == kMadeUpRows);
  CHECK(map.pitch_x_um == doctest::Approx(2.0));
  CHECK(map.pitch_y_um == doctest::Approx(1.0));
  for (std::size_t k = 0; k < 15; ++k)
    CHECK(map.heights_um[k] == doctest::Approx(scale * made_up_heights()[k]).epsilon(1e-6));
}

}  // namespace

TEST_CASE("a .gwy of either version is read, in metres whatever prefix its unit carries") {
  for (const bool old : {false, true})
    for (const std::string unit : {"m", "nm", "\xB5m", "\xC2\xB5m"}) {
      MadeUpGwy made;
      made.old = old;
      made.lateral_unit = made.channels[0].unit = unit;
      const HeightMap map = read(gwy_file(made));
      check_made_up(map);
      CHECK(map.title == "Height");
      CHECK(contains(map.steps[0], std::string(old ? "(Gwyddion 1" : "(Gwyddion") + ", channel \"Height\")"));
    }
}

TEST_CASE("a .gwy without units requires them; a mask is left alone and noted") {
  MadeUpGwy made;
  made.lateral_unit = made.channels[0].unit = "";
  CHECK(contains(complaint_about(gwy_file(made)), "--width"));
  CHECK(contains(complaint_about(gwy_file(made)), "--unit"));
  made = {};
  made.channels[0].unit = "V";
  CHECK(contains(complaint_about(gwy_file(made)), "channel \"Height\" is in \"V\""));
  made = {};
  made.mask = std::vector<double>(15, 1.0);
  const HeightMap map = read(gwy_file(made));
  CHECK(missing_points(map) == 0);
  CHECK(map.steps.back() == "the mask in the file was not applied");
}

TEST_CASE("a .gwy that contradicts itself or is cut is refused") {
  const std::string good = gwy_file();
  for (std::size_t size = 4; size < good.size(); ++size) {
    CAPTURE(size);
    CHECK(contains(complaint_about(good.substr(0, size)), "truncated"));
  }
  MadeUpGwy made;
  made.columns = 4;
  CHECK(contains(complaint_about(gwy_file(made)), "15 heights; expected 4 x 3"));
  made.columns = 2000000000;
  CHECK(contains(complaint_about(gwy_file(made)), "expected at most"));
  made = {};
  made.width = -1.0;
  CHECK(contains(complaint_about(gwy_file(made)), "\"xreal\" is -1"));
  made.channels.clear();
  CHECK(contains(complaint_about(gwy_file(made)), "no image channel"));
  CHECK(contains(complaint_about(first_replaced(good, "GwyContainer", "GwyXontainer")),
                 "expected a \"GwyContainer\""));
  CHECK(contains(complaint_about(first_replaced(good, std::string("xres\0i", 6), std::string("xres\0q", 6))),
                 "expected"));
  CHECK(contains(complaint_about(first_replaced(good, std::string("xres\0i", 6), std::string("xres\0z", 6))),
                 "type \"z\""));
}

TEST_CASE("a channel is taken by name: exactly before by its beginning, upper and lower case alike") {
  const std::vector<MadeUpChannel> both{{"Height", "nm"},
                                        {"Height Sensor", "nm", std::vector<double>(15, 2.0)}};
  const std::string file = nanoscope_file({both});
  CHECK(read(file, channel("HEIGHT")).at(4, 0) == doctest::Approx(9e-3));
  CHECK(read(file, channel("height s")).at(4, 0) == doctest::Approx(2e-3));
  CHECK(contains(read(file, channel("height s")).steps[0], "(Nanoscope, channel \"Height Sensor\" of 2)"));
  CHECK(contains(complaint_about(file, channel("hei")),
                 "fits several channels; the channels are \"Height\", \"Height Sensor\""));
  CHECK(contains(complaint_about(file, channel("Hight")), "no channel \"Hight\""));
  CHECK(contains(complaint_about(file, channel("Hight")), "did you mean \"Height\"?"));
  CHECK(contains(complaint_about(file, channel(" ")), "no channel \" \""));
}

TEST_CASE("without a name, the sensor's height goes before the height, and forward before backward") {
  const auto taken = [](const std::vector<MadeUpChannel>& channels) {
    MadeUpGwy made;
    made.channels = channels;
    return read(gwy_file(made)).steps[0];
  };
  CHECK(contains(taken({{"Phase", "deg"}, {"Height", "m"}, {"ZSensor", "m"}}), "\"ZSensor\""));
  CHECK(contains(taken({{"Deflection", "m"}, {"Height", "m"}}), "\"Height\""));
  CHECK(contains(taken({{"HeightRetrace", "m"}, {"HeightTrace", "m"}}), "\"HeightTrace\""));
  CHECK(contains(taken({{"Phase", "deg"}, {"Something", "m"}}), "\"Something\""));
  CHECK(contains(taken({{"Anything", "m"}}), "\"Anything\""));
  MadeUpGwy made;
  made.channels = {{"A", "m"}, {"B", "m"}};
  CHECK(contains(complaint_about(gwy_file(made)),
                 "several channels may be the height map; the channels are \"A\", \"B\""));
  made.channels = {{"A", "V"}, {"B", "deg"}};
  CHECK(contains(complaint_about(gwy_file(made)), "no channel is in a unit of length"));
  made.channels = {{"", "m"}, {"", "m"}};
  CHECK(contains(complaint_about(gwy_file(made)), "\"channel 1\", \"channel 2\""));
  const std::string twice =
      nanoscope_file({{{"Height", "nm", made_up_heights(), "Retrace"}, {"Height", "nm"}}});
  CHECK(contains(read(twice).steps[0], "\"Height (Trace)\""));
  CHECK(contains(complaint_about(twice, channel("Height")), "\"Height (Retrace)\", \"Height (Trace)\""));
}

TEST_CASE("an Igor wave is read, with Asylum's channel names and the units that follow from them") {
  MadeUpIbw made;
  check_made_up(read(ibw_file(made)));
  CHECK(contains(read(ibw_file(made)).steps[0], "channel \"HeightRetrace\" of 2"));
  CHECK(contains(complaint_about(ibw_file(made), channel("Phase")), "\"PhaseRetrace\" is in \"deg\""));
  made.big_endian = true;
  check_made_up(read(ibw_file(made)));
  made.channels[1].name = "UserIn0Retrace";
  CHECK(contains(complaint_about(ibw_file(made), channel("User")), "is in \"V\""));
  made.channels.resize(1);
  made.labels = made.asylum = false;
  check_made_up(read(ibw_file(made)));
  made.lateral_unit = "";
  CHECK(contains(complaint_about(ibw_file(made)), "no lateral size"));
  ReadOptions width = channel();
  width.width_um = 10.0;
  check_made_up(read(ibw_file(made), width));  // the ratio of the pitches is known
}

TEST_CASE("Igor waves that are no images, or of a wrong size, are refused") {
  const std::string good = ibw_file();
  const auto with = [&](std::size_t at, const std::string& bytes) {
    std::string file = good;
    return file.replace(at, bytes.size(), bytes);
  };
  CHECK(contains(complaint_about(with(0, bytes_of(std::int16_t{2}))), "format not known"));
  CHECK(contains(complaint_about(with(4, bytes_of(std::int32_t{319}))), "format not known"));
  CHECK(contains(complaint_about(with(80, bytes_of(std::int16_t{3}))), "number type 3"));
  CHECK(contains(complaint_about(with(136, bytes_of(std::int32_t{0}))), "curves are not height maps"));
  CHECK(contains(complaint_about(with(132, bytes_of(std::int32_t{1000000}))), "truncated"));
  CHECK(contains(complaint_about(with(140, bytes_of(std::int32_t{2000000000}))), "channels in"));
  CHECK(contains(complaint_about(with(140, bytes_of(std::int32_t{1}))), "the header states"));
  CHECK(contains(complaint_about(with(12, bytes_of(std::int32_t{-1}))), "negative size"));
  CHECK(contains(complaint_about(good.substr(0, good.size() - 1)), "truncated"));
  CHECK(contains(complaint_about(good.substr(0, 450)), "truncated"));
  CHECK(contains(complaint_about(with(148, bytes_of(0.0))), "distance of points"));
}

TEST_CASE("Nanoscope files are read with 16 and 32 bits, and with 32 that are declared as 16") {
  MadeUpNanoscope made;
  check_made_up(read(nanoscope_file(made)), 1e-3);
  made.bytes = 4;
  check_made_up(read(nanoscope_file(made)), 1e-3);
  made.bytes_said = 2;
  CHECK(contains(complaint_about(nanoscope_file(made)), "expected 30 bytes"));
  made.version = "0x09200000";
  check_made_up(read(nanoscope_file(made)), 1e-3);
}

TEST_CASE("Nanoscope files before 9.2 may state the step of the electronics; the full scale counts") {
  for (const char* version : {"0x05120000", "0x07200000", "0x09010201"}) {
    CAPTURE(version);
    MadeUpNanoscope made;
    made.version = version;
    check_made_up(read(first_replaced(nanoscope_file(made), "(0.0001", "(0.0113")), 1e-3);
  }
}

TEST_CASE("heights that no surface of the size of its map has are refused at once") {
  const auto map_in = [](const std::string& unit) {
    return "# Channel: Main\n# Width: 10 µm\n# Height: 10 µm\n# Value units: " + unit +
           "\n 1.0 2.0 3.0 4.0\n 5.0 6.0 7.0 8.0\n 9.0 10.0 11.0 12.0\n";
  };
  const std::string found = complaint_about(map_in("m"));
  CHECK(contains(found, "1.1e+07 um"));
  CHECK(contains(found, "10 x 10 um"));
  CHECK(contains(found, "--unit um"));
  CHECK(read(map_in("µm")).heights_um[11] == doctest::Approx(12.0));
  ReadOptions stated = channel();
  stated.height_unit_um = 1.0;
  CHECK(read(map_in("m"), stated).heights_um[11] == doctest::Approx(12.0));
  // A single wrong point is left for outlier removal.
  std::string large = "# Channel: Main\n# Width: 20 µm\n# Height: 20 µm\n# Value units: µm\n";
  for (int row = 0; row < 20; ++row) {
    for (int column = 0; column < 20; ++column)
      large += row == 3 && column == 7 ? " 1e9" : " " + std::to_string((row * column) % 3);
    large += "\n";
  }
  CHECK(read(large).heights_um[67] == doctest::Approx(1e9));
}

TEST_CASE("Nanoscope headers that lack something or contradict themselves are refused with the line") {
  const std::string good = nanoscope_file();
  CHECK(contains(complaint_about(first_replaced(good, "\\*File list end", "\\*Anything  end")),
                 "without its end"));
  CHECK(contains(complaint_about(good.substr(0, good.size() - 31)), "truncated"));
  CHECK(contains(complaint_about(first_replaced(good, "Samps/line: 5", "Samps/line: x")), "map:"));
  CHECK(
      contains(complaint_about(first_replaced(good, "Samps/line: 5", "Samps/line: 9")), "expected 54 bytes"));
  CHECK(contains(complaint_about(first_replaced(good, "Samps/line: 5", "Samps/line: 1e300")),
                 "expected a number from 0"));
  CHECK(contains(complaint_about(first_replaced(good, "Data offset: 4096", "Data offset: 99999999")),
                 "0 bytes of heights"));
  CHECK(
      contains(complaint_about(first_replaced(good, "Bytes/pixel: 2", "Bytes/pixel: 3")), "expected 2 or 4"));
  MadeUpNanoscope recent;
  recent.version = "0x09200000";
  CHECK(contains(complaint_about(first_replaced(nanoscope_file(recent), "(0.0001", "(0.0002")),
                 "full scale of 2^16"));
  CHECK(contains(complaint_about(first_replaced(good, "(0.0001", "(0.00001")), "full scale of 2^16"));
  CHECK(contains(complaint_about(first_replaced(good, "@2:Z scale", "@2:X scale")),
                 "without \"\\@2:Z scale\""));
  CHECK(contains(complaint_about(first_replaced(good, "10 3 ~m", "10 3 V")), "their unit"));
  CHECK(contains(complaint_about(nanoscope_file({{{"Amplitude", "mV"}}})), "\"Amplitude\" is in \"mV\""));
  CHECK(contains(complaint_about(nanoscope_file({{}})), "no image channel"));
}

TEST_CASE("PicoView files are read with 16 and 32 bits") {
  check_made_up(read(picoview_file()));
  const HeightMap coarse = read(picoview_file({{"Topography", "um"}, {"Friction", "V"}}, false));
  for (std::size_t k = 0; k < 15; ++k)
    CHECK(std::abs(coarse.heights_um[k] - made_up_heights()[k]) <= 0.5 * 100.0 / 32768);
  CHECK(contains(complaint_about(picoview_file(), channel("Friction")), "is in \"V\""));
  CHECK(contains(complaint_about(picoview_file().substr(0, 200)), "truncated"));
  CHECK(contains(complaint_about(first_replaced(picoview_file(), "BINARY_32", "ASCII")), "\"BINARY_32\""));
  CHECK(contains(complaint_about(first_replaced(picoview_file(), "Image", "Spectroscopy")),
                 "expected an \"Image\""));
  CHECK(contains(complaint_about(first_replaced(picoview_file(), "xPixels       5", "xPixels       999999")),
                 "truncated"));
  CHECK(contains(complaint_about(first_replaced(picoview_file(), "bufferRange   100", "bufferRange   nan")),
                 "bufferRange"));
}

TEST_CASE("ISO 25178-71 files are read as text and binary, with missing points") {
  check_made_up(read(sdf_text_file()));
  check_made_up(read(sdf_binary_file()));
  CHECK(missing_points(read(sdf_text_file("1 2 3 4 5\n1 BAD 3 4 5\n1 2 3 4 5\n"))) == 1);
  std::string binary = sdf_binary_file();
  binary.replace(binary.size() - 2, 2, bytes_of(std::int16_t{-32768}));
  CHECK(std::isnan(read(binary).heights_um.back()));
  CHECK(contains(complaint_about(sdf_binary_file().substr(0, 100)), "truncated"));
  CHECK(contains(complaint_about(sdf_text_file("1 2 3\n")), "truncated"));
  CHECK(contains(complaint_about(sdf_text_file("1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16\n")),
                 "no more than 15"));
  CHECK(contains(complaint_about(sdf_text_file("1 2 x\n")), "map:13:5"));
  CHECK(contains(complaint_about(first_replaced(sdf_text_file(), "NumPoints = 5", "NumPoints = 999999")),
                 "truncated"));
  CHECK(
      contains(complaint_about(first_replaced(sdf_text_file(), "Zscale = 1.0E-6", "Zscale = 0")), "Zscale"));
  CHECK(contains(complaint_about(first_replaced(sdf_text_file(), "Compression = 0", "Compression = 1")),
                 "Compression"));
  CHECK(
      contains(complaint_about(first_replaced(sdf_text_file(), "DataType = 7", "DataType = 8")), "DataType"));
  CHECK(contains(complaint_about(sdf_text_file(), channel("Height")), "no names"));
}

TEST_CASE("ISO 25178-72 archives are read with every number type, a folder level more, and junk") {
  for (const std::string type : {"D", "F", "L", "I"}) {
    MadeUpX3p made;
    made.type = type;
    check_made_up(read(x3p_file(made)));
    made.folder = "land/";
    made.junk = true;
    check_made_up(read(x3p_file(made)));
  }
  MadeUpX3p listed;
  listed.listed = true;
  check_made_up(read(x3p_file(listed)));
  listed.values[7] = std::nan("");
  CHECK(std::isnan(read(x3p_file(listed)).heights_um[7]));
  MadeUpX3p marked;
  marked.type = "I";
  marked.valid = std::vector<bool>(15, true);
  marked.valid[9] = false;
  const HeightMap map = read(x3p_file(marked));
  CHECK(missing_points(map) == 1);
  CHECK(std::isnan(map.heights_um[9]));
}

TEST_CASE("ISO 25178-72 archives that lack something, contradict themselves or are damaged are refused") {
  const std::string good = x3p_file();
  CHECK(contains(complaint_about(good.substr(0, good.size() - 30)), "damaged zip archive"));
  std::string flipped = good;
  flipped[flipped.find("main.xml") + 200] ^= 1;
  CHECK(contains(complaint_about(flipped), "checksum"));
  CHECK(contains(complaint_about(zipped({{"readme.txt", "hello"}})), "format not known"));
  CHECK(contains(complaint_about(zipped({{"__MACOSX/main.xml", "hello"}})), "without main.xml"));
  CHECK(contains(complaint_about(zipped({{"main.xml", "no xml <"}})), "not XML"));
  const auto with = [](const std::string& from, const std::string& to, const MadeUpX3p& base = {}) {
    const std::string plain = x3p_file(base);
    const std::size_t begin = plain.find("<?xml"), end = plain.find("</p:ISO5436_2>") + 14;
    MadeUpX3p made = base;
    made.xml = first_replaced(plain.substr(begin, end - begin), from, to);
    return complaint_about(x3p_file(made));
  };
  CHECK(contains(with("SUR", "PRF"), "SUR, a surface"));
  CHECK(contains(with("<SizeX>5", "<SizeX>9000"), "truncated"));
  CHECK(contains(with("<SizeX>5", "<SizeX>2"), "120 bytes; expected 48"));
  CHECK(contains(with("<SizeZ>1", "<SizeZ>2"), "1 layer"));
  CHECK(contains(with("2e-06", "-2e-06"), "Record1/Axes/CX/Increment in main.xml is \"-2e-06\""));
  CHECK(contains(with("<CY><AxisType>I", "<CY><AxisType>A"), "equal distances"));
  CHECK(contains(with("data.bin", "nothing.bin"), "no file \"bindata/nothing.bin\""));
  CHECK(contains(with("<DataType>D</DataType></CZ>", "<DataType>Q</DataType></CZ>"), "D, F, L or I"));
  MadeUpX3p whole;
  whole.type = "L";
  CHECK(contains(with("<Increment>1e-07</Increment>", "", whole), "metres per unit"));
}

TEST_CASE("a packed file that unpacks to far more than a height map does is refused") {
  // 80 MB of zeros pack into 80 kB.
  const std::string zeros(std::size_t{80} << 20, '0');
  CHECK(contains(complaint_about(gzip_file(zeros)), "declare to unpack to 83886080 bytes"));
  const std::string xml = "<x><Record1><FeatureType>SUR</FeatureType></Record1></x>";
  CHECK(contains(complaint_about(zipped({{"main.xml", zeros}, {"b", xml}}, true)), "claims 83886080 bytes"));
  std::string lying = gzip_file("1 2\n3 4\n");
  CHECK(contains(complaint_about(lying + std::string("more\0\0\0", 7)), "after the end"));
  lying.replace(lying.size() - 4, 4, "\xFF\xFF\xFF\x7F");
  CHECK(contains(complaint_about(lying), "declare to unpack to 2147483647 bytes"));
  // The trailer counts modulo 2^32, so what comes out is counted as well.
  std::string silent = gzip_file(zeros);
  silent.replace(silent.size() - 4, 4, std::string(4, '\0'));
  CHECK(contains(complaint_about(silent), "unpack to more bytes"));
  std::string zip = zipped({{"main.xml", xml}});
  const std::string size = bytes_of(static_cast<std::uint32_t>(xml.size()));
  // The size in the central directory stands twice: packed, unpacked.
  const std::size_t at = zip.rfind(size + size);
  REQUIRE(at != std::string::npos);
  zip.replace(at + 4, 4, bytes_of(std::uint32_t{0x03000000}));
  CHECK_FALSE(complaint_about(zip).empty());
}

TEST_CASE("an unknown format is refused with the known ones and a hint") {
  const std::string text = complaint_about("\x89PNG\r\n\x1A\n not a height map");
  CHECK(contains(text, "format not known"));
  CHECK(contains(text, ".x3p"));
  CHECK(contains(text, "gwyddion"));
}
