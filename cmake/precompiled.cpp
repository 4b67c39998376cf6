// A target whose headers are compiled once for others needs a source: ScintRayPrecompile.cmake.
