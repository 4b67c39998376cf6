#pragma once
/// What a photon owes to the reflectances of the reflectors on its way.

#include <cmath>
#include <cstdint>
#include <vector>

namespace scintray::optics {

struct Reflector;

/// Reflections that one photon survived by a draw against a reflectance, summed up for each reflector. The
/// reflector of a stack may be met never, once or often within one meeting with the stack.
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
