#pragma once

#include <malloc.h>

#include <fstream>
#include <string>

/// Returns the peak growth of the process during a run, in megabytes; 0 where Linux does not report it.
template <class Run>
double peak_megabytes(Run&& run) {
    const auto status = [](const std::string& key) {
        std::ifstream file("/proc/self/status");
        for (std::string line; std::getline(file, line);)
            if (line.starts_with(key + ":"))
                return std::stod(line.substr(key.size() + 1)) / 1024;
        return 0.0;
    };
    malloc_trim(0);                              // return free memory to the system, since its reuse would not be seen
    std::ofstream("/proc/self/clear_refs") << 5; // resets the peak
    const double before = status("VmRSS");
    run();
    return status("VmHWM") - before;
}
