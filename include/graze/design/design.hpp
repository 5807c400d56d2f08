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

/// How exactly the workshop makes a dimension.
struct DesignTolerance {
    double size = 0;    ///< as Tolerance has it: in the parameter's unit, or
    bool share = false; ///< a share of the parameter's value
    Spread spread = Spread::normal;

    /// At a value of the dimension.
    Tolerance at(ParameterId parameter, double value) const;
};

/// A parameter that the designer may choose.
struct DesignDimension {
    std::string name, unit, text;
    ParameterId parameter;
    double least = 0, greatest = 0;
    std::optional<DesignTolerance> tolerance;
    Place place;

    /// @throws InputError unless the first device, which has this value, is within the range, and has its tolerance
    void require_first(double value) const;
};

/// Where the point lies at which the device trips: on a branch that begins with what a simulated motion settles on at
/// the least value of the control parameter and leads upwards to its first touch, or at any point of a study's run.
struct Approach {
    std::string study; ///< name or file; empty: the branch is the design's own
    std::string run, point;
    ParameterValues from; ///< initial states, instead of the model's
    double least = 0, greatest = 0;
    std::string event;      ///< that is touched; empty: any
    std::size_t cycles = 0; ///< for the motion to settle; 0: as many as usual
    Place place;
    Place range_place; ///< of the range, if there is one
};

/// What counts as tripped, and at which distances beyond the trip value its time is asked for.
struct TripRequest {
    std::string until = "end"; ///< the motion's own end; "EXPR=LEVEL"; "speed=VALUE" of contacts
    TripEnd end;
    std::vector<double> overshoots; ///< of the control parameter; empty: decades from 1e-2 to 1e-20 of its size
    double cycles = 2000;           ///< that are simulated at most
    Place place{};                  ///< of the overshoots, if there are any
};

/// What the finished device is to have. What is not said is not asked for.
struct Wanted {
    std::optional<double> least, greatest; ///< of the trip value
    std::optional<double> value;           ///< that it is to have exactly
    std::optional<GrazingOutcome> outcome; ///< class
    std::optional<double> overshoot, longest_time;
    std::optional<double> least_reset, greatest_reset;
    Place reset_place{};
    std::optional<double> clear; ///< least distance of the trip value from every other point before it
    /// Greatest percents of the trip value for one percent of each parameter.
    std::vector<std::pair<ParameterId, double>> sensitivities;
    std::optional<double> least_yield; ///< share of the devices made with the tolerances that will do
    Place yield_place{};
    /// How many times a miss counts, by the wish's key, as "trip_time"; once where nothing is said.
    std::vector<std::pair<std::string, double>> importance;

    bool is_empty() const;
};

struct DesignYield {
    std::size_t devices = 10'000;
    std::uint64_t seed = 1;
    std::optional<double> least, greatest; ///< of the trip values that will do; none: what is wanted
};

/// A switch to be designed.
struct Design {
    std::string name, text, source, file;
    std::string fingerprint; ///< of all in the file that says which device is found, whatever stands where
    Model model;             ///< with the parameters that the design sets
    std::string model_path;
    ParameterValues set;
    std::string control;
    ParameterId control_parameter;
    Approach approach;
    TripRequest trip;
    std::vector<DesignDimension> dimensions;
    std::vector<std::pair<std::size_t, std::size_t>> planes; ///< pairs of dimensions; empty: the first two
    std::optional<std::size_t> adjustable;                   ///< the dimension that is tuned on the finished device
    std::size_t curve_points = 41, plane_points = 31;        ///< along each dimension
    DesignYield yield;
    Wanted wanted;

    /// Trip values that will do: those of the yield, or else those that are wanted; none: all will.
    std::optional<double> least_usable() const { return yield.least ? yield.least : wanted.least; }
    std::optional<double> greatest_usable() const { return yield.greatest ? yield.greatest : wanted.greatest; }

    /// Its place among the dimensions.
    std::optional<std::size_t> find_dimension(std::string_view name) const;
};

/// Reads a design from TOML text; docs/design.md describes it.
/// @param file the name to use in messages; models and studies are looked for relative to its folder
/// @throws InputErrors with the places of all that is wrong, or InputError for the only one
Design parse_design(std::string_view text, const std::string& file);
Design read_design(const std::string& path);

/// Names of the designs that come with graze (the files of designs/), in alphabetical order.
std::vector<std::string> shipped_designs();
/// The text of one of them. @throws InputError when there is none of that name (with the nearest)
std::string shipped_design_text(const std::string& name);
/// The design of this name or in this file. @throws InputError when there is neither, or something is wrong with it
Design load_design(const std::string& name_or_path);

} // namespace graze
