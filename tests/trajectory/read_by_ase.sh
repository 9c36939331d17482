#!/usr/bin/env bash
# usage: read_by_ase.sh WRITE_TRAJECTORY FOLDER
set -euo pipefail

here="$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")"
"$1" "$2"
# Debian's ASE belongs to Debian's Python, which need not be the first in the path.
for python in python3 /usr/bin/python3; do
  if "$python" -c 'import ase' 2>/dev/null; then
    exec "$python" "$here/read_by_ase.py" "$2"
  fi
done
echo "no python3 here has ASE; Debian's package is python3-ase" >&2
exit 1
