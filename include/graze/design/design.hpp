#pragma once

#include "graze/base/input_error.hpp"
#include "graze/branch/yield.hpp"
#include "graze/grazing/verdict.hpp"
#include "graze/model/model.hpp"
#include "graze/study/study.hpp"
#include "graze/trip/trip_time.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace graze {

/// Manufacturing tolerance of a dimension.
struct DesignTolerance {
    double size = 0;    ///< size as in Tolerance, in the parameter's unit, or relative
    bool share = false; ///< true: `size` is relative to the parameter's value
    Spread spread = Spread::normal;

    /// Returns the absolute tolerance at a value of the dimension.
    Tolerance at(ParameterId parameter, double value) const;
};

/// A parameter that the designer may choose, within a range.
struct DesignDimension {
    std::string name, unit, text;
    ParameterId parameter;
    double least = 0, greatest = 0;
    std::optional<DesignTolerance> tolerance;
    Place place;

    /// @throws InputError unless the first device's value is within the range, and a relative tolerance has a nonzero
    /// value
    void require_first(double value) const;
};

/// How the device is brought to its trip point: along a branch that starts from the attractor at the least value of the
/// control parameter and leads upwards to its first touch; or the trip point is a point of a study's run.
struct Approach {
    std::string study; ///< name or file of a study; empty: the design has a branch of its own
    std::string run, point;
    ParameterValues from; ///< initial states that replace the model's
    double least = 0, greatest = 0;
    std::string event;      ///< event whose surface is touched; empty: any
    std::size_t cycles = 0; ///< cycles for the motion to settle; 0: the default of studies
    Place place;
    Place range_place; ///< place of the range, if there is one
};

/// Which end counts as tripped, and the overshoots of the trip value for which the trip time is computed.
struct TripRequest {
    std::string until = "end"; ///< "end" (of the motion itself), "EXPR=LEVEL", or "speed=VALUE" of contacts
    TripEnd end;
    std::vector<double>
        overshoots;       ///< overshoots of the control parameter; empty: decades from 1e-2 to 1e-20 of its magnitude
    double cycles = 2000; ///< longest simulation, in cycles
    Place place{};        ///< place of the overshoots, if there are any
};

/// Requirements on the finished device; empty ones are not imposed.
struct Wanted {
    std::optional<double> least, greatest; ///< limits of the trip value
    std::optional<double> value;           ///< exact trip value
    std::optional<GrazingOutcome> outcome; ///< class of the trip point
    std::optional<double> overshoot, longest_time;
    std::optional<double> least_reset, greatest_reset;
    Place reset_place{};
    std::optional<double> clear; ///< least distance of the trip value from every earlier point on the branch
    /// Largest sensitivities: percent of the trip value per percent of a parameter.
    std::vector<std::pair<ParameterId, double>> sensitivities;
    /// Least yield: share of devices, made with the tolerances, that meet the limits.
    std::optional<double> least_yield;
    Place yield_place{};
    /// Weights of violations by the key of the requirement, such as "trip_time"; 1 by default.
    std::vector<std::pair<std::string, double>> importance;

    bool is_empty() const;
};

/// Options of the yield computation.
struct DesignYield {
    std::size_t devices = 10'000;
    std::uint64_t seed = 1;
    std::optional<double> least, greatest; ///< limits of usable trip values; empty: those that are wanted
};

/// A limit switch to be designed, as read from a design file.
struct Design {
    std::string name, text, source, file;
    std::string fingerprint; ///< hash of all settings that determine the device, independent of their order
    Model model;             ///< model with the parameters that the design sets
    std::string model_path;
    ParameterValues set;
    std::string control;
    ParameterId control_parameter;
    Approach approach;
    TripRequest trip;
    std::vector<DesignDimension> dimensions;
    /// Pairs of dimensions that are mapped; empty: the first two.
    std::vector<std::pair<std::size_t, std::size_t>> planes;
    std::optional<std::size_t> adjustable;            ///< dimension that is adjusted on the finished device
    std::size_t curve_points = 41, plane_points = 31; ///< points along each dimension
    DesignYield yield;
    Wanted wanted;

    /// Limits of usable trip values: those of the yield, or else those that are wanted; empty: none.
    std::optional<double> least_usable() const { return yield.least ? yield.least : wanted.least; }
    std::optional<double> greatest_usable() const { return yield.greatest ? yield.greatest : wanted.greatest; }

    /// Returns the index of a dimension.
    std::optional<std::size_t> find_dimension(std::string_view name) const;
};

/// Reads a design from TOML text, whose format docs/design.md describes.
/// @param file name for messages; models and studies are looked for relative to its folder
/// @throws InputErrors with places for several errors, InputError for a single one
Design parse_design(std::string_view text, const std::string& file);
Design read_design(const std::string& path);

/// Returns the names of the shipped designs (the files of designs/), in alphabetical order.
std::vector<std::string> shipped_designs();
/// Returns the text of a shipped design. @throws InputError for an unknown name, with the nearest
std::string shipped_design_text(const std::string& name);
/// Loads a shipped design by name, or a design file. @throws InputError when neither exists, or the design is invalid
Design load_design(const std::string& name_or_path);

} // namespace graze
