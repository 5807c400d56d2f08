#!/usr/bin/env bash
# Bifurcation diagrams, phase portraits and spectra of an electromagnetic testbed whose voltage is swept up and down at two
# frequencies; then the branches of orbits that bound these motions. When run again, it does only what is missing.
# usage: [GRAZE=program] demo.sh [FOLDER]
set -euo pipefail
graze=${GRAZE:-graze}
folder=${1:-demo}
runs=sweep_6_25Hz,sweep_8Hz,no_impact_6_25Hz,asymmetric,impacting_8Hz,touches,folds,folds_3,symmetry_3
echo "graze run electromagnetic-testbed --output $folder --only $runs"
"$graze" run electromagnetic-testbed --output "$folder" --only "$runs" --progress

echo
echo "Where the motion changes at 6.25 Hz, on the way up and down (for at least 20 mV):"
"$graze" export "$folder" --digits 6 --sql "
SELECT direction, min(V0) AS \"from\", max(V0) AS \"to\", label, period, symmetric, signature FROM (
  SELECT *, sum(new) OVER (ORDER BY number) AS stretch FROM (
    SELECT *, (label IS NOT lag(label) OVER w OR period IS NOT lag(period) OVER w OR symmetric IS NOT lag(symmetric) OVER w)
              AS new FROM points_sweep_6_25Hz WINDOW w AS (ORDER BY number)))
GROUP BY stretch HAVING count(*) >= 20 ORDER BY stretch"
echo
echo "Where motions without impacts graze the stop, and what bounds those with impacts:"
"$graze" points "$folder" --type GR,SN,BP,PD --digits 12
for picture in branches-6-25Hz branches-8Hz fig-5-10 fig-5-12 fig-5-14 fig-5-15 map map-period-3; do
    [[ -s $folder/$picture.png ]] || { echo "$folder/$picture.png was not drawn" >&2; exit 1; }
done
echo
echo "A third sweep, at 7 Hz, has far more chaos and takes minutes: graze run $folder"
