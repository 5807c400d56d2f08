#pragma once

#include "graze/results/result_file.hpp"
#include "graze/study/study.hpp"
#include "study/settings_fields.hpp"

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace graze {

/// A text that differs for runs whose results differ; see RunRecord.
/// @param parent_fingerprint of the runs that it needs
std::string run_fingerprint(const StudyRun& run, const std::string& parent_fingerprint);

/// What results keep of a run besides its points.
/// @param parent_fingerprint of the runs that it needs
/// @param points planned
RunRecord record_of(const StudyRun& run, const std::string& parent_fingerprint, std::size_t points);

/// The fingerprints of the runs that a run needs, one after another.
/// @param fingerprints by the names of runs; of some there may be none
std::string parent_fingerprint(const StudyRun& run, const std::map<std::string, std::string>& fingerprints);

/// Ways in which a run of kind continue, or a sweep, goes.
std::vector<std::string> direction_names(const StudyRun& run);

/// A run as it was asked for, without its model, as texts.
struct AskedRun {
    std::string name, kind, settings, version;
    std::string file = {};               ///< from which these texts come, for messages
    std::vector<std::string> units = {}; ///< of its values; of branches, of its monitors
};

/// Makes the run. @throws InputError when the settings cannot be read, or come from another version that has more of
/// them
StudyRun run_of(const AskedRun& asked, Model model);

/// A run as texts, its model with it.
struct WrittenRun {
    AskedRun asked;
    std::string model; ///< text of its file
};
WrittenRun written(const StudyRun& run);

template <class Fields, class Run>
void describe_written(Fields& fields, Run& run) {
    describe_fields(fields, "name", run.asked.name, "kind", run.asked.kind, "model", run.model, "settings",
                    run.asked.settings, "version", run.asked.version, "units", run.asked.units);
}

} // namespace graze
