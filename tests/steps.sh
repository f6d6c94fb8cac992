# Functions of tests/run and .ci/run, which source this file in the root of the clone. They count checks and print the
# results.

export PYTHONDONTWRITEBYTECODE=1
export CCACHE_MAXSIZE=${CCACHE_MAXSIZE:-5G}
# Other clones can use this clone's compiler cache.
export CCACHE_BASEDIR=$PWD CCACHE_NOHASHDIR=1
results=$PWD/build/tests
begin_until= # no sanitizer step begins after this time, in seconds since 1970; empty: no limit
end_at=      # a sanitizer step is ended at this time
passed=0
failed=0
failures=()
not_run=()

say() { printf '[%4ds] %s\n' "$SECONDS" "$*"; }

# count_failure NAME: counts one failure and remembers its name for the summary.
count_failure() {
  failed=$((failed + 1))
  failures+=("$1")
}

# check NAME COMMAND...: runs a command as one check and shows its output only if it fails.
check() {
  local name=$1 log=$results/$1.log
  shift
  say "$name"
  if "$@" >"$log" 2>&1 </dev/null; then
    passed=$((passed + 1))
  else
    count_failure "$name (full log: $log)"
    tail -n 60 "$log"
    return 1
  fi
}

# tally PRESET STATUS: adds the results of a complete ctest run with this exit status to the totals.
tally() {
  local preset=$1 status=$2 junit=$results/$1.xml
  local total bad skipped name
  total=$(count "$junit" tests)
  bad=$(count "$junit" failures)
  skipped=$(($(count "$junit" skipped) + $(count "$junit" disabled)))
  passed=$((passed + total - bad - skipped))
  failed=$((failed + bad))
  while IFS= read -r name; do
    failures+=("$preset: $name (log: build/$preset/Testing/Temporary/LastTest.log)")
  done < <(sed -n 's/.*<testcase name="\([^"]*\)".* status="fail".*/\1/p' "$junit" 2>/dev/null)
  ((status == 0 || bad != 0)) || count_failure "ctest --preset $preset ended with status $status"
  say "$preset: $total tests, $bad failed, $skipped skipped"
}

# count FILE ATTRIBUTE: prints an attribute of the JUnit file's <testsuite>; 0 without a file.
count() {
  local value
  value=$(sed -n "/<testsuite/,/>/s/.*[[:space:]]$2=\"\([0-9]*\)\".*/\1/p" "$1" 2>/dev/null | head -n1)
  echo "${value:-0}"
}

# tally_ended NAME LOG: counts the failures in the log of a ctest run that was ended, but not its passed tests. The last
# try of a repeated test counts.
tally_ended() {
  local name=$1 log=$2 test
  while IFS= read -r test; do
    count_failure "$name: $test (log: $log)"
  done < <(awk 'match($0, /^ *([0-9]+\/[0-9]+ )?Test +#[0-9]+: /) {
                  line = substr($0, RLENGTH + 1)
                  if (!match(line, / *\.+( +Passed|\*\*\*)/)) next
                  name = substr(line, 1, RSTART - 1)
                  state[name] = substr(line, RSTART) ~ /\*\*\*(Failed|Timeout|Exception|Not Run$)/ ? "bad" : ""
                }
                END { for (name in state) if (state[name]) print name }' "$log" 2>/dev/null)
}

# skip NAME: records a step that the budget left out or ended.
skip() {
  not_run+=("$1")
  say "not run: $1 (budget)"
}

# summarize: prints what failed and what was not run, and the sum as the last line.
summarize() {
  ((${#failures[@]} == 0)) || printf 'FAILED: %s\n' "${failures[@]}"
  ((${#not_run[@]} == 0)) || printf 'not run: %s (budget)\n' "${not_run[@]}"
  echo "$passed passed, $failed failed"
}

# record_last SECONDS: writes the result of a whole run for this commit to build/tests/last.
record_last() {
  local state=clean
  git diff --quiet HEAD && [[ -z $(git ls-files --others --exclude-standard) ]] || state=dirty
  echo "$(git rev-parse HEAD) $state $passed passed, $failed failed $1" >"$results/last"
}

# Prints the sanitizer steps in the order of this commit, so that each of them is first from time to time.
sanitizer_order() {
  local orders=("asan tsan fuzz" "asan fuzz tsan" "tsan asan fuzz" "tsan fuzz asan" "fuzz asan tsan" "fuzz tsan asan")
  echo "${orders[$((16#$(git rev-parse HEAD | cut -c1-6) % 6))]}"
}

# ctest_of PRESET [CTEST ARGUMENT...]: runs ctest, with five tests at once on two cores, because three of them are timing
# tests, which mostly wait.
ctest_of() {
  local preset=$1
  shift
  rm -f "$results/$preset.xml"
  ctest --preset "$preset" -j 5 --no-tests=error --output-junit "$results/$preset.xml" "$@" </dev/null
}

# within_budget COMMAND...: runs a command and ends it at --end-at; its status is then 124 or 137.
within_budget() {
  local left=$((${end_at:-9999999999} - $(date +%s)))
  ((left > 0)) || return 124
  timeout --kill-after=20 "$left" "$@"
}

was_ended() { (($1 == 124 || $1 == 137)) && [[ -n $end_at ]] && (($(date +%s) >= end_at)); }

# build_sanitizer PRESET: like build(), but within the budget; fails if there is nothing to test.
build_sanitizer() {
  local preset=$1 status=0
  check "configure-$preset" cmake --preset "$preset" || return 1
  say "build-$preset"
  within_budget cmake --build --preset "$preset" >"$results/build-$preset.log" 2>&1 </dev/null || status=$?
  if ((status == 0)); then
    passed=$((passed + 1))
    return 0
  fi
  if was_ended "$status"; then
    skip "$preset"
  else
    tail -n 60 "$results/build-$preset.log"
    count_failure "build-$preset (full log: $results/build-$preset.log)"
  fi
  return 1
}

# test_sanitizer PRESET [CTEST ARGUMENT...]: runs the tests of a sanitizer build within the budget.
test_sanitizer() {
  local preset=$1 status=0 log=$results/tests-$1.log
  say "tests of the $preset build"
  export -f ctest_of
  export results
  within_budget bash -c 'ctest_of "$@"' bash "$@" 2>&1 | tee "$log" || status=${PIPESTATUS[0]}
  if was_ended "$status"; then
    tally_ended "$preset" "$log"
    skip "$preset"
  else
    tally "$preset" "$status"
  fi
}
