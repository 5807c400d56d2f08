#pragma once

#include "page/point_actions.hpp"

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace graze {

/// What somebody wants to do from a point.
struct ProposalWish {
    std::string action;               ///< one of those that are possible there
    std::vector<std::string> along{}; ///< other parameters than the proposed ones, in their order; empty: these
    std::map<std::string, std::pair<double, double>> bounds{}; ///< other bounds than the proposed ones
    /// Further keys of the run, or replaced ones, with their values as a study has them: steps = "200".
    std::map<std::string, std::string> options{};
    /// The model that the study has for all runs (its key `model`), which the run need not name. Empty: none.
    std::string study_model{};
};

/// The key `model` of the text of a study, for ProposalWish::study_model; empty where it has none, or is no TOML.
std::string study_model_of(std::string_view text);

/// A run of a study that is proposed: a table [runs.NAME] to be appended to the text of the study.
struct ProposedRun {
    std::string name, text;
};

/// The run that does what is wished. Its name is free in the study and in the result file. The text names the run that
/// it begins from, and the model by its file, as the study does, or by its name.
/// @param file may be null
/// @throws InputError for an action that is not possible there, unknown parameters, and wrong bounds
ProposedRun proposed_run(const PointOrigin& origin, const Study& study, const ResultFile* file,
                         const ProposalWish& wish);

} // namespace graze
