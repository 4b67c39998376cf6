#pragma once
/// Values by the crossing of an interface.

#include <array>

#include "scintray/core/id_vector.hpp"
#include "scintray/core/ids.hpp"

namespace scintray::tally {

/// A value for each interface and direction across it: [interface][from_back].
template <typename T>
using PerCrossing = core::IdVector<core::InterfaceId, std::array<T, 2>>;

}  // namespace scintray::tally
