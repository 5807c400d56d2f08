#pragma once

#include "base/temporary_folder.hpp"
#include "graze/design/trip_point.hpp"
#include "graze/study/runner.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>

namespace graze::testing {

inline TripPoint trip_of(const Design& design) {
    const TemporaryFolder folder;
    const Study study = approach_study(design);
    ResultFile file(folder / "results.sqlite", ResultFile::Access::write);
    run_study(study, file, {});
    return find_trip_point(design, study, file);
}

inline std::pair<Design, TripPoint> with_trip(Design design) {
    TripPoint trip = trip_of(design);
    return {std::move(design), std::move(trip)};
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

inline Design oscillator_design(const std::string& rest = "") {
    return parse_design(oscillator_text(rest), "d.toml");
}

/// The amplitude at which it touches the stop.
inline double oscillator_value(double sigma, double zeta, double omega = 0.5) {
    return sigma * std::hypot(1 - omega * omega, 2 * zeta * omega);
}

/// A point of the shipped study of a beam, as the trip point of a design.
inline Design beam_design(const std::string& rest = "") {
    return parse_design(R"(name = "beam"
control = "V"
[approach]
study = "microbeam"
run = "contact"
point = "SN1"
[dimensions.k]
range = [50, 200]
)" + rest,
                        "d.toml");
}

} // namespace graze::testing
