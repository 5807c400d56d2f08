#!/usr/bin/env bash
# Fails when a folder includes a header of a later one: data flows in one direction only.
# usage: check_layers.sh REPOSITORY FOLDER... (in the order in which data flows)
set -euo pipefail
cd "$1"
shift
folders=("$@")
wrong=0
for ((i = 0; i < ${#folders[@]}; ++i)); do
    for later in "${folders[@]:i+1}"; do
        for place in "include/graze/${folders[i]}" "src/${folders[i]}"; do
            if [[ -d $place ]] && grep -rnE "^ *# *include *[\"<](graze/)?$later/" "$place"; then
                echo "${folders[i]} must not know of $later: includes go from later folders to earlier ones." >&2
                wrong=1
            fi
        done
    done
done
exit $wrong
