#pragma once

#include <malloc.h>

#include <fstream>
#include <string>

/// Megabytes by which a run makes this process grow at most, beyond what it had before; 0 where Linux does not tell.
template <class Run>
double peak_megabytes(Run&& run) {
    const auto status = [](const std::string& key) {
        std::ifstream file("/proc/self/status");
        for (std::string line; std::getline(file, line);)
            if (line.starts_with(key + ":"))
                return std::stod(line.substr(key.size() + 1)) / 1024;
        return 0.0;
    };
    malloc_trim(0);                              // what is free but kept would not be seen to be used again
    std::ofstream("/proc/self/clear_refs") << 5; // forgets the peak so far
    const double before = status("VmRSS");
    run();
    return status("VmHWM") - before;
}
