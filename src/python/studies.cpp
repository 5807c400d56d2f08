#include "graze/atlas/run_atlas.hpp"
#include "graze/picture/result_picture.hpp"
#include "graze/results/table_text.hpp"
#include "graze/study/further_runs.hpp"
#include "graze/study/part_exchange.hpp"
#include "graze/study/run_summary.hpp"
#include "graze/study/runner.hpp"
#include "graze/study/stored_study.hpp"
#include "graze/study/study_catalogue.hpp"
#include "graze/study/study_keys.hpp"
#include "graze/study/study_table.hpp"
#include "python/attended.hpp"
#include "python/figures.hpp"
#include "python/noted.hpp"
#include "python/tables.hpp"

#include <algorithm>
#include <optional>

namespace graze::python {

namespace {

using HeldModels = std::map<std::string, std::shared_ptr<HeldModel>>;

NamedModels named(const HeldModels& models) {
    NamedModels result;
    for (const auto& [name, one] : models)
        result.emplace(name, one->model);
    return result;
}

/// What a study does at present.
struct StudyNote {
    StudyProgress progress;
    std::optional<double> parameter; ///< of the orbit followed last
};

/// With the interpreter's lock.
py::dict told_object(const StudyNote& note) {
    const StudyProgress& progress = note.progress;
    py::dict object;
    object["run"] = progress.run;
    object["done"] = progress.done;
    object["points"] = progress.points;
    object["all_done"] = progress.study_done;
    object["all_points"] = progress.study_points;
    object["parameter"] = note.parameter;
    return object;
}

py::list carried_out(const Study& study, ResultFile& file, int threads, const std::vector<std::string>& only,
                     const py::object& told, const std::shared_ptr<PartExchange>& parts) {
    Noted<StudyNote> note;
    std::vector<RunReport> reports;
    attended(
        [&](const std::function<bool()>& must_stop) {
            RunnerOptions options;
            options.jobs = threads;
            options.only = only;
            options.interrupted = must_stop;
            options.progress = [&](const StudyProgress& made) {
                note.change([&](StudyNote& now) { now.progress = made; });
            };
            options.orbit = [&](const std::string& run, const OrbitRecord& record) {
                note.change([&](StudyNote& now) {
                    now.progress.run = run;
                    now.progress.done = record.number;
                    now.parameter = record.point.parameter;
                });
            };
            Study whole = study; // atlases add runs to it
            reports =
                run_with_atlases(whole, file, options, [&](const Study& all, ResultFile& to, const RunnerOptions& now) {
                    return run_study(all, to, now, {.points = points_by(parts)});
                });
        },
        telling(told, [&] { return told_object(note.now()); }));
    py::list list;
    for (const RunReport& report : reports) {
        const RunSummary summary = summary_of(report, file);
        py::dict object;
        object["name"] = report.name;
        object["kind"] = report.kind;
        object["points"] = report.points;
        object["computed"] = report.computed;
        object["seconds"] = report.seconds;
        object["status"] = std::string(name_of(report.outcome));
        object["problem"] = report.problem;
        object["remedy"] = report.remedy;
        object["labels"] = summary.labels;
        object["ends"] = summary.ends;
        object["escapes"] = summary.escapes;
        list.append(object);
    }
    return list;
}

py::list keys_of(const std::string& kind) {
    const auto known = run_kind(kind);
    if (!known)
        throw InputError("there is no kind of runs '" + kind + "'", "use one of kinds_of_runs()");
    py::list list;
    for (const StudyKey& key : study_keys(*known)) {
        py::dict object;
        object["name"] = key.name;
        object["type"] = key.type;
        object["standard"] = key.standard;
        object["meaning"] = key.meaning;
        object["least"] = key.least;
        object["most"] = key.most;
        object["includes_least"] = key.includes_least;
        object["words"] = key.words;
        list.append(object);
    }
    return list;
}

/// Refuses results of other values of parameters.
void require_values_of_study(const Study& study, const ResultFile& file) {
    const auto words = [](const ParameterValues& set) {
        std::string text;
        for (const auto& [name, value] : set)
            text += (text.empty() ? "" : ", ") + name + " = " + py::str(py::float_(value)).cast<std::string>();
        return text;
    };
    require_same_values(study, file, words, "choose another folder: output=\"FOLDER\"");
}

const StudyTable& table_named(const Study& study, const std::string& name) {
    for (const StudyTable& table : study.tables)
        if (table.name == name)
            return table;
    throw InputError("the study has no table '" + name + "'", "");
}

py::object figure_of(const Study& study, const ResultFile& file, const std::string& name) {
    for (const StudyPicture& picture : study.pictures)
        if (picture.name == name) {
            ResultPicture made;
            {
                const Unlocked unlocked;
                made = make_picture(picture, file);
            }
            return object_of(std::move(made.figure));
        }
    throw InputError("the study has no picture '" + name + "'", "");
}

/// A picture of runs of a result file, asked for by the text of its keys: the figure, and the table made for it.
py::tuple picture_of(const ResultFile& file, const std::string& text, const std::string& named) {
    ResultPicture made;
    {
        const Unlocked unlocked;
        made = make_picture(parse_picture(text, "picture", named, stored_study(file)), file);
    }
    return py::make_tuple(object_of(std::move(made.figure)), columns_of(made.table));
}

} // namespace

void bind_studies(py::module_& module) {
    py::class_<Study, std::shared_ptr<Study>>(module, "Study")
        .def_static(
            "parsed",
            [](const std::string& text, const std::string& file, const ParameterValues& set, const HeldModels& models) {
                return std::make_shared<Study>(parse_study(text, file, set, named(models)));
            },
            py::arg("text"), py::arg("file"), py::arg("set"), py::arg("models"))
        .def_static(
            "loaded",
            [](const std::string& name_or_path, const ParameterValues& set) {
                return std::make_shared<Study>(load_study(name_or_path, set));
            },
            py::arg("name_or_path"), py::arg("set"))
        .def_static(
            "stored", [](const ResultFile& file) { return std::make_shared<Study>(stored_study(file)); },
            py::arg("file"))
        .def(
            "further",
            [](const Study& self, const std::string& text, const std::string& file, const HeldModels& models) {
                return std::make_shared<Study>(parse_further_runs(text, file, self, named(models)));
            },
            py::arg("text"), py::arg("file"), py::arg("models"))
        .def(
            "kept_in",
            [](const Study& self, const ResultFile& file) {
                auto kept = std::make_shared<Study>(self);
                kept->file = file.path(); // so that carrying it out does not store it each time
                return kept;
            },
            py::arg("file"))
        .def(
            "store", [](const Study& self, ResultFile& file) { store_study(self, file); }, py::arg("file"))
        .def("require_same_values", &require_values_of_study, py::arg("file"))
        .def_readonly("name", &Study::name)
        .def_readonly("text", &Study::text)
        .def_readonly("source", &Study::source)
        .def_property_readonly("runs",
                               [](const Study& self) {
                                   std::vector<std::pair<std::string, std::string>> runs;
                                   for (const StudyRun& run : self.runs)
                                       runs.emplace_back(run.name, std::string(name_of(run.kind)));
                                   return runs;
                               })
        .def_property_readonly("pictures",
                               [](const Study& self) {
                                   std::vector<std::string> names;
                                   for (const StudyPicture& picture : self.pictures)
                                       names.push_back(picture.name);
                                   return names;
                               })
        .def_property_readonly("tables",
                               [](const Study& self) {
                                   std::vector<std::string> names;
                                   for (const StudyTable& table : self.tables)
                                       names.push_back(table.name);
                                   return names;
                               })
        .def(
            "table",
            [](const Study& self, const ResultFile& file, const std::string& name) {
                return columns_of(make_table(table_named(self, name), file));
            },
            py::arg("file"), py::arg("name"))
        .def(
            "table_text",
            [](const Study& self, const ResultFile& file, const std::string& name) {
                return csv_text(make_table(table_named(self, name), file));
            },
            py::arg("file"), py::arg("name"))
        .def("run", &carried_out, py::arg("file"), py::kw_only(), py::arg("threads"), py::arg("only"), py::arg("told"),
             py::arg("parts") = std::shared_ptr<PartExchange>())
        .def("figure", &figure_of, py::arg("file"), py::arg("name"));
    module.def("picture", &picture_of, py::arg("file"), py::arg("text"), py::arg("named"));
    module.def("study_keys", &keys_of);
    module.def("kinds_of_runs", &kinds_of_runs);
    module.def("shipped_studies", &shipped_studies);
    module.def("shipped_study_text", &shipped_study_text);
}

} // namespace graze::python
