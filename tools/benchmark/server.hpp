#pragma once
/// The side of a paired measurement that traces: reads requests, writes answers, one line of JSON each.
///
///     {"scene": "polished", "work": 8192, "threads": 1}
///     {"segments": 1234567, "photons": 8192, "events": 0, "wall_s": 0.101, "cpu_s": 0.100}
///     {"scene": "polished", "seconds": 0.1}
///     {"work": 81920}
///     {"machine": true}
///     {"cpu": "AMD EPYC", "cycles_per_ns": 3.7, "lane_widths": [1, 2, 4, 8]}
///     {"kinds_of": [["", "src/scintray/optics/fresnel_laws.hpp", "scintray::transport::step()"]]}
///     {"kinds": ["surface"]}
///
/// The second request calibrates: the work that takes that time on one thread. The fourth requests the kinds
/// of work of places: library (empty: the program itself), source file, and the function that it is compiled
/// into. The first two may have a "lane_width". A request that fails is answered with {"error": "why"}. These
/// lines are how binaries of different revisions compare, so that a key may be added, but none may change its
/// meaning.

#include <iosfwd>
#include <string>

#include "measure.hpp"

namespace scintray::bench {

/// Answers requests until the input ends. The last scene requested is kept built.
void serve(std::istream& requests, std::ostream& answers);

/// Request to calibrate.
std::string calibration_request(const std::string& scene, double seconds);
/// Request to trace.
std::string trace_request(const std::string& scene, std::uint64_t work, const Turn& turn);

/// Work of an answer to a calibration. @throws InputError with the error that was answered
std::uint64_t work_of_answer(const std::string& answer);
/// Trace of an answer. @throws InputError with the error that was answered
Trace trace_of_answer(const std::string& answer);

}  // namespace scintray::bench
