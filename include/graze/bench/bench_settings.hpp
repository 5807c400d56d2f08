#pragma once

#include "graze/model/model.hpp"
#include "graze/model/named_value.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace graze {

/// A parameter of a model that the generator sets: it is `factor` times a setting of the generator.
struct DrivenInput {
    ParameterId parameter;
    double factor = 1; ///< for an amplitude, the gain of the amplifier
};

/// A measured channel: a sensor with noise, offset and drift, and its analog-to-digital converter.
struct BenchChannel {
    NamedValue value;  ///< measured quantity; its name and unit are those of the channel
    double noise = 0;  ///< standard deviation of white noise, in the channel's unit
    double offset = 0; ///< constant error
    double drift = 0;  ///< change of the offset per second
    double range = 0;  ///< input range of the converter, -range to range; 0: no converter
};

/// Options of `VirtualBench`.
struct BenchSettings {
    Model model;
    DrivenInput amplitude; ///< driven by half the generator's peak-to-peak amplitude, in V
    DrivenInput frequency; ///< driven by the generator's frequency, in Hz
    /// Driven by the generator's offset, in V; empty: the model has none.
    std::optional<DrivenInput> offset{};
    double time_unit = 1; ///< seconds in a unit of the model's time
    std::vector<BenchChannel> channels{};
    int bits = 16;            ///< resolution of the converters
    double anti_alias = 0;    ///< corner frequency of the anti-aliasing filter in each channel, in Hz; 0: no filter
    std::uint64_t seed = 1;   ///< seed of the noise
    double tolerance = 1e-10; ///< tolerance of the simulation
    /// @throws InputError naming the setting that is out of range
    void validate() const;
};

/// Texts of the channels of a bench where none are chosen, for bench_channel: the quantity `voltage`, and all states
/// that are not cyclic.
std::vector<std::string> usual_channels(const Model& model);

/// Parses a channel such as "V=V0*sin(theta):V" or "q": a name, an expression of the model, a unit.
/// @param asked option that gives the text, for messages. @throws InputError for an invalid text
BenchChannel bench_channel(const Model& model, const std::string& text, const std::string& asked);

/// Parses a driven parameter such as "V0" or "omega=2*pi": its name, and optionally a factor.
/// @throws InputError for an unknown independent parameter
DrivenInput driven_input(const Model& model, const std::string& text, const std::string& asked);

} // namespace graze
