#!/usr/bin/env bash
# A study computed by processes of MPI has the same results as without, also when it is killed and gone on with.
# usage: mpi.sh GRAZE WORK_FOLDER
set -euo pipefail
graze=$(realpath "$1")
rm -rf "$2"
mkdir -p "$2"
cd "$2"
export OMPI_MCA_btl_vader_single_copy_mechanism=none OMPI_MCA_rmaps_base_oversubscribe=1 OMPI_ALLOW_RUN_AS_ROOT=1 \
    OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_btl=self,vader
TMPDIR=$(mktemp -d) # what killed processes leave behind is removed with it
export TMPDIR
trap 'rm -rf "$TMPDIR"' EXIT

fail() {
    echo "mpi.sh: $*" >&2
    cat ./*.log >&2
    exit 1
}

cat >study.toml <<'TOML'
name = "s"
model = "impact-oscillator"
values = ["v"]
[runs.sweep]
kind = "sweep"
vary = { omega = { from = 2.7, to = 2.9, points = 20 }, sigma = { from = 1.2, to = 1.3, points = 20 } }
direction = "both"
[runs.basin]
kind = "basin"
vary = { x = { from = -1, to = 0, points = 12 }, v = { from = -1, to = 1, points = 12 } }
set = { omega = 2.8 }
cycles = 60
[runs.orbit]
kind = "orbit"
set = { omega = 4 }
from = { x = -0.07 }
[runs.branch]
kind = "continue"
start = { run = "orbit" }
along = { omega = [3.9, 4.1] }
[runs.far]
kind = "continue"
start = { run = "orbit" }
along = { omega = [3, 40] }
steps = 100000
step = { largest = 1e-6 }
[runs.long]
kind = "sweep"
vary = { omega = { from = 2.7, to = 2.9, points = 160 }, sigma = { from = 1.2, to = 1.3, points = 80 } }
direction = "both"
TOML
runs=(sweep basin orbit branch)
short=${runs[*]}
short=${short// /,}

same() { # FOLDER RUN...: has the results of the runs without MPI
    local run
    for run in "${@:2}"; do
        "$graze" export "$1" --run "$run" --format csv --output "$1/$run.csv"
        cmp "alone/$run.csv" "$1/$run.csv" || fail "$1: $run has other results"
    done
}
points() { # FOLDER: how many the long run has so far
    "$graze" export "$1" --sql "SELECT count(*) AS points FROM points_long" --format csv 2>/dev/null | tail -n 1 || true
}
begin() { # FOLDER PROCESSES: in the background, until it has some points; leaves the process of mpirun in `started`
    mpirun -n "$2" "$graze" run study.toml --only "${3:-long}" --output "$1" --no-pictures >"$1.log" 2>&1 &
    started=$!
    local before look
    before=$(points "$1")
    for look in {1..200}; do
        [[ $(points "$1") =~ ^[0-9]+$ && $(points "$1") -gt ${before:-0} ]] && return
        kill -0 $started 2>/dev/null || fail "$1: it ended before it was killed"
        sleep 0.05
    done
    fail "$1: no points come ($look looks)"
}
processes_of() { read -r -a children < <(cat "/proc/$1/task/$1/children"; echo); } # leaves them in `children`
ended() { # PROCESS FOLDER: its exit code is left in `code`; waits until the results are free
    code=0
    wait "$1" || code=$?
    local look
    for look in {1..200}; do
        flock --nonblock "$2/results.sqlite.lock" true && return
        sleep 0.05
    done
    fail "$2: a process still writes ($look looks)"
}

# Without Open MPI, and where the processes do not find each other, none writes.
mkdir empty
echo "no library" >empty/libmpi.so.40
for way in "LD_LIBRARY_PATH=$PWD/empty OMPI_COMM_WORLD_SIZE=2 OMPI_COMM_WORLD_RANK=0" \
    "SLURM_STEP_NUM_TASKS=2 SLURM_PROCID=0 SLURM_STEP_ID=0"; do
    code=0
    read -r -a variables <<<"$way"
    env "${variables[@]}" "$graze" run study.toml --output refused --no-pictures >refused.log 2>&1 || code=$?
    [[ $code == 2 && ! -e refused ]] && grep -q -e "--part" refused.log || fail "$way: code $code"
done
command -v mpirun >/dev/null || exit 77

"$graze" run study.toml --only "$short,long" --output alone --no-pictures --quiet
for run in "${runs[@]}" long; do
    "$graze" export alone --run "$run" --format csv --output "alone/$run.csv"
done
for count in 1 2 3 5; do
    mpirun -n $count "$graze" run study.toml --only "$short" --output "by$count" --no-pictures >"by$count.log" 2>&1 ||
        fail "$count processes: code $?"
    [[ $(grep -c done "by$count.log") == "${#runs[@]}" ]] || fail "$count processes: not one table"
    same "by$count" "${runs[@]}"
done
mpirun -n 2 "$graze" run study.toml --only "$short" --output threads --no-pictures --quiet --jobs 3 >threads.log 2>&1 || fail "threads"
same threads "${runs[@]}"

# Yields have the same devices, whoever solves for them.
"$graze" run mems-switch --only free,no_impact --output switch --no-pictures --quiet
"$graze" design mems-switch --show | sed 's/^within.*/&\ndevices = 500\n\n[points]\ncurve = 5\nplane = 4/' >switch.toml
yields() { # FOLDER COMMAND...
    mkdir "$1"
    "${@:2}" "$graze" tolerance switch no_impact:GR1 --vary delta=1%,omega=0.002 --within 0.19: --devices 3000 \
        --format json --output "$1/tolerance.json" 2>>yields.log || fail "$1: tolerance: code $?"
    "${@:2}" "$graze" design switch.toml --output "$1/design" --no-pictures --quiet 2>>yields.log || fail "$1: design: code $?"
    "${@:2}" "$graze" layout mems-switch-device --yield 2 --folder "$1/wafers" >"$1/wafers.txt" 2>>yields.log ||
        fail "$1: layout: code $?"
    sed -i "s/$1//" "$1/wafers.txt"
    rm "$1"/*/results.sqlite* # which have times
}
yields yields
for count in 1 3; do
    yields "yields$count" mpirun -n $count
    diff -r yields "yields$count" >yields.log || fail "$count processes: another yield"
done
mpirun -n 3 "$graze" tolerance switch no_impact:GR1 --vary delta=1% --devices 100000000 >stopped.txt 2>stopped.log &
started=$!
sleep 2 # it takes hours
processes_of "$started"
kill -TERM "${children[0]}"
code=0
wait "$started" || code=$?
[[ $code == 143 && $(grep -c "devices were made" stopped.log) == 1 ]] || fail "SIGTERM to a yield: code $code"
# mpirun is killed, then a process that computes, then process 0; each time another number of processes goes on.
begin killed 3
kill -KILL "$started"
ended "$started" killed
for killed in 1 0; do
    begin killed $((4 - killed))
    processes_of "$started"
    kill -KILL "${children[killed]}"
    ended "$started" killed
    [[ $code != 0 ]] || fail "process $killed was killed: code $code"
done
before=$(points killed)
mpirun -n 2 "$graze" run study.toml --only long --output killed --no-pictures >killed.log 2>&1 || fail "killed: code $?"
grep -q "gone on with" killed.log || fail "after $before points it began again"
same killed long

# A signal that process 0 gets ends all in order.
rm -rf "$TMPDIR"/graze-* # of processes that were killed
begin ended 3 long,far
processes_of "$started"
kill -TERM "${children[0]}"
ended "$started" ended
[[ $code == 143 ]] && grep -q "what was computed is kept" ended.log || fail "SIGTERM: code $code"
compgen -G "$TMPDIR/graze-*" >/dev/null && fail "SIGTERM left $(echo "$TMPDIR"/graze-*)"
# mpirun passes on what it gets, and has a code of its own.
begin ended 2
kill -INT "$started"
ended "$started" ended
[[ $code != 0 ]] || fail "SIGINT to mpirun: code $code"
"$graze" run study.toml --only long --output ended --no-pictures >ended.log 2>&1
grep -q "gone on with" ended.log || fail "after SIGTERM it began again"
same ended long

# What is wrong is said once.
code=0
mpirun -n 3 "$graze" run nowhere.toml >wrong.log 2>&1 || code=$?
[[ $code == 2 && $(grep -c "^graze: " wrong.log) == 1 ]] || fail "a study that is not there: code $code"
