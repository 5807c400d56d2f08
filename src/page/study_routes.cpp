#include "graze/base/input_errors.hpp"
#include "graze/model/catalogue.hpp"
#include "graze/model/model_file.hpp"
#include "graze/results/run_kind.hpp"
#include "graze/study/study_schema.hpp"
#include "page/error_answer.hpp"
#include "page/page_route.hpp"
#include "page/proposed_run.hpp"
#include "page/request_json.hpp"
#include "page/stored_subject.hpp"
#include "page/toml_value.hpp"
#include "symbolic/vocabulary.hpp"

#include <fmt/format.h>

#include <filesystem>

namespace graze {

namespace {

/// @param own path of the text's file: a mistake with another one is not in the text
nlohmann::json mistake_json(const InputError& error, const std::string& own) {
    return {{"problem", error.problem()},
            {"remedy", error.remedy()},
            {"file", error.place().file == own ? "" : error.place().file},
            {"line", error.place().line},
            {"column", error.place().column}};
}

nlohmann::json mistakes_json(const std::vector<InputError>& errors, const std::string& own) {
    nlohmann::json list = nlohmann::json::array();
    for (const InputError& error : errors)
        list.push_back(mistake_json(error, own));
    return list;
}

nlohmann::json study_json(const PageParts& parts, const StudyText& text) {
    return {{"text", text.text},         {"name", text.file},
            {"revision", text.revision}, {"saved", text.saved},
            {"has_file", text.has_file}, {"errors", mistakes_json(text.errors, parts.session.studied_file())}};
}

HttpAnswer answer_check(PageParts& parts, const PageCall& call) {
    const std::string kind = text_member(call.body, "kind"), text = text_member(call.body, "text");
    if (kind != "model" && kind != "study")
        throw InputError(fmt::format("there is no kind '{}' of text", kind), "say model or study");
    nlohmann::json runs = nlohmann::json::array(), errors = nlohmann::json::array();
    const std::string own = kind == "model" ? "model" : parts.session.studied_file();
    try {
        if (kind == "model")
            parse_model(text, own);
        else
            for (const StudyRun& run : parts.session.read(text).runs)
                runs.push_back(run.name);
    } catch (const InputErrors& all) {
        errors = mistakes_json(all.all(), own);
    } catch (const InputError& error) {
        errors = mistakes_json({error}, own);
    }
    return json_answer({{"errors", errors}, {"runs", runs}});
}

HttpAnswer answer_schema(PageParts&, const PageCall&) {
    HttpAnswer answer;
    answer.body = study_schema();
    return answer;
}

HttpAnswer answer_words(PageParts&, const PageCall&) {
    nlohmann::json functions = nlohmann::json::array();
    for (const FunctionName& function : function_names())
        functions.push_back(function.name);
    return json_answer({{"functions", functions},
                        {"models", shipped_models()},
                        {"run_kinds", kinds_of_runs()},
                        {"model_keys", model_keys()}});
}

HttpAnswer answer_study(PageParts& parts, const PageCall&) {
    return json_answer(study_json(parts, parts.session.text()));
}

HttpAnswer keep_study(PageParts& parts, const PageCall& call) {
    StudySaving saving;
    saving.save = flag_member(call.body, "save", false);
    saving.file = text_member(call.body, "file", "");
    saving.replace = flag_member(call.body, "replace", false);
    const std::size_t before = count_member(call.body, "revision");
    const StudyText kept = parts.session.keep(text_member(call.body, "text"), before, saving);
    if (kept.revision != before)
        parts.events.tell("study", {{"revision", kept.revision}});
    return json_answer(study_json(parts, kept));
}

/// The parameters of a proposal, in their order, with other bounds if there are any.
void read_along(const std::string& request, ProposalWish& wish) {
    // In objects of nlohmann::json members are sorted.
    const nlohmann::ordered_json body = nlohmann::ordered_json::parse(request);
    const auto found = body.find("along");
    if (found == body.end() || found->is_null())
        return;
    const auto refuse = [] {
        throw InputError("'along' of the request is not understood",
                         "give names of parameters, or an object of [least, greatest] by name");
    };
    if (!found->is_structured())
        refuse();
    for (const auto& [key, value] : found->items()) {
        if (found->is_array()) {
            if (!value.is_string())
                refuse();
            wish.along.push_back(value.get<std::string>());
            continue;
        }
        wish.along.push_back(key);
        if (value.is_null())
            continue;
        if (!value.is_array() || value.size() != 2 || !value[0].is_number() || !value[1].is_number())
            refuse();
        wish.bounds[key] = {value[0].get<double>(), value[1].get<double>()};
    }
}

/// The beginning of a new run of the opened model, or of the model of a run.
/// @param named whether the study names the opened model for all runs
PointOrigin origin_of_model(const StudySession& session, const Study& study, const std::string& run, bool named) {
    PointOrigin origin = point_origin(model_of_run(session, run));
    if (const StudyRun* known = study.find_run(run)) {
        origin.asked.model = known->model;
        origin.asked.model_path = known->model_path;
    } else if (const std::string& path = session.subject().path; run.empty() && !named && !path.empty()) {
        origin.asked.model_path = std::filesystem::absolute(path).string();
    }
    return origin;
}

HttpAnswer propose_run(PageParts& parts, const PageCall& call) {
    ProposalWish wish;
    wish.action = text_member(call.body, "action");
    read_along(call.http.body, wish);
    const nlohmann::json options = object_member(call.body, "options");
    for (const auto& [key, value] : options.items())
        if (!value.is_null())
            wish.options[key] = toml_value(value);
    wish.study_model = study_model_of(parts.session.text().text);
    const std::string run = text_member(call.body, "run", "");
    const auto file = parts.session.results();
    const bool at_point = !run.empty() && call.body.contains("number") && !call.body["number"].is_null();
    std::shared_ptr<const Study> study = parts.session.study();
    if (at_point || (file && !run.empty()))
        study = study_with_run(parts.session, file ? *file : present_results(parts.session), run);
    const PointOrigin origin = at_point ? point_origin(*file, *study, run, count_member(call.body, "number"))
                                        : origin_of_model(parts.session, *study, run, !wish.study_model.empty());
    const ProposedRun proposed = proposed_run(origin, *study, file ? &*file : nullptr, wish);
    return json_answer({{"name", proposed.name}, {"text", proposed.text}});
}

} // namespace

std::vector<PageRoute> study_routes() {
    return {{"POST", "/check", answer_check, {"kind", "text"}},
            {"GET", "/schema", answer_schema},
            {"GET", "/words", answer_words},
            {"GET", "/study", answer_study},
            {"PUT", "/study", keep_study, {"text", "revision", "save", "file", "replace"}},
            {"POST", "/propose", propose_run, {"run", "number", "action", "along", "options"}}};
}

} // namespace graze
