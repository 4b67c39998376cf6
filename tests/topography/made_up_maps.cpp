#include "made_up_maps.hpp"

#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace scintray::test {

namespace {

std::string text(double value) {
  char buffer[40];
  std::snprintf(buffer, sizeof buffer, "%.17g", value);
  return buffer;
}

std::string ended(const std::string& words) { return words + '\0'; }

/// Rows in reverse, for formats that begin at the bottom.
std::vector<double> from_below(const std::vector<double>& values, std::size_t columns = kMadeUpColumns) {
  std::vector<double> result;
  for (std::size_t end = values.size(); end >= columns; end -= columns)
    result.insert(result.end(), values.begin() + static_cast<long>(end - columns),
                  values.begin() + static_cast<long>(end));
  return result;
}

std::string padded(std::string words, std::size_t size) {
  words.resize(size, '\0');
  return words;
}

std::string object(const std::string& name, const std::string& content) {
  return ended(name) + bytes_of(static_cast<std::uint32_t>(content.size())) + content;
}

std::string unit_object(const std::string& key, const std::string& unit) {
  return ended(key) + "o" + object("GwySIUnit", ended("unitstr") + "s" + ended(unit));
}

std::string data_field(const MadeUpGwy& made, const std::string& unit, const std::vector<double>& values) {
  std::string content = ended("xres") + "i" + bytes_of(made.columns) + ended("yres") + "i" +
                        bytes_of(kMadeUpRows) + ended("xreal") + "d" + bytes_of(made.width) + ended("yreal") +
                        "d" + bytes_of(made.height);
  if (!made.lateral_unit.empty()) content += unit_object("si_unit_xy", made.lateral_unit);
  if (!unit.empty()) content += unit_object("si_unit_z", unit);
  content += ended("data") + "D" + bytes_of(static_cast<std::uint32_t>(values.size()));
  for (const double value : values) content += bytes_of(value);
  return object("GwyDataField", content);
}

}  // namespace

std::vector<double> made_up_heights() {
  std::vector<double> heights;
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 5; ++i) heights.push_back(1.0 + 2.0 * i - 3.0 * j);
  return heights;
}

std::string gwy_file(const MadeUpGwy& made) {
  constexpr std::uint32_t kOldString = 16 << 2, kOldObject = 20 << 2, kOldBoolean = 5 << 2;
  const auto item = [&](const std::string& key, char type, const std::string& value) {
    const std::uint32_t number = type == 's' ? kOldString : type == 'o' ? kOldObject : kOldBoolean;
    return made.old ? bytes_of(number) + ended(key) + value : ended(key) + type + value;
  };
  std::string content = item("/filename", 's', ended("made-up"));
  for (std::size_t k = 0; k < made.channels.size(); ++k) {
    const MadeUpChannel& channel = made.channels[k];
    const std::string key = "/" + std::to_string(k) + "/data";
    if (!channel.name.empty()) content += item(key + "/title", 's', ended(channel.name));
    content += item(key + "/visible", 'b', std::string(1, '\1'));
    std::vector<double> metres = channel.values;
    for (double& value : metres) value *= 1e-6;
    content += item(key, 'o', data_field(made, channel.unit, metres));
  }
  if (!made.mask.empty()) content += item("/0/mask", 'o', data_field(made, "", made.mask));
  if (!made.old)
    content += item("/0/data/log", 'o',
                    object("GwyStringList", ended("strings") + "S" + bytes_of(std::uint32_t{2}) +
                                                ended("one") + ended("two")));
  return (made.old ? "GWYO" : "GWYP") + object("GwyContainer", content);
}

std::string ibw_file(const MadeUpIbw& made) {
  const std::string note = made.asylum ? "ScanSize: 1e-05\rInvOLS: 4e-08\rUserIn0Unit: V\r" : "";
  const auto number = [&](auto value) {
    std::string bytes = bytes_of(value);
    if (made.big_endian) std::reverse(bytes.begin(), bytes.end());
    return bytes;
  };
  std::string data, labels;
  labels += padded("", 32);
  for (const MadeUpChannel& channel : made.channels) {
    for (const double value : from_below(channel.values)) data += number(static_cast<float>(value * 1e-6));
    labels += padded(channel.name, 32);
  }
  if (!made.labels) labels.clear();
  const auto size = [&](std::size_t n) { return number(static_cast<std::int32_t>(n)); };
  std::string file = number(std::int16_t{5}) + number(std::int16_t{0}) + size(320 + data.size()) + size(0) +
                     size(note.size()) + size(0) + std::string(16, '\0') + size(0) + size(0) +
                     size(labels.size()) + size(0);
  file = padded(file, 64);
  file += std::string(16, '\0') + number(std::int16_t{2}) + std::string(10, '\0') + padded("wave", 32) +
          std::string(8, '\0');
  file += size(kMadeUpColumns) + size(kMadeUpRows) +
          size(made.channels.size() > 1 ? made.channels.size() : 0) + size(0);
  for (const double step : {2e-6, 1e-6, 1.0, 1.0}) file += number(step);
  file += std::string(32, '\0') + padded(made.channels.front().unit, 4) + padded(made.lateral_unit, 4) +
          padded(made.lateral_unit, 4) + std::string(8, '\0');
  return padded(file, 384) + data + note + labels;
}

std::string nanoscope_file(const MadeUpNanoscope& made) {
  constexpr std::size_t kData = 4096;
  const std::size_t length = 15 * static_cast<std::size_t>(made.bytes);
  const double range = std::ldexp(1.0, 8 * made.bytes);
  std::string header = "\\*File list\r\n\\Version: " + made.version +
                       "\r\n\\*Scanner list\r\n\\@Sens. ZsensSens: V 100.0000 nm/V\r\n\\*Ciao scan list\r\n";
  std::string data;
  for (std::size_t k = 0; k < made.channels.size(); ++k) {
    const MadeUpChannel& channel = made.channels[k];
    header +=
        "\\*Ciao image list\r\n\\Data offset: " + std::to_string(kData + k * length) +
        "\r\n\\Data length: " + std::to_string(length) +
        "\r\n\\Bytes/pixel: " + std::to_string(made.bytes_said ? made.bytes_said : made.bytes) +
        "\r\n\\Samps/line: 5\r\n\\Number of lines: 3\r\n\\Aspect Ratio: 1:1\r\n\\Scan Size: 10 3 ~m\r\n" +
        "\\Line Direction: " + channel.direction + "\r\n\\@2:Image Data: S [Short] \"" + channel.name +
        "\"\r\n\\@2:Z scale: V " +
        (channel.unit == "nm" ? "[Sens. ZsensSens] (0.0001000000 V/LSB) " + text(1e-4 * range) + " V"
                              : "[Sens. Amplitude] (0.01000000 mV/LSB) " + text(1e-2 * range) + " mV") +
        "\r\n";
    for (const double value : from_below(channel.values)) {
      const double stored = value / 0.01;
      data += made.bytes == 2 ? bytes_of(static_cast<std::int16_t>(std::lround(stored)))
                              : bytes_of(static_cast<std::int32_t>(std::lround(stored)));
    }
  }
  return padded(header + "\\*File list end\r\n\x1A", kData) + data;
}

std::string picoview_file(const std::vector<MadeUpChannel>& channels, bool wide) {
  const auto line = [](std::string key, const std::string& value) {
    key.resize(14, ' ');
    return key + value + "\n";
  };
  std::string file = line("fileType", "Image") + line("xPixels", "5") + line("yPixels", "3") +
                     line("xLength", "1e-005") + line("yLength", "3e-006");
  std::string data;
  for (const MadeUpChannel& channel : channels) {
    file += line("bufferLabel", channel.name) + line("trace", channel.direction) +
            line("bufferRange", "100") + line("bufferUnit", channel.unit);
    for (const double value : from_below(channel.values)) {
      const double part = value / 100.0;
      data += wide ? bytes_of(static_cast<std::int32_t>(std::lround(std::ldexp(part, 31))))
                   : bytes_of(static_cast<std::int16_t>(std::lround(std::ldexp(part, 15))));
    }
  }
  return file + line("data", wide ? "BINARY_32" : "BINARY") + data;
}

std::string sdf_text_file(std::string_view heights) {
  std::string file =
      "aISO-1.0\nManufacID = made-up\nNumPoints = 5\nNumProfiles = 3\nXscale = 2.0E-6\nYscale = 1.0E-6\n"
      "Zscale = 1.0E-6\nZresolution = 1.0E-9\nCompression = 0\nDataType = 7\nCheckType = 0\n*\n";
  if (heights.empty())
    for (const double value : made_up_heights()) file += text(value) + "\n";
  else
    file += heights;
  return file + "*\n< PartName > made up < /PartName >\n*\n";
}

std::string sdf_binary_file() {
  std::string file = "bISO-1.0" + padded("made-up", 34) +
                     bytes_of(static_cast<std::uint16_t>(kMadeUpColumns)) +
                     bytes_of(static_cast<std::uint16_t>(kMadeUpRows));
  for (const double value : {2e-6, 1e-6, 1e-7, 1e-9}) file += bytes_of(value);
  file += std::string("\0\5\0", 3);
  for (const double value : made_up_heights())
    file += bytes_of(static_cast<std::int16_t>(std::lround(10 * value)));
  return file;
}

std::string x3p_file(const MadeUpX3p& made) {
  std::string data, list, valid;
  for (const double value : made.values) {
    if (made.type == "D") data += bytes_of(value * 1e-6);
    if (made.type == "F") data += bytes_of(static_cast<float>(value * 1e-6));
    if (made.type == "L") data += bytes_of(static_cast<std::int32_t>(std::lround(value * 10)));
    if (made.type == "I") data += bytes_of(static_cast<std::int16_t>(std::lround(value * 10)));
    list += std::isnan(value) ? "<Datum/>" : "<Datum>" + text(value * 1e-6) + "</Datum>";
  }
  for (std::size_t k = 0; k < made.valid.size(); ++k) {
    if (k % 8 == 0) valid += '\0';
    if (made.valid[k]) valid.back() = static_cast<char>(valid.back() | 1 << (k % 8));
  }
  const bool whole = made.type == "L" || made.type == "I";
  const auto axis = [](const std::string& name, const std::string& kind, const std::string& type,
                       const std::string& step) {
    return "<" + name + "><AxisType>" + kind + "</AxisType><DataType>" + type + "</DataType>" +
           (step.empty() ? "" : "<Increment>" + step + "</Increment>") + "</" + name + ">";
  };
  const std::string links =
      made.listed
          ? "<DataList>" + list + "</DataList>"
          : "<DataLink><PointDataLink>bindata/data.bin</PointDataLink>" +
                (valid.empty() ? std::string() : "<ValidPointsLink>bindata/valid.bin</ValidPointsLink>") +
                "</DataLink>";
  std::string xml = made.xml;
  if (xml.empty())
    xml = "<?xml version=\"1.0\"?><p:ISO5436_2 xmlns:p=\"x\"><Record1><FeatureType>SUR</FeatureType><Axes>" +
          axis("CX", "I", "D", "2e-06") + axis("CY", "I", "D", "1e-06") +
          axis("CZ", "A", made.type, whole ? "1e-07" : "") +
          "</Axes></Record1><Record3><MatrixDimension><SizeX>5</SizeX><SizeY>3</SizeY><SizeZ>1</SizeZ>"
          "</MatrixDimension>" +
          links + "</Record3></p:ISO5436_2>";
  std::vector<std::pair<std::string, std::string>> entries;
  if (made.junk) entries.emplace_back("__MACOSX/._main.xml", "junk");
  if (made.junk) entries.emplace_back("__MACOSX/main.xml", "junk");
  entries.emplace_back(made.folder + "main.xml", xml);
  if (!made.listed) entries.emplace_back(made.folder + "bindata/data.bin", data);
  if (!valid.empty()) entries.emplace_back(made.folder + "bindata/valid.bin", valid);
  return zipped(entries);
}

std::string gzip_file(std::string_view content) {
  z_stream stream{};
  constexpr int kGzip = 15 + 16;
  deflateInit2(&stream, Z_BEST_COMPRESSION, Z_DEFLATED, kGzip, 9, Z_DEFAULT_STRATEGY);
  std::string packed(deflateBound(&stream, content.size()) + 64, '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(content.data()));
  stream.avail_in = static_cast<uInt>(content.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = static_cast<uInt>(packed.size());
  deflate(&stream, Z_FINISH);
  packed.resize(stream.total_out);
  deflateEnd(&stream);
  return packed;
}

}  // namespace scintray::test
