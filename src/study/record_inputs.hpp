#pragma once

#include "graze/base/input_error.hpp"
#include "graze/model/model.hpp"
#include "graze/record/samples.hpp"
#include "graze/study/record_request.hpp"

#include <string>
#include <vector>

namespace graze {

/// The files that a name in a study stands for: one file or, with `*` in its last part, all that match, in alphabetical
/// order. They must be plain files in the study's folder or below it; links must not lead outside.
/// @param study its file @throws InputError with the place otherwise, and when there are none
std::vector<RecordInput> record_inputs(const std::string& study, const std::string& name, const Place& place);

/// Sets the length and the hash of a file. @throws InputError when it cannot be read
void fingerprint_record(RecordInput& input);

/// A channel, or a number that belongs to a record, with its description (empty where there is none).
struct RecordedName {
    std::string name, unit, text;
};

/// A record as a model, for expressions in its names: channels are states at rest, numbers that belong to a record are
/// parameters.
/// @throws InputError for names that expressions cannot have
Model model_of_record(const std::vector<RecordedName>& states, const std::vector<RecordedName>& parameters,
                      const std::string& time_unit);

} // namespace graze
