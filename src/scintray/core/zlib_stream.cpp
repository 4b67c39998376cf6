#include "scintray/core/zlib_stream.hpp"

#include <zlib.h>

#include <algorithm>
#include <array>

#include "scintray/core/error.hpp"

namespace scintray::core {

namespace {

/// Runs `input` through `step` (inflate or deflate) until the input is used up or the stream ends or fails.
/// What `step` left of the input stays in it. Returns the last state of zlib.
template <typename Step>
int run(z_stream& stream, std::string_view& input, const Step& step, const TakeBytes& take) {
  constexpr std::size_t kMost = 1 << 30;  // zlib counts in 32 bits
  std::array<char, 1 << 14> part{};
  int state = Z_OK;
  do {
    const std::size_t fed = std::min(input.size(), kMost);
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(input.data()));
    stream.avail_in = static_cast<uInt>(fed);
    do {
      stream.next_out = reinterpret_cast<Bytef*>(part.data());
      stream.avail_out = static_cast<uInt>(part.size());
      state = step(stream);
      if (stream.avail_out < part.size()) take({part.data(), part.size() - stream.avail_out});
    } while (state == Z_OK && stream.avail_out == 0);
    input.remove_prefix(fed - stream.avail_in);
    // Z_BUF_ERROR: all input is consumed.
  } while ((state == Z_OK || state == Z_BUF_ERROR) && !input.empty());
  return state;
}

}  // namespace

std::uint32_t crc32(std::string_view bytes, std::uint32_t before) {
  if (bytes.empty()) return before;  // a null pointer would mean the initial value
  return static_cast<std::uint32_t>(
      ::crc32_z(before, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

Unpacked unpack(std::string_view packed, Packing packing, const TakeBytes& take) {
  z_stream stream{};
  constexpr int kWindowBits = 15, kGzipOnly = 16;
  if (inflateInit2(&stream, kWindowBits + (packing == Packing::gzip ? kGzipOnly : 0)) != Z_OK)
    throw SystemError("cannot start zlib");
  const std::unique_ptr<z_stream, int (*)(z_stream*)> guard(&stream, inflateEnd);
  const int state = run(
      stream, packed, [](z_stream& s) { return inflate(&s, Z_NO_FLUSH); }, take);
  return {state == Z_STREAM_END, packed.size()};
}

struct Packer::State {
  z_stream stream{};
  ~State() { deflateEnd(&stream); }
};

Packer::Packer() : state_(std::make_unique<State>()) {
  if (deflateInit(&state_->stream, Z_DEFAULT_COMPRESSION) != Z_OK) throw SystemError("cannot start zlib");
}

Packer::~Packer() = default;

void Packer::add(std::string_view text, const TakeBytes& take) {
  if (text.empty()) return;
  run(
      state_->stream, text, [](z_stream& s) { return deflate(&s, Z_NO_FLUSH); }, take);
}

void Packer::finish(const TakeBytes& take) {
  std::string_view nothing;
  run(
      state_->stream, nothing, [](z_stream& s) { return deflate(&s, Z_FINISH); }, take);
}

}  // namespace scintray::core
