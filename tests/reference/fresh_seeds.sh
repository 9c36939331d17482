#!/usr/bin/env bash
# How often an unchanged method passes the gate: fresh_seeds.sh PROGRAM FOLDER [COUNT [THREADS]]
# runs the reference study COUNT times (default 200) with seeds from 1001 on, each for one method in
# turn, gates every result against the committed one, and prints how many pass. FOLDER gets the
# results and comparisons; what is there is not run again.
set -euo pipefail

program="$1" folder="$2" count="${3:-200}" threads="${4:-1}"
reference="$(dirname "${BASH_SOURCE[0]}")"
mapfile -t methods < <("$program" methods | grep -E '^[a-z]')
mkdir -p "$folder"

passed=0
for ((n = 1; n <= count; ++n)); do
  method="${methods[n % ${#methods[@]}]}"
  study="$folder/$method.json"
  sed "s/\"methods\": \"all\"/\"methods\": [\"$method\"]/" "$reference/study.json" >"$study"
  "$program" run -q -t "$threads" --seed $((1000 + n)) -o "$folder/$n" "$study" >/dev/null 2>&1
  if "$program" compare --gate --only "$method" --json "$folder/$n/comparison.json" \
    "$reference/result.json" "$folder/$n" >"$folder/$n/comparison.txt"; then
    passed=$((passed + 1))
  else
    echo "seed $((1000 + n)), $method: $(tail -n 1 "$folder/$n/comparison.txt")"
  fi
done
echo "$passed of $count pass"
