#pragma once

#include "graze/study/study.hpp"

#include <optional>
#include <string>
#include <vector>

namespace graze {

/// A key that a run of some kind may have.
struct StudyKey {
    std::string name;
    std::string type; ///< "number", "whole number", "true or false", "text", "texts", "one of", or how it is written
    std::string standard; ///< what holds where it is left out; empty: it depends, as `meaning` says
    std::string meaning;
    std::optional<double> least, most; ///< of numbers
    bool includes_least = true;
    std::vector<std::string> words; ///< of which it is one
};

/// The keys of runs of a kind, in the order in which they are described. @throws InputError for what is no kind
const std::vector<StudyKey>& study_keys(RunKind kind);

} // namespace graze
