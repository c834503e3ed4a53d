# Shared by the scripts in tools/: where the project is, and a few lines of output. Sourced, not run.
set -euo pipefail
project=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
cd "$project"
# the same texts and sort order on every machine
export LC_ALL=C

say() { printf '== %s\n' "$*" >&2; }
fail() { printf '%s: %s\n' "${0##*/}" "$*" >&2; exit 2; }

# build_preset PRESET [NINJA ARGUMENTS]: configures where needed and builds build/PRESET; quiet unless it fails
build_preset() {
  local preset=$1; shift
  if [[ ! -f build/$preset/build.ninja ]]; then
    say "configure $preset"
    mkdir -p "build/$preset"
    cmake --preset "$preset" >"build/$preset/configure.log" 2>&1 || { cat "build/$preset/configure.log" >&2; return 1; }
  fi
  say "build $preset"
  ninja -C "build/$preset" --quiet "$@" >&2
}
