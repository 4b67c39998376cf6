#pragma once
/// Small height map files of every format, made up byte by byte, for tests of the readers.

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "support/zipped.hpp"

namespace scintray::test {

inline constexpr std::uint32_t kMadeUpColumns = 5, kMadeUpRows = 3;

/// 15 numbers, top row first: 1 + 2 column - 3 row.
std::vector<double> made_up_heights();

struct MadeUpChannel {
  std::string name, unit;
  std::vector<double> values = made_up_heights();
  std::string direction = "Trace";  ///< where the format has it
};

/// Bytes of a number, little-endian.
template <class T>
std::string bytes_of(T value) {
  return {reinterpret_cast<const char*>(&value), sizeof value};
}

struct MadeUpGwy {
  bool old = false;  ///< version 1
  std::vector<MadeUpChannel> channels{{"Height", "m"}};
  std::string lateral_unit = "m";
  std::vector<double> mask;  ///< of the first channel, or none
  double width = 10e-6, height = 3e-6;
  std::uint32_t columns = kMadeUpColumns;
};
std::string gwy_file(const MadeUpGwy& made = {});

struct MadeUpIbw {
  std::vector<MadeUpChannel> channels{{"HeightRetrace", "m"}, {"PhaseRetrace", "m"}};
  bool labels = true, asylum = true, big_endian = false;
  std::string lateral_unit = "m";
};
/// Pitch 2 x 1 um; a "UserIn0Unit: V" in the note.
std::string ibw_file(const MadeUpIbw& made = {});

struct MadeUpNanoscope {
  std::vector<MadeUpChannel> channels{{"Height Sensor", "nm"}, {"Height", "nm"}};
  int bytes = 2;       ///< stored
  int bytes_said = 0;  ///< 0: as stored
  std::string version = "0x09010201";
};
/// Pitch 2 x 1 um; stored numbers are values / 0.01 nm. A channel in "mV" has no sensitivity.
std::string nanoscope_file(const MadeUpNanoscope& made = {});

/// Pitch 2 x 1 um, range 100 of the unit.
std::string picoview_file(const std::vector<MadeUpChannel>& channels = {{"Topography", "um"},
                                                                        {"Friction", "V"}},
                          bool wide = true);

/// Pitch 2 x 1 um, heights in um; the binary one stores int16 tenths.
std::string sdf_text_file(std::string_view heights = {});
std::string sdf_binary_file();

struct MadeUpX3p {
  std::string folder;       ///< "land/" puts everything one level down
  std::string type = "D";   ///< of heights, in metres; whole numbers count 1e-7 m
  bool listed = false;      ///< heights stand in main.xml
  bool junk = false;        ///< what macOS adds
  std::vector<bool> valid;  ///< or no list of valid points
  std::vector<double> values = made_up_heights();
  std::string xml;  ///< in place of the one made
};
/// Pitch 2 x 1 um, heights in um.
std::string x3p_file(const MadeUpX3p& made = {});

std::string gzip_file(std::string_view content);

}  // namespace scintray::test
