#include "scintray/topography/detail/readers/bytes.hpp"

namespace scintray::topography {

namespace {

template <class T>
std::vector<double> decode(std::string_view block, std::endian order) {
  std::vector<double> values;
  values.reserve(block.size() / sizeof(T));
  Bytes bytes(block, {}, 0, order);
  while (bytes.left() >= sizeof(T)) values.push_back(static_cast<double>(bytes.take<T>()));
  return values;
}

}  // namespace

std::size_t sample_size(SampleType type) {
  switch (type) {
    case SampleType::int8:
    case SampleType::uint8:
      return 1;
    case SampleType::int16:
    case SampleType::uint16:
      return 2;
    case SampleType::int32:
    case SampleType::uint32:
    case SampleType::float32:
      return 4;
    case SampleType::float64:
      return 8;
  }
  throw core::InternalError("unknown sample type");
}

std::vector<double> decode_samples(std::string_view block, SampleType type, std::endian order) {
  switch (type) {
    case SampleType::int8:
      return decode<std::int8_t>(block, order);
    case SampleType::uint8:
      return decode<std::uint8_t>(block, order);
    case SampleType::int16:
      return decode<std::int16_t>(block, order);
    case SampleType::uint16:
      return decode<std::uint16_t>(block, order);
    case SampleType::int32:
      return decode<std::int32_t>(block, order);
    case SampleType::uint32:
      return decode<std::uint32_t>(block, order);
    case SampleType::float32:
      return decode<float>(block, order);
    case SampleType::float64:
      return decode<double>(block, order);
  }
  throw core::InternalError("unknown sample type");
}

}  // namespace scintray::topography
