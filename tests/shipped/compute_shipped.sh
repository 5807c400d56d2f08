#!/usr/bin/env bash
# Computes a shipped study, whose results several tests look at: compute_shipped.sh GRAZE FOLDER STUDY [RUN]...
# The results go to FOLDER/STUDY. Runs that are named are left out. Nothing is done where this very program, of which the
# study is a part, has been here before.
set -euo pipefail
graze=$1 study=$3 folder=$2/$3
made_by="$(sha256sum <"$graze") without ${*:4}"
[[ ! -f $folder/made_by || $(<"$folder/made_by") != "$made_by" ]] || exit 0
rm -rf "$folder"
runs=()
for run in $("$graze" run "$study" --show | sed -n 's/^\[runs\.\([a-z0-9_]*\)\]$/\1/p'); do
    [[ " ${*:4} " == *" $run "* ]] || runs+=(--only "$run")
done
"$graze" run "$study" "${runs[@]}" --output "$folder" --no-pictures --quiet --jobs 1
echo "$made_by" >"$folder/made_by"
