#include "scintray/core/rng.hpp"

#include "scintray/core/philox.hpp"

namespace scintray::core {

Rng::Rng(std::uint64_t seed, StreamKind kind, std::uint64_t a, std::uint64_t b, std::uint64_t set) {
  const std::array<std::uint64_t, 4> block =
      philox4x64({0, b, a, static_cast<std::uint64_t>(kind)}, {seed, set});
  // One address in 2^128 has a state of zeros, which would stay so.
  state_ = {block[0], (block[0] | block[1]) != 0 ? block[1] : 1};
}

}  // namespace scintray::core
