#pragma once

#include <string>
#include <string_view>

namespace graze {

/// What a page shows: results, a study, or a model.
struct PageSubject {
    enum class Kind { results, study, model };

    Kind kind = Kind::results;
    std::string name;   ///< as it was given, or as graze ships it
    std::string path{}; ///< of the file; empty: it comes with graze
    std::string text{}; ///< of a study or model
};

std::string_view name_of(PageSubject::Kind kind);

/// Finds out what is meant. @param given a result file, or a folder with one; a file of a study or a model; or the name
/// of a study or model that comes with graze; empty: the current folder @param model whether a model is meant where a
/// study has the same name
/// @throws InputError when there is no such thing
PageSubject page_subject(const std::string& given, bool model = false);

} // namespace graze
