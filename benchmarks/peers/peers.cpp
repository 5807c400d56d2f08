// Graze against AUTO-07p and CVODES in one run: `./run peers`, or `./run peers --quick` for a version that takes
// seconds; `branches` or `derivatives` for one half. AUTO runs in the current folder and leaves its files there.

#include "branch_peers.hpp"
#include "derivative_peers.hpp"

#include <cstdio>
#include <exception>
#include <string>

int main(int count, char** arguments) {
    bool quick = false, branches = false, derivatives = false;
    for (int i = 1; i < count; ++i) {
        const std::string argument = arguments[i];
        quick = quick || argument == "--quick";
        branches = branches || argument == "branches";
        derivatives = derivatives || argument == "derivatives";
        if (argument != "--quick" && argument != "branches" && argument != "derivatives") {
            std::fprintf(stderr, "usage: peers [--quick] [branches] [derivatives]\n");
            return 2;
        }
    }
    try {
        std::printf("All times are those of the processor, the least of several where they are short.\n");
        if (branches || !derivatives)
            peers::compare_branches(quick);
        if (derivatives || !branches)
            peers::compare_derivatives(quick);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "peers: %s\n", error.what());
        return 1;
    }
    return 0;
}
