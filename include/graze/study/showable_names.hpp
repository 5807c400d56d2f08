#pragma once

#include "graze/results/result_file.hpp"
#include "graze/study/study.hpp"

#include <string>
#include <vector>

namespace graze {

/// What a picture may show by a name, for which it can be given another one (StudyPicture::names).
class ShowableNames {
public:
    /// What the picture itself names, and what all results have.
    explicit ShowableNames(const StudyPicture& picture);
    /// What a run of the picture has: as it is asked for, or as a file has it.
    void add(const StudyRun& run);
    void add(const RunRecord& run);
    /// @param subject what gives the name, for the message
    /// @throws InputError for a name of nothing, with those that the runs have themselves
    void require(const std::string& name, const Place& place, const std::string& subject) const;

private:
    void add_model(const Model& model);
    std::vector<std::string> own_, others_; ///< own: what a study calls something
};

} // namespace graze
