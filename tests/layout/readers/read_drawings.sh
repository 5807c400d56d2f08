#!/usr/bin/env bash
# Drawings are read by two programs of others, which measure what graze says of them: KLayout repeats the design's rules on the
# merged polygons, gdspy areas and boxes. usage: read_drawings.sh GRAZE FOLDER
# Exits with 77 (skipped) where one of them is missing, but not in CI.
set -euo pipefail
graze=$1
folder=$2
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
python=/usr/bin/python3 # Debian's, for which its modules are

missing() {
    echo "not tested: $1 is missing (Debian: apt-get install klayout python3-gdspy)" >&2
    [[ ${CI-} != true ]] || exit 1
    exit 77
}
command -v klayout >/dev/null || missing klayout
"$python" -c 'import gdspy' 2>/dev/null || missing gdspy

rm -rf "$folder"
mkdir -p "$folder"
cd "$folder"
"$python" "$here/draw.py" "$graze"
QT_QPA_PLATFORM=offscreen klayout -b -zz -r "$here/read_by_klayout.py" || exit 1
[[ -f klayout.json ]] || exit 1 # what an exception within KLayout leaves out
"$python" "$here/read_by_gdspy.py"
