#!/usr/bin/env bash
# Runs the tests of a folder in one process: whole_folder.sh BUILD FOLDER LEFT_OUT
# Under the sanitizers a process takes longer to start than most tests take, and tests that share results compute them once.
# LEFT_OUT is a regular expression of names such as page.PointJson.OfASweep.
set -euo pipefail
program=$1/test_$2
chosen=$("$program" --gtest_list_tests | awk -v folder="$2" '
    /^[^ ]/ { sub(/ *#.*/, ""); suite = $1; next }
    /^  / { sub(/ *#.*/, ""); print folder "." suite $1 }' | grep -vE "Slow\.|$3" | sed "s/^$2\.//" | paste -sd ':')
[[ $chosen ]] || {
    echo "whole_folder.sh: no test of $2 is left" >&2
    exit 1
}
said=$(mktemp)
trap 'rm -f "$said"' EXIT
begin=$SECONDS status=0
cd "$1"
timeout 1200 "./test_$2" --gtest_brief=1 --gtest_filter="$chosen" >"$said" 2>&1 || status=$?
[[ $status == 0 ]] || {
    cat "$said"
    echo "tests of $2: FAILED with status $status" >&2
    exit 1
}
echo "tests of $2: $(grep -E '^\[  PASSED  \]' "$said" | tail -n 1 | sed 's/.*\] //; s/\.$//') in $((SECONDS - begin)) s"
