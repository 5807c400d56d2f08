#pragma once

#include "graze/model/model.hpp"
#include "graze/model/named_value.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace graze {

/// A parameter of a model that an instrument drives: it is `factor` times what the instrument gives.
struct DrivenInput {
    ParameterId parameter;
    double factor = 1; ///< of amplitudes that of the amplifier
};

/// A sensor with what stands behind it, up to the number that comes out of a converter.
struct BenchChannel {
    NamedValue value;  ///< what is measured; its name and unit are the channel's
    double noise = 0;  ///< standard deviation, from sample to sample independent
    double offset = 0; ///< added
    double drift = 0;  ///< what the offset gains in a second
    double range = 0;  ///< the converter goes from -range to range; 0: no converter
};

struct BenchSettings {
    Model model;
    DrivenInput amplitude; ///< by half of the generator's amplitude from peak to peak, in V
    DrivenInput frequency; ///< by its frequency, in Hz
    std::optional<DrivenInput> offset{};
    double time_unit = 1; ///< seconds that a unit of the model's time lasts
    std::vector<BenchChannel> channels{};
    int bits = 16;            ///< of converters
    double anti_alias = 0;    ///< corner of a low-pass filter in each channel, in Hz; 0: none
    std::uint64_t seed = 1;   ///< of noise
    double tolerance = 1e-10; ///< of the simulation
    /// @throws InputError naming the setting that is out of range
    void validate() const;
};

/// A channel from a text such as "V=V0*sin(theta):V" or "q": a name, what it is in terms of the model, a unit.
/// @param asked who asks, for messages. @throws InputError when it is none
BenchChannel bench_channel(const Model& model, const std::string& text, const std::string& asked);

/// What drives a parameter from a text such as "V0" or "omega=2*pi": its name, a factor.
/// @throws InputError when there is no such independent parameter
DrivenInput driven_input(const Model& model, const std::string& text, const std::string& asked);

} // namespace graze
