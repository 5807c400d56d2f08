#!/usr/bin/env bash
# The main job on two machines of the literature: an electromagnetic testbed that grazes its stop, and a MEMS switch
# that a grazing makes snap. Leaves tables and pictures. usage: [GRAZE=program] demo.sh [FOLDER]
set -euo pipefail
graze=${GRAZE:-graze}
folder=${1:-demo}
mkdir -p "$folder"

show() { # what is run, then runs it
    echo "graze $*" >&2
    "$graze" "$@"
}

# Just below its grazing voltage of 4.833263 V the testbed still has an impacting motion of three forcing periods.
testbed=(simulate electromagnetic-testbed --set V0=4.833 --from I=0.1 --periods 20)
show "${testbed[@]}" --section phase0 --format csv >"$folder/testbed-sections.csv"
show "${testbed[@]}" --plot "$folder/testbed.png" --format csv >"$folder/testbed-events.csv"

# A ten-thousandth above its grazing voltage the switch touches its stop ever harder, four times, and snaps through.
switch=(simulate mems-switch)
show "${switch[@]}" --plot "$folder/switch.png" --format csv >"$folder/switch-events.csv"

echo "The demonstration's pictures and data:"
for file in testbed.png testbed-sections.csv testbed-events.csv switch.png switch-events.csv; do
    [[ -s $folder/$file ]] || { echo "$folder/$file was not written" >&2; exit 1; }
    echo "  $(realpath "$folder")/$file"
done
