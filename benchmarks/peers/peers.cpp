// Graze against AUTO-07p, CVODES and heyoka in one run: `./run peers`, or `./run peers --quick` for a version that
// takes seconds; `branches`, `derivatives` or `trajectories` for a part. AUTO runs in the current folder and leaves its
// files there.

#include "branch_peers.hpp"
#include "derivative_peers.hpp"
#ifdef GRAZE_HEYOKA
#include "trajectory_peers.hpp"
#endif

#include <cstdio>
#include <exception>
#include <string>

namespace {

/// @return whether heyoka is there
bool compare_with_heyoka([[maybe_unused]] bool quick) {
#ifdef GRAZE_HEYOKA
    peers::compare_trajectories(quick);
    return true;
#else
    std::printf("\nTrajectories are not compared: heyoka was not found. It is a library in C++ "
                "(https://github.com/bluescarni/heyoka); if it is installed in PREFIX, tell CMake with\n"
                "    CMAKE_PREFIX_PATH=PREFIX ./run peers trajectories\n");
    return false;
#endif
}

} // namespace

int main(int count, char** arguments) {
    bool quick = false, branches = false, derivatives = false, trajectories = false;
    for (int i = 1; i < count; ++i) {
        const std::string argument = arguments[i];
        quick = quick || argument == "--quick";
        branches = branches || argument == "branches";
        derivatives = derivatives || argument == "derivatives";
        trajectories = trajectories || argument == "trajectories";
        if (argument != "--quick" && argument != "branches" && argument != "derivatives" &&
            argument != "trajectories") {
            std::fprintf(stderr, "usage: peers [--quick] [branches] [derivatives] [trajectories]\n");
            return 2;
        }
    }
    const bool all = !branches && !derivatives && !trajectories;
    try {
        std::printf("All times are those of the processor, the least of several where they are short.\n");
        if (branches || all)
            peers::compare_branches(quick);
        if (derivatives || all)
            peers::compare_derivatives(quick);
        if ((trajectories || all) && !compare_with_heyoka(quick) && trajectories)
            return 1;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "peers: %s\n", error.what());
        return 1;
    }
    return 0;
}
