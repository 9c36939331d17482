#!/usr/bin/env bash
# Sets up and builds what is missing, then runs the tests.
#
# usage: ./test.sh [CTEST ARGS...]   for example: ./test.sh -R momentum
set -euo pipefail

root="$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")"
"$root/setup.sh" test

export CTEST_PARALLEL_LEVEL="${CTEST_PARALLEL_LEVEL:-$(nproc)}"
exec ctest --test-dir "$root/build" --output-on-failure --no-tests=error "$@"
