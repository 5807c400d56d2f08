#include "page/motion_rows.hpp"

#include "graze/study/plain_states.hpp"
#include "page/json_text.hpp"
#include "page/quantity_json.hpp"
#include "picture/shown_names.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace graze {

namespace {

constexpr std::size_t most_thinned_rows = 20'000, most_numbers = 400'000;
constexpr std::size_t longest_name = 4000;

/// Leaves out every other beginning of an arc and every other contact.
void forget_half(DenseMotion& motion) {
    std::size_t next = 0;
    for (std::size_t arc = 1; arc < motion.begins.size(); arc += 2, ++next) {
        motion.begins[next] = motion.begins[arc];
        if (arc + 1 < motion.modes.size())
            motion.modes[next + 1] = motion.modes[arc + 1];
    }
    motion.begins.resize(next);
    motion.modes.resize(std::min(motion.modes.size(), next + 1));
    next = 0;
    for (std::size_t contact = 0; contact < motion.impacts.size(); contact += 2)
        motion.impacts[next++] = motion.impacts[contact];
    motion.impacts.resize(next);
}

nlohmann::json column_json(const NamedValue& column, double period) {
    nlohmann::json one = quantity_json(column.name, column.unit, first_words(column.text));
    one["period"] = period > 0 ? number_json(period) : nlohmann::json();
    return one;
}

} // namespace

std::size_t most_rows_of(std::size_t columns) {
    return std::max<std::size_t>(100, std::min(most_thinned_rows, most_numbers / (columns + 1)));
}

void thin_rows(DenseMotion& motion, std::size_t most) {
    const std::size_t rows = motion.values.empty() ? 0 : motion.values.front().size();
    if (rows <= most || most == 0)
        return;
    while (most > 1 && 2 * motion.begins.size() + motion.impacts.size() > most)
        forget_half(motion);
    const std::size_t each = (rows + most - 1) / most;
    std::vector<bool> kept(rows, false);
    for (std::size_t row = 0; row < rows; row += each)
        kept[row] = true;
    kept.back() = true;
    for (const std::size_t row : motion.begins)
        kept[row] = kept[row > 0 ? row - 1 : 0] = true;
    for (const std::size_t row : motion.impacts)
        kept[row] = true;
    std::vector<std::size_t> places(rows, 0);
    std::size_t next = 0;
    for (std::size_t row = 0; row < rows; ++row) {
        places[row] = next;
        next += kept[row] ? 1 : 0;
    }
    for (std::vector<double>& column : motion.values) {
        for (std::size_t row = 0; row < rows; ++row)
            if (kept[row])
                column[places[row]] = column[row];
        column.resize(next);
    }
    for (auto* list : {&motion.begins, &motion.impacts})
        for (std::size_t& row : *list)
            row = places[row];
}

nlohmann::json motion_rows_json(const Model& model, const std::vector<NamedValue>& columns, DenseMotion motion,
                                const MotionShown& shown) {
    thin_rows(motion, std::min(shown.most_rows, most_rows_of(columns.size())));
    nlohmann::json one{{"complete", shown.complete},
                       {"ending", name_of(motion.outcome.ending)},
                       {"detail", motion.outcome.detail},
                       {"time", number_json(motion.outcome.time)}};
    nlohmann::json described = nlohmann::json::array(), values = nlohmann::json::array();
    for (std::size_t c = 0; c < columns.size(); ++c)
        described.push_back(column_json(columns[c], c < motion.periods.size() ? motion.periods[c] : 0));
    for (const std::vector<double>& column : motion.values)
        values.push_back(numbers_json(column));
    one["columns"] = std::move(described);
    one["values"] = std::move(values);
    one["begins"] = motion.begins;
    one["contacts"] = motion.impacts;
    one["modes"] = nlohmann::json::array();
    for (const std::size_t mode : motion.modes)
        one["modes"].push_back(mode < model.modes.size() ? model.modes[mode].name : std::string());
    return one;
}

std::vector<NamedValue> motion_columns(const Model& model, const std::vector<std::string>& names,
                                       const StoredRun* run) {
    if (names.size() > most_motion_names)
        throw InputError({"names", 0, 0}, fmt::format("{} values are asked for", names.size()),
                         fmt::format("ask for {} at most", most_motion_names));
    std::vector<NamedValue> columns{{"t", model.time_unit, "time", {}}};
    for (const std::string& name : names.empty() ? plain_states(model) : names) {
        if (name.size() > longest_name)
            throw InputError({"names", 0, 0}, fmt::format("an expression has {} characters", name.size()),
                             fmt::format("give {} at most", longest_name));
        const bool of_study = run != nullptr && run->has_value(name) && !model.find_state(name) &&
                              !model.find_parameter(name) && !model.find_quantity(name);
        columns.push_back(of_study ? NamedValue{name, run->unit(name), words_of(*run, name), {}}
                                   : named_value(model, name, {"names", 0, 0}));
    }
    return columns;
}

} // namespace graze
