#include "graze/base/input_error.hpp"
#include "graze/picture/result_picture.hpp"
#include "graze/results/name_advice.hpp"
#include "graze/results/result_table.hpp"
#include "graze/results/table_text.hpp"
#include "graze/study/stored_study.hpp"
#include "page/error_answer.hpp"
#include "page/figure_json.hpp"
#include "page/page_route.hpp"
#include "page/pictures_json.hpp"
#include "page/request_json.hpp"
#include "page/runs_json.hpp"
#include "page/special_points_json.hpp"
#include "page/stored_subject.hpp"
#include "page/table_json.hpp"
#include "page/toml_value.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace graze {

namespace {

HttpAnswer answer_session(PageParts& parts, const PageCall&) {
    const StudySession& session = parts.session;
    std::error_code error;
    const bool there = std::filesystem::exists(session.results_path(), error);
    nlohmann::json answer{{"version", GRAZE_VERSION},
                          {"title", session.title()},
                          {"opened", {{"kind", name_of(session.subject().kind)}, {"name", session.subject().name}}},
                          {"can_compute", session.can_compute()},
                          {"results", there ? nlohmann::json(session.results_path()) : nlohmann::json()},
                          {"stored", false},
                          {"limits", {{"body", parts.limits.body}, {"connections", parts.limits.connections}}}};
    return json_answer(answer);
}

HttpAnswer answer_runs(PageParts& parts, const PageCall&) {
    const std::shared_ptr<const Study> study = parts.session.study();
    const std::string traces = results_trace(parts.session.results_path());
    if (const nlohmann::json known = parts.runs.find_all(traces, study); !known.is_null())
        return json_answer(known);
    const auto file = parts.session.results();
    if (!file)
        return json_answer(missing_runs_json(*study));
    nlohmann::json list = runs_json(*file, study.get(), &parts.runs);
    const std::set<std::string> outdated = parts.session.outdated(*file);
    for (nlohmann::json& one : list)
        if (outdated.contains(one["name"].get<std::string>()))
            one["status"] = "outdated";
    parts.runs.keep_all(traces, study, list);
    return json_answer(list);
}

HttpAnswer answer_pictures(PageParts& parts, const PageCall&) {
    return json_answer(pictures_json(*parts.session.study()));
}

/// The picture that is asked for: by the name of one of the study, or by its keys.
StudyPicture asked_picture(const StudySession& session, const ResultFile& file, const nlohmann::json& request) {
    if (const std::string name = text_member(request, "name", ""); !name.empty()) {
        const std::shared_ptr<const Study> study = session.study();
        const auto found = std::ranges::find(study->pictures, name, &StudyPicture::name);
        if (found == study->pictures.end())
            throw InputError(fmt::format("the study has no picture '{}'", name),
                             name_advice(name, names_of(study->pictures), "it has none"));
        return *found;
    }
    const auto keys = request.find("picture");
    if (keys == request.end() || !keys->is_object())
        throw InputError("no picture is asked for", "give its 'name', or an object 'picture' with its keys");
    // Where only the run is named, the picture is the usual one of the run.
    if (const auto runs = keys->find("runs"); keys->size() == 1 && runs != keys->end() && runs->size() == 1)
        return default_picture(stored_record(file, texts_member(*keys, "runs").front()));
    return parse_picture(toml_lines(*keys), "picture", "picture", stored_study(file));
}

HttpAnswer answer_figure(PageParts& parts, const PageCall& call) {
    const ResultFile file = present_results(parts.session);
    const ResultPicture made = make_picture(asked_picture(parts.session, file, call.body), file);
    return json_answer({{"figure", figure_json(made.figure)},
                        {"table", made.table.rows() > 0 ? table_json("", made.table) : nlohmann::json()}});
}

HttpAnswer answer_special_points(PageParts& parts, const PageCall& call) {
    const std::string& run = call.query("run");
    return json_answer(special_points_json(present_results(parts.session), run));
}

Table table_of_rows(ResultTable given) {
    constexpr std::size_t most_cells = 10'000'000;
    std::vector<Table::Column> columns;
    for (std::size_t c = 0; c < given.rows.columns(); ++c)
        columns.push_back({given.rows.column_name(c), given.units[c]});
    Table table(columns);
    while (given.rows.next()) {
        if (table.rows() * columns.size() > most_cells)
            throw RefusedRequest(413, "the table is too long for a page", "export it into a file instead");
        for (std::size_t c = 0; c < columns.size(); ++c)
            if (given.rows.is_text(c))
                table.add(given.rows.text(c));
            else
                table.add_extended(given.rows.is_null(c) ? std::nan("") : given.rows.number(c));
    }
    return table;
}

HttpAnswer answer_table(PageParts& parts, const PageCall& call) {
    const std::string wanted = call.has_query("samples") ? call.query("samples") : "0";
    if (wanted != "0" && wanted != "1")
        throw InputError("'samples' of the address is neither 0 nor 1", "say 1 for samples, 0 for points");
    const ResultFile file = present_results(parts.session);
    const RunRecord record = stored_record(file, call.query("run"));
    const bool samples = wanted == "1";
    ResultTableRequest request;
    request.what = !samples ? "points" : record.is_branch() ? "segments" : "samples";
    request.runs = {record.name};
    HttpAnswer answer;
    answer.type = "text/csv; charset=utf-8";
    answer.body = csv_text(table_of_rows(result_table(file, request)));
    // The names of runs are safe as names of files.
    answer.headers.emplace_back("Content-Disposition", fmt::format("attachment; filename=\"{}.csv\"", record.name));
    return answer;
}

} // namespace

std::vector<PageRoute> reading_routes() {
    return {{"GET", "/session", answer_session},
            {"GET", "/runs", answer_runs},
            {"GET", "/pictures", answer_pictures},
            {"POST", "/figure", answer_figure, {"name", "picture"}},
            {"GET", "/points", answer_special_points, {"run"}},
            {"GET", "/table", answer_table, {"run", "samples"}}};
}

} // namespace graze
