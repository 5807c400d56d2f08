#include "graze/model/model_file.hpp"

#include "graze/base/input_error.hpp"
#include "graze/base/printable.hpp"
#include "graze/base/text_file.hpp"
#include "model/model_file_parts.hpp"
#include "model/model_validate.hpp"

#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <map>

namespace graze {

namespace {

/// Reads one model, table by table.
class ModelReader : private ModelParts {
public:
    ModelReader(std::string_view text, const std::string& file)
        : ModelParts(text, file), root_(parse_toml(text, file)) {}

    Model read() {
        if (root_.empty())
            throw InputError({source_.file(), 0, 0}, "the model is empty",
                             "give at least [states] and a mode; docs/model-format.md shows how");
        std::map<std::string, TomlEntry> top;
        for (const TomlEntry& entry : reader_.entries(root_, "")) {
            mistakes_.attempt([&] {
                reader_.require_known(entry, "",
                                      {"name", "text", "source", "time_unit", "parameters", "states", "definitions",
                                       "modes", "events", "jumps", "transitions", "sections", "symmetries",
                                       "quantities", "initial"});
            });
            places_.set(entry.name, entry.place);
            top.emplace(entry.name, entry);
        }
        const auto read = [&](const char* key, void (ModelReader::*member)(const TomlEntry&)) {
            const auto found = top.find(key);
            return found == top.end() || mistakes_.attempt([&] { (this->*member)(found->second); });
        };
        mistakes_.attempt([&] { read_head(top); });
        const bool named =
            read("parameters", &ModelReader::name_parameters) && read("states", &ModelReader::name_states) &&
            read("definitions", &ModelReader::name_definitions) && read("modes", &ModelReader::name_modes) &&
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
        read("transitions", &ModelReader::read_transitions);
        read("sections", &ModelReader::read_sections);
        read("symmetries", &ModelReader::read_symmetries);
        read("quantities", &ModelReader::read_quantities);
        read("initial", &ModelReader::read_initial);
        if (top.count("initial") == 0 && model_.modes.size() > 1)
            mistakes_.attempt([&] {
                throw InputError({source_.file(), 0, 0},
                                 "the model has several modes but does not say which one is first",
                                 "add [initial] with mode = \"<mode>\"");
            });
        mistakes_.throw_noted();
        validate_model(model_, places_);
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

    /// Names are read before all contents, which may refer to them in any order.
    template <typename Item>
    void name_items(const TomlEntry& group, std::vector<Item>& items) {
        for (const TomlEntry& entry : reader_.entries(reader_.table(group), group.path)) {
            places_.set(entry.path, entry.place);
            Item item;
            item.name = entry.name;
            items.push_back(std::move(item));
        }
    }

    /// A number written as an expression, such as 30*pi/180, depends on no parameter and can be changed like a number.
    static void set_value(Parameter& parameter, const Expression& value) {
        if (value.is_number())
            parameter.value = value.node().value;
        else
            parameter.expression = value;
    }

    void read_parameters(const TomlEntry& group) {
        auto item = model_.parameters.begin();
        for (const TomlEntry& entry : reader_.entries(reader_.table(group), group.path)) {
            Parameter& parameter = *item++;
            mistakes_.attempt([&] {
                for (const TomlEntry& part : short_form(entry, "value", {"value", "unit", "text"})) {
                    if (part.name == "value" && part.node->is_number())
                        parameter.value = number(part);
                    else if (part.name == "value")
                        set_value(parameter, expression(part));
                    else
                        read_words(part, parameter.unit, parameter.text);
                }
                if (!parameter.value && !parameter.expression)
                    fail_missing(entry, "value", "value");
            });
        }
    }

    void read_words(const TomlEntry& part, std::string& unit, std::string& text) const {
        if (part.name == "unit")
            unit = reader_.line(part);
        else
            text = reader_.string(part);
    }

    void read_states(const TomlEntry& group) {
        auto item = model_.states.begin();
        for (const TomlEntry& entry : reader_.entries(reader_.table(group), group.path)) {
            State& state = *item++;
            mistakes_.attempt([&] {
                for (const TomlEntry& part :
                     short_form(entry, "initial", {"initial", "unit", "text", "period", "drifting"})) {
                    if (part.name == "initial")
                        state.initial = expression(part);
                    else if (part.name == "period")
                        state.period = expression(part);
                    else if (part.name == "drifting")
                        state.drifting = reader_.boolean(part);
                    else
                        read_words(part, state.unit, state.text);
                }
                if (state.initial.empty())
                    fail_missing(entry, "initial value", "initial");
            });
        }
    }

    void read_definitions(const TomlEntry& group) {
        auto item = model_.definitions.begin();
        for (const TomlEntry& entry : reader_.entries(reader_.table(group), group.path)) {
            Definition& definition = *item++;
            mistakes_.attempt([&] {
                for (const TomlEntry& part : short_form(entry, "value", {"value", "text"})) {
                    if (part.name == "value")
                        definition.value = expression(part);
                    else
                        definition.text = reader_.string(part);
                }
                if (definition.value.empty())
                    fail_missing(entry, "value", "value");
            });
        }
    }

    void read_events(const TomlEntry& group) {
        for (const TomlEntry& entry : reader_.entries(reader_.table(group), group.path)) {
            Event event;
            event.name = entry.name;
            const bool good = mistakes_.attempt([&] {
                places_.set(entry.path, entry.place);
                for (const TomlEntry& part : short_form(entry, "function", {"function", "kind", "text"})) {
                    if (part.name == "function")
                        event.function = expression(part);
                    else if (part.name == "kind")
                        event.kind =
                            choice(part, {"barrier", "section"}) == 0 ? EventKind::barrier : EventKind::section;
                    else
                        event.text = reader_.string(part);
                }
                if (event.function.empty())
                    fail_missing(entry, "function", "function");
            });
            if (!good) // a placeholder for items that refer to the event
                event.function = model_.graph->number(1);
            model_.events.push_back(std::move(event));
        }
    }

    void read_jumps(const TomlEntry& group) {
        const bool has_text = !model_.find_state("text");
        for (const TomlEntry& entry : reader_.entries(reader_.table(group), group.path)) {
            Jump jump;
            jump.name = entry.name;
            jump.map = identity();
            mistakes_.attempt([&] {
                places_.set(entry.path, entry.place);
                if (entry.name == "identity")
                    throw InputError(entry.place, "the jump 'identity' exists always",
                                     "choose another name, or leave it out");
                std::vector<TomlEntry> states = reader_.entries(reader_.table(entry), entry.path);
                // "text" describes the jump, unless a state has that name.
                if (has_text)
                    std::erase_if(states, [&](const TomlEntry& part) {
                        if (part.name == "text")
                            jump.text = reader_.string(part);
                        return part.name == "text";
                    });
                jump.map = state_map(states);
            });
            model_.jumps.push_back(std::move(jump));
        }
    }

    void read_modes(const TomlEntry& group) {
        auto item = model_.modes.begin();
        for (const TomlEntry& entry : reader_.entries(reader_.table(group), group.path)) {
            Mode& mode = *item++;
            mistakes_.attempt([&] {
                mode.rates.resize(model_.states.size());
                Place rates = entry.place;
                for (const TomlEntry& part :
                     reader_.entries(reader_.table(entry), entry.path, {"text", "rates", "watch"})) {
                    places_.set(part.path, part.place);
                    if (part.name == "text") {
                        mode.text = reader_.string(part);
                    } else if (part.name == "watch") {
                        for (const TomlEntry& event : reader_.elements(part))
                            mode.watched.push_back(index(event, model_.events, "event"));
                    } else {
                        rates = part.place;
                        for (const TomlEntry& rate : reader_.entries(reader_.table(part), part.path))
                            mode.rates[key_index(rate, model_.states, "state")] = expression(rate);
                    }
                }
                for (std::size_t i = 0; i < mode.rates.size(); ++i)
                    if (mode.rates[i].empty())
                        throw InputError(
                            rates,
                            fmt::format("mode '{}' has no rate for the state '{}'", mode.name, model_.states[i].name),
                            fmt::format("add {} = \"...\" to the rates; 0 for a state that does not move",
                                        model_.states[i].name));
            });
        }
    }

    void read_transitions(const TomlEntry& group) {
        for (const TomlEntry& entry : reader_.elements(group)) {
            mistakes_.attempt([&] {
                places_.set(entry.path, entry.place);
                Transition transition;
                bool has_mode = false;
                bool has_event = false;
                for (const TomlEntry& part : reader_.entries(reader_.table(entry), entry.path,
                                                             {"mode", "event", "label", "jump", "next", "chatter"})) {
                    if (part.name == "mode") {
                        transition.mode = index(part, model_.modes, "mode");
                        has_mode = true;
                    } else if (part.name == "event") {
                        transition.event = index(part, model_.events, "event");
                        has_event = true;
                    } else if (part.name == "label") {
                        transition.label = reader_.line(part);
                    } else if (part.name == "jump") {
                        transition.jump = index(part, model_.jumps, "jump");
                    } else if (part.name == "next") {
                        transition.next = read_next(part);
                    } else {
                        transition.chatter = read_chatter(part);
                    }
                }
                if (!has_mode)
                    fail_missing(entry, "mode", "mode");
                if (!has_event)
                    fail_missing(entry, "event", "event");
                if (transition.next.empty())
                    fail_missing(entry, "next mode", "next");
                if (transition.label.empty())
                    transition.label = model_.modes[transition.mode].name + ":" + model_.events[transition.event].name;
                model_.transitions.push_back(std::move(transition));
            });
        }
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
            Alternative alternative;
            bool has_mode = false;
            for (const TomlEntry& part : reader_.entries(reader_.table(element), element.path, {"when", "mode"})) {
                if (part.name == "mode") {
                    alternative.mode = next_mode(part);
                    has_mode = true;
                } else {
                    alternative.when_text = reader_.string(part);
                    alternative.when = conditions(part);
                }
            }
            if (!has_mode)
                fail_missing(element, "mode", "mode");
            result.push_back(std::move(alternative));
        }
        return result;
    }

    Sticking read_chatter(const TomlEntry& entry) {
        Sticking sticking{0, model_.modes.size()};
        for (const TomlEntry& part : reader_.entries(reader_.table(entry), entry.path, {"jump", "mode"})) {
            if (part.name == "jump")
                sticking.jump = index(part, model_.jumps, "jump");
            else
                sticking.mode = index(part, model_.modes, "mode");
        }
        if (sticking.mode == model_.modes.size())
            fail_missing(entry, "mode", "mode");
        return sticking;
    }

    void read_sections(const TomlEntry& group) {
        for (const TomlEntry& entry : reader_.entries(reader_.table(group), group.path)) {
            mistakes_.attempt([&] {
                places_.set(entry.path, entry.place);
                Section section;
                section.name = entry.name;
                const TomlEntry* direction = nullptr;
                const std::vector<TomlEntry> parts = reader_.entries(
                    reader_.table(entry), entry.path, {"function", "direction", "state", "value", "text"});
                for (const TomlEntry& part : parts) {
                    if (part.name == "function")
                        section.function = expression(part);
                    else if (part.name == "state")
                        section.state = index(part, model_.states, "state");
                    else if (part.name == "value")
                        section.value = expression(part);
                    else if (part.name == "text")
                        section.text = reader_.string(part);
                    else
                        direction = &part;
                }
                if (section.function.empty() == !section.state)
                    throw InputError(entry.place, fmt::format("{} needs either a function or a state", entry.path),
                                     "give function = \"...\", or state = \"...\" and value = ...");
                if (section.state.has_value() == section.value.empty())
                    throw InputError(entry.place, fmt::format("{}: state and value belong together", entry.path),
                                     "give state = \"...\" and value = ...");
                if (direction != nullptr && section.state)
                    throw InputError(direction->place, fmt::format("{} cannot have a direction", entry.path),
                                     "a phase section is passed as the phase moves: leave direction out");
                constexpr std::array directions{Direction::falling, Direction::rising, Direction::both};
                if (direction != nullptr)
                    section.direction = directions[choice(*direction, {"falling", "rising", "both"})];
                model_.sections.push_back(std::move(section));
            });
        }
    }

    void read_symmetries(const TomlEntry& group) {
        for (const TomlEntry& entry : reader_.entries(reader_.table(group), group.path)) {
            mistakes_.attempt([&] {
                places_.set(entry.path, entry.place);
                Symmetry symmetry;
                symmetry.name = entry.name;
                symmetry.map = model_.state_symbols();
                for (std::size_t i = 0; i < model_.modes.size(); ++i)
                    symmetry.modes.push_back(i);
                for (const TomlEntry& part :
                     reader_.entries(reader_.table(entry), entry.path, {"map", "modes", "text"})) {
                    if (part.name == "text") {
                        symmetry.text = reader_.string(part);
                    } else if (part.name == "map") {
                        symmetry.map = state_map(reader_.entries(reader_.table(part), part.path));
                    } else {
                        for (const TomlEntry& mode : reader_.entries(reader_.table(part), part.path)) {
                            const std::size_t from = key_index(mode, model_.modes, "mode");
                            symmetry.modes[from] = index(mode, model_.modes, "mode");
                        }
                    }
                }
                model_.symmetries.push_back(std::move(symmetry));
            });
        }
    }

    void read_quantities(const TomlEntry& group) {
        for (const TomlEntry& entry : reader_.entries(reader_.table(group), group.path)) {
            mistakes_.attempt([&] {
                places_.set(entry.path, entry.place);
                Quantity quantity;
                quantity.name = entry.name;
                for (const TomlEntry& part : short_form(entry, "value", {"value", "unit", "text"})) {
                    if (part.name == "value")
                        quantity.value = expression(part);
                    else
                        read_words(part, quantity.unit, quantity.text);
                }
                if (quantity.value.empty())
                    fail_missing(entry, "value", "value");
                model_.quantities.push_back(std::move(quantity));
            });
        }
    }

    void read_initial(const TomlEntry& entry) {
        bool has_mode = false;
        for (const TomlEntry& part : reader_.entries(reader_.table(entry), entry.path, {"mode"})) {
            model_.initial_mode = index(part, model_.modes, "mode");
            has_mode = true;
        }
        if (!has_mode && model_.modes.size() > 1)
            fail_missing(entry, "mode", "mode");
    }

    toml::table root_;
};

} // namespace

Model parse_model(std::string_view text, const std::string& file) {
    return ModelReader(text, file).read();
}

Model read_model(const std::string& path) {
    return parse_model(read_text_file(path, "model file", longest_model), path);
}

} // namespace graze
