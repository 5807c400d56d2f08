#include "graze/model/model_file.hpp"

#include "graze/base/input_error.hpp"
#include "graze/symbolic/parser.hpp"
#include "graze/symbolic/piece_table.hpp"
#include "graze/symbolic/transform.hpp"
#include "model/model_completion.hpp"
#include "model/model_expressions.hpp"
#include "model/written_text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <cmath>
#include <iterator>

namespace graze {

namespace {

std::string value_text(const Expression& expression) {
    return value_of_written(written_text(expression));
}

/// Returns "" for an empty text, which is left out.
std::string quoted_if_any(const std::string& text) {
    return text.empty() ? "" : toml_string(text);
}

/// Keys and values of an inline table; empty values are left out.
using Parts = std::vector<std::pair<const char*, std::string>>;

std::string inline_table(const Parts& parts) {
    std::vector<std::string> written;
    for (const auto& [key, value] : parts)
        if (!value.empty())
            written.push_back(fmt::format("{} = {}", key, value));
    return fmt::format("{{ {} }}", fmt::join(written, ", "));
}

class ModelWriter {
public:
    explicit ModelWriter(const Model& model) : model_(model), states_(model.state_symbols()), scope_(scope_of(model)) {}

    std::string write(bool drawing) {
        line("name = {}", toml_string(model_.name));
        string("text", model_.text);
        string("source", model_.source);
        string("time_unit", model_.time_unit);
        write_values();
        write_tables();
        write_modes();
        write_events();
        write_jumps();
        write_transitions();
        write_slides();
        write_frictions();
        write_contacts();
        write_sections();
        write_symmetries();
        write_quantities();
        write_conserved();
        if (drawing && model_.drawing)
            write_drawing(*model_.drawing);
        line("\n[initial]");
        line("mode = {}", toml_string(mode_name(model_.initial_mode)));
        return std::move(text_);
    }

private:
    template <typename... Arguments>
    void line(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
        fmt::format_to(std::back_inserter(text_), format, std::forward<Arguments>(arguments)...);
        text_ += '\n';
    }
    void string(const char* key, const std::string& text) {
        if (!text.empty())
            line("{} = {}", key, toml_string(text));
    }
    /// Writes the short form `key = value` when there is only the first part, the value.
    void item(const std::string& key, const Parts& parts) {
        const bool only_value =
            std::all_of(parts.begin() + 1, parts.end(), [](const auto& part) { return part.second.empty(); });
        line("{} = {}", key, only_value ? parts.front().second : inline_table(parts));
    }
    const std::string& mode_name(std::size_t mode) const { return model_.modes[mode].name; }

    void write_values() {
        if (!model_.parameters.empty())
            line("\n[parameters]");
        for (const Parameter& parameter : model_.parameters) {
            // A dependent parameter is written as a string even if it is a number, so that it stays dependent.
            const std::string value = parameter.expression ? toml_string(to_string(*parameter.expression))
                                                           : number_text(parameter.value.value_or(std::nan("")));
            item(parameter.name,
                 {{"value", value}, {"unit", quoted_if_any(parameter.unit)}, {"text", quoted_if_any(parameter.text)}});
        }
        line("\n[states]");
        for (const State& state : model_.states)
            item(state.name, {{"initial", value_text(state.initial)},
                              {"period", state.period ? value_text(*state.period) : ""},
                              {"drifting", state.drifting ? "true" : ""},
                              {"unit", quoted_if_any(state.unit)},
                              {"text", quoted_if_any(state.text)}});
        if (!model_.definitions.empty())
            line("\n[definitions]");
        for (const Definition& definition : model_.definitions)
            item(definition.name, {{"value", value_text(definition.value)}, {"text", quoted_if_any(definition.text)}});
    }

    /// Writes tables with their points, so that a stored model needs no other file.
    void write_tables() {
        for (const auto& table : model_.graph->tables()) {
            line("\n[tables.{}]", table->name());
            string("text", table->text());
            const PieceTable::Options& options = table->options();
            if (options.interpolation == PieceTable::Interpolation::cubic)
                line("interpolation = \"cubic\"");
            if (options.periodic)
                line("periodic = true");
            else if (options.outside != PieceTable::Outside::hold)
                line("outside = {}", options.outside == PieceTable::Outside::linear ? "\"linear\"" : "\"error\"");
            line("points = [");
            for (const PieceTable::Point& point : table->points())
                line("    [{}, {}],", number_text(point.x), number_text(point.y));
            line("]");
        }
    }

    std::string events(const std::vector<std::size_t>& watched) const {
        std::vector<std::string> names;
        for (const std::size_t event : watched)
            names.push_back(toml_string(model_.events[event].name));
        return fmt::format("[{}]", fmt::join(names, ", "));
    }

    void write_modes() {
        for (const Mode& mode : model_.modes) {
            if (mode.rates.empty()) // made when the declarations are completed
                continue;
            line("\n[modes.{}]", mode.name);
            string("text", mode.text);
            if (!mode.watched.empty())
                line("watch = {}", events(mode.watched));
            line("[modes.{}.rates]", mode.name);
            for (std::size_t i = 0; i < mode.rates.size(); ++i)
                line("{} = {}", model_.states[i].name, value_text(mode.rates[i]));
        }
    }

    void write_events() {
        for (const Event& event : model_.events) {
            line("\n[events.{}]", event.name);
            string("text", event.text);
            line("function = {}", value_text(event.function));
            if (event.kind == EventKind::section)
                line("kind = \"section\"");
        }
    }

    /// Returns the entries of a map for the states that it changes.
    std::vector<std::string> changes(const StateMap& map) {
        std::vector<std::string> result;
        for (const StateMap::Change& change : changes_of(map, states_, identity_))
            result.push_back(fmt::format("{} = {}", states_[change.state].name(), value_text(change.image)));
        return result;
    }

    void write_jumps() {
        const bool has_text = !model_.find_state("text");
        for (std::size_t i = 1; i < model_.jumps.size(); ++i) {
            const Jump& jump = model_.jumps[i];
            line("\n[jumps.{}]", jump.name);
            if (has_text)
                string("text", jump.text);
            for (const std::string& change : changes(jump.map))
                line("{}", change);
        }
    }

    /// Returns the user's text if it still has the meaning of `when`, otherwise a new text.
    std::string conditions_text(const std::vector<Condition>& when, const std::string& text) const {
        if (!text.empty()) {
            try {
                const std::vector<Condition> read = parse_conditions(*model_.graph, text, scope_);
                if (read == when)
                    return text;
            } catch (const InputError&) {
                // The text of a model built from C++ may be a description instead of conditions.
            }
        }
        std::vector<std::string> parts;
        for (const Condition& condition : when)
            parts.push_back(fmt::format("{} {} 0", to_string(condition.function), condition.strict ? ">" : ">="));
        return fmt::format("{}", fmt::join(parts, " and "));
    }

    void write_transitions() {
        for (const Transition& transition : model_.transitions) {
            const std::string& event = model_.events[transition.event].name;
            line("\n[[transitions]]");
            line("mode = {}", toml_string(mode_name(transition.mode)));
            line("event = {}", toml_string(event));
            if (!transition.also.empty())
                line("also = {}", events(transition.also));
            if (!transition.when.empty())
                line("when = {}", toml_string(conditions_text(transition.when, transition.when_text)));
            if (transition.label != mode_name(transition.mode) + ":" + event)
                string("label", transition.label);
            if (transition.jump != 0)
                line("jump = {}", toml_string(model_.jumps[transition.jump].name));
            const auto next = [&](const Alternative& alternative) {
                return toml_string(alternative.mode ? mode_name(*alternative.mode) : "end");
            };
            if (transition.next.size() == 1 && transition.next.front().when.empty()) {
                line("next = {}", next(transition.next.front()));
            } else {
                line("next = [");
                for (const Alternative& alternative : transition.next) {
                    const std::string when =
                        alternative.when.empty()
                            ? ""
                            : toml_string(conditions_text(alternative.when, alternative.when_text));
                    line("    {},", inline_table({{"when", when}, {"mode", next(alternative)}}));
                }
                line("]");
            }
            if (transition.chatter)
                line("chatter = {{ jump = {}, mode = {} }}", toml_string(model_.jumps[transition.chatter->jump].name),
                     toml_string(mode_name(transition.chatter->mode)));
        }
    }

    void write_slides() {
        for (const Slide& slide : model_.slides) {
            line("\n[slides.{}]", slide.name);
            string("text", slide.text);
            line("surface = {}", toml_string(model_.events[slide.surface].name));
            line("between = [{}, {}]", toml_string(mode_name(slide.left)), toml_string(mode_name(slide.right)));
            if (slide.convention == SlideConvention::utkin)
                line("convention = \"utkin\"");
            string("control", slide.control);
            if (slide.watched)
                line("watch = {}", events(*slide.watched));
        }
    }

    void write_frictions() {
        for (const Friction& friction : model_.frictions) {
            line("\n[friction.{}]", friction.name);
            string("text", friction.text);
            line("velocity = {}", value_text(friction.velocity));
            line("normal = {}", value_text(friction.normal));
            line("coefficient = {}", value_text(friction.coefficient));
            if (friction.static_coefficient)
                line("static = {}", value_text(*friction.static_coefficient));
        }
    }

    void write_contacts() {
        if (model_.contacts.empty())
            return;
        const ContactSettings& settings = model_.contact_settings;
        line("\n[contacts]");
        line("law = {}", toml_string(std::string(impact_law_words[static_cast<std::size_t>(settings.law)])));
        std::vector<std::string> velocities, mass, row, modes;
        for (const std::size_t state : settings.velocities)
            velocities.push_back(toml_string(model_.states[state].name));
        line("velocities = [{}]", fmt::join(velocities, ", "));
        const bool full = settings.mass.size() > velocities.size();
        for (const Expression& one : settings.mass) {
            row.push_back(value_text(one));
            if (row.size() == velocities.size()) {
                mass.push_back(full ? fmt::format("[{}]", fmt::join(row, ", "))
                                    : fmt::format("{}", fmt::join(row, ", ")));
                row.clear();
            }
        }
        line("mass = [{}]", fmt::join(mass, ", "));
        for (const std::size_t mode : settings.modes.value_or(std::vector<std::size_t>{}))
            modes.push_back(toml_string(mode_name(mode)));
        if (settings.modes)
            line("modes = [{}]", fmt::join(modes, ", "));
        for (const UnilateralContact& contact : model_.contacts) {
            line("\n[contacts.{}]", contact.name);
            string("text", contact.text);
            line("gap = {}", value_text(contact.gap));
            line("restitution = {}", value_text(contact.restitution));
            if (contact.friction)
                line("friction = {}", value_text(*contact.friction));
            if (contact.slip)
                line("slip = {}", value_text(*contact.slip));
        }
    }

    void write_sections() {
        for (const Section& section : model_.sections) {
            line("\n[sections.{}]", section.name);
            string("text", section.text);
            if (section.state) {
                line("state = {}", toml_string(model_.states[*section.state].name));
                line("value = {}", value_text(section.value));
                continue;
            }
            line("function = {}", value_text(section.function));
            if (section.direction != Direction::both)
                line("direction = {}", section.direction == Direction::falling ? "\"falling\"" : "\"rising\"");
        }
    }

    void write_symmetries() {
        for (const Symmetry& symmetry : model_.symmetries) {
            line("\n[symmetries.{}]", symmetry.name);
            string("text", symmetry.text);
            line("map = {{ {} }}", fmt::join(changes(symmetry.map), ", "));
            std::vector<std::string> modes;
            for (std::size_t i = 0; i < symmetry.modes.size(); ++i)
                if (symmetry.modes[i] != i)
                    modes.push_back(fmt::format("{} = {}", mode_name(i), toml_string(mode_name(symmetry.modes[i]))));
            if (!modes.empty())
                line("modes = {{ {} }}", fmt::join(modes, ", "));
        }
    }

    void write_quantities() {
        if (!model_.quantities.empty())
            line("\n[quantities]");
        for (const Quantity& quantity : model_.quantities)
            item(quantity.name, {{"value", value_text(quantity.value)},
                                 {"unit", quoted_if_any(quantity.unit)},
                                 {"text", quoted_if_any(quantity.text)}});
    }

    void write_conserved() {
        if (!model_.conserved.empty())
            line("\n[conserved]");
        for (const ConservedQuantity& conserved : model_.conserved) {
            std::vector<std::string> modes;
            for (const ConservedQuantity::InMode& own : conserved.modes)
                modes.push_back(fmt::format("{} = {}", own.mode, value_text(own.value)));
            item(conserved.name, {{"value", conserved.value.empty() ? "" : value_text(conserved.value)},
                                  {"modes", modes.empty() ? "" : fmt::format("{{ {} }}", fmt::join(modes, ", "))},
                                  {"unit", quoted_if_any(conserved.unit)},
                                  {"text", quoted_if_any(conserved.text)}});
        }
    }

    static std::string pair(const std::string& x, const std::string& y) {
        return fmt::format("[{}, {}]", value_of_written(x), value_of_written(y));
    }
    static std::string pair(const DrawnPair& both) { return pair(both.x, both.y); }

    std::string shape(const DrawnShape& shape) const {
        std::vector<std::string> points, modes;
        for (const DrawnPair& point : shape.points)
            points.push_back(pair(point));
        for (const std::size_t mode : shape.modes)
            modes.push_back(toml_string(mode_name(mode)));
        const bool has_centre = !has_ends(shape.kind) && shape.kind != ShapeKind::path;
        return inline_table(
            {{"kind", toml_string(std::string(name_of(shape.kind)))},
             {"from", has_ends(shape.kind) ? points.front() : ""},
             {"to", has_ends(shape.kind) ? points.back() : ""},
             {"points", shape.kind == ShapeKind::path ? fmt::format("[{}]", fmt::join(points, ", ")) : ""},
             {"at", has_centre ? points.front() : ""},
             {"size", shape.kind == ShapeKind::box ? pair(shape.size) : ""},
             {"radius", shape.kind == ShapeKind::circle ? value_of_written(shape.radius) : ""},
             {"text", shape.kind == ShapeKind::text ? toml_string(shape.text) : ""},
             {"colour", shape.colour == ShapeColour::black ? "" : toml_string(std::string(name_of(shape.colour)))},
             {"modes", modes.empty() ? "" : fmt::format("[{}]", fmt::join(modes, ", "))}});
    }

    void write_drawing(const ModelDrawing& drawing) {
        line("\n[drawing]");
        string("text", drawing.text);
        line("x = {}", pair(drawing.x[0], drawing.x[1]));
        line("y = {}", pair(drawing.y[0], drawing.y[1]));
        line("shapes = [");
        for (const DrawnShape& one : drawing.shapes)
            line("    {},", shape(one));
        line("]");
    }

    const Model& model_;
    std::vector<Expression> states_;
    std::shared_ptr<const std::vector<Expression>> identity_; ///< see changes_of
    Scope scope_;
    std::string text_;
};

} // namespace

namespace {

/// Writes a model with its declarations. If it was changed after they were completed it is written without them.
std::string written(const Model& model, bool drawing) {
    model.validate();
    if (!model.declared)
        return ModelWriter(model).write(drawing);
    Model plain = is_as_declared(model) ? declared_model(model) : model;
    if (plain.declared) {
        plain.slides.clear();
        plain.frictions.clear();
        plain.contacts.clear();
    }
    return ModelWriter(plain).write(drawing);
}

} // namespace

std::string write_model(const Model& model) {
    return written(model, true);
}

std::string write_equations(const Model& model) {
    return written(model, false);
}

} // namespace graze
