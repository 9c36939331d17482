#!/usr/bin/env bash
# Tests of run.sh, test.sh and setup.sh. Stand-ins for cmake, npm, apt-get and the like note how they
# were called, so that each case takes milliseconds, and nothing on this machine is changed.
# shellcheck disable=SC2016  # the stand-ins' bodies are expanded when they run
set -euo pipefail

scripts="$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)"
sandbox="$(mktemp -d)"
trap 'rm -rf "$sandbox"' EXIT
passed=0
failed=0

# ---- The stand-ins

stand_in() { # NAME, its body on the standard input
  { echo '#!/usr/bin/env bash' && cat; } >"$sandbox/bin/$1"
  chmod +x "$sandbox/bin/$1"
}

fresh_sandbox() {
  rm -rf "${sandbox:?}"/*
  mkdir -p "$sandbox"/{bin,store,tree}
  cp "$scripts"/{run.sh,test.sh,setup.sh} "$sandbox/tree"
  echo '{}' >"$sandbox/tree/package.json"
  echo '{"version": 1}' >"$sandbox/tree/package-lock.json"
  : >"$sandbox/calls"
  local name
  for name in bash cat chmod cp dirname env flock ln mkdir mktemp mv nproc readlink rm sha256sum tail true; do
    ln -s "$(type -P "$name")" "$sandbox/bin/$name"
  done
  for name in c++ ninja git node chromium python3; do stand_in "$name" <<<'exit 0'; done
  stand_in id <<<'echo "${FAKE_USER:-0}"'
  stand_in cmake <<'BODY'
echo "cmake $*" >>"$SANDBOX/calls"
case "$1" in
  --fresh)
    case "$3" in release) : >build/build.ninja ;; *) : >"build-$3/build.ninja" ;; esac
    ;;
  --build)
    echo "[0/2] Re-checking globbed directories..."
    echo "[1/2] cd build && cmake -P build_info.cmake"
    if [[ -n ${BUILD_STEP:-} ]]; then echo "[2/2] $BUILD_STEP CXX something"; fi
    if [[ -n ${BUILD_FAILS:-} ]]; then echo "[2/2] the compiler's complaint" && exit 1; fi
    cp "$SANDBOX/program" "$2/driftless" ;;
esac
BODY
  stand_in npm <<'BODY'
echo "npm $*" >>"$SANDBOX/calls"
rm -rf node_modules
if [[ -n ${NPM_FAILS:-} ]]; then exit 1; fi
mkdir node_modules
BODY
  stand_in apt-get <<'BODY'
echo "apt-get $*" >>"$SANDBOX/calls"
if [[ -n ${APT_FAILS:-} ]]; then exit 100; fi
if [[ $1 == install ]]; then cp "$SANDBOX"/store/* "$SANDBOX/bin/"; fi
BODY
  stand_in ctest <<<'echo "ctest $*" >>"$SANDBOX/calls"'
  cat >"$sandbox/program" <<'BODY'
#!/usr/bin/env bash
echo "driftless in $PWD:$(printf ' <%s>' "$@")"
exit "${PROGRAM_STATUS:-0}"
BODY
  chmod +x "$sandbox/program"
}

# call [NAME=VALUE...] SCRIPT ARGS...: sets status; leaves what it printed in the sandbox.
call() {
  status=0
  : >"$sandbox/calls"
  env -i PATH="$sandbox/bin" SANDBOX="$sandbox" "$@" \
    >"$sandbox/output" 2>"$sandbox/errors" </dev/null || status=$?
}

missing_cmake() {
  fresh_sandbox
  mv "$sandbox/bin/cmake" "$sandbox/store/cmake"
}

# ---- What is asked of them

complain() {
  echo "    $*"
  sed 's/^/    | /' "$sandbox/calls" "$sandbox/output" "$sandbox/errors"
  return 1
}
exits() { [[ $status == "$1" ]] || complain "exit code $status instead of $1"; }
calls() { grep -qxF -e "$1" "$sandbox/calls" || complain "no call: $1"; }
calls_no() { ! grep -q -e "$1" "$sandbox/calls" || complain "a call of: $1"; }
prints() { grep -qF -e "$1" "$sandbox/output" || complain "not printed: $1"; }
tells() { grep -qF -e "$1" "$sandbox/errors" || complain "not told: $1"; }
tells_lines() {
  [[ $(wc -l <"$sandbox/errors") == "$1" ]] || complain "not $1 lines on the standard error"
}
tree="$sandbox/tree"

# ---- The cases

case_first_call_sets_up_builds_and_runs_the_default_study() {
  call "$tree/run.sh"
  exits 0 && calls 'npm ci --omit=dev' && calls_no apt-get &&
    calls 'cmake --fresh --preset release -DDRIFTLESS_TESTS=OFF' &&
    calls 'cmake --build build --target driftless' &&
    prints "driftless in $tree: <run> <experiments/studies/default.json> <-o> <driftless-results/default>"
}

case_second_call_installs_and_configures_nothing_and_is_silent() {
  call "$tree/run.sh"
  call "$tree/run.sh" --help
  exits 0 && calls_no npm && calls_no apt-get && calls_no --preset && tells_lines 0
}

case_arguments_and_working_folder_are_the_callers() {
  mkdir "$sandbox/else where"
  cd "$sandbox/else where"
  call "$tree/run.sh" run 'my study.json' -o out
  exits 0 && prints "driftless in $sandbox/else where: <run> <my study.json> <-o> <out>"
}

case_called_through_a_link() {
  ln -s "$tree/run.sh" "$sandbox/link"
  call "$sandbox/link" methods
  exits 0 && prints '<methods>'
}

case_exit_code_is_the_programs() {
  call PROGRAM_STATUS=2 "$tree/run.sh" check bad.json
  exits 2
}

case_root_installs_exactly_what_is_missing() {
  missing_cmake
  call "$tree/run.sh"
  exits 0 && calls 'apt-get update' &&
    calls 'apt-get install --yes --no-install-recommends -o DPkg::Lock::Timeout=300 cmake'
}

case_sudo_installs_where_the_user_is_not_root() {
  missing_cmake
  stand_in sudo <<<'shift; echo "sudo $*" >>"$SANDBOX/calls"; exec "$@"'
  call FAKE_USER=1000 "$tree/run.sh"
  exits 0 && calls 'sudo apt-get update' && calls_no 'sudo npm' && calls_no 'sudo cmake'
}

case_neither_root_nor_sudo_is_one_sentence() {
  missing_cmake
  call FAKE_USER=1000 "$tree/run.sh"
  exits 1 && tells_lines 1 && tells 'missing: cmake;' && calls_no . &&
    tells 'apt-get update && apt-get install --no-install-recommends cmake'
}

case_no_apt_is_one_sentence() {
  missing_cmake
  rm "$sandbox/bin/apt-get"
  call "$tree/run.sh"
  exits 1 && tells_lines 1 && tells 'cmake; there is no apt-get here'
}

case_neither_root_nor_apt_is_needed_where_nothing_is_missing() {
  rm "$sandbox/bin/apt-get"
  call FAKE_USER=1000 "$tree/run.sh"
  exits 0
}

case_failing_apt_is_told_with_the_remedy() {
  missing_cmake
  call APT_FAILS=1 "$tree/run.sh"
  exits 1 && tells 'missing: cmake; apt-get could not install' && calls_no npm
}

case_apt_that_installs_something_else_is_noticed() {
  missing_cmake
  mv "$sandbox/store/cmake" "$sandbox/store/something_else"
  call "$tree/run.sh"
  exits 1 && tells 'missing even after'
}

case_tests_after_run_only_add() {
  call "$tree/run.sh"
  call "$tree/test.sh"
  exits 0 && calls 'npm ci --include=dev' &&
    calls 'cmake --fresh --preset release -DDRIFTLESS_TESTS=ON'
}

case_run_after_tests_takes_nothing_away() {
  call "$tree/test.sh"
  call "$tree/run.sh" methods
  exits 0 && calls_no npm && calls_no --preset && tells_lines 0
}

case_changed_lock_installs_again_and_keeps_the_tests_packages() {
  call "$tree/test.sh"
  echo '{"version": 2}' >"$tree/package-lock.json"
  call "$tree/run.sh"
  exits 0 && calls 'npm ci --include=dev'
}

case_failing_npm_leaves_what_worked() {
  call "$tree/run.sh"
  call NPM_FAILS=1 "$tree/test.sh"
  exits 1 && tells 'npm could not install them' && calls_no ctest || return 1
  call "$tree/run.sh"
  exits 0 && calls_no npm
}

case_compiling_or_linking_is_said_once() {
  local step
  for step in Building Linking; do
    call BUILD_STEP="$step" "$tree/run.sh" methods
    exits 0 && tells 'building (log: build/build.log)' || return 1
    call BUILD_STEP="$step" "$tree/run.sh" methods
    exits 0 && tells_lines 1 || return 1
  done
}

case_failing_build_shows_its_end_and_runs_nothing() {
  call "$tree/run.sh"
  call BUILD_FAILS=1 "$tree/run.sh"
  exits 1 && tells 'building failed' && tells "the compiler's complaint" &&
    [[ ! -s $sandbox/output ]]
}

case_ctest_gets_arguments_and_quiet_threads() {
  call "$tree/test.sh" -R some_topic
  exits 0 && calls \
    "ctest --test-dir $tree/build --output-on-failure --no-tests=error -R some_topic"
}

case_other_preset_has_its_own_folder() {
  stand_in clang++ <<<'exit 0'
  call "$tree/setup.sh" test clang
  exits 0 && calls 'cmake --build build-clang --target all' && [[ ! -e $tree/build ]]
}

for name in $(compgen -A function case_); do
  fresh_sandbox
  if ("$name"); then
    passed=$((passed + 1))
  else
    echo "FAILED: ${name#case_}"
    failed=$((failed + 1))
  fi
done
echo "$passed passed, $failed failed"
((failed == 0))
