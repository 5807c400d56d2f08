#pragma once

#include "graze/identify/estimate.hpp"
#include "graze/study/figure.hpp"
#include "program/arguments.hpp"

#include <string>
#include <vector>

namespace graze {

/// What has been found from records.
struct Identified {
    struct Value {
        std::string name, unit;
        Estimate estimate;
    };
    std::vector<Value> values;
    std::vector<std::string> warnings; ///< what calls for a look at the record
    Figure figure;
};

/// Each reads the records that are asked for. @throws InputError
Identified identify_decrement(const IdentifyArguments& arguments);
Identified identify_restitution(const IdentifyArguments& arguments);
Identified identify_coupling(const IdentifyArguments& arguments);
Identified identify_impedance(const IdentifyArguments& arguments);

} // namespace graze
