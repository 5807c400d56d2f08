#include "study/estimate_kind.hpp"

#include "graze/base/require.hpp"

namespace graze {

const std::vector<EstimateKind>& estimate_kinds() {
    using Request = IdentifyRequest;
    using Names = std::pair<std::string, std::string>;
    static const std::vector<EstimateKind> kinds{
        {.name = "decrement",
         .numbers = {"natural_frequency", "damping_ratio", "natural_frequency_of_pairs", "damping_ratio_of_pairs",
                     "rest_position"},
         .ratios = {"damping_ratio"},
         .shown = [](const Request&) { return Names("t", "peak"); },
         .shows_channel = true,
         .identify = identify_decrement},
        {.name = "restitution",
         .numbers = {"restitution"},
         .ratios = {"restitution"},
         .shown = [](const Request&) { return Names("before", "after"); },
         .shows_channel = true,
         .identify = identify_restitution},
        {.name = "coupling",
         .numbers = {"beta1", "beta2", "correlation", "beta1_of_regression", "beta2_of_regression"},
         .ratios = {"correlation"},
         .shown =
             [](const Request& one) { return Names(one.current, one.displacement.empty() ? "q" : one.displacement); },
         .shows_channel = false,
         .identify = identify_coupling},
        {.name = "impedance",
         .numbers = {"resistance", "inductance", "leakage_inductance", "frequency"},
         .ratios = {},
         .shown = [](const Request& one) { return Names("t", one.current); },
         .shows_channel = false,
         .identify = identify_impedance},
        {.name = "fit", .numbers = {}, .ratios = {}, .shown = nullptr, .shows_channel = false, .identify = nullptr},
    };
    return kinds;
}

const EstimateKind& estimate_kind(IdentifyRequest::What what) {
    const auto index = static_cast<std::size_t>(what);
    require_index(index, estimate_kinds().size(), "kind of estimate");
    return estimate_kinds()[index];
}

const std::vector<std::string>& kinds_of_estimates() {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> all;
        for (const EstimateKind& kind : estimate_kinds())
            all.push_back(kind.name);
        return all;
    }();
    return names;
}

} // namespace graze
