#pragma once
/// Reflections of a photon at reflectors, with their reflectances.

#include <cmath>
#include <cstdint>
#include <vector>

namespace scintray::optics {

struct Reflector;

/// Reflections that one photon survived in a draw against a reflectance, summed for each reflector. Within
/// one interaction with a stack a photon may reach its reflector never, once or often.
class ReflectionLog {
 public:
  struct Entry {
    const Reflector* reflector = nullptr;
    std::uint32_t count = 0;
    double depth = 0.0;  ///< sum of -ln(reflectance), each at the wavelength of that reflection
  };

  /// @param reflectance  with which the photon survived, above 0
  void add(const Reflector& reflector, double reflectance) {
    Entry& entry = of(reflector);
    ++entry.count;
    entry.depth -= std::log(reflectance);
  }
  void clear() { entries_.clear(); }
  const std::vector<Entry>& entries() const { return entries_; }

 private:
  Entry& of(const Reflector& reflector) {
    for (Entry& known : entries_)
      if (known.reflector == &reflector) return known;
    return entries_.emplace_back(Entry{&reflector, 0, 0.0});
  }

  std::vector<Entry> entries_;
};

}  // namespace scintray::optics
