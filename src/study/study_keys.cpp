#include "graze/base/require.hpp"
#include "study/key_list.hpp"
#include "study/run_description.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

namespace graze {

namespace {

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
    for (const char* other : {"from", "mode", "signature", "table", "within"})
        refuse_two("start", other);
    refuse_two("within", "from");
    for (const char* other : {"from", "mode"})
        refuse_two("table", other);
    if (is_branch(kind))
        mistakes.attempt([&] { check_unused(reader, kind, keys); });
    if (kind == RunKind::record && !keys.contains("bench"))
        mistakes.attempt(
            [&] { refuse_any(reader, keys, of_bench, "the records are files", "leave it out, or give `bench`"); });
    mistakes.throw_noted();
}

} // namespace

const std::vector<StudyKey>& study_keys(RunKind kind) {
    static const std::vector<std::vector<StudyKey>> of_kinds = [] {
        std::vector<std::vector<StudyKey>> all;
        for (std::size_t one = 0; one < kinds_of_runs().size(); ++one) {
            StudyRun run(static_cast<RunKind>(one));
            set_standards(run);
            KeyList list;
            describe(list, run);
            all.push_back(std::move(list.keys));
        }
        return all;
    }();
    const auto index = static_cast<std::size_t>(kind);
    require_index(index, of_kinds.size(), "kind of runs");
    return of_kinds[index];
}

const std::vector<std::string>& names_of_keys() {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> all;
        for (std::size_t kind = 0; kind < kinds_of_runs().size(); ++kind)
            for (const StudyKey& key : study_keys(static_cast<RunKind>(kind)))
                if (std::find(all.begin(), all.end(), key.name) == all.end())
                    all.push_back(key.name);
        return all;
    }();
    return names;
}

void check_keys_of_kind(const StudyReader& reader, RunKind kind, const RunKeys& keys) {
    const auto has = [](std::size_t of, const std::string& name) {
        const std::vector<StudyKey>& known = study_keys(static_cast<RunKind>(of));
        return std::any_of(known.begin(), known.end(), [&](const StudyKey& key) { return key.name == name; });
    };
    Mistakes mistakes;
    for (const auto& [name, entry] : keys) {
        if (has(static_cast<std::size_t>(kind), name))
            continue;
        std::vector<std::string> kinds;
        for (std::size_t other = 0; other < kinds_of_runs().size(); ++other)
            if (has(other, name))
                kinds.push_back(fmt::format("\"{}\"", kinds_of_runs()[other]));
        mistakes.attempt([&, &name = name, &entry = entry] {
            reader.fail(entry, fmt::format("runs of kind \"{}\" have no `{}`", name_of(kind), name),
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
    if (start.direction && !parent.is_swept() && !parent.is_followed())
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
    if (curve && !start.onto.empty() && (!of_curves || !run.branch().keeps_point()))
        fail_start(
            start,
            fmt::format("`onto = \"{}\"` has no effect here: a curve goes on along points of one kind", start.onto),
            run.branch().keeps_point() ? "leave it out, or name the kind, such as \"SN\"" : "leave it out");
    if (!curve && of_curves)
        fail_start(start, fmt::format("`onto = \"{}\"` chooses a curve, and this is none", start.onto),
                   "follow it with kind = \"curve\", or choose \"same\", \"other\", \"twin\" or \"homoclinic\"");
    if (run.is_branch() && parent.is_branch()) {
        const std::string leave = "leave it out";
        refuse_any(reader, keys, of_settling, "no orbit is settled on", leave);
        refuse_any(reader, keys, of_integration, "no motion leads to the orbit; `tolerance` is that of the orbit",
                   leave);
    }
}

} // namespace graze
