#pragma once

#include "graze/results/result_file.hpp"
#include "graze/study/study.hpp"

#include <nlohmann/json.hpp>

#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

namespace graze {

/// What is known of stored runs as long as their revision is the same, so that nothing is read twice. Any thread may
/// use it.
class RunsMemory {
public:
    /// What was kept for this revision of the run; null: nothing.
    nlohmann::json find(const std::string& run, const std::string& revision) const;
    void keep(const std::string& run, const std::string& revision, nlohmann::json one);
    /// Forgets all other runs.
    void keep_only(const std::vector<RunRecord>& runs);

    /// The list of all runs, if the result file has these traces (results_trace) and the study is the same as when it
    /// was kept; null otherwise. The settings of runs with many values take long to read.
    nlohmann::json find_all(const std::string& traces, const std::shared_ptr<const Study>& study) const;
    /// Keeps the list if all runs of the file could be read. @param traces before it was read
    void keep_all(const std::string& traces, const std::shared_ptr<const Study>& study, const nlohmann::json& list);

private:
    mutable std::mutex mutex_;
    std::map<std::string, std::pair<std::string, nlohmann::json>> runs_; ///< by name, with their revision
    std::string traces_;
    std::shared_ptr<const Study> study_;
    nlohmann::json all_;
};

/// The runs of a result file with how they ended, in their order there. With a study, those that it has come first, and
/// those that are not computed yet are "missing".
/// @param study, memory may be null
nlohmann::json runs_json(const ResultFile& file, const Study* study, RunsMemory* memory = nullptr);

/// The runs of a study of which nothing has been computed yet.
nlohmann::json missing_runs_json(const Study& study);

/// A text that differs when a run has other rows, or another state, than when it was asked for before. The rows are
/// counted for it, not read.
std::string run_revision(const ResultFile& file, const RunRecord& run);

} // namespace graze
