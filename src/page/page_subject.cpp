#include "page/page_subject.hpp"

#include "base/enumerator_name.hpp"
#include "graze/base/input_error.hpp"
#include "graze/base/text_file.hpp"
#include "graze/model/catalogue.hpp"
#include "graze/model/microbeam.hpp"
#include "graze/model/model_file.hpp"
#include "graze/results/name_advice.hpp"
#include "graze/results/result_file.hpp"
#include "graze/study/study_catalogue.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <vector>

namespace graze {

namespace {

std::string beginning_of(const std::string& path) {
    PlainFile file(path, "file");
    std::string start(512, ' ');
    start.resize(file.read(start.data(), start.size()));
    return start;
}

PageSubject subject_in_file(const std::string& path) {
    // The whole file is read only if it is a text.
    const std::string start = beginning_of(path);
    if (start.starts_with(std::string_view("SQLite format 3\0", 16)))
        return {PageSubject::Kind::results, path, path};
    if (start.find('\0') != std::string::npos) // a picture, say: no text has a zero byte
        throw InputError(Place{path, 0, 0}, "this is not a text file, nor results of graze",
                         "name a study, a model, or results; a picture opens in a viewer of pictures");
    std::string text = read_text_file(path, "file", longest_model);
    const bool study = is_study_text(text, path);
    return {study ? PageSubject::Kind::study : PageSubject::Kind::model, path, path, std::move(text)};
}

PageSubject shipped_subject(const std::string& name, bool model) {
    std::vector<std::string> known = shipped_studies();
    if (!model && std::ranges::find(known, name) != known.end())
        return {PageSubject::Kind::study, name, "", shipped_study_text(name)};
    if (const auto entry = find_in_catalogue(name))
        return {PageSubject::Kind::model, name, "", entry->text};
    if (microbeam_member(name))
        return {PageSubject::Kind::model, name, "", write_model(load_model(name))};
    for (std::string& one : shipped_models())
        known.push_back(std::move(one));
    std::ranges::sort(known);
    known.erase(std::unique(known.begin(), known.end()), known.end());
    throw InputError(fmt::format("there is no file '{}', and nothing of that name comes with graze", name),
                     name_advice(name, known, ""));
}

} // namespace

std::string_view name_of(PageSubject::Kind kind) {
    constexpr std::string_view names[] = {"results", "study", "model"};
    return enumerator_name(names, kind, "unknown");
}

PageSubject page_subject(const std::string& given, bool model) {
    const std::string named = given.empty() ? "." : given;
    std::error_code error;
    if (!std::filesystem::exists(named, error) && !is_model_path(named))
        return shipped_subject(named, model);
    const std::string path = result_path(named);
    if (path != named && !std::filesystem::exists(path, error))
        throw InputError(
            Place{named, 0, 0}, "there are no results in this folder",
            "name a folder with a results.sqlite, which graze run makes, a file, or what comes with graze");
    return subject_in_file(path);
}

} // namespace graze
