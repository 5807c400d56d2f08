#include "graze/study/escape_rates.hpp"

#include "graze/study/study.hpp"

#include <algorithm>
#include <map>
#include <string>
#include <utility>

namespace graze {

namespace {

bool has_label(const std::string& text, Label label) {
    return text == name_of(label);
}

/// Whether it is known when a motion left, or that it has not.
bool is_known(const std::string& label) {
    return !has_label(label, Label::unsettled) && !has_label(label, Label::failed);
}

bool has_left(const std::string& kind, const std::string& label, const std::string& ending) {
    if (kind == name_of(RunKind::simulate))
        return !has_label(label, Label::ended) || ending == name_of(Ending::terminal);
    return !has_label(label, Label::chaotic) && !has_label(label, Label::transient);
}

/// Motions that settle are noticed after a number of returns that varies by a few: a mean lifetime below that is not
/// that of a transient, but of the way to a regular attractor. When a motion escapes or ends is known to the return.
constexpr double shortest_resolved_lifetime = 5;

struct Group {
    std::map<std::pair<std::size_t, bool>, std::size_t> motions; ///< by their returns, and whether they have left
    std::vector<std::size_t> chaotic;
    bool settles = false; ///< some motion has left by settling

    std::vector<Stay> stays() const {
        std::vector<Stay> all;
        for (const auto& [of, count] : motions)
            all.push_back({of.first, of.second, count});
        return all;
    }
    bool resolves(const EscapeLaw& law) const { return !settles || law.rate * shortest_resolved_lifetime < 1; }
};

bool has_settled(const std::string& label) {
    return has_label(label, Label::periodic) || has_label(label, Label::equilibrium) ||
           has_label(label, Label::quasi_periodic);
}

} // namespace

std::vector<EscapeRate> escape_rates(const StoredRun& run) {
    const RunRecord& record = run.record;
    if (record.kind != name_of(RunKind::basin) && record.kind != name_of(RunKind::simulate))
        return {};
    std::vector<std::string> parameters;
    for (const ResultColumn& coordinate : record.coordinates)
        if (std::ranges::find(record.states, coordinate.name, &ResultColumn::name) == record.states.end())
            parameters.push_back(coordinate.name);
    if (parameters.size() == record.coordinates.size())
        return {}; // motions of a group are all alike, and there may be millions of groups
    std::map<std::vector<double>, Group> groups;
    auto rows = run.rows({.columns = {"number", "label", "ending", "cycles"}, .quantities = parameters});
    while (rows.next()) {
        const std::string label = rows.text(1);
        const std::int64_t cycles = rows.integer(3);
        if (!is_known(label) || cycles < 1)
            continue;
        std::vector<double> at;
        for (std::size_t p = 0; p < parameters.size(); ++p)
            at.push_back(rows.number(4 + p));
        Group& group = groups[at];
        ++group.motions[{static_cast<std::size_t>(cycles), has_left(record.kind, label, rows.text(2))}];
        group.settles = group.settles || has_settled(label);
        if (has_label(label, Label::chaotic))
            group.chaotic.push_back(static_cast<std::size_t>(rows.integer(0)));
    }
    std::vector<EscapeRate> rates;
    for (auto& [at, group] : groups)
        if (const auto law = escape_law(group.stays()); law && group.resolves(*law))
            rates.push_back({at, *law, std::move(group.chaotic)});
    return rates;
}

void label_transients(ResultFile& file, const std::string& run) {
    std::vector<std::size_t> points;
    for (const EscapeRate& rate : escape_rates(StoredRun(file, run, {})))
        points.insert(points.end(), rate.chaotic.begin(), rate.chaotic.end());
    if (!points.empty())
        file.set_label(run, points, Label::transient,
                       "chaotic so far, but motions like it leave at a rate that it agrees with");
}

} // namespace graze
