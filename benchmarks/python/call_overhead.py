"""What a call from Python costs above the library: a motion of one step, again and again, by graze.Simulation.run and by the
same calls of the C++ library, which are compiled here by the system's compiler.

usage: PYTHONPATH=build/release/python python3 benchmarks/python/call_overhead.py [BUILD]

BUILD is a build folder with libgraze.a, such as build/release; without it, only the times of Python are printed.
"""
import pathlib
import subprocess
import sys
import tempfile
import time

import graze

LIBRARY = r"""
#include "graze/model/catalogue.hpp"
#include "graze/model/model_file.hpp"
#include "graze/results/table_recorder.hpp"
#include "graze/trajectory/recorder.hpp"
#include "graze/trajectory/run_control.hpp"
#include "graze/trajectory/trajectory.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>

int main() {
    using namespace graze;
    const Model model = load_model("impact-oscillator");
    const Simulation simulation{System(model)};
    const std::vector<double> parameters = model.parameter_values(), state = model.initial_state();
    JetSet jets(simulation, LaneKind::single);
    double best = 1;
    for (int repetition = 0; repetition < 20; ++repetition) {
        const auto begun = std::chrono::steady_clock::now();
        for (int i = 0; i < 2000; ++i) {
            TableRequest request;
            request.kind = TableKind::contacts;
            request.events.assign(model.events.size(), true);
            const std::shared_ptr<TableRecorder> contacts = make_table_recorder(simulation, request);
            const auto control = std::make_shared<RunControl>(contacts, std::nullopt, request.events);
            Trajectory trajectory(simulation, parameters, control);
            trajectory.start(state, model.initial_mode, 0, 0.01);
            control->begin({0.01, 0, 0, 0.01}, 0, true);
            contacts->begin(trajectory, 0.01);
            run(trajectory, jets);
            contacts->finish(trajectory);
        }
        best = std::min(best, std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count() / 2000);
    }
    std::printf("%.9g\n", best);
}
"""


def best_of(call, calls=2000, repetitions=20) -> float:
    """The least mean time of a call, in seconds."""
    best = float("inf")
    for _ in range(repetitions):
        begun = time.perf_counter()
        for _ in range(calls):
            call()
        best = min(best, (time.perf_counter() - begun) / calls)
    return best


def time_of_library(build: pathlib.Path) -> float:
    root = build.parents[1]
    with tempfile.TemporaryDirectory() as folder:
        source, program = pathlib.Path(folder, "calls.cpp"), pathlib.Path(folder, "calls")
        source.write_text(LIBRARY)
        libraries = ["-lfmt", "-lsqlite3", "-lnlopt", "-lceres", "-lglog", "-lcholmod", "-lhdf5_serial", "-lpthread"]
        subprocess.run(["g++", "-std=c++20", "-O2", f"-I{root / 'include'}", str(source), str(build / "libgraze.a"), *libraries,
                        "-o", str(program)], check=True)
        return float(subprocess.run([str(program)], check=True, capture_output=True, text=True).stdout)


def main() -> None:
    model = graze.Model.shipped("impact-oscillator")
    simulation = graze.Simulation(model)
    called = best_of(lambda: simulation.run(time=0.01, samples=0))
    print(f"Simulation.run of one step:           {1e6 * called:8.2f} us")
    if len(sys.argv) > 1:
        library = time_of_library(pathlib.Path(sys.argv[1]).resolve())
        print(f"the same by the library:              {1e6 * library:8.2f} us")
        print(f"the call costs:                       {1e6 * (called - library):8.2f} us")
    print(f"with 500 samples:                     {1e6 * best_of(lambda: simulation.run(time=0.01), 200):8.2f} us")
    motion = simulation.run(time=0.01)
    print(f"the samples as arrays:                "
          f"{1e6 * best_of(lambda: graze.Table(*motion._core.table('samples')), 200):8.2f} us")
    print(f"graze.simulate (makes a Simulation):  "
          f"{1e6 * best_of(lambda: graze.simulate(model, time=0.01, samples=0), 200):8.2f} us")
    print(f"model.with_(omega=...):               {1e6 * best_of(lambda: model.with_(omega=2.9), 200):8.2f} us")


if __name__ == "__main__":
    main()
