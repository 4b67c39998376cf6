# shellcheck shell=bash
# Sourced by tools/test and tools/sanitize, after setup.sh.

# sanitize PRESET: builds one of the presets with sanitizers and runs its tests; both are timed.
sanitize() {
  local preset=$1
  timed "$preset: build" build "$preset"
  say "tests of build/$preset"
  timed "$preset: tests" ctest --preset "$preset" -j "$(nproc)"
}
