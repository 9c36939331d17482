#!/usr/bin/env bash
# Installs what is missing, then configures and builds. run.sh and test.sh call it each time: where
# nothing is missing and nothing changed, it says nothing and takes a moment.
#
# usage: setup.sh run [PRESET]    the program
#        setup.sh test [PRESET]   program, tests and benchmarks, by a preset of CMakePresets.json
#        setup.sh check           only the tools that read the sources (formatter, shell linter)
#
# DRIFTLESS_WERROR=ON makes warnings errors; CXX names another compiler. Its messages go to the
# standard error, so that the program's output can be piped; its logs into the build folder.
set -euo pipefail

cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")"
purpose="${1:-run}"
preset="${2:-release}"
build="build-$preset"
compiler="${CXX:-c++}"
case "$preset" in
  release) build=build ;;
  clang) compiler=clang++ ;;
esac

say() { echo "driftless: $*" >&2; }

fail() {
  say "$@"
  exit 1
}

# logged LOG COMMAND...: the output goes to a log in the build folder, not to the terminal.
logged() {
  local log="$build/$1"
  shift
  "$@" >"$log" 2>&1 </dev/null
}

# ---- What is needed, each with the Debian package that has it. Things are looked for, not packages,
# ---- so that what was installed in another way counts.

has_command() { command -v "$1" >/dev/null; }

has_header() {
  local folder folders
  IFS=':;' read -ra folders <<<"${CPATH:-}:${CPLUS_INCLUDE_PATH:-}"
  for folder in /usr/include /usr/local/include "${folders[@]}"; do
    if [[ -n $folder && (-e $folder/$1 || -e $folder/eigen3/$1) ]]; then return 0; fi
  done
  return 1
}

has_certificates() {
  [[ -e ${SSL_CERT_FILE:-/etc/ssl/certs/ca-certificates.crt} ||
    -e /etc/pki/tls/certs/ca-bundle.crt ]]
}

has_openmp() { "$compiler" -fopenmp -fsyntax-only -x c++ -include omp.h /dev/null 2>/dev/null; }

# Debian's ASE belongs to Debian's Python, which need not be the first in the path.
has_ase() {
  local python
  for python in python3 /usr/bin/python3; do
    if "$python" -c 'import ase' 2>/dev/null; then return 0; fi
  done
  return 1
}

# need PACKAGE TEST...: notes the package if the test fails.
need() {
  local package="$1"
  shift
  if ! "$@"; then missing+=("$package"); fi
}

need_to_run() {
  if [[ $compiler == *clang* ]]; then
    need clang has_command "$compiler"
    # The CMake file of SUNDIALS asks for OpenMP, which g++ brings along and clang does not.
    need libomp-dev has_openmp
  else
    need g++ has_command "$compiler"
  fi
  need cmake has_command cmake
  need ninja-build has_command ninja
  need git has_command git
  need nodejs has_command node
  need npm has_command npm
  need ca-certificates has_certificates
  need libeigen3-dev has_header Eigen/Core
  need libsundials-dev has_header cvode/cvode.h
  need libboost-dev has_header boost/random.hpp
  need librandom123-dev has_header Random123/philox.h
  need libhwy-dev has_header hwy/highway.h
  need libtbb-dev has_header tbb/parallel_for.h
  need nlohmann-json3-dev has_header nlohmann/json.hpp
  need libcli11-dev has_header CLI/CLI.hpp
  need libfmt-dev has_header fmt/core.h
}

need_to_test() {
  need libgtest-dev has_header gtest/gtest.h
  need libvalijson-dev has_header valijson/validator.hpp
  need libbenchmark-dev has_header benchmark/benchmark.h
  need chromium has_command chromium
  need python3-ase has_ase
}

need_to_check() {
  need git has_command git
  need clang-format has_command clang-format-14
  need shellcheck has_command shellcheck
}

find_missing() {
  missing=()
  case "$purpose" in
    run) need_to_run ;;
    test)
      need_to_run
      need_to_test
      ;;
    check) need_to_check ;;
    *) fail "setup.sh knows run, test and check, not '$purpose'." ;;
  esac
}

# ---- Debian packages

# Sets as_root to what runs a command as root; fails where nothing does.
find_root() {
  as_root=()
  if (($(id -u) == 0)); then return 0; fi
  if ! has_command sudo; then return 1; fi
  as_root=(sudo -n)
  # At a terminal sudo may ask for the password; elsewhere nobody could answer.
  if sudo -n true 2>/dev/null; then return 0; fi
  [[ -t 0 ]] && sudo -v
}

run_apt() {
  # A source that cannot be reached need not be one that is needed here: the install decides.
  "${as_root[@]}" apt-get update || true
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install --yes \
    --no-install-recommends -o DPkg::Lock::Timeout=300 "$@"
}

install_packages() {
  find_missing
  if ((${#missing[@]} == 0)); then return 0; fi
  local wanted="${missing[*]}"
  local remedy="apt-get update && apt-get install --no-install-recommends $wanted"
  if ! has_command apt-get; then
    fail "missing, by the names of Debian's packages: $wanted; there is no apt-get here," \
      "so please install them in this system's way."
  fi
  if ! find_root; then
    fail "missing: $wanted; this is not root and sudo cannot be used, so please run as root:" \
      "$remedy"
  fi
  say "installing $wanted (log: $build/install.log)"
  if ! logged install.log run_apt "${missing[@]}"; then
    fail "missing: $wanted; apt-get could not install them (the network may be out of reach," \
      "see $build/install.log), so please run as root: $remedy"
  fi
  hash -r
  find_missing
  if ((${#missing[@]} > 0)); then
    fail "missing even after apt-get installed them: ${missing[*]} (see $build/install.log)."
  fi
}

# ---- npm packages: the chart libraries of the page; for the tests also the browser's driver

npm_ci() {
  local previous="$build/node_modules.previous"
  # npm ci begins by deleting; what works now must survive a failure.
  rm -rf "$previous"
  if [[ -d node_modules ]]; then mv node_modules "$previous"; fi
  if logged npm.log npm ci "$@"; then
    rm -rf "$previous"
    return 0
  fi
  rm -rf node_modules
  if [[ -d $previous ]]; then mv "$previous" node_modules; fi
  return 1
}

install_page_libraries() {
  local stamp=node_modules/.driftless-setup wanted=page extent=none installed='' sum
  local option=--omit=dev
  sum="$(cat package.json package-lock.json | sha256sum)"
  sum="${sum%% *}"
  if [[ -f $stamp ]]; then read -r extent installed <"$stamp" || true; fi
  # The tests' packages, once there, stay: run.sh takes nothing away from test.sh.
  if [[ $purpose == test || $extent == all ]]; then
    wanted=all
    option=--include=dev
  fi
  if [[ "$extent $installed" == "$wanted $sum" ]]; then return 0; fi
  say "installing the npm packages of package-lock.json (log: $build/npm.log)"
  if ! npm_ci "$option"; then
    fail "missing: the npm packages of package-lock.json; npm could not install them (the network" \
      "may be out of reach, see $build/npm.log), so please run: npm ci $option"
  fi
  echo "$wanted $sum" >"$stamp"
}

# ---- Configure and build

# failed WHAT LOG: one sentence, then the end of the log.
failed() {
  say "$1 failed; this is the end of $build/$2:"
  tail -n 40 "$build/$2" >&2
  exit 1
}

configure() {
  local stamp="$build/configured-with" tests=ON configured=''
  if [[ -f $stamp ]]; then configured="$(<"$stamp")"; fi
  # A build that has the tests keeps them: run.sh builds its own target alone.
  if [[ $purpose == run && $configured != *DRIFTLESS_TESTS=ON* ]]; then tests=OFF; fi
  local options=("-DDRIFTLESS_TESTS=$tests")
  if [[ -n ${DRIFTLESS_WERROR:-} ]]; then options+=("-DDRIFTLESS_WERROR=$DRIFTLESS_WERROR"); fi
  local wanted="$PWD ${CXX:-} ${options[*]}"
  if [[ -f $build/build.ninja && $configured == "$wanted" ]]; then return 0; fi
  rm -f "$stamp"
  logged configure.log cmake --fresh --preset "$preset" "${options[@]}" ||
    failed configuring configure.log
  echo "$wanted" >"$stamp"
}

# Says once that something is compiled or linked, and where its log is; passes the log through. What
# ninja looks at in every build (new files, the commit) is not worth a word.
announce() {
  local line announced=''
  while IFS= read -r line; do
    if [[ -z $announced && $line =~ ^\[[0-9]+/[0-9]+\]\ (Building|Linking)\  ]]; then
      say "building (log: $build/build.log)"
      announced=yes
    fi
    printf '%s\n' "$line"
  done
}

build() {
  local target=all
  if [[ $purpose == run ]]; then target=driftless; fi
  cmake --build "$build" --target "$target" 2>&1 </dev/null | announce >"$build/build.log" ||
    failed building build.log
}

if ! mkdir -p "$build" 2>/dev/null || [[ ! -w $build ]]; then
  fail "cannot write into $PWD/$build, where the program is built."
fi
# Two calls at once take turns.
exec 9>"$build/setup.lock"
flock 9

install_packages
if [[ $purpose != check ]]; then
  install_page_libraries
  configure
  build
fi
