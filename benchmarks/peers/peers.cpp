// Graze against AUTO-07p and CVODES in one run: `./run peers`, or `./run peers --quick` for a look that takes seconds.
// AUTO runs in the present folder and leaves its files there.

#include "branch_peers.hpp"
#include "derivative_peers.hpp"

#include <cstdio>
#include <exception>
#include <string>

int main(int count, char** arguments) {
    const bool quick = count > 1 && arguments[1] == std::string("--quick");
    if (count > 2 || (count == 2 && !quick)) {
        std::fprintf(stderr, "usage: peers [--quick]\n");
        return 2;
    }
    try {
        std::printf("All times are those of the processor, the least of several where they are short.\n");
        peers::compare_branches(quick);
        peers::compare_derivatives(quick);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "peers: %s\n", error.what());
        return 1;
    }
    return 0;
}
