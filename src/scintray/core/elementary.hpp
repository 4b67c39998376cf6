#pragma once
/// Logarithm, sine and cosine for light transport, of one number: elementary_laws.hpp has what they are, and
/// the same for the lanes of a vector.

#include "scintray/core/elementary_laws.hpp"

namespace scintray::core {

using SineCosine = SineCosineOf<double>;

/// Sine and cosine of an angle given as a share of a full turn, within 2^49 of zero, with an error below
/// 2e-16.
constexpr SineCosine sincos_of_turn(double turns) { return laws::sincos_of_turn<double>(turns); }

/// Sine and cosine of an angle (rad) within 1000 of zero, with an error below 2e-16.
constexpr SineCosine sincos(double angle_rad) { return laws::sincos<double>(angle_rad); }

/// Natural logarithm of a normal positive number.
constexpr double log(double x) { return laws::log<double>(x); }

}  // namespace scintray::core
