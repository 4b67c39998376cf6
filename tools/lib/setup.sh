# shellcheck shell=bash
# Sourced by the scripts in tools/: finds the repository, installs missing Debian packages, builds.
set -euo pipefail
repository=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)

say() { printf '== %s\n' "$*"; }
fail() { printf 'error: %s\n' "$1" >&2; shift; for hint in "$@"; do printf '  hint: %s\n' "$hint" >&2; done; exit 3; }

# Names in the package lists given, less comments.
listed_packages() { sed -e 's/#.*//' "$@" | tr -s '[:space:]' '\n' | sed '/^$/d'; }

missing_packages() {
  local package
  for package in $(listed_packages "$@"); do
    [ "$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null)" = installed ] || echo "$package"
  done
}

# Runs a command as root, directly or through sudo.
as_root() {
  if [ "$(id -u)" = 0 ]; then "$@"; else sudo "$@"; fi
}

# install_packages LIST...: installs what the lists name and this machine lacks.
install_packages() {
  if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
    say "this is not a Debian machine: nothing is installed; CMake will say which library is missing"
    return
  fi
  local missing
  missing=$(missing_packages "$@" | tr '\n' ' ')
  missing=${missing% }
  if [ -z "$missing" ]; then
    say "all Debian packages are there"
    return
  fi
  say "Debian packages missing: $missing"
  if [ "$(id -u)" != 0 ] && ! command -v sudo >/dev/null; then
    fail "installing packages takes root or sudo, and neither is at hand" \
         "run as root: apt-get install $missing"
  fi
  say "apt-get update"
  as_root apt-get update -qq || say "the package lists could not be refreshed; going on with those at hand"
  say "apt-get install $missing"
  # shellcheck disable=SC2086 # a list of words
  as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends $missing \
      >/dev/null ||
    fail "apt-get could not install: $missing" \
         "is this machine online, with Debian 12 (bookworm) in its package sources?" \
         "to see apt's own words: apt-get install $missing"
}

# Number of compilers to run at once: one a core, but no more than memory allows (2 GiB each).
jobs() {
  local cores gibibytes
  cores=$(nproc)
  gibibytes=$(awk '/MemAvailable/ {print int($2 / 1048576)}' /proc/meminfo)
  local by_memory=$((gibibytes / 2))
  [ "$by_memory" -ge 1 ] || by_memory=1
  [ "$cores" -le "$by_memory" ] && echo "$cores" || echo "$by_memory"
}

# build PRESET [TARGET...]: configures and builds, into build/PRESET. Shows the log when it fails.
build() {
  local preset=$1 log=$repository/build/$1.log
  shift
  mkdir -p "$repository/build"
  say "building build/$preset with $(jobs) jobs (log: build/$preset.log)"
  local started=$SECONDS
  if ! (cd "$repository" && cmake --preset "$preset" && cmake --build --preset "$preset" -j "$(jobs)" \
        ${@:+--target "$@"}) >"$log" 2>&1; then
    tail -n 60 "$log" >&2
    fail "the build of build/$preset failed; the end of build/$preset.log is above"
  fi
  say "built in $((SECONDS - started)) s"
}
