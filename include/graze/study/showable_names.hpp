#pragma once

#include "graze/results/result_file.hpp"
#include "graze/study/study.hpp"

#include <string>
#include <vector>

namespace graze {

/// The names that a picture may show, and that StudyPicture::names may therefore replace.
class ShowableNames {
public:
    /// Begins with the names in the picture itself, and those that all results have.
    explicit ShowableNames(const StudyPicture& picture);
    /// Adds the names of a run of the picture: as a study asks for it, or as a file has it.
    void add(const StudyRun& run);
    void add(const RunRecord& run);
    /// @param subject what uses the name, for the message
    /// @throws InputError for an unknown name, listing those that the study itself has given
    void require(const std::string& name, const Place& place, const std::string& subject) const;

private:
    void add_model(const Model& model);
    std::vector<std::string> own_, others_; ///< own: names that the study gives
};

} // namespace graze
