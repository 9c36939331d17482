#!/usr/bin/env bash
# Sets up and builds what is missing, then runs the program.
#
# usage: ./run.sh           the default study; result and page go to driftless-results/default
#        ./run.sh ARGS...   driftless ARGS..., for example: ./run.sh run my.json -o my-results
set -euo pipefail

root="$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")"
"$root/setup.sh" run

if (($# > 0)); then
  exec "$root/build/driftless" "$@"
fi
if [[ ! $PWD -ef $root ]]; then echo "driftless: working in $root" >&2; fi
# From the root, so that the command that the result records can be repeated elsewhere.
cd "$root"
exec build/driftless run experiments/studies/default.json -o driftless-results/default
