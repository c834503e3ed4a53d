# Shared by the scripts in tools/: where the project is, a few lines of output, and times. Sourced, not run.
set -euo pipefail
project=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
cd "$project"
# the same texts and sort order on every machine
export LC_ALL=C

say() { printf '== %s\n' "$*" >&2; }
fail() { printf '%s: %s\n' "${0##*/}" "$*" >&2; exit 2; }

# every tool prints its first comment for --help
case ${1-} in
  -h | --help)
    sed -nE '2,/^[^#]/s/^# ?//p' "$0"
    exit 0
    ;;
esac

times=$project/build/times.tsv
times_before=$(wc -l 2>/dev/null <"$times" || echo 0)
# number of steps running around this tool; a tool that a step calls inherits it
export KADR_STEP_DEPTH=${KADR_STEP_DEPTH:-0}
own_depth=$KADR_STEP_DEPTH

# timed NAME COMMAND...: runs a step and adds name, seconds and depth to build/times.tsv, whatever its outcome
timed() {
  local name=$1 begin=${EPOCHREALTIME/./} depth=$KADR_STEP_DEPTH status=0
  shift
  KADR_STEP_DEPTH=$((depth + 1))
  "$@" || status=$?
  KADR_STEP_DEPTH=$depth
  mkdir -p "$project/build"
  printf '%s\t%d\t%d\n' "$name" $(((${EPOCHREALTIME/./} - begin + 500000) / 1000000)) "$depth" >>"$times"
  return $status
}

# print_times: the steps of this tool and, indented above each, the steps within it; the sum counts each second once
print_times() {
  [[ -f $times ]] || return 0
  tail -n "+$((times_before + 1))" "$times" | awk -F '\t' -v cores="$(nproc)" -v own="$own_depth" '
    { printf "%6d s  %*s%s\n", $2, 2 * ($3 - own), "", $1; if ($3 == own) sum += $2 }
    END { printf "%6d s  in all, on %d cores\n", sum, cores }'
}

# build_preset PRESET [-DNAME=VALUE ...] [NINJA ARGUMENTS]: configures where needed and builds build/PRESET; quiet
# unless it fails. Values of earlier calls stay as they are.
build_preset() {
  local preset=$1 options=() option stale=no
  shift
  # also while a page is left out: its packages may be there by now
  [[ -f build/$preset/build.ninja && ! -f build/$preset/pages/missing ]] || stale=yes
  while [[ ${1-} == -D* ]]; do
    option=${1#-D}
    grep -qE "^${option%%=*}:[A-Z]+=${option#*=}\$" "build/$preset/CMakeCache.txt" 2>/dev/null || stale=yes
    options+=("$1")
    shift
  done
  mkdir -p "build/$preset"
  if [[ $stale == yes ]]; then
    timed "configure $preset" configure_preset "$preset" "${options[@]}" || return 1
  fi
  say "build $preset${*:+: $*}"
  timed "build $preset${*:+: $*}" ninja -C "build/$preset" --quiet "$@" >&2
}

# configure_preset PRESET [CMAKE ARGUMENTS]: shows only what CMake reports about missing or omitted parts
configure_preset() {
  local preset=$1 log=build/$1/configure.log
  shift
  say "configure $preset"
  cmake --preset "$preset" "$@" >"$log" 2>&1 || { cat "$log" >&2; return 1; }
  sed -nE 's/^-- (kadr: )/\1/p' "$log" >&2
}
