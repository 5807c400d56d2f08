#include "graze/model/model_file.hpp"

#include "graze/base/input_error.hpp"
#include "graze/base/printable.hpp"
#include "graze/base/text_file.hpp"
#include "graze/model/conserved.hpp"
#include "model/model_completion.hpp"
#include "model/model_file_contacts.hpp"
#include "model/model_validate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <numeric>
#include <optional>

namespace graze {

namespace {

/// Reads one model, table by table.
class ModelReader : private ContactParts {
public:
    ModelReader(std::string_view text, const std::string& file, std::optional<std::string> folder = std::nullopt)
        : ContactParts(text, file), root_(parse_toml(text, file)) {
        if (folder)
            allow_files(*folder);
    }

    Model read() {
        if (root_.empty())
            throw InputError({source_.file(), 0, 0}, "the model is empty",
                             "give at least [states] and a mode; docs/model-format.md shows how");
        std::map<std::string, TomlEntry> top;
        for (const TomlEntry& entry : reader_.entries(root_, "")) {
            mistakes_.attempt([&] { reader_.require_known(entry, "", model_keys()); });
            places_.set(entry.name, entry.place);
            top.emplace(entry.name, entry);
        }
        const auto read = [&](const char* key, void (ModelReader::*member)(const TomlEntry&)) {
            const auto found = top.find(key);
            return found == top.end() || mistakes_.attempt([&] { (this->*member)(found->second); });
        };
        mistakes_.attempt([&] { read_head(top); });
        const bool named =
            read("tables", &ModelReader::read_tables) && read("parameters", &ModelReader::name_parameters) &&
            read("states", &ModelReader::name_states) && read("definitions", &ModelReader::name_definitions) &&
            read("modes", &ModelReader::name_modes) && read("slides", &ModelReader::name_slides) &&
            read("friction", &ModelReader::name_frictions) &&
            mistakes_.attempt([&] { validate_names(model_, places_); });
        if (!named) // everything else refers to these names
            mistakes_.throw_noted();
        make_scope();
        read("parameters", &ModelReader::read_parameters);
        read("states", &ModelReader::read_states);
        read("definitions", &ModelReader::read_definitions);
        read("events", &ModelReader::read_events);
        model_.jumps.front().map = identity();
        read("jumps", &ModelReader::read_jumps);
        read("modes", &ModelReader::read_modes);
        read("contacts", &ModelReader::read_contacts);
        if (top.contains("contacts"))
            mistakes_.throw_noted(); // modes are made of what has been read
        mistakes_.attempt([&] { set_accelerations(); });
        mistakes_.attempt([&] { name_derived_modes(model_, places_); });
        read("slides", &ModelReader::read_slides);
        mistakes_.attempt([&] { name_corner_modes(model_, places_); });
        read("friction", &ModelReader::read_frictions);
        read("transitions", &ModelReader::read_transitions);
        read("sections", &ModelReader::read_sections);
        read("symmetries", &ModelReader::read_symmetries);
        read("quantities", &ModelReader::read_quantities);
        read("conserved", &ModelReader::read_conserved);
        read("drawing", &ModelReader::read_drawing);
        read("initial", &ModelReader::read_initial);
        if (top.count("initial") == 0 && written_modes() > 1)
            mistakes_.attempt([&] {
                throw InputError({source_.file(), 0, 0},
                                 "the model has several modes but does not say which one is first",
                                 "add [initial] with mode = \"<mode>\"");
            });
        mistakes_.throw_noted();
        complete_model(model_, places_);
        validate_model(model_, places_);
        let_ignorable_states_drift(model_);
        return std::move(model_);
    }

private:
    void read_head(const std::map<std::string, TomlEntry>& top) {
        model_.name = printable_line(std::filesystem::path(source_.file()).stem().string());
        const auto read = [&](const char* key, std::string& value, bool one_line) {
            if (const auto found = top.find(key); found != top.end())
                value = one_line ? reader_.line(found->second) : reader_.string(found->second);
        };
        read("name", model_.name, true);
        read("text", model_.text, false);
        read("source", model_.source, false);
        read("time_unit", model_.time_unit, true);
    }

    void name_parameters(const TomlEntry& group) { name_items(group, model_.parameters); }
    void name_states(const TomlEntry& group) { name_items(group, model_.states); }
    void name_definitions(const TomlEntry& group) { name_items(group, model_.definitions); }
    void name_modes(const TomlEntry& group) { name_items(group, model_.modes); }

    std::vector<TomlEntry> entries(const TomlEntry& group) const {
        return reader_.entries(reader_.table(group), group.path);
    }

    /// Names are read before all contents, which may refer to them in any order.
    template <typename Item>
    void name_items(const TomlEntry& group, std::vector<Item>& items) {
        for (const TomlEntry& entry : entries(group)) {
            places_.set(entry.path, entry.place);
            items.emplace_back().name = entry.name;
        }
    }
    /// Reads the contents of the items that have been named.
    template <typename Item, typename Read>
    void fill_items(const TomlEntry& group, std::vector<Item>& items, const Read& read) {
        auto item = items.begin();
        for (const TomlEntry& entry : entries(group)) {
            Item& one = *item++;
            mistakes_.attempt([&] { read(entry, one); });
        }
    }
    /// Adds an item for each entry that is read without a mistake.
    template <typename Item, typename Read>
    void add_items(const TomlEntry& group, std::vector<Item>& items, const Read& read) {
        for (const TomlEntry& entry : entries(group))
            mistakes_.attempt([&] {
                places_.set(entry.path, entry.place);
                Item item;
                item.name = entry.name;
                read(entry, item);
                items.push_back(std::move(item));
            });
    }

    /// A number written as an expression, such as 30*pi/180, depends on no parameter and can be changed like a number.
    void read_value(const TomlEntry& part, Parameter& parameter) {
        if (part.node->is_number())
            parameter.value = number(part);
        else if (const Expression value = expression(part); value.is_number())
            parameter.value = value.node().value;
        else
            parameter.expression = value;
    }

    void read_parameters(const TomlEntry& group) {
        fill_items(group, model_.parameters, [&](const TomlEntry& entry, Parameter& parameter) {
            read_value_or_parts(entry, {{"value", [&](const TomlEntry& part) { read_value(part, parameter); }},
                                        {"unit", line_into(parameter.unit)},
                                        {"text", text_into(parameter.text)}});
            if (!parameter.value && !parameter.expression)
                fail_missing(entry, "value", "value");
        });
    }

    void read_states(const TomlEntry& group) {
        fill_items(group, model_.states, [&](const TomlEntry& entry, State& state) {
            read_value_or_parts(entry,
                                {{"initial", expression_into(state.initial)},
                                 {"unit", line_into(state.unit)},
                                 {"text", text_into(state.text)},
                                 {"period", [&](const TomlEntry& part) { state.period = expression(part); }},
                                 {"drifting", [&](const TomlEntry& part) { state.drifting = reader_.boolean(part); }}});
            if (state.initial.empty())
                fail_missing(entry, "initial value", "initial");
        });
    }

    void read_definitions(const TomlEntry& group) {
        fill_items(group, model_.definitions, [&](const TomlEntry& entry, Definition& definition) {
            read_value_or_parts(entry,
                                {{"value", expression_into(definition.value)}, {"text", text_into(definition.text)}});
            if (definition.value.empty())
                fail_missing(entry, "value", "value");
        });
    }

    void read_events(const TomlEntry& group) {
        for (const TomlEntry& entry : entries(group)) {
            Event& event = model_.events.emplace_back();
            event.name = entry.name;
            const auto read_kind = [&](const TomlEntry& part) {
                event.kind = choice(part, {"barrier", "section"}) == 0 ? EventKind::barrier : EventKind::section;
            };
            const bool good = mistakes_.attempt([&] {
                places_.set(entry.path, entry.place);
                read_value_or_parts(entry, {{"function", expression_into(event.function)},
                                            {"kind", read_kind},
                                            {"text", text_into(event.text)}});
                if (event.function.empty())
                    fail_missing(entry, "function", "function");
            });
            if (!good) // a placeholder for items that refer to the event
                event.function = model_.graph->number(1);
        }
    }

    void read_jumps(const TomlEntry& group) {
        const bool has_text = !model_.find_state("text");
        for (const TomlEntry& entry : entries(group)) {
            Jump& jump = model_.jumps.emplace_back();
            jump.name = entry.name;
            jump.map = identity();
            mistakes_.attempt([&] {
                places_.set(entry.path, entry.place);
                if (entry.name == "identity")
                    throw InputError(entry.place, "the jump 'identity' exists always",
                                     "choose another name, or leave it out");
                std::vector<TomlEntry> states = entries(entry);
                // "text" describes the jump, unless a state has that name.
                if (has_text)
                    std::erase_if(states, [&](const TomlEntry& part) {
                        if (part.name == "text")
                            jump.text = reader_.string(part);
                        return part.name == "text";
                    });
                jump.map = state_map(states);
            });
        }
    }

    void read_modes(const TomlEntry& group) {
        fill_items(group, model_.modes, [&](const TomlEntry& entry, Mode& mode) {
            mode.rates.resize(model_.states.size());
            Place rates = entry.place;
            const auto read_rates = [&](const TomlEntry& part) {
                places_.set(part.path, part.place);
                rates = part.place;
                for (const TomlEntry& rate : entries(part))
                    mode.rates[key_index(rate, model_.states, "state")] = expression(rate);
            };
            const auto read_watch = [&](const TomlEntry& part) {
                places_.set(part.path, part.place);
                for (const TomlEntry& event : reader_.elements(part))
                    mode.watched.push_back(index(event, model_.events, "event"));
            };
            const auto of_mode = static_cast<std::size_t>(&mode - model_.modes.data());
            read_parts(entry, {{"text", text_into(mode.text)},
                               {"rates", read_rates},
                               {"forces", [&](const TomlEntry& part) { read_forces(of_mode, part); }},
                               {"watch", read_watch}});
            for (std::size_t i = 0; i < mode.rates.size(); ++i)
                if (const std::string& state = model_.states[i].name; mode.rates[i].empty() && !has_force(of_mode, i))
                    throw InputError(
                        rates, fmt::format("mode '{}' has no rate for the state '{}'", mode.name, state),
                        fmt::format("add {} = \"...\" to the rates; 0 for a state that does not move", state));
        });
    }

    void read_transitions(const TomlEntry& group) {
        for (const TomlEntry& entry : reader_.elements(group))
            mistakes_.attempt([&] {
                places_.set(entry.path, entry.place);
                Transition transition;
                std::optional<std::size_t> mode, event;
                const auto read_also = [&](const TomlEntry& part) {
                    for (const TomlEntry& other : reader_.elements(part))
                        transition.also.push_back(index(other, model_.events, "event"));
                };
                const auto read_when = [&](const TomlEntry& part) {
                    transition.when_text = reader_.string(part);
                    transition.when = conditions(part);
                };
                read_parts(entry,
                           {{"mode", index_into(mode, model_.modes, "mode")},
                            {"event", index_into(event, model_.events, "event")},
                            {"also", read_also},
                            {"when", read_when},
                            {"label", line_into(transition.label)},
                            {"jump", index_into(transition.jump, model_.jumps, "jump")},
                            {"next", [&](const TomlEntry& part) { transition.next = read_next(part); }},
                            {"chatter", [&](const TomlEntry& part) { transition.chatter = read_chatter(part); }}});
                if (!mode)
                    fail_missing(entry, "mode", "mode");
                if (!event)
                    fail_missing(entry, "event", "event");
                if (transition.next.empty())
                    fail_missing(entry, "next mode", "next");
                transition.mode = *mode;
                transition.event = *event;
                if (transition.label.empty())
                    transition.label = model_.modes[*mode].name + ":" + model_.events[*event].name;
                model_.transitions.push_back(std::move(transition));
            });
    }

    std::optional<std::size_t> next_mode(const TomlEntry& entry) {
        if (reader_.string(entry) == "end")
            return std::nullopt;
        return index(entry, model_.modes, "mode");
    }

    std::vector<Alternative> read_next(const TomlEntry& entry) {
        places_.set(entry.path, entry.place);
        if (entry.node->is_string())
            return {{{}, "", next_mode(entry)}};
        if (!entry.node->is_array())
            reader_.fail_type(entry, "the name of a mode or a list of alternatives");
        std::vector<Alternative> result;
        for (const TomlEntry& element : reader_.elements(entry)) {
            Alternative& alternative = result.emplace_back();
            bool has_mode = false;
            const auto read_when = [&](const TomlEntry& part) {
                alternative.when_text = reader_.string(part);
                alternative.when = conditions(part);
            };
            const auto read_mode = [&](const TomlEntry& part) {
                alternative.mode = next_mode(part);
                has_mode = true;
            };
            read_parts(element, {{"when", read_when}, {"mode", read_mode}});
            if (!has_mode)
                fail_missing(element, "mode", "mode");
        }
        return result;
    }

    Sticking read_chatter(const TomlEntry& entry) {
        std::size_t jump = 0;
        std::optional<std::size_t> mode;
        read_parts(entry, {{"jump", index_into(jump, model_.jumps, "jump")},
                           {"mode", index_into(mode, model_.modes, "mode")}});
        if (!mode)
            fail_missing(entry, "mode", "mode");
        return {jump, *mode};
    }

    void read_sections(const TomlEntry& group) {
        add_items(group, model_.sections, [&](const TomlEntry& entry, Section& section) {
            std::optional<TomlEntry> direction;
            read_parts(entry, {{"function", expression_into(section.function)},
                               {"direction", [&](const TomlEntry& part) { direction = part; }},
                               {"state", index_into(section.state, model_.states, "state")},
                               {"value", expression_into(section.value)},
                               {"text", text_into(section.text)}});
            if (section.function.empty() == !section.state)
                throw InputError(entry.place, fmt::format("{} needs either a function or a state", entry.path),
                                 "give function = \"...\", or state = \"...\" and value = ...");
            if (section.state.has_value() == section.value.empty())
                throw InputError(entry.place, fmt::format("{}: state and value belong together", entry.path),
                                 "give state = \"...\" and value = ...");
            if (direction && section.state)
                throw InputError(direction->place, fmt::format("{} cannot have a direction", entry.path),
                                 "a phase section is passed as the phase moves: leave direction out");
            constexpr std::array directions{Direction::falling, Direction::rising, Direction::both};
            if (direction)
                section.direction = directions[choice(*direction, {"falling", "rising", "both"})];
        });
    }

    void read_symmetries(const TomlEntry& group) {
        add_items(group, model_.symmetries, [&](const TomlEntry& entry, Symmetry& symmetry) {
            symmetry.map = model_.state_symbols();
            symmetry.modes.resize(model_.modes.size());
            std::iota(symmetry.modes.begin(), symmetry.modes.end(), std::size_t{0});
            const auto read_mode_images = [&](const TomlEntry& part) {
                for (const TomlEntry& mode : entries(part)) {
                    const std::size_t from = key_index(mode, model_.modes, "mode");
                    symmetry.modes[from] = index(mode, model_.modes, "mode");
                }
            };
            read_parts(entry, {{"map", [&](const TomlEntry& part) { symmetry.map = state_map(entries(part)); }},
                               {"modes", read_mode_images},
                               {"text", text_into(symmetry.text)}});
        });
    }

    void read_quantities(const TomlEntry& group) {
        add_items(group, model_.quantities, [&](const TomlEntry& entry, Quantity& quantity) {
            read_value_or_parts(entry, {{"value", expression_into(quantity.value)},
                                        {"unit", line_into(quantity.unit)},
                                        {"text", text_into(quantity.text)}});
            if (quantity.value.empty())
                fail_missing(entry, "value", "value");
        });
    }

    void read_conserved(const TomlEntry& group) {
        add_items(group, model_.conserved, [&](const TomlEntry& entry, ConservedQuantity& conserved) {
            const auto read_modes = [&](const TomlEntry& part) {
                for (const TomlEntry& mode : entries(part)) {
                    places_.set(mode.path, mode.place);
                    conserved.modes.push_back(
                        {model_.modes[key_index(mode, model_.modes, "mode")].name, expression(mode)});
                }
            };
            read_value_or_parts(entry, {{"value", expression_into(conserved.value)},
                                        {"modes", read_modes},
                                        {"unit", line_into(conserved.unit)},
                                        {"text", text_into(conserved.text)}});
            for (const Mode& mode : model_.modes)
                if (conserved.value.empty() && !conserved_in(conserved, mode.name))
                    throw InputError(entry.place,
                                     fmt::format("{} has no expression in mode '{}'", entry.path, mode.name),
                                     "give a value for all modes, or one in `modes` for each");
        });
    }

    /// Returns the number of modes that the file has, without those that are made for it.
    std::size_t written_modes() const {
        return model_.modes.size() - static_cast<std::size_t>(std::ranges::count(model_.modes, true, &Mode::derived));
    }

    void read_initial(const TomlEntry& entry) {
        std::optional<std::size_t> mode;
        read_parts(entry, {{"mode", index_into(mode, model_.modes, "mode")}});
        if (!mode && written_modes() > 1)
            fail_missing(entry, "mode", "mode");
        model_.initial_mode = mode.value_or(model_.initial_mode);
    }

    toml::table root_;
};

} // namespace

const std::vector<std::string>& model_keys() {
    static const std::vector<std::string> keys{
        "name",     "text",       "source",     "time_unit",   "parameters", "states",   "definitions",
        "modes",    "events",     "jumps",      "transitions", "slides",     "friction", "contacts",
        "sections", "symmetries", "quantities", "conserved",   "tables",     "drawing",  "initial"};
    return keys;
}

Model parse_model(std::string_view text, const std::string& file) {
    return ModelReader(text, file).read();
}

Model read_model(const std::string& path) {
    const std::string text = read_text_file(path, "model file", longest_model);
    return ModelReader(text, path, std::filesystem::path(path).parent_path().string()).read();
}

} // namespace graze
