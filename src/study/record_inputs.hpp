#pragma once

#include "graze/base/input_error.hpp"
#include "graze/model/model.hpp"
#include "graze/record/samples.hpp"
#include "graze/study/record_request.hpp"

#include <string>
#include <vector>

namespace graze {

/// Files that a name of a study means: itself or, with `*` in its last part, all that fit, in the order of their names.
/// They lie in the study's folder or below it, also where links lead, and are plain files.
/// @param study its file @throws InputError with the place otherwise, and when there are none
std::vector<RecordInput> record_inputs(const std::string& study, const std::string& name, const Place& place);

/// Length and hash of what is in a file. @throws InputError when it cannot be read
void fingerprint_record(RecordInput& input);

/// A channel, or what was found of a record, with what it is in words (empty where nobody said it).
struct RecordedName {
    std::string name, unit, text;
};

/// A record as a model: channels are states that rest, what was found of each record are parameters. Values of samples
/// are expressions in them.
/// @throws InputError for names that expressions cannot have
Model model_of_record(const std::vector<RecordedName>& states, const std::vector<RecordedName>& parameters,
                      const std::string& time_unit);

} // namespace graze
