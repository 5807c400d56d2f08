#pragma once

#include "graze/identify/identification.hpp"
#include "graze/study/identify_request.hpp"

#include <string>
#include <utility>
#include <vector>

namespace graze {

/// A kind of estimate that runs of kind identify may ask for. A new kind is an entry of the table, besides its
/// enumerator of IdentifyRequest::What, its keys (measured_description.hpp) and its computation.
struct EstimateKind {
    std::string name;                 ///< in studies and on the command line
    std::vector<std::string> numbers; ///< names of what it finds; from several records it finds further numbers
    std::vector<std::string> ratios;  ///< those of the numbers that have no unit by their nature
    /// Names of the abscissa and the ordinate of what samples show.
    std::pair<std::string, std::string> (*shown)(const IdentifyRequest& request);
    bool shows_channel; ///< what is shown has the unit of IdentifyRequest::channel, except times
    /// The computation; null for fits, which need all records at once.
    Identification (*identify)(const EachRecord& records, const IdentificationSettings& settings);
};

/// All kinds, in the order of IdentifyRequest::What.
const std::vector<EstimateKind>& estimate_kinds();
const EstimateKind& estimate_kind(IdentifyRequest::What what);

} // namespace graze
