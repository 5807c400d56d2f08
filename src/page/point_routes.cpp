#include "graze/model/model_file.hpp"
#include "page/error_answer.hpp"
#include "page/grazing_json.hpp"
#include "page/model_json.hpp"
#include "page/motion_json.hpp"
#include "page/page_route.hpp"
#include "page/point_actions.hpp"
#include "page/point_json.hpp"
#include "page/request_json.hpp"
#include "page/simulation_json.hpp"
#include "page/stored_subject.hpp"
#include "page/trip_json.hpp"

namespace graze {

namespace {

/// Whether nobody waits for an answer any more.
std::function<bool()> interrupted_by(const PageParts& parts, const PageCall& call) {
    return [&parts, &call] { return parts.stopping || (call.http.has_left && call.http.has_left()); };
}

HttpAnswer answer_point(PageParts& parts, const PageCall& call) {
    const std::string& run = call.query("run");
    const std::size_t number = count_of(call.query("number"), "number");
    const StoredRun stored(present_results(parts.session), run, {});
    nlohmann::json answer = point_json(stored, number);
    answer["actions"] = nlohmann::json::array();
    if (parts.session.can_compute())
        answer["actions"] =
            actions_json(actions_at(point_origin(stored, *study_with_run(parts.session, stored.file, run), number)));
    return json_answer(answer);
}

/// The point that the body of a request names.
struct NamedPoint {
    explicit NamedPoint(const PageCall& call)
        : run(text_member(call.body, "run")), number(count_member(call.body, "number")) {}
    std::string run;
    std::size_t number;
};

HttpAnswer answer_motion(PageParts& parts, const PageCall& call) {
    const NamedPoint point(call);
    const std::vector<std::string> names = texts_member(call.body, "names");
    return json_answer(
        motion_json(present_results(parts.session), point.run, point.number, names, interrupted_by(parts, call)));
}

HttpAnswer answer_model(PageParts& parts, const PageCall& call) {
    const std::string run = call.has_query("run") ? call.query("run") : "";
    const Model model = model_of_run(parts.session, run);
    const auto opened = run.empty() ? parts.session.model_text() : std::nullopt;
    nlohmann::json answer = model_json(model, opened ? opened->text : "");
    if (opened && !opened->file.empty()) {
        answer["file"] = opened->file;
        answer["revision"] = opened->revision;
    }
    answer["actions"] = nlohmann::json::array();
    if (run.empty() && parts.session.can_compute())
        answer["actions"] = actions_json(actions_at(point_origin(model)));
    return json_answer(answer);
}

/// What a text of a model describes, which no file has yet.
HttpAnswer answer_model_text(PageParts&, const PageCall& call) {
    const std::string text = text_member(call.body, "text");
    nlohmann::json answer = model_json(parse_model(text, "model"), text);
    answer["actions"] = nlohmann::json::array();
    return json_answer(answer);
}

HttpAnswer keep_model(PageParts& parts, const PageCall& call) {
    const std::size_t before = parts.session.text().revision;
    const ModelText kept = parts.session.keep_model(text_member(call.body, "text"), count_member(call.body, "revision"),
                                                    flag_member(call.body, "replace", false));
    if (const std::size_t now = parts.session.text().revision; now != before)
        parts.events.tell("study", {{"revision", now}});
    return json_answer({{"text", kept.text}, {"file", kept.file}, {"revision", kept.revision}});
}

/// Values by name; values of other types are refused.
std::map<std::string, double> numbers_member(const nlohmann::json& request, const char* name) {
    std::map<std::string, double> numbers;
    const nlohmann::json members = object_member(request, name);
    for (const auto& [member, value] : members.items())
        numbers[member] = number_member(members, member.c_str());
    return numbers;
}

HttpAnswer answer_simulation(PageParts& parts, const PageCall& call) {
    const std::string text = text_member(call.body, "text", ""), run = text_member(call.body, "run", "");
    if (!text.empty() && !run.empty())
        throw InputError("the request has both a run and the text of a model", "give one of them");
    const Model model = text.empty() ? model_of_run(parts.session, run) : parse_model(text, "model");
    SimulationWish wish;
    wish.parameters = numbers_member(call.body, "parameters");
    wish.initial = numbers_member(call.body, "initial");
    if (call.body.contains("duration") && !call.body["duration"].is_null())
        wish.duration = number_member(call.body, "duration");
    wish.mode = text_member(call.body, "mode", "");
    wish.names = texts_member(call.body, "names");
    wish.interrupted = interrupted_by(parts, call);
    return json_answer(simulation_json(model, wish));
}

HttpAnswer answer_grazing(PageParts& parts, const PageCall& call) {
    const NamedPoint point(call);
    return json_answer(grazing_json(present_results(parts.session), point.run, point.number));
}

HttpAnswer answer_trip(PageParts& parts, const PageCall& call) {
    const nlohmann::json options = object_member(call.body, "options");
    require_known_members(options, {"parameter", "overshoots", "until", "cycles"});
    TripWish wish;
    wish.parameter = text_member(options, "parameter", "");
    wish.overshoots = texts_member(options, "overshoots");
    wish.until = text_member(options, "until", "");
    if (options.contains("cycles") && !options["cycles"].is_null())
        wish.cycles = number_member(options, "cycles");
    wish.interrupted = interrupted_by(parts, call);
    const NamedPoint point(call);
    return json_answer(trip_json(present_results(parts.session), point.run, point.number, wish));
}

} // namespace

std::vector<PageRoute> point_routes() {
    return {
        {"GET", "/point", answer_point, {"run", "number"}},
        {"POST", "/motion", answer_motion, {"run", "number", "names"}},
        {"GET", "/model", answer_model, {"run"}},
        {"POST", "/model", answer_model_text, {"text"}},
        {"PUT", "/model", keep_model, {"text", "revision", "replace"}},
        {"POST", "/simulate", answer_simulation, {"run", "text", "parameters", "initial", "mode", "duration", "names"}},
        {"POST", "/grazing", answer_grazing, {"run", "number"}},
        {"POST", "/trip", answer_trip, {"run", "number", "options"}}};
}

} // namespace graze
