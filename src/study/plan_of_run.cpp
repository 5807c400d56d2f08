#include "graze/study/runner.hpp"
#include "graze/symbolic/require.hpp"
#include "graze/symbolic/text_file.hpp"
#include "graze/symbolic/transform.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <memory>

namespace graze {

namespace {

/// A number from three others that looks random (Steele, Lea and Flood 2014): any draw can be made by itself.
std::uint64_t mixed(std::uint64_t seed, std::uint64_t point, std::uint64_t axis) {
    const auto mix = [](std::uint64_t x) {
        x += 0x9e3779b97f4a7c15u;
        x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
        x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
        return x ^ (x >> 31);
    };
    return mix(mix(mix(seed) ^ point) ^ axis);
}

double drawn(const StudyRun& run, std::size_t axis, std::size_t point) {
    const Variation& variation = run.axes[axis];
    const double share = static_cast<double>(mixed(run.seed, point, axis) >> 11) * 0x1p-53;
    return variation.offset + (variation.logarithmic ? variation.low * std::pow(variation.high / variation.low, share)
                                                     : variation.low + share * (variation.high - variation.low));
}

/// Values along the first axis of a sweep, one way.
std::size_t sweep_length(const StudyRun& run) {
    return run.kind == RunKind::sweep ? run.axes.front().values.size() : 1;
}

std::size_t chain_length_of(const StudyRun& run) {
    return sweep_length(run) * (run.kind == RunKind::sweep && run.direction == SweepDirection::both ? 2 : 1);
}

/// Combinations of the axes' values that make chains.
std::size_t combinations(const StudyRun& run) {
    std::size_t count = 1;
    for (std::size_t a = run.kind == RunKind::sweep ? 1 : 0; a < run.axes.size(); ++a)
        count *= std::max<std::size_t>(run.axes[a].values.size(), 1);
    return count;
}

} // namespace

std::size_t direction_of(const StudyRun& run, std::size_t point) {
    require_index(point, points_of(run), "point");
    if (run.kind != RunKind::sweep)
        return 0;
    const bool second = point % chain_length_of(run) >= sweep_length(run);
    return run.direction == SweepDirection::both ? (second ? 1 : 0) : 0;
}

std::vector<double> coordinates_of(const StudyRun& run, std::size_t point) {
    require_index(point, points_of(run), "point");
    const std::size_t length = chain_length_of(run), chain = point / length, index = point % length;
    std::vector<double> coordinates(run.axes.size());
    std::size_t rest = chain % combinations(run);
    for (std::size_t a = run.axes.size(); a-- > 0;) {
        const Variation& axis = run.axes[a];
        if (axis.values.empty()) {
            coordinates[a] = drawn(run, a, point);
        } else if (a == 0 && run.kind == RunKind::sweep) {
            const std::size_t size = axis.values.size();
            const bool falling = run.direction == SweepDirection::down || index >= size;
            coordinates[a] = axis.values[falling ? size - 1 - index % size : index];
        } else {
            coordinates[a] = axis.values[rest % axis.values.size()];
            rest /= axis.values.size();
        }
    }
    return coordinates;
}

namespace {

std::size_t chains_of(const StudyRun& run) {
    return combinations(run) * std::max<std::size_t>(run.draws, 1);
}

} // namespace

std::size_t points_of(const StudyRun& run) {
    return chains_of(run) * chain_length_of(run);
}

Plan plan_of(const StudyRun& run, const System& system, const PointRecord* start) {
    Plan plan;
    plan.chain_length = chain_length_of(run);
    plan.chains = chains_of(run);
    plan.carry = run.kind == RunKind::sweep && run.carry;
    std::vector<double> state = start ? start->result.state : std::vector<double>();
    const std::size_t mode = start ? start->result.mode : run.model.initial_mode;
    plan.start = [&run, state, mode, system](std::size_t point) {
        PointStart result{run.model.parameter_values(), state, mode};
        const std::vector<double> coordinates = coordinates_of(run, point);
        for (std::size_t a = 0; a < run.axes.size(); ++a)
            if (!run.axes[a].is_state)
                result.parameters[run.axes[a].index] = coordinates[a];
        if (result.state.empty())
            result.state = system.initial()(result.parameters);
        for (std::size_t a = 0; a < run.axes.size(); ++a)
            if (run.axes[a].is_state)
                result.state[run.axes[a].index] = coordinates[a];
        return result;
    };
    return plan;
}

namespace {

/// Members of a JSON object, written in a fixed order.
class Settings {
public:
    template <class Value>
    Settings& add(std::string_view name, const Value& value) {
        text_ += fmt::format("{}\"{}\":", text_.empty() ? "" : ",", name);
        write(value);
        return *this;
    }
    std::string text() const { return "{" + text_ + "}"; }

private:
    void write(double value) { text_ += std::isfinite(value) ? fmt::format("{:.17g}", value) : "null"; }
    void write(bool value) { text_ += value ? "true" : "false"; }
    void write(std::size_t value) { text_ += fmt::format("{}", value); }
    void write(int value) { text_ += fmt::format("{}", value); }
    void write(const char* value) { write(std::string(value)); }
    void write(const Settings& value) { text_ += value.text(); }
    void write(const std::string& value) {
        text_ += '"';
        for (const char c : value)
            if (c == '"' || c == '\\')
                text_ += {'\\', c};
            else if (static_cast<unsigned char>(c) < 0x20)
                text_ += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
            else
                text_ += c;
        text_ += '"';
    }
    template <class Item>
    void write(const std::vector<Item>& items) {
        text_ += '[';
        for (std::size_t i = 0; i < items.size(); ++i) {
            text_ += i > 0 ? "," : "";
            write(items[i]);
        }
        text_ += ']';
    }
    std::string text_;
};

/// Empty when it cannot be read, which is told when the run reads it.
std::string text_of_table(const std::string& path) {
    try {
        return path.empty() ? std::string() : read_text_file(path, "table of an orbit", longest_table);
    } catch (const InputError&) {
        return "";
    }
}

std::vector<Settings> axes_of(const StudyRun& run) {
    std::vector<Settings> axes;
    for (const Variation& axis : run.axes) {
        Settings item;
        item.add("name", axis.name);
        if (axis.values.empty())
            item.add("low", axis.low)
                .add("high", axis.high)
                .add("logarithmic", axis.logarithmic)
                .add("offset", axis.offset);
        else
            item.add("values", axis.values);
        axes.push_back(item);
    }
    return axes;
}

std::vector<Settings> samplings_of(const StudyRun& run) {
    std::vector<Settings> samplings;
    for (const Sampling& sampling : run.samplings) {
        Settings item;
        item.add("name", sampling.name);
        if (sampling.at == Sampling::At::section)
            item.add("section", sampling.section);
        if (sampling.at == Sampling::At::extremum)
            item.add("extrema", to_string(sampling.expression)).add("direction", static_cast<int>(sampling.direction));
        if (sampling.at == Sampling::At::contact)
            item.add("events", sampling.events);
        if (sampling.symmetry)
            item.add("image", run.model.symmetries[*sampling.symmetry].name);
        samplings.push_back(item);
    }
    return samplings;
}

std::vector<Settings> bounds_of(const StudyRun& run) {
    std::vector<Settings> bounds;
    for (const StateBounds& one : run.attractor.bounds)
        bounds.push_back(Settings()
                             .add("state", run.model.states[one.state].name)
                             .add("least", one.least)
                             .add("greatest", one.greatest));
    return bounds;
}

std::vector<Settings> monitors_of(const BranchSettings& branch) {
    std::vector<Settings> monitors;
    for (const Monitor& monitor : branch.monitors) {
        Settings item;
        item.add("name", monitor.name).add("kind", static_cast<int>(monitor.kind)).add("segment", monitor.segment);
        if (monitor.kind == Monitor::Kind::multiplier)
            item.add("place", monitor.place);
        else if (monitor.kind != Monitor::Kind::duration)
            item.add("expression", to_string(monitor.expression));
        item.add("fixed", monitor.fixed).add("crossings", monitor.crossings);
        if (monitor.held)
            item.add("held", *monitor.held);
        if (monitor.least)
            item.add("least", *monitor.least);
        if (monitor.greatest)
            item.add("greatest", *monitor.greatest);
        monitors.push_back(item);
    }
    return monitors;
}

Settings branch_settings(const StudyRun& run) {
    const BranchSettings& branch = run.branch.settings;
    const std::vector<std::string> parameters = run.model.independent_parameters();
    Settings settings;
    settings.add("signature", run.branch.signature).add("table", text_of_table(run.branch.table));
    std::vector<std::string> set, free, stop;
    for (const std::size_t parameter : run.branch.set)
        set.push_back(parameters[parameter]);
    for (const std::size_t parameter : branch.free)
        free.push_back(parameters[parameter]);
    for (const PointType type : branch.stop_at)
        stop.emplace_back(short_name(type));
    settings.add("set", set).add("monitors", monitors_of(branch)).add("accuracy", branch.orbit.accuracy);
    settings.add("orbit_tolerance", branch.orbit.tolerance);
    if (run.kind == RunKind::orbit)
        return settings;
    settings.add("along", parameters[branch.parameter])
        .add("direction", static_cast<int>(run.direction))
        .add("steps", branch.steps)
        .add("free", free)
        .add("stop", stop)
        .add("stop_when_unphysical", branch.stop_when_unphysical);
    if (branch.least)
        settings.add("least", *branch.least);
    if (branch.greatest)
        settings.add("greatest", *branch.greatest);
    const ContinuationOptions& step = branch.continuation;
    settings.add("first_step", step.first_step)
        .add("smallest_step", step.smallest_step)
        .add("largest_step", step.largest_step)
        .add("largest_angle", step.largest_angle);
    return settings;
}

} // namespace

std::string settings_of(const StudyRun& run) {
    Settings settings;
    settings.add("kind", std::string(name_of(run.kind))).add("vary", axes_of(run));
    if (run.draws > 0)
        settings.add("draws", run.draws).add("seed", static_cast<std::size_t>(run.seed));
    const AttractorOptions& attractor = run.attractor;
    const TransientOptions& transient = run.transient;
    if (run.kind == RunKind::sweep)
        settings.add("direction", static_cast<int>(run.direction)).add("carry", run.carry);
    if (run.is_branch())
        settings.add("branch", branch_settings(run));
    if (run.kind == RunKind::simulate)
        settings.add("section", transient.section)
            .add("skip_time", transient.skip_time)
            .add("time", transient.time)
            .add("skip_periods", transient.skip_periods)
            .add("periods", transient.periods)
            .add("contacts", transient.contacts)
            .add("counted", transient.counted)
            .add("greatest_speed", transient.greatest_speed);
    else
        settings.add("section", attractor.section)
            .add("cycles", attractor.cycles)
            .add("keep", attractor.keep)
            .add("largest_period", attractor.largest_period)
            .add("recurrence", attractor.recurrence)
            .add("disturbance", attractor.disturbance)
            .add("lyapunov_cycles", attractor.lyapunov_cycles)
            .add("longest_return", attractor.longest_return);
    std::vector<std::string> values;
    for (const Expression& value : run.values)
        values.push_back(to_string(value));
    settings.add("bounds", bounds_of(run)).add("samplings", samplings_of(run)).add("values", values);
    settings.add("value_names", run.value_names);
    if (run.start)
        settings.add("start", Settings()
                                  .add("run", run.start->run)
                                  .add("coordinate", run.start->coordinate.value_or(""))
                                  .add("value", run.start->value)
                                  .add("direction", run.start->direction.value_or(""))
                                  .add("point", run.start->point)
                                  .add("onto", run.start->onto));
    settings.add("tolerance", run.simulation.tolerance)
        .add("order", run.simulation.order)
        .add("largest_step", run.simulation.largest_step);
    return settings.text();
}

} // namespace graze
