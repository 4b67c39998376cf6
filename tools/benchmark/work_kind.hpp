#pragma once
/// Kinds of work, and the source that does them.

#include <cstddef>
#include <string>
#include <vector>

#include "scintray/core/words.hpp"

namespace scintray::bench {

enum class WorkKind {
  ray_query,    ///< where a ray leaves a region: Embree, planes, exact query
  propagation,  ///< steps of photons between interactions, and the choice of what happens at a boundary
  surface,      ///< interaction with a surface: Fresnel, facets, tables, height maps, reflectors
  random,       ///< random numbers
  elementary,   ///< elementary functions of the C library
  emission,     ///< gammas, energy deposits, initial state of photons
  tally,        ///< fates, tallies, lists
  readout,      ///< sensors and electronics, event records
  other,        ///< memory, threads, the loop over photons, what could not be attributed
};
inline constexpr std::size_t kWorkKindCount = 9;

/// Words of the kinds in JSON and in tables.
inline constexpr core::Word<WorkKind> kWorkKinds[] = {{"ray query", WorkKind::ray_query},
                                                      {"propagation", WorkKind::propagation},
                                                      {"surface", WorkKind::surface},
                                                      {"random", WorkKind::random},
                                                      {"elementary", WorkKind::elementary},
                                                      {"emission", WorkKind::emission},
                                                      {"tally", WorkKind::tally},
                                                      {"readout", WorkKind::readout},
                                                      {"other", WorkKind::other}};
static_assert(std::size(kWorkKinds) == kWorkKindCount);

/// A function at an address, as addr2line prints it: one that is inlined there, or the one that it is in.
struct CodeFrame {
  std::string function;  ///< demangled; "??" when unknown
  std::string file;      ///< of its line at the address; empty when unknown
};

/// Kind of the work of a library: Embree's, the C library's elementary functions, or other.
WorkKind kind_of_library(const std::string& library);

/// Kind of the work at an address of the program, that of the innermost frame whose file (without lines:
/// whose function) has one. Vectors, lists and the like have none of their own: their work is that of their
/// caller.
WorkKind kind_of_code(const std::vector<CodeFrame>& frames);

}  // namespace scintray::bench
