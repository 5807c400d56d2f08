#include "graze/results/stored_orbit.hpp"

#include "graze/base/input_error.hpp"
#include "graze/results/name_advice.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <charconv>

namespace graze {

namespace {

constexpr const char* no_branches_remedy =
    "run a study with a run of kind = \"continue\", which follows a branch of periodic orbits";

bool is_number(const std::string& text) {
    return !text.empty() && std::all_of(text.begin(), text.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
}

/// The orbit with this label, name or number, if there is one.
std::optional<OrbitRecord> look_up(const ResultFile& file, const RunRecord& run, const std::string& point) {
    if (const std::string named = run.label_named(point); !named.empty())
        return file.orbit(run.name, named);
    if (!is_number(point))
        return file.orbit(run.name, point);
    std::size_t number = 0;
    const auto [end, error] = std::from_chars(point.data(), point.data() + point.size(), number);
    return error == std::errc() ? file.orbit(run.name, number) : std::nullopt;
}

[[noreturn]] void throw_ambiguous(const std::string& point, const std::vector<std::string>& runs, const Place& place) {
    throw InputError(place, fmt::format("several runs have an orbit '{}'", point),
                     fmt::format("write {}:{}", fmt::join(runs, fmt::format(":{} or ", point)), point));
}

} // namespace

std::vector<RunRecord> branch_runs(const ResultFile& file, const std::vector<std::string>& names, const Place& place) {
    const std::vector<RunRecord> all = file.runs();
    std::vector<std::string> known;
    for (const RunRecord& run : all)
        if (run.is_branch())
            known.push_back(run.name);
    std::vector<RunRecord> chosen;
    for (const std::string& name : names.empty() ? known : names) {
        const auto found = std::ranges::find(all, name, &RunRecord::name);
        if (found == all.end())
            throw InputError(place, fmt::format("there are no results of a run '{}'", name),
                             name_advice(name, known, no_branches_remedy));
        if (!found->is_branch())
            throw InputError(place,
                             fmt::format("run '{}' is of kind {}, which has no orbits of a branch", name, found->kind),
                             "see its points");
        chosen.push_back(*found);
    }
    if (chosen.empty())
        throw InputError(Place{file.path(), 0, 0}, "the file has no branches of periodic orbits", no_branches_remedy);
    return chosen;
}

OrbitRecord orbit_of_run(const ResultFile& file, const RunRecord& run, const std::string& point, const Place& place) {
    if (auto record = look_up(file, run, point))
        return std::move(*record);
    if (is_number(point))
        throw InputError(place, fmt::format("run '{}' has no orbit number {}", run.name, point),
                         fmt::format("give one of its {} orbits", file.point_count(run.name)));
    throw InputError(place, fmt::format("run '{}' has no orbit '{}'", run.name, point),
                     name_advice(point, StoredRun(file, run.name, place).special_labels(),
                                 "none of its orbits has a label; give a number"));
}

StoredOrbit find_stored_orbit(const ResultFile& file, const std::string& point, const Place& place) {
    const std::vector<RunRecord> runs = branch_runs(file, {}, place);
    const std::size_t colon = point.find(':');
    if (colon != std::string::npos) {
        const RunRecord run = branch_runs(file, {point.substr(0, colon)}, place).front();
        return {StoredRun(file, run.name, place), orbit_of_run(file, run, point.substr(colon + 1), place)};
    }
    for (const RunRecord& run : runs)
        if (run.name == point && file.point_count(point) == 1)
            return {StoredRun(file, point, place), file.orbits(point, false).front()};
    if (runs.size() == 1)
        return {StoredRun(file, runs.front().name, place), orbit_of_run(file, runs.front(), point, place)};
    std::vector<std::string> having;
    for (const RunRecord& run : runs)
        if (look_up(file, run, point))
            having.push_back(run.name);
    if (having.size() > 1)
        throw_ambiguous(point, having, place);
    if (having.empty())
        throw InputError(place, fmt::format("no run has an orbit '{}'", point),
                         fmt::format("graze points {} lists the special ones; others are RUN:NUMBER", file.path()));
    return {StoredRun(file, having.front(), place), *look_up(file, *file.find_run(having.front()), point)};
}

StoredOrbit find_closed_orbit(const ResultFile& file, const std::string& point, const Place& place) {
    StoredOrbit stored = find_stored_orbit(file, point, place);
    if (stored.record.torus)
        throw InputError(place, fmt::format("'{}' is a torus, whose motions do not close", point),
                         "choose a point of a branch of periodic orbits");
    return stored;
}

std::string title_of(const OrbitRecord& record) {
    return record.label.empty() ? fmt::format("point {}", record.number) : record.label;
}

std::string multipliers_text(const std::vector<std::complex<double>>& multipliers, int digits) {
    std::string text;
    for (const std::complex<double>& one : multipliers) {
        text += fmt::format("{}{:.{}g}", text.empty() ? "" : ", ", one.real(), digits);
        if (one.imag() != 0)
            text += fmt::format("{:+.{}g}i", one.imag(), digits);
    }
    return text;
}

std::string multipliers_text(const OrbitSolution& solution, int digits) {
    if (solution.outcome != OrbitOutcome::converged || is_rest(solution.orbit.signature) ||
        is_homoclinic(solution.orbit.signature))
        return "";
    if (solution.other_multipliers == 0)
        return solution.multipliers.empty() ? "undefined" : multipliers_text(solution.multipliers, digits);
    const std::string others =
        fmt::format("{} {}within {:.3g}", solution.other_multipliers, solution.multipliers.empty() ? "" : "others ",
                    std::nextafter(solution.others_within + 5e-4, 1.0));
    return solution.multipliers.empty() ? others : multipliers_text(solution.multipliers, digits) + ", " + others;
}

bool is_unphysical(const OrbitRecord& record) {
    return !record.point.solution.certificate.admissible && !kind_of(record.point.type).limits;
}

std::string followed_parameter(const RunRecord& run) {
    return run.is_followed() && !run.coordinates.empty() ? run.coordinates.front().name : "";
}

std::vector<double> parameters_of(const StoredRun& run, const OrbitRecord& record) {
    std::vector<double> values;
    for (const ResultColumn& column : run.record.coordinates)
        if (const auto place = run.model.find_independent_parameter(column.name))
            values.push_back(record.point.solution.orbit.parameters[place->place()]);
    return values;
}

} // namespace graze
