#include "scintray/core/rng.hpp"

#include "scintray/core/philox.hpp"

namespace scintray::core {

Rng::Rng(std::uint64_t seed, StreamKind kind, std::uint64_t a, std::uint64_t b, std::uint64_t set)
    : Rng(StreamFamily(seed, kind, a, set).at(b)) {}

StreamFamily::StreamFamily(std::uint64_t seed, StreamKind kind, std::uint64_t a, std::uint64_t set)
    : start_(philox4x64({0, 0, a, static_cast<std::uint64_t>(kind)}, {seed, set})) {}

}  // namespace scintray::core
