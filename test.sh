#!/usr/bin/env bash
# Sets up and builds what is missing, then runs the tests.
#
# usage: ./test.sh [CTEST ARGS...]   for example: ./test.sh -R momentum
set -euo pipefail

root="$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")"
"$root/setup.sh" test

# One core a test; threads that wait for work must not take a core from the tests beside them.
export CTEST_PARALLEL_LEVEL="${CTEST_PARALLEL_LEVEL:-$(nproc)}"
export OMP_NUM_THREADS="${OMP_NUM_THREADS:-1}"
export OMP_WAIT_POLICY=passive
exec ctest --test-dir "$root/build" --output-on-failure --no-tests=error "$@"
