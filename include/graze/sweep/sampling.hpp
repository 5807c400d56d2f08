#pragma once

#include "graze/model/model.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace graze {

/// Where along a motion values are taken.
struct Sampling {
    enum class At {
        section, ///< passages of a section of the model
        extremum,
        contact, ///< impacts and the like, from the state just before; of sticking, from that of the accumulation
    };
    std::string name;
    At at = At::section;
    std::string section;                   ///< name of the section
    Expression expression;                 ///< whose extrema
    Direction direction = Direction::both; ///< of extrema: falling = maxima, rising = minima
    std::vector<std::size_t> events;       ///< whose contacts
    std::optional<std::size_t> symmetry;   ///< values are those of the image under Model::symmetries[symmetry]
};

/// Values taken along a motion, in the order of time.
struct SampleSet {
    std::size_t width = 0;              ///< values of each sample
    std::vector<std::size_t> samplings; ///< which Sampling each comes from
    std::vector<double> times;          ///< since the point's start
    std::vector<double> values;         ///< [sample * width + value]

    std::size_t size() const { return times.size(); }
    void clear();
};

} // namespace graze
