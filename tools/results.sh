# Counted results for tools that run many checks. Sourced after common.sh.
passed=0
failed=()
skipped=()

# check NAME COMMAND...: one step, counted as one result; exit code 77 says that it could not be run here
check() {
  local name=$1 status=0
  shift
  say "$name"
  timed "$name" "$@" || status=$?
  case $status in
    0) echo "passed  $name"; passed=$((passed + 1)) ;;
    77) echo "skipped $name"; skipped+=("$name") ;;
    *) echo "FAILED  $name"; failed+=("$name") ;;
  esac
}

# run_tests PRESET [CTEST OPTION...]: tests of a build folder; every test is one line and one result
run_tests() {
  local preset=$1 log=build/$1/test.log names
  shift
  timed "tests $preset" ctest --test-dir "build/$preset" "$@" --parallel "$(nproc)" --timeout 600 --output-on-failure \
    --no-tests=error 2>&1 | tee "$log" || true
  # "  3/120 Test  #3: name ....   Passed    0.01 sec"
  passed=$((passed + $(grep -cE '^ *[0-9]+/[0-9]+ Test +#[0-9]+: .* Passed +[0-9.]+ sec' "$log" || true)))
  while read -r name; do skipped+=("$preset: $name"); done < <(
    sed -n '/^The following tests did not run:/,$p' "$log" | sed -nE 's/^[[:space:]]+[0-9]+ - (.*) \(Skipped\)$/\1/p')
  # any other outcome (failed, crashed, timed out, not run) is listed once more at the end of ctest's output
  mapfile -t names < <(sed -n '/^The following tests FAILED:/,$p' "$log" |
    sed -nE 's/^[[:space:]]+[0-9]+ - (.*)/\1/p')
  for name in "${names[@]}"; do failed+=("$preset: $name"); done
  # a ctest that printed no verdict ended before its tests did
  grep -qE '^[0-9]+% tests passed' "$log" || failed+=("$preset: ctest did not finish")
}

# build_and_test PRESET [-DNAME=VALUE ...]: without a build there is nothing to test
build_and_test() {
  if build_preset "$@"; then
    echo "passed  build $1, warnings as errors"; passed=$((passed + 1))
    run_tests "$1"
  else
    echo "FAILED  build $1"; failed+=("build $1")
  fi
}

# print_results: skipped and failed steps, their times, and the line with the counts; false if any failed
print_results() {
  local name
  echo
  for name in "${skipped[@]}"; do echo "skipped $name"; done
  for name in "${failed[@]}"; do echo "FAILED  $name"; done
  print_times
  echo "$passed passed, ${#failed[@]} failed${skipped[*]:+, ${#skipped[@]} skipped}"
  [[ ${#failed[@]} -eq 0 ]]
}
