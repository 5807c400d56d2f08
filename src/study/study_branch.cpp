#include "graze/base/file_name.hpp"
#include "graze/base/with_place.hpp"
#include "graze/model/named_value.hpp"
#include "study/run_forms.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <tuple>

namespace graze {

namespace {

/// Returns the names along which branches may be followed.
std::vector<std::string> names_with_conserved(const Model& model) {
    std::vector<std::string> names = model.independent_parameters();
    for (const ConservedQuantity& one : model.conserved)
        names.push_back(one.name);
    return names;
}

ParameterId parameter_named(const StudyReader& reader, const Model& model, const TomlEntry& entry,
                            const std::string& name) {
    const auto place = model.find_independent_parameter(name);
    if (!place && !model.find_parameter(name) && (name == "period" || find_named(model.conserved, name)))
        reader.fail(entry, fmt::format("'{}' is no parameter of the model", name),
                    fmt::format("name a parameter here: runs of kind continue and curve take '{}', as one of the names "
                                "in `along`",
                                name));
    if (!place)
        reader.fail(entry,
                    model.find_parameter(name) ? fmt::format("parameter '{}' follows from others", name)
                                               : fmt::format("the model has no parameter '{}'", name),
                    study_name_remedy(name, names_with_conserved(model)));
    return *place;
}

} // namespace

void read_free(const StudyReader& reader, StudyRun& run, const TomlEntry& entry) {
    BranchSettings& settings = run.branch().settings;
    if (!entry.node->is_table()) {
        for (const std::string& name : reader.strings(entry))
            settings.free.push_back(parameter_named(reader, run.model, entry, name));
        return;
    }
    reader.each_of(entry, {}, [&](const TomlEntry& item) {
        const ParameterId parameter = parameter_named(reader, run.model, item, item.name);
        const auto [least, greatest] = reader.range(run.model, item);
        settings.free.push_back(parameter);
        settings.free_bounds.push_back({parameter, least, greatest});
    });
}

namespace {

/// Reads the coordinate of a family: a conserved quantity, or the period. @return whether the name is one
bool read_family(StudyRun& run, const std::string& name) {
    const bool is_conserved = find_named(run.model.conserved, name).has_value();
    if (run.model.find_parameter(name) || (!is_conserved && name != "period"))
        return false;
    run.branch().settings.family = FamilyCoordinate{is_conserved ? name : ""};
    return true;
}

/// Reads both parameters of a curve; the second one is the first free parameter, before those of `free`.
void read_plane(const StudyReader& reader, StudyRun& run, const TomlEntry& entry) {
    BranchSettings& settings = run.branch().settings;
    const auto items = reader.toml().entries(reader.toml().table(entry), entry.path);
    if (items.size() != 2)
        reader.fail(entry, fmt::format("{} names {} parameters", entry.path, items.size()),
                    "name the two of the curve: along = { omega = [0, 3], V = [0, 1] }");
    std::size_t parameters = 0;
    reader.each(items, [&](const TomlEntry& item) {
        const auto [least, greatest] = reader.range(run.model, item);
        if (!settings.family && read_family(run, item.name)) {
            std::tie(settings.family_least, settings.family_greatest) = std::pair(least, greatest);
            return;
        }
        const ParameterId parameter = parameter_named(reader, run.model, item, item.name);
        if (parameters++ == 0) {
            settings.parameter = parameter;
            std::tie(settings.least, settings.greatest) = std::pair(least, greatest);
        } else {
            settings.free.push_back(parameter);
            settings.free_bounds.push_back({parameter, least, greatest});
        }
    });
}

} // namespace

void read_along(const StudyReader& reader, StudyRun& run, const TomlEntry& entry) {
    BranchSettings& settings = run.branch().settings;
    if (run.kind == RunKind::curve)
        return read_plane(reader, run, entry);
    const auto read_name = [&](const TomlEntry& item, const std::string& name) {
        if (run.kind != RunKind::follow || !read_family(run, name))
            settings.parameter = parameter_named(reader, run.model, item, name);
    };
    if (entry.node->is_string())
        return read_name(entry, reader.toml().string(entry));
    const auto items = reader.toml().entries(reader.toml().table(entry), entry.path);
    if (items.size() != 1)
        reader.fail(entry, fmt::format("{} names {} parameters", entry.path, items.size()),
                    "name the one that is followed: along = { V = [0, 1] }; `free` names further ones");
    read_name(items[0], items[0].name);
    const auto [least, greatest] = reader.range(run.model, items[0]);
    settings.least = least;
    settings.greatest = greatest;
}

void read_stop(const StudyReader& reader, StudyRun& run, const TomlEntry& entry) {
    const std::vector<std::string> known = short_names_of_points(&PointKind::may_stop);
    for (const std::string& name : reader.strings(entry)) {
        const auto type = point_type(name);
        if (!type || std::find(known.begin(), known.end(), name) == known.end())
            reader.fail(entry, fmt::format("there is no type of point '{}'", name), study_name_remedy(name, known));
        run.branch().settings.stop_at.push_back(*type);
    }
}

namespace {

/// Reads what a monitor measures: KIND = "EXPRESSION", or duration = "SEGMENT".
void read_monitor_kind(const StudyReader& reader, const Model& model, const TomlEntry& item, Monitor& monitor) {
    const std::vector<std::string>& kinds = monitor_kinds();
    monitor.kind = static_cast<Monitor::Kind>(std::find(kinds.begin(), kinds.end(), item.name) - kinds.begin());
    if (monitor.kind == Monitor::Kind::multiplier) {
        monitor.unit = "";
        monitor.place = reader.count(item, 1);
        return;
    }
    if (monitor.kind == Monitor::Kind::conserved) {
        const std::string quantity = reader.toml().string(item);
        with_place(item.place, [&] {
            const Monitor conserved = monitor_of_conserved(model, quantity);
            monitor.unit = conserved.unit;
            monitor.expression = conserved.expression;
            monitor.in_modes = conserved.in_modes;
        });
        return;
    }
    if (monitor.kind == Monitor::Kind::duration) {
        const std::string segment =
            item.node->is_integer() ? std::to_string(reader.count(item, 1)) : reader.toml().string(item);
        monitor.segment = segment == "period" ? "" : segment;
        monitor.unit = model.time_unit;
        return;
    }
    const NamedValue value = named_value(model, reader.toml().string(item), reader.inside(item));
    monitor.expression = value.value;
    monitor.unit = value.unit;
}

Monitor read_monitor(const StudyReader& reader, const Model& model, const TomlEntry& entry) {
    Monitor monitor;
    require_plain_line(entry.name, "name of a monitor", entry.place);
    monitor.name = entry.name;
    monitor.unit = model.time_unit;
    if (entry.node->is_string()) {
        reader.choice(entry, {"period"});
        return monitor;
    }
    std::size_t kinds = 0;
    const auto read = [&](const TomlEntry& item) {
        if (item.name == "at") {
            monitor.segment =
                item.node->is_integer() ? std::to_string(reader.count(item, 1)) : reader.toml().string(item);
        } else if (item.name == "fixed") {
            monitor.fixed = !item.node->is_boolean() || reader.toml().boolean(item);
            if (!item.node->is_boolean())
                monitor.held = reader.number(model, item);
        } else if (item.name == "report") {
            const auto values = item.node->is_array() ? reader.toml().elements(item) : std::vector<TomlEntry>{item};
            for (const TomlEntry& value : values)
                monitor.crossings.push_back(reader.number(model, value));
        } else if (item.name == "bounds") {
            const auto [least, greatest] = reader.range(model, item);
            monitor.least = least;
            monitor.greatest = greatest;
        } else {
            ++kinds;
            read_monitor_kind(reader, model, item, monitor);
        }
    };
    reader.each_of(entry,
                   {"value", "start", "duration", "maximum", "minimum", "mean", "norm", "multiplier", "conserved", "at",
                    "fixed", "report", "bounds"},
                   read);
    if (kinds != 1)
        reader.fail(entry, fmt::format("{} is measured in {} ways", entry.path, kinds),
                    "give one of value, start, duration, maximum, minimum, mean, norm, multiplier or conserved");
    const bool has_segment = !monitor.segment.empty();
    if (has_segment && monitor.kind == Monitor::Kind::multiplier)
        reader.fail(entry, fmt::format("{} has `at`, and multipliers are those of the whole orbit", entry.path),
                    "leave it out");
    if (has_segment && monitor.kind == Monitor::Kind::conserved)
        reader.fail(entry, fmt::format("{} has `at`, and is the same everywhere on the orbit", entry.path),
                    "leave it out");
    return monitor;
}

} // namespace

void read_monitors(const StudyReader& reader, StudyRun& run, const TomlEntry& entry) {
    std::vector<Monitor>& monitors = run.branch().settings.monitors;
    monitors.clear();
    reader.each_of(entry, {},
                   [&](const TomlEntry& item) { monitors.push_back(read_monitor(reader, run.model, item)); });
}

const std::vector<std::string>& monitor_kinds() {
    static const std::vector<std::string> kinds{"value", "start", "duration",   "maximum",  "minimum",
                                                "mean",  "norm",  "multiplier", "conserved"};
    return kinds;
}

std::vector<Monitor> usual_monitors(const Model& model, RunKind kind) {
    std::vector<Monitor> monitors;
    Monitor& period = monitors.emplace_back();
    period.name = "period";
    period.unit = model.time_unit;
    for (const State& state : model.states)
        if (!state.period && !state.drifting) {
            Monitor& greatest = monitors.emplace_back();
            greatest.name = "max_" + state.name;
            greatest.unit = state.unit;
            greatest.kind = Monitor::Kind::maximum;
            greatest.expression = model.symbol(state.name);
        }
    for (const ConservedQuantity& one : model.conserved)
        monitors.push_back(monitor_of_conserved(model, one.name));
    if (kind == RunKind::torus)
        std::erase_if(monitors, [](const Monitor& monitor) { return !is_extreme(monitor); });
    return monitors;
}

namespace {

/// True when a text cannot name a point since it has another meaning where points are asked for.
bool is_taken(const std::string& name) {
    return is_point_label(name) || point_type(name) || name.find(':') != std::string::npos ||
           name.find_first_not_of("0123456789") == std::string::npos;
}

} // namespace

void read_point_names(const StudyReader& reader, StudyRun& run, const TomlEntry& entry) {
    reader.each_of(entry, {}, [&](const TomlEntry& item) {
        if (!is_point_label(item.name))
            reader.fail(item, fmt::format("no point has the label '{}'", item.name),
                        "name points by their labels: point_names = { GR1 = \"G-1\" }; graze points lists them");
        const std::string name = reader.toml().line(item);
        if (is_taken(name))
            reader.fail(item, fmt::format("'{}' cannot be told from a label, a type, a number or a run's point", name),
                        "call the point something else, such as \"G-1\"");
        for (const PointName& other : run.point_names)
            if (other.name == name)
                reader.fail(item, fmt::format("{} is called '{}' too", other.label, name),
                            "give each point a name of its own");
        run.point_names.push_back({item.name, name});
    });
}

void note_set(const StudyReader& reader, StudyRun& run, const TomlEntry& entry) {
    for (const TomlEntry& item : reader.toml().entries(reader.toml().table(entry), entry.path))
        if (const auto place = run.model.find_independent_parameter(item.name))
            run.set.push_back(*place);
}

void read_signature(const StudyReader& reader, StudyRun& run, const TomlEntry& entry) {
    run.branch().signature = reader.toml().string(entry);
    run.branch().signature_place = reader.inside(entry);
    parse_signature(run.model, run.branch().signature, run.branch().signature_place);
}

void read_orbit_table(const StudyReader& reader, StudyRun& run, const TomlEntry& entry) {
    const std::filesystem::path path = reader.toml().string(entry);
    run.branch().table =
        (path.is_relative() ? std::filesystem::path(reader.file()).parent_path() / path : path).string();
}

namespace {

/// Adds what varies along a family to the monitors, which are columns of the results. The period is one anyway.
void add_coordinate(BranchSettings& settings, const Model& model) {
    if (!settings.family || settings.family->conserved.empty())
        return;
    const std::string& name = settings.family->conserved;
    std::vector<Monitor>& monitors = settings.monitors;
    if (std::ranges::find(monitors, name, &Monitor::name) == monitors.end())
        monitors.push_back(monitor_of_conserved(model, name));
    const auto coordinate = std::ranges::find(monitors, name, &Monitor::name);
    std::rotate(monitors.begin(), coordinate, coordinate + 1); // it comes first
}

} // namespace

void complete_branch(StudyRun& run, const RunKeys& keys) {
    BranchRequest& branch = run.branch();
    branch.settings.continuation.accuracy = branch.settings.orbit.accuracy;
    add_coordinate(branch.settings, run.model);
    branch.every_mode = !branch.within.empty() && !keys.contains("mode");
    if (keys.contains("tolerance"))
        branch.set_tolerance(branch.simulation.tolerance);
}

void check_branch(const StudyReader& reader, const StudyRun& run, const TomlEntry& entry, const RunKeys& keys) {
    const BranchRequest& branch = run.branch();
    if (run.kind == RunKind::curve && !run.start)
        throw InputError(entry.place, fmt::format("{} does not say where the curve begins", entry.path),
                         "give start = { run = \"BRANCH\", point = \"SN1\" }");
    if (run.kind == RunKind::ladder && (!run.start || run.start->point.empty()))
        throw InputError(entry.place, fmt::format("{} does not say at which point the ladder begins", entry.path),
                         "give start = { run = \"BRANCH\", point = \"GR1\" }");
    if (run.kind == RunKind::torus && (!run.start || run.start->point.empty()))
        throw InputError(entry.place, fmt::format("{} does not say at which point the tori begin", entry.path),
                         "give start = { run = \"BRANCH\", point = \"NS1\" }");
    if (run.is_followed() && !keys.contains("along"))
        throw InputError(entry.place, fmt::format("{} does not say what is followed", entry.path),
                         run.kind == RunKind::curve
                             ? "give along = { PARAMETER = [LEAST, GREATEST], OTHER = [LEAST, GREATEST] }"
                             : "give along = { PARAMETER = [LEAST, GREATEST] }");
    if (run.kind == RunKind::torus)
        for (const Monitor& monitor : branch.settings.monitors)
            if (!is_extreme(monitor) || monitor.fixed || !monitor.crossings.empty() || monitor.least ||
                monitor.greatest)
                reader.fail(
                    keys.at("monitors"),
                    fmt::format("monitor '{}' is not just a maximum or minimum, and tori have no others", monitor.name),
                    "give { maximum = \"q\" } or { minimum = \"q\" }");
    if (!run.is_followed())
        for (const Monitor& monitor : branch.settings.monitors)
            if (monitor.fixed || !monitor.crossings.empty() || monitor.least || monitor.greatest)
                reader.fail(keys.at("monitors"),
                            fmt::format("monitor '{}' is fixed, reported or bounded, and a run of kind \"{}\" "
                                        "follows nothing",
                                        monitor.name, name_of(run.kind)),
                            "leave that out, or choose kind = \"continue\"");
    with_place(
        entry.place,
        [&] {
            branch.validate(run.kind, run.model);
            if (!run.start && !branch.has_table() && branch.signature.empty() && run.kind != RunKind::equilibrium)
                branch.attractor.validate(run.model);
        },
        entry.path + ": ");
}

} // namespace graze
