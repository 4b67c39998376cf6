#pragma once
/// How Geant4's LUTDAVIS model reads a pair of files and samples from it, written from a description of its
/// reader and sharing no code with ours. Its habits are kept: reflected directions one block low, the
/// normal scaled in place, straight lines below 1 deg.

#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include "scintray/core/rng.hpp"
#include "scintray/core/vec.hpp"

namespace scintray::test {

inline std::string file_content(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// As Geant4 unpacks: a buffer that doubles until zlib is content.
inline std::string uncompressed(const std::string& packed) {
  for (std::size_t size = packed.size() * 2;; size *= 2) {
    std::string text(size, '\0');
    uLongf got = size;
    const int state = uncompress(reinterpret_cast<Bytef*>(text.data()), &got,
                                 reinterpret_cast<const Bytef*>(packed.data()), packed.size());
    if (state == Z_BUF_ERROR) continue;
    if (state != Z_OK) return {};
    text.resize(got);
    return text;
  }
}

class Geant4Davis {
 public:
  /// The texts of X_LUT and X_LUTR.
  Geant4Davis(const std::string& directions, const std::string& reflectances, int samples)
      : samples_(samples), lut_(2 * 91 * 2 * static_cast<std::size_t>(samples) + 1), reflectances_(90) {
    std::istringstream pairs(directions), shares(reflectances);
    for (float& value : lut_) pairs >> value;
    whole = !pairs.fail();
    for (float& value : reflectances_) shares >> value;
    whole = whole && !shares.fail();
    std::string rest;
    whole = whole && !(pairs >> rest) && !(shares >> rest);
  }

  /// All numbers were there, and no more.
  bool whole = false;

  double reflectance(int degree) const { return reflectances_[static_cast<std::size_t>(degree)]; }

  /// `momentum` is incident on a surface whose normal `normal` points back to it, EFFICIENCY 0.
  core::Vec3 sample(const core::Vec3& momentum, core::Vec3 normal, core::Rng& rng) const {
    const double drawn = rng.uniform();
    const double angle = std::acos(std::clamp(-momentum.dot(normal), -1.0, 1.0));
    const int degree = std::min(static_cast<int>(std::floor(angle / core::kDegree)), 89);
    const bool reflects = !(drawn > reflectances_[static_cast<std::size_t>(degree)]);
    if (degree == 0) return reflects ? core::Vec3(-momentum) : momentum;
    const std::size_t half = 91 * 2 * static_cast<std::size_t>(samples_);
    const std::size_t block = reflects ? static_cast<std::size_t>((degree - 1) * samples_ * 2)
                                       : half + static_cast<std::size_t>(degree * samples_ * 2);
    double azimuth = 0.0, elevation = 0.0;
    do {
      const int j = 1 + std::min(static_cast<int>(rng.uniform() * samples_), samples_ - 1);
      azimuth = lut_[block + static_cast<std::size_t>(2 * (j - 1))];
      elevation = lut_[block + static_cast<std::size_t>(2 * (j - 1) + 1)];
    } while (azimuth == 0.0 && elevation == 0.0);
    const core::Vec3 v = normal.cross(momentum).normalized();
    const core::Vec3 u = v.cross(normal);
    normal *= std::cos(elevation);
    return u * (std::sin(elevation) * std::cos(azimuth)) + v * (std::sin(elevation) * std::sin(azimuth)) +
           normal;
  }

 private:
  int samples_;
  std::vector<float> lut_;
  std::vector<float> reflectances_;
};

}  // namespace scintray::test
