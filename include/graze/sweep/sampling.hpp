#pragma once

#include "graze/model/model.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace graze {

/// Specifies where values are sampled along a motion.
struct Sampling {
    enum class At {
        section, ///< passages of a section of the model
        extremum,
        contact, ///< contacts, with the state just before; for sticking, with the state at the accumulation
    };
    std::string name;
    At at = At::section;
    std::string section;                   ///< name of the section
    Expression expression;                 ///< its extrema are sampled
    Direction direction = Direction::both; ///< for extrema: falling = maxima, rising = minima
    std::vector<std::size_t> events;       ///< events whose contacts are sampled
    std::optional<std::size_t> symmetry;   ///< values are taken at the image under Model::symmetries[symmetry]
};

/// Samples along a motion, in the order of time.
struct SampleSet {
    std::size_t width = 0;              ///< number of values of each sample
    std::vector<std::size_t> samplings; ///< index of the Sampling of each sample
    std::vector<double> times;          ///< since the point's start
    std::vector<double> values;         ///< [sample * width + value]

    std::size_t size() const { return times.size(); }
    void clear() {
        samplings.clear();
        times.clear();
        values.clear();
    }
};

} // namespace graze
