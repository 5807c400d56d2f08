#include "study/study_reader.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

namespace graze {

namespace {

/// Kinds of runs, as bits.
enum Kinds : unsigned {
    simulate = 1u << static_cast<unsigned>(RunKind::simulate),
    sweep = 1u << static_cast<unsigned>(RunKind::sweep),
    basin = 1u << static_cast<unsigned>(RunKind::basin),
    orbit = 1u << static_cast<unsigned>(RunKind::orbit),
    follow = 1u << static_cast<unsigned>(RunKind::follow),
    curve = 1u << static_cast<unsigned>(RunKind::curve),
    ladder = 1u << static_cast<unsigned>(RunKind::ladder),
    record = 1u << static_cast<unsigned>(RunKind::record),
    identify = 1u << static_cast<unsigned>(RunKind::identify),
    followed = follow | curve,
    points = simulate | sweep | basin, ///< those whose points are motions
    branches = orbit | follow,         ///< that may begin by themselves
    settling = sweep | basin | branches,
    at_will = points | branches | curve, ///< at other parameters than where they start
    simulated = at_will | ladder,
    measured = record | identify,
    every = simulated | measured,
};

struct Key {
    const char* name;
    unsigned kinds; ///< that use it
};

/// Which kinds of runs use a key: no other may have it.
constexpr std::array keys_of_runs{
    Key{"kind", every},
    Key{"text", every},
    Key{"model", every},
    Key{"set", at_will | measured},
    Key{"from", points | branches | measured},
    Key{"mode", points | branches | measured},
    Key{"start", simulated},
    Key{"parameters", at_will | identify},
    Key{"section", points | branches},
    Key{"bounds", points | branches},
    Key{"tolerance", simulated | identify},
    Key{"order", points | branches},
    Key{"largest_step", points | branches},
    Key{"vary", points | record},
    Key{"draws", points},
    Key{"seed", points | record},
    Key{"sample", points | record},
    Key{"values", points | record},
    Key{"time", simulate},
    Key{"periods", simulate},
    Key{"contacts", simulate},
    Key{"skip", simulate},
    Key{"events", simulate},
    Key{"greatest_speed", simulate},
    Key{"carry", sweep | record},
    Key{"direction", sweep | followed | record},
    Key{"keep", sweep | basin | record},
    Key{"cycles", settling},
    Key{"largest_period", settling},
    Key{"recurrence", settling},
    Key{"disturbance", settling},
    Key{"longest_return", settling},
    Key{"lyapunov_cycles", sweep | basin},
    Key{"chaos_cycles", sweep | basin},
    Key{"signature", branches},
    Key{"table", branches},
    Key{"monitors", orbit | followed | ladder},
    Key{"accuracy", orbit | followed | ladder},
    Key{"along", followed | ladder},
    Key{"steps", followed | ladder},
    Key{"stop", followed},
    Key{"step", followed | ladder},
    Key{"rungs", ladder},
    Key{"grazing", followed | ladder},
    Key{"point_names", followed | ladder},
    Key{"free", followed},
    Key{"unphysical", orbit | followed},
    Key{"files", record},
    Key{"bench", record},
    Key{"channels", record},
    Key{"columns", record},
    Key{"group", record},
    Key{"lines", record},
    Key{"scale", record},
    Key{"part", record},
    Key{"every", record},
    Key{"filter", record},
    Key{"derivative", record},
    Key{"reference", record},
    Key{"coordinate", record},
    Key{"what", identify},
    Key{"records", identify},
    Key{"gives", identify},
    Key{"channel", identify},
    Key{"displacement", identify},
    Key{"voltage", identify},
    Key{"current", identify},
    Key{"peaks", identify},
    Key{"window", identify},
    Key{"transition", identify},
    Key{"least_jump", identify},
    Key{"gap", identify},
    Key{"stiffness", identify},
    Key{"beta1", identify},
    Key{"beta2", identify},
    Key{"clamped", identify},
    Key{"frequency", identify},
    Key{"noise", identify},
    Key{"unknowns", identify},
    Key{"readings", identify},
    Key{"known", identify},
    Key{"loss", identify},
    Key{"piece", identify},
};

/// Keys of runs of orbits that say how simulation settles on one.
constexpr std::array of_settling{"section",    "bounds",      "cycles",        "largest_period",
                                 "recurrence", "disturbance", "longest_return"};
constexpr std::array of_integration{"order", "largest_step"};
/// Keys of runs of records that say what a virtual bench does.
constexpr std::array of_bench{"model", "set", "from", "mode", "vary", "direction", "carry", "seed"};

template <class Names>
void refuse_any(const StudyReader& reader, const RunKeys& keys, const Names& names, const std::string& why,
                const std::string& remedy) {
    Mistakes mistakes;
    for (const char* name : names)
        with_key(mistakes, keys, name, [&](const TomlEntry& entry) {
            reader.fail(entry, fmt::format("`{}` has no effect here: {}", name, why), remedy);
        });
    mistakes.throw_noted();
}

/// What is never settled on an orbit, or never integrated, has no settings for it.
void check_unused(const StudyReader& reader, RunKind kind, const RunKeys& keys) {
    const std::string leave = "leave it out";
    if (keys.contains("signature") || keys.contains("table"))
        refuse_any(reader, keys, of_settling, "no orbit is settled on", leave);
    if (kind == RunKind::orbit && keys.contains("unphysical") && !keys.contains("signature"))
        reader.fail(keys.at("unphysical"),
                    "`unphysical` has no effect here: nothing is followed, and no signature given", leave);
    if (keys.contains("table"))
        refuse_any(reader, keys, of_integration, "no motion leads to the orbit; `tolerance` is that of the orbit",
                   leave);
}

/// Several keys say where a run begins; all but one would be ignored.
void check_beginning(const StudyReader& reader, RunKind kind, const RunKeys& keys) {
    Mistakes mistakes;
    const auto refuse = [&](const char* key, const std::string& problem, const std::string& remedy) {
        mistakes.attempt([&] { reader.fail(keys.at(key), problem, remedy); });
    };
    const auto refuse_two = [&](const char* one, const char* other) {
        if (keys.contains(one) && keys.contains(other))
            refuse(other, fmt::format("`{}` has no effect here: the run has `{}`", other, one),
                   "leave one of them out");
    };
    if (kind == RunKind::simulate && keys.contains("sample")) {
        const bool periods = keys.contains("periods") || keys.contains("skip");
        if (keys.contains("section") && !periods)
            refuse("section", "`section` has no effect here: no periods are counted, and `sample` is given",
                   "leave it out");
    }
    if (keys.contains("events") && !keys.contains("contacts") && !keys.contains("greatest_speed"))
        refuse("events", "`events` has no effect here: it says which contacts count, and none are counted",
               "leave it out, or give `contacts` or `greatest_speed`");
    refuse_two("start", "from");
    refuse_two("start", "mode");
    refuse_two("start", "signature");
    refuse_two("start", "table");
    refuse_two("table", "from");
    refuse_two("table", "mode");
    if (kind == RunKind::orbit || kind == RunKind::follow || kind == RunKind::curve || kind == RunKind::ladder)
        mistakes.attempt([&] { check_unused(reader, kind, keys); });
    if (kind == RunKind::record && !keys.contains("bench"))
        mistakes.attempt(
            [&] { refuse_any(reader, keys, of_bench, "the records are files", "leave it out, or give `bench`"); });
    mistakes.throw_noted();
}

} // namespace

std::vector<std::string> run_keys() {
    std::vector<std::string> names;
    for (const Key& key : keys_of_runs)
        names.emplace_back(key.name);
    return names;
}

void check_keys_of_kind(const StudyReader& reader, RunKind kind, const RunKeys& keys) {
    Mistakes mistakes;
    for (const auto& [name, entry] : keys) {
        const auto* key = std::find_if(keys_of_runs.begin(), keys_of_runs.end(),
                                       [&, &name = name](const Key& one) { return name == one.name; });
        if (key->kinds & (1u << static_cast<unsigned>(kind)))
            continue;
        std::vector<std::string> kinds;
        for (unsigned k = 0; k < kinds_of_runs().size(); ++k)
            if (key->kinds & (1u << k))
                kinds.push_back(fmt::format("\"{}\"", name_of(static_cast<RunKind>(k))));
        with_key(mistakes, keys, key->name, [&](const TomlEntry& wrong) {
            reader.fail(wrong, fmt::format("runs of kind \"{}\" have no `{}`", name_of(kind), wrong.name),
                        fmt::format("leave it out; it belongs to {}", fmt::join(kinds, ", ")));
        });
    }
    mistakes.throw_noted();
    check_beginning(reader, kind, keys);
}

void check_keys_of_picture(const StudyReader& reader, const std::string& kind, const std::vector<TomlEntry>& keys) {
    const std::vector<std::pair<std::string, std::vector<std::string>>> of_kinds{
        {"fit", {"regression"}},
        {"group", {"regression"}},
        {"successive", {"regression"}},
        {"at", {"history", "portrait", "poincare", "spectrum"}},
        {"points", {"history", "portrait", "branch"}},
        {"over", {"bifurcation", "history", "portrait", "poincare"}},
    };
    reader.each(keys, [&](const TomlEntry& key) {
        for (const auto& [name, kinds] : of_kinds)
            if (!kind.empty() && key.name == name && std::find(kinds.begin(), kinds.end(), kind) == kinds.end())
                reader.fail(key, fmt::format("pictures of kind \"{}\" have no `{}`", kind, name),
                            fmt::format("leave it out; it belongs to {}", fmt::join(kinds, ", ")));
    });
}

namespace {

[[noreturn]] void fail_start(const StartFrom& start, const std::string& problem, const std::string& remedy) {
    throw InputError(start.place, problem, remedy);
}

/// Whether states, modes, transitions and parameters are the same, so that one's points mean the same to the other.
bool are_alike(const Model& one, const Model& other) {
    const auto labels = [](const Model& model) {
        std::vector<std::string> result;
        for (const Transition& transition : model.transitions)
            result.push_back(transition.label);
        return result;
    };
    return names_of(one.states) == names_of(other.states) && names_of(one.modes) == names_of(other.modes) &&
           names_of(one.parameters) == names_of(other.parameters) && labels(one) == labels(other);
}

} // namespace

void check_start(const StudyReader& reader, const StudyRun& run, const StudyRun& parent, const RunKeys& keys) {
    const StartFrom& start = *run.start;
    if (!are_alike(run.model, parent.model))
        fail_start(start,
                   fmt::format("run '{}' is of another model ('{}') than this one ('{}')", parent.name,
                               parent.model.name, run.model.name),
                   "start from a run of the same model");
    if (start.coordinate && !start.point.empty())
        fail_start(start, "both `at` and `point` say where to start", "leave one of them out");
    if (start.direction && !start.coordinate)
        fail_start(start, "`direction` chooses among the points nearest to `at`, which is not given",
                   "write at = { PARAMETER = VALUE }, or leave it out");
    if (start.direction && parent.kind != RunKind::sweep && !parent.is_followed())
        fail_start(start, fmt::format("runs of kind \"{}\" have no direction", name_of(parent.kind)), "leave it out");
    if (!start.onto.empty() && !(parent.is_branch() && run.is_branch()))
        fail_start(start, "`onto` chooses a branch, and leads from an orbit to an orbit", "leave it out");
    if (!parent.is_branch() && start.point.find_first_not_of("0123456789") != std::string::npos)
        fail_start(start, fmt::format("points of runs of kind \"{}\" have no labels", name_of(parent.kind)),
                   "give the point's number, or at = { PARAMETER = VALUE }");
    if (run.kind == RunKind::curve && !(parent.is_followed() && !start.point.empty()))
        fail_start(start, "a curve begins at a special point of a branch",
                   "give start = { run = \"BRANCH\", point = \"SN1\" }");
    const bool curve = run.kind == RunKind::curve, of_curves = point_type(start.onto).has_value();
    if (curve && !start.onto.empty() && (!of_curves || !run.branch.keeps_point()))
        fail_start(
            start,
            fmt::format("`onto = \"{}\"` has no effect here: a curve goes on along points of one kind", start.onto),
            run.branch.keeps_point() ? "leave it out, or name the kind, such as \"SN\"" : "leave it out");
    if (!curve && of_curves)
        fail_start(start, fmt::format("`onto = \"{}\"` chooses a curve, and this is none", start.onto),
                   "follow it with kind = \"curve\", or choose \"same\", \"other\" or \"twin\"");
    if (run.is_branch() && parent.is_branch()) {
        const std::string leave = "leave it out";
        refuse_any(reader, keys, of_settling, "no orbit is settled on", leave);
        refuse_any(reader, keys, of_integration, "no motion leads to the orbit; `tolerance` is that of the orbit",
                   leave);
    }
}

} // namespace graze
