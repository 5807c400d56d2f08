#!/usr/bin/env bash
# Trajectories of two machines of the literature: an electromagnetic testbed that impacts just below the voltage at which
# it would graze its stop, and a MEMS switch that impacts make snap through. Leaves tables and pictures.
# usage: [GRAZE=program] demo.sh [FOLDER]
set -euo pipefail
graze=${GRAZE:-graze}
folder=${1:-demo}
mkdir -p "$folder"
folder=$(realpath "$folder")
written=()

simulate() { # NAME OPTION...: the contacts as a table and the motion as a picture
    echo "graze simulate ${*:2}"
    "$graze" simulate "${@:2}" --contacts --format csv --plot "$folder/$1.png" >"$folder/$1-contacts.csv"
    written+=("$1.png" "$1-contacts.csv")
}

# At 4.833 V, below the 4.833263 V at which the motion without impacts touches the stop, a motion with impacts coexists
# that repeats after three periods of the voltage: first how it sets in, then what remains.
simulate testbed electromagnetic-testbed --set V0=4.833 --from I=0.1 --periods 20
simulate testbed-settled electromagnetic-testbed --set V0=4.833 --from I=0.1 --skip 300 --periods 6
echo "graze simulate electromagnetic-testbed --set V0=4.833 --from I=0.1 --periods 300 --section phase0 --format csv"
"$graze" simulate electromagnetic-testbed --set V0=4.833 --from I=0.1 --periods 300 --section phase0 --format csv \
    >"$folder/testbed-phase0.csv"
written+=(testbed-phase0.csv)

# A ten-thousandth above its grazing voltage the switch touches its stop four times, ever harder, and snaps through.
simulate switch mems-switch

echo
echo "The pictures and data are:"
for file in "${written[@]}"; do
    [[ -s $folder/$file ]] || { echo "$folder/$file was not written" >&2; exit 1; }
    echo "  $folder/$file"
done
