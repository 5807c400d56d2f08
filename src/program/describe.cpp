#include "program/describe.hpp"

#include "graze/symbolic/function.hpp"
#include "graze/symbolic/transform.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>

namespace graze {

namespace {

/// Definitions of families of models can be as long as a book.
std::string formula(const Expression& expression) {
    constexpr std::size_t longest = 100;
    const std::string text = to_string(expression);
    return text.size() <= longest ? text : text.substr(0, longest - 4) + " ...";
}

std::string way_of(const Model& model, const Transition& transition) {
    const auto through = [&](std::size_t jump) { return jump == 0 ? std::string() : " / " + model.jumps[jump].name; };
    std::vector<std::string> ways;
    for (const Alternative& alternative : transition.next)
        ways.push_back((alternative.mode ? model.modes[*alternative.mode].name : "end") +
                       (alternative.when.empty() ? "" : fmt::format(" [{}]", alternative.when_text)));
    std::string way = fmt::format("{}: {}{} -> {}", model.modes[transition.mode].name,
                                  model.events[transition.event].name, through(transition.jump), fmt::join(ways, ", "));
    if (transition.chatter)
        way += fmt::format("; chatter{} -> {}", through(transition.chatter->jump),
                           model.modes[transition.chatter->mode].name);
    return way;
}

std::string watched_by(const Model& model, const Mode& mode) {
    std::vector<std::string> names;
    for (const std::size_t event : mode.watched)
        names.push_back(model.events[event].name);
    return names.empty() ? "" : fmt::format("watches {}", fmt::join(names, ", "));
}

std::string section_text(const Model& model, const Section& section) {
    if (section.state)
        return fmt::format("{} = {}", model.states[*section.state].name, formula(section.value));
    const char* direction = section.direction == Direction::both      ? ""
                            : section.direction == Direction::falling ? ", falling"
                                                                      : ", rising";
    return formula(section.function) + " = 0" + direction;
}

/// What becomes of the states that a symmetry changes.
std::vector<std::string> images_of(const Model& model, const Symmetry& symmetry) {
    std::vector<std::string> images;
    for (std::size_t i = 0; i < model.states.size(); ++i)
        if (symmetry.map[i] != model.symbol(model.states[i].name))
            images.push_back(fmt::format("{} -> {}", model.states[i].name, formula(symmetry.map[i])));
    return images;
}

std::string kind_of(const State& state) {
    if (state.period)
        return fmt::format(" (cyclic, period {})", to_string(*state.period));
    return state.drifting ? " (drifting)" : "";
}

/// @param value a number or a text
template <typename Value>
void add_row(Table& table, std::string_view item, std::string_view name, const Value& value, std::string_view unit,
             std::string_view text) {
    table.add(item);
    table.add(name);
    table.add(value);
    table.add(unit);
    table.add(text);
}

/// A heading, and below it rows of which only what is there takes room.
class Listing {
public:
    void heading(std::size_t count, const std::string& one, const std::string& many) {
        flush();
        if (count > 0)
            text_ += fmt::format("\n{} {}\n", count, count == 1 ? one : many);
    }
    void row(std::vector<std::string> cells) { rows_.push_back(std::move(cells)); }
    std::string text() {
        flush();
        return text_;
    }

private:
    void flush() {
        std::vector<std::size_t> widths;
        for (const auto& row : rows_)
            for (std::size_t i = 0; i < row.size(); ++i) {
                widths.resize(std::max(widths.size(), row.size()));
                widths[i] = std::max(widths[i], row[i].size());
            }
        for (const auto& row : rows_) {
            std::string line = " ";
            for (std::size_t i = 0; i < row.size(); ++i)
                if (widths[i] > 0)
                    line += fmt::format(" {:<{}} ", row[i], widths[i]);
            line.erase(line.find_last_not_of(' ') + 1);
            text_ += line + '\n';
        }
        rows_.clear();
    }
    std::string text_;
    std::vector<std::vector<std::string>> rows_;
};

} // namespace

std::vector<double> all_parameter_values(const Model& model) {
    std::vector<Expression> values;
    for (const Parameter& parameter : model.parameters)
        values.push_back(model.symbol(parameter.name));
    return model.values_of(values);
}

Table describe_in_table(const Model& model) {
    Table table({{"item", ""}, {"name", ""}, {"value", ""}, {"unit", ""}, {"text", ""}});
    add_row(table, "model", model.name, "", model.time_unit, model.text);
    const std::vector<double> parameters = all_parameter_values(model);
    for (std::size_t i = 0; i < parameters.size(); ++i)
        add_row(table, "parameter", model.parameters[i].name, parameters[i], model.parameters[i].unit,
                model.parameters[i].text);
    const std::vector<double> states = model.initial_state();
    for (std::size_t i = 0; i < states.size(); ++i)
        add_row(table, "state", model.states[i].name, states[i], model.states[i].unit, model.states[i].text);
    for (const Definition& item : model.definitions)
        add_row(table, "definition", item.name, formula(item.value), "", item.text);
    for (const Mode& item : model.modes) {
        add_row(table, "mode", item.name, "", "", item.text);
        for (const std::size_t event : item.watched)
            add_row(table, "watched event", item.name, model.events[event].name, "", "");
    }
    for (const Event& item : model.events)
        add_row(table, item.kind == EventKind::barrier ? "barrier" : "section event", item.name, formula(item.function),
                "", item.text);
    for (const Jump& item : model.jumps)
        if (&item != &model.jumps.front())
            add_row(table, "jump", item.name, "", "", item.text);
    for (const Transition& item : model.transitions)
        add_row(table, "transition", item.label, way_of(model, item), "", "");
    for (const Section& item : model.sections)
        add_row(table, "section", item.name, section_text(model, item), "", item.text);
    for (const Symmetry& item : model.symmetries) {
        add_row(table, "symmetry", item.name, "", "", item.text);
        for (const std::string& image : images_of(model, item))
            add_row(table, "image", item.name, image, "", "");
    }
    for (const Quantity& item : model.quantities)
        add_row(table, "quantity", item.name, formula(item.value), item.unit, item.text);
    return table;
}

std::string describe(const Model& model, std::size_t width) {
    Listing listing;
    listing.heading(model.states.size(), "state (initial value)", "states (initial values)");
    const std::vector<double> states = model.initial_state();
    for (std::size_t i = 0; i < states.size(); ++i)
        listing.row({model.states[i].name, fmt::format("= {}", states[i]), model.states[i].unit,
                     model.states[i].text + kind_of(model.states[i])});
    listing.heading(model.parameters.size(), "parameter", "parameters");
    const std::vector<double> parameters = all_parameter_values(model);
    for (std::size_t i = 0; i < parameters.size(); ++i) {
        const Parameter& item = model.parameters[i];
        listing.row({item.name, fmt::format("= {}", parameters[i]), item.unit,
                     item.text + (item.expression ? fmt::format(" (= {})", formula(*item.expression)) : "")});
    }
    listing.heading(model.definitions.size(), "definition", "definitions");
    listing.heading(model.modes.size(), "mode", "modes");
    for (const Mode& item : model.modes)
        listing.row({item.name, watched_by(model, item), item.text});
    listing.heading(model.transitions.size(), "transition (mode: event / jump -> next mode)",
                    "transitions (mode: event / jump -> next mode)");
    for (const Transition& item : model.transitions)
        listing.row({item.label, way_of(model, item)});
    listing.heading(model.sections.size(), "section", "sections");
    for (const Section& item : model.sections)
        listing.row({item.name, section_text(model, item), item.text});
    listing.heading(model.symmetries.size(), "symmetry", "symmetries");
    for (const Symmetry& item : model.symmetries)
        listing.row({item.name, fmt::format("{}", fmt::join(images_of(model, item), ", ")), item.text});
    listing.heading(model.quantities.size(), "quantity", "quantities");
    for (const Quantity& item : model.quantities)
        listing.row({item.name, item.unit, item.text});
    std::string text =
        fmt::format("{}{}\n", model.name, model.time_unit.empty() ? "" : fmt::format(" (time in {})", model.time_unit));
    for (const std::string& paragraph : {model.text, model.source.empty() ? "" : "Source: " + model.source})
        if (!paragraph.empty())
            text += wrapped(paragraph, width) + '\n';
    return text + listing.text();
}

} // namespace graze
