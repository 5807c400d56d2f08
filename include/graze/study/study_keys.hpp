#pragma once

#include "graze/study/study.hpp"

#include <optional>
#include <string>
#include <vector>

namespace graze {

/// A key that runs of one kind may have in a study file.
struct StudyKey {
    std::string name;
    std::string type;     ///< "number", "whole number", "true or false", "text", "one of", or how it is written
    std::string standard; ///< its default; empty: `meaning` tells what holds where the key is left out
    std::string meaning;
    std::optional<double> least, most; ///< range of a number
    bool includes_least = true;
    std::vector<std::string> words; ///< of type "one of": the possible values
};

/// The keys of runs of a kind, in the order in which they are described. @throws InputError for what is no kind
const std::vector<StudyKey>& study_keys(RunKind kind);

} // namespace graze
