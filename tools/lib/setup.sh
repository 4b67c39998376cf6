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

# A second build is quick, and so is the first one of another clone: what ccache keeps must not hold the place of
# the repository. The user's own settings, of the environment or of ccache's file, are left alone.
share_compiler_cache() {
  command -v ccache >/dev/null || return 0
  [ -n "$(ccache --get-config base_dir 2>/dev/null)" ] || export CCACHE_BASEDIR=$repository
  [ -n "${CCACHE_HASHDIR+set}${CCACHE_NOHASHDIR+set}" ] || export CCACHE_NOHASHDIR=1
  # Headers that are compiled once: cmake/ScintRayPrecompile.cmake.
  [ -n "$(ccache --get-config sloppiness 2>/dev/null)" ] || export CCACHE_SLOPPINESS=pch_defines,time_macros
}

# Shows how far ninja is whose output is read: one line rewritten on a terminal, else a line every 20 s.
show_progress() {
  local line step='' started=$SECONDS shown=$SECONDS terminal=no
  [ -t 1 ] && terminal=yes
  while true; do
    if IFS= read -r -t 5 line; then
      [[ $line =~ ^\[([0-9]+/[0-9]+)\] ]] && step=${BASH_REMATCH[1]}
    elif [ $? -le 128 ]; then
      break
    fi
    if [ $terminal = yes ] && [ "$SECONDS" -gt "$shown" ]; then
      shown=$SECONDS
      printf '\r   [%s] %d s ' "${step:-configuring}" $((SECONDS - started))
    elif [ $((SECONDS - shown)) -ge 20 ]; then
      shown=$SECONDS
      printf '   [%s] %d s\n' "${step:-configuring}" $((SECONDS - started))
    fi
  done
  [ $terminal = no ] || printf '\r%40s\r' ''
}

configure_and_build() {
  local preset=$1
  shift
  cd "$repository"
  cmake --preset "$preset" && cmake --build --preset "$preset" -j "$(jobs)" ${@:+--target "$@"}
}

# build PRESET [TARGET...]: configures and builds, into build/PRESET. Shows the log when it fails.
build() {
  local preset=$1 log=$repository/build/$1.log
  mkdir -p "$repository/build"
  share_compiler_cache
  say "building build/$preset with $(jobs) jobs (log: build/$preset.log)"
  local started=$SECONDS
  if ! configure_and_build "$@" 2>&1 | tee "$log" | show_progress; then
    tail -n 60 "$log" >&2
    fail "the build of build/$preset failed; the end of build/$preset.log is above"
  fi
  say "built in $((SECONDS - started)) s"
}

# timed NAME COMMAND...: runs the command, and adds what it cost to the table of show_costs.
costs=()
timed() {
  local name=$1 started=$SECONDS
  shift
  "$@"
  costs+=("$(printf '%-26s %5d s' "$name" $((SECONDS - started)))")
}

# Prints what each part run by timed cost, on the wall.
show_costs() {
  say "what each part cost on $(nproc) cores"
  printf '   %s\n' "${costs[@]}"
}
