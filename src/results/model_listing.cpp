#include "graze/results/model_table.hpp"

#include "graze/model/conserved.hpp"
#include "graze/symbolic/transform.hpp"
#include "model/model_words.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string>
#include <vector>

namespace graze {

namespace {

/// @param free nothing depends on the state
std::string kind_words(const Model& model, const State& state, bool free) {
    if (state.period)
        return fmt::format(" (cyclic, period {})", to_string(*state.period));
    if (free)
        return " (ignorable: nothing depends on it, and orbits may drift)";
    if (state.drifts_with)
        return fmt::format(" (may be translated together with {})", model.states[*state.drifts_with].name);
    return state.drifting ? " (drifting)" : "";
}

/// A text of headings with aligned rows below them; columns that are empty in all rows are left out.
class ModelListing {
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

/// Laws of contacts make transitions with an alternative for each set of contacts that stay closed.
bool has_many_outcomes(const Transition& transition) {
    constexpr std::size_t most = 3;
    return transition.derived && transition.next.size() > most;
}

/// The modes that may follow, without the conditions, which `--format csv` tells.
std::string outcomes_text(const Model& model, const Transition& transition) {
    std::vector<std::string> modes;
    for (const Alternative& alternative : transition.next) {
        const std::string mode = alternative.mode ? model.modes[*alternative.mode].name : "the end";
        if (std::ranges::find(modes, mode) == modes.end())
            modes.push_back(mode);
    }
    return fmt::format("{}: {} -> {}", model.modes[transition.mode].name, model.events[transition.event].name,
                       modes.size() > 3 ? fmt::format("one of {} modes", modes.size())
                                        : fmt::format("{}", fmt::join(modes, " or ")));
}

} // namespace

std::string model_listing(const Model& model) {
    ModelListing listing;
    listing.heading(model.states.size(), "state (initial value)", "states (initial values)");
    const std::vector<double> states = model.initial_state();
    const std::vector<std::size_t> free =
        model.conserved.empty() ? std::vector<std::size_t>() : ignorable_states(model);
    for (std::size_t i = 0; i < states.size(); ++i)
        listing.row({model.states[i].name, fmt::format("= {}", states[i]), model.states[i].unit,
                     model.states[i].text + kind_words(model, model.states[i], std::ranges::count(free, i) > 0)});
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
        listing.row({item.label, has_many_outcomes(item) ? outcomes_text(model, item) : transition_text(model, item)});
    listing.heading(model.slides.size(), "slide", "slides");
    for (const Slide& item : model.slides) {
        listing.row({item.name, slide_text(model, item), item.text});
        for (const std::string& rate : sliding_rates(model, item))
            listing.row({"", rate});
    }
    listing.heading(model.frictions.size(), "friction", "frictions");
    for (const Friction& item : model.frictions)
        listing.row({item.name, friction_text(item), item.text});
    listing.heading(model.contacts.size(), "contact", "contacts");
    for (const UnilateralContact& item : model.contacts)
        listing.row({item.name, contact_text(item), item.text});
    for (const std::string& remark : contact_remarks(model))
        listing.row({"", remark});
    listing.heading(model.sections.size(), "section", "sections");
    for (const Section& item : model.sections)
        listing.row({item.name, section_text(model, item), item.text});
    listing.heading(model.symmetries.size(), "symmetry", "symmetries");
    for (const Symmetry& item : model.symmetries)
        listing.row({item.name, fmt::format("{}", fmt::join(images_of(model, item), ", ")), item.text});
    listing.heading(model.quantities.size(), "quantity", "quantities");
    for (const Quantity& item : model.quantities)
        listing.row({item.name, item.unit, item.text});
    listing.heading(model.conserved.size(), "conserved quantity", "conserved quantities");
    for (const ConservedQuantity& item : model.conserved)
        listing.row({item.name, item.unit, item.text});
    if (model.drawing)
        listing.heading(model.drawing->shapes.size(), "drawn shape", "drawn shapes");
    return listing.text();
}

} // namespace graze
