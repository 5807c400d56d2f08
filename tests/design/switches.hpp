#pragma once

#include "graze/design/trip_point.hpp"
#include "graze/study/runner.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <string>
#include <unistd.h>

namespace graze::testing {

/// A temporary folder.
struct DesignFolder {
    DesignFolder() {
        static int count = 0;
        path = std::filesystem::temp_directory_path() /
               ("graze-design-" + std::to_string(getpid()) + "-" + std::to_string(count++));
        std::filesystem::create_directories(path);
    }
    ~DesignFolder() { std::filesystem::remove_all(path); }
    DesignFolder(const DesignFolder&) = delete;
    DesignFolder& operator=(const DesignFolder&) = delete;
    std::filesystem::path path;
};

inline TripPoint trip_of(const Design& design) {
    const DesignFolder folder;
    const Study study = approach_study(design);
    ResultFile file((folder.path / "results.sqlite").string(), ResultFile::Access::write);
    run_study(study, file, {});
    return find_trip_point(design, study, file);
}

/// A linear oscillator driven below its resonance up to its stop: an orbit without contact in closed form.
inline std::string oscillator_text(const std::string& rest = "") {
    return R"(name = "oscillator"
model = "impact-oscillator"
control = "amplitude"
set = { zeta = 0.1, sigma = 0.2, omega = 0.5 }
adjustable = "sigma"
[approach]
range = [0.01, 1]
event = "stop"
[trip]
until = "speed=0.5"
overshoots = [1e-3]
[dimensions.sigma]
range = [0.1, 0.4]
tolerance = "1%"
[dimensions.zeta]
range = [0.05, 0.3]
[points]
curve = 5
plane = 3
[yield]
devices = 200
)" + rest;
}
/// The amplitude at which it touches the stop.
inline double oscillator_value(double sigma, double zeta, double omega = 0.5) {
    return sigma * std::hypot(1 - omega * omega, 2 * zeta * omega);
}

} // namespace graze::testing
