#include "page/stored_subject.hpp"

#include "graze/base/input_error.hpp"
#include "graze/model/model_file.hpp"
#include "graze/results/name_advice.hpp"
#include "graze/study/stored_study.hpp"

#include <fmt/format.h>

namespace graze {

ResultFile present_results(const StudySession& session) {
    if (auto file = session.results())
        return *file;
    throw InputError("nothing has been computed yet", "compute a run first");
}

RunRecord stored_record(const ResultFile& file, const std::string& run) {
    if (auto record = file.find_run(run))
        return *record;
    throw InputError(fmt::format("the results have no run '{}'", run),
                     name_advice(run, names_of(file.runs()), "there are none"));
}

std::shared_ptr<const Study> study_with_run(const StudySession& session, const ResultFile& file,
                                            const std::string& run) {
    std::shared_ptr<const Study> study = session.study();
    if (study->find_run(run) != nullptr)
        return study;
    return std::make_shared<Study>(stored_study(file));
}

Model model_of_run(const StudySession& session, const std::string& run) {
    if (run.empty() && session.subject().kind == PageSubject::Kind::model)
        return session.subject().path.empty() ? parse_model(session.subject().text, session.subject().name)
                                              : read_model(session.subject().path); // as it is by now
    if (run.empty())
        throw InputError("no run is named", "name one: its model is meant");
    if (const auto file = session.results())
        if (const auto record = file->find_run(run))
            return stored_model(*record);
    const std::shared_ptr<const Study> study = session.study();
    if (const StudyRun* found = study->find_run(run))
        return found->model;
    throw InputError(fmt::format("there is no run '{}'", run),
                     name_advice(run, names_of(study->runs), "the study has none"));
}

} // namespace graze
