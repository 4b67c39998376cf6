#pragma once
/// Entries for the surface tables of other programs, in small sizes of their layouts.

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace scintray::fuzz {

/// The bytes are X_LUT, beside a sound X_LUTR.
bool run_davis(const std::uint8_t* data, std::size_t size);
/// The bytes are X_LUTR, beside a sound X_LUT.
bool run_davis_reflectances(const std::uint8_t* data, std::size_t size);
bool run_lbnl(const std::uint8_t* data, std::size_t size);
bool run_dichroic(const std::uint8_t* data, std::size_t size);

std::vector<std::string> davis_seeds();
std::vector<std::string> davis_reflectance_seeds();
std::vector<std::string> lbnl_seeds();
std::vector<std::string> dichroic_seeds();

}  // namespace scintray::fuzz
