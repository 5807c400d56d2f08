#include "design/design_reader.hpp"

#include "design/design_keys.hpp"
#include "graze/base/file_name.hpp"
#include "graze/base/with_place.hpp"
#include "graze/model/catalogue.hpp"
#include "graze/study/study_catalogue.hpp"

#include <fmt/format.h>

namespace graze {

Design DesignReader::read(const toml::table& root) {
    design_.fingerprint = design_fingerprint(root);
    whole_ = mistakes_.attempt([&] { read_keys(root); });
    const auto with = [&](const char* name, auto work) { with_key(mistakes_, keys_, name, work); };
    const auto require_key = [&](const char* name, const char* remedy) {
        if (!key(name) && whole_)
            mistakes_.attempt([&] {
                throw InputError(Place{design_.file, 1, 1}, fmt::format("the design has no {}", name), remedy);
            });
    };
    require_key("name", "give name = \"...\" in its first line");
    require_key("approach", "add a table [approach], which says how the device comes to its touch");
    require_key("dimensions", "add a table [dimensions.NAME] for each parameter that may be chosen");
    with("name", [&](const TomlEntry& e) {
        design_.name = reader_.toml().string(e);
        require_file_name(design_.name, "name of a design", reader_.toml().place(*e.node));
    });
    with("text", [&](const TomlEntry& e) { design_.text = reader_.toml().string(e); });
    with("source", [&](const TomlEntry& e) { design_.source = reader_.toml().string(e); });
    with("approach", [&](const TomlEntry& e) { read_approach(e); });
    // Parts that name parameters need the model.
    if (mistakes_.attempt([&] { read_model(); })) {
        with("set", [&](const TomlEntry& e) { read_set(e); });
        mistakes_.attempt([&] { read_control(); });
        mistakes_.attempt([&] { read_branch(); });
        with("trip", [&](const TomlEntry& e) { read_trip(e); });
        mistakes_.attempt([&] { read_dimensions(); });
        mistakes_.attempt([&] { read_choices(); });
        with("yield", [&](const TomlEntry& e) { read_yield(e); });
        with("wanted", [&](const TomlEntry& e) { WantedReader(reader_, design_).read(e); });
    }
    mistakes_.throw_noted();
    return std::move(design_);
}

void DesignReader::read_keys(const toml::table& root) {
    StudyReader::each(reader_.toml().entries(root, ""), [&](const TomlEntry& entry) {
        require_design_key(reader_.toml(), entry);
        keys_.emplace(entry.name, entry);
    });
}

const TomlEntry* DesignReader::key(const std::string& name) const {
    const auto found = keys_.find(name);
    return found == keys_.end() ? nullptr : &found->second;
}

/// Reads the parts of the approach that do not need the model.
void DesignReader::read_approach(const TomlEntry& entry) {
    Approach& approach = design_.approach;
    approach.place = entry.place;
    const auto noted = [&](const StudyReader::ReadEntry& read) {
        return [this, read](const TomlEntry& item) {
            approach_.emplace(item.name, item);
            if (read)
                read(item);
        };
    };
    reader_.read_keys(entry, {{"study", noted(reader_.into(approach.study))},
                              {"run", noted(reader_.into(approach.run))},
                              {"point", noted(reader_.into(approach.point))},
                              {"from", noted({})},
                              {"range", noted({})},
                              {"event", noted(reader_.into(approach.event))},
                              {"cycles", noted(reader_.into(approach.cycles, {1, 1'000'000}))}});
    const bool of_study = !approach.study.empty();
    for (const char* name : {"run", "point"})
        if (of_study != approach_.contains(name))
            throw InputError(entry.place,
                             of_study ? fmt::format("{} names no {} of the study", entry.path, name)
                                      : fmt::format("{} names a {} without a study", entry.path, name),
                             of_study ? "give run = \"NAME\" and point = \"GR1\""
                                      : "give study = \"NAME\", or leave it out and give range = [A, B]");
    for (const char* name : {"from", "range", "cycles"})
        if (of_study && approach_.contains(name))
            throw InputError(approach_.at(name).place,
                             fmt::format("the study defines its runs itself, so '{}' cannot be given", name),
                             "leave it out");
    if (!of_study && !approach_.contains("range"))
        throw InputError(entry.place, fmt::format("{} has no range", entry.path),
                         "give range = [A, B]: where the control parameter begins, and how far it goes");
}

void DesignReader::read_model() {
    if (!design_.approach.study.empty())
        return take_model_of_study();
    const TomlEntry* entry = key("model");
    if (!entry && !whole_)
        mistakes_.throw_noted();
    if (!entry)
        throw InputError(Place{design_.file, 1, 1}, "the design has no model", "give model = \"NAME\" or a path");
    const std::string name = reader_.toml().string(*entry);
    design_.model_path = is_model_path(name) ? beside(design_.file, name) : name;
    design_.model = with_place(reader_.toml().place(*entry->node), [&] { return load_model(design_.model_path); });
}

void DesignReader::take_model_of_study() {
    Approach& approach = design_.approach;
    if (const TomlEntry* entry = key("model"))
        throw InputError(entry->place, "the study has its model already", "leave `model` out");
    const Place place = reader_.toml().place(*approach_.at("study").node);
    if (is_model_path(approach.study))
        approach.study = beside(design_.file, approach.study);
    const Study study = with_place(place, [&] { return load_study(approach.study); });
    require_run(approach.run, names_of(study.runs), reader_.toml().place(*approach_.at("run").node));
    const StudyRun& run = *study.find_run(approach.run);
    if (!run.is_branch())
        throw InputError(reader_.toml().place(*approach_.at("run").node),
                         fmt::format("run '{}' has no orbits", approach.run),
                         "name one of kind \"orbit\" or \"continue\"");
    design_.model = run.model;
    design_.model_path = run.model_path;
}

void DesignReader::read_set(const TomlEntry& entry) {
    reader_.each_of(entry, {}, [&](const TomlEntry& item) {
        const double value = number(item);
        with_place(item.place, [&] { design_.model.set_parameter(item.name, value); });
        design_.set.emplace_back(item.name, value);
    });
}

ParameterId DesignReader::parameter_of(const TomlEntry& entry, const std::string& name) const {
    return with_place(entry.place, [&] { return design_.model.independent_parameter(name); });
}

void DesignReader::read_control() {
    const TomlEntry* entry = key("control");
    if (!entry)
        throw InputError(Place{design_.file, 1, 1}, "the design has no control parameter",
                         "give control = \"NAME\", such as the voltage's");
    design_.control = reader_.toml().line(*entry);
    design_.control_parameter = parameter_of(*entry, design_.control);
}

/// Reads the parts of the approach that need the model.
void DesignReader::read_branch() {
    Approach& approach = design_.approach;
    Mistakes mistakes;
    const auto with = [&](const char* name, auto work) { with_key(mistakes, approach_, name, work); };
    with("range", [&](const TomlEntry& e) {
        approach.range_place = e.place;
        std::tie(approach.least, approach.greatest) = reader_.range(design_.model, e);
    });
    with("event", [&](const TomlEntry& e) {
        if (!design_.model.find_event(approach.event))
            reader_.fail(e, fmt::format("model '{}' has no event '{}'", design_.model.name, approach.event),
                         study_name_remedy(approach.event, names_of(design_.model.events)));
    });
    with("from", [&](const TomlEntry& e) {
        reader_.each_of(e, {}, [&](const TomlEntry& item) {
            const double value = number(item);
            with_place(item.place, [&] { design_.model.set_initial(item.name, value); });
            approach.from.emplace_back(item.name, value);
        });
    });
    mistakes.throw_noted();
}

void DesignReader::read_trip(const TomlEntry& entry) {
    constexpr std::size_t most_overshoots = 100;
    TripRequest& trip = design_.trip;
    reader_.each_of(entry, {"until", "overshoots", "cycles"}, [&](const TomlEntry& item) {
        if (item.name == "cycles") {
            trip.cycles = static_cast<double>(reader_.count(item, 1, 1'000'000));
        } else if (item.name == "overshoots") {
            trip.place = reader_.toml().place(*item.node);
            reader_.each(reader_.toml().elements(item), [&](const TomlEntry& one) {
                if (trip.overshoots.size() == most_overshoots)
                    reader_.fail(item, fmt::format("there are more than {} overshoots", most_overshoots),
                                 "leave some of them out");
                trip.overshoots.push_back(reader_.positive(design_.model, one));
            });
        } else {
            trip.until = reader_.toml().line(item);
            const std::size_t equals = trip.until.rfind('=');
            if (trip.until == "end")
                return;
            if (equals == std::string::npos)
                reader_.fail(item, fmt::format("'{}' names no level", trip.until),
                             "write \"end\", \"EXPR=LEVEL\", such as \"q=0.9\", or \"speed=VALUE\"");
            const Place place = reader_.inside(item);
            const double level = value_of_text(design_.model, trip.until.substr(equals + 1), place);
            const std::string what = trip.until.substr(0, equals);
            if (what == "speed" && !(level > 0))
                reader_.fail(item, "the approach speed is not positive", "give one that contacts are to reach");
            if (what == "speed")
                trip.end.speed = level;
            else
                trip.end.quantity = named_value(design_.model, what, place).value;
            trip.end.level = what == "speed" ? 0 : level;
        }
    });
}

/// Parses a tolerance: a number in the parameter's unit or "2%", optionally followed by " uniform" or " normal".
DesignTolerance DesignReader::tolerance_of(const TomlEntry& entry) const {
    DesignTolerance result;
    if (!entry.node->is_string()) {
        result.size = number(entry);
    } else {
        std::string text = reader_.toml().line(entry);
        const auto ends_with = [&](std::string_view word) {
            const bool does = text.ends_with(word);
            if (does)
                text.resize(text.size() - word.size());
            return does;
        };
        if (ends_with(" uniform"))
            result.spread = Spread::uniform;
        else
            ends_with(" normal");
        if (const std::size_t word = text.find_last_of("% "); word + 1 < text.size() && word != std::string::npos &&
                                                              is_valid_name(text.substr(word + 1)) &&
                                                              !design_.model.find_parameter(text.substr(word + 1)))
            reader_.fail(entry, fmt::format("'{}' is no way in which devices differ", text.substr(word + 1)),
                         "write \"1%\" for a standard deviation of one percent, \"1% uniform\" for the largest "
                         "departure");
        while (text.ends_with(' '))
            text.pop_back();
        result.share = !text.empty() && text.back() == '%';
        if (result.share)
            text.pop_back();
        result.size = value_of_text(design_.model, text, reader_.inside(entry)) * (result.share ? 0.01 : 1);
    }
    if (!(result.size >= 0))
        reader_.fail(entry, fmt::format("{} is below zero", entry.path), "give its size");
    return result;
}

void DesignReader::read_dimension(const TomlEntry& entry) {
    DesignDimension dimension;
    dimension.name = entry.name;
    dimension.place = entry.place;
    dimension.parameter = parameter_of(entry, entry.name);
    if (dimension.parameter == design_.control_parameter && !design_.control.empty())
        throw InputError(entry.place,
                         fmt::format("'{}' is the control parameter, whose trip value follows", entry.name),
                         "choose other parameters");
    const Parameter& parameter = design_.model.parameters[*design_.model.find_parameter(entry.name)];
    dimension.unit = parameter.unit;
    dimension.text = parameter.text;
    bool ranged = false;
    reader_.each_of(entry, {"text", "range", "tolerance"}, [&](const TomlEntry& item) {
        if (item.name == "text")
            dimension.text = reader_.toml().line(item);
        else if (item.name == "tolerance")
            dimension.tolerance = tolerance_of(item);
        else
            std::tie(dimension.least, dimension.greatest) = reader_.range(design_.model, item), ranged = true;
    });
    if (!ranged)
        throw InputError(entry.place, fmt::format("{} has no range", entry.path),
                         "give range = [A, B], within which it may be chosen");
    if (design_.approach.study.empty()) // a study's runs may have other values
        dimension.require_first(design_.model.parameter_values()[dimension.parameter.place()]);
    design_.dimensions.push_back(std::move(dimension));
}

void DesignReader::read_dimensions() {
    constexpr std::size_t most_dimensions = 50;
    const TomlEntry* entry = key("dimensions");
    if (!entry)
        return;
    const auto entries = reader_.toml().entries(reader_.toml().table(*entry), entry->path);
    if (entries.empty() || entries.size() > most_dimensions)
        reader_.fail(*entry, fmt::format("the design has {} dimensions", entries.size()),
                     fmt::format("give from 1 to {}", most_dimensions));
    for (const TomlEntry& one : entries)
        dimension_names_.insert(one.name);
    StudyReader::each(entries, [&](const TomlEntry& one) { read_dimension(one); });
}

/// Finds a dimension by name. @return nothing for one that was invalid, which has been reported
std::optional<std::size_t> DesignReader::dimension_named(const TomlEntry& entry) const {
    const std::string name = reader_.toml().line(entry);
    if (const auto place = design_.find_dimension(name))
        return place;
    if (dimension_names_.empty() || dimension_names_.contains(name))
        return std::nullopt;
    reader_.fail(entry, fmt::format("the design has no dimension '{}'", name),
                 study_name_remedy(name, {dimension_names_.begin(), dimension_names_.end()}));
}

/// Reads choices among the dimensions: the adjustable one, planes, and numbers of points.
void DesignReader::read_choices() {
    constexpr std::size_t most_planes = 20, most_points = 401;
    if (const TomlEntry* entry = key("adjustable"))
        design_.adjustable = dimension_named(*entry);
    if (const TomlEntry* entry = key("points"))
        reader_.read_keys(*entry, {{"curve", reader_.into(design_.curve_points, {2, most_points})},
                                   {"plane", reader_.into(design_.plane_points, {2, most_points})}});
    if (const TomlEntry* entry = key("planes")) {
        const auto items = reader_.toml().elements(*entry);
        if (items.size() > most_planes)
            reader_.fail(*entry, fmt::format("the design has {} planes", items.size()),
                         fmt::format("give up to {}", most_planes));
        reader_.each(items, [&](const TomlEntry& item) {
            const auto pair = reader_.toml().elements(item);
            if (pair.size() != 2)
                reader_.fail(item, fmt::format("{} has {} dimensions", item.path, pair.size()),
                             "name two: [\"A\", \"B\"]");
            const std::optional<std::size_t> x = dimension_named(pair[0]), y = dimension_named(pair[1]);
            if (!x || !y)
                return;
            if (*x == *y)
                reader_.fail(item, fmt::format("{} has one dimension twice", item.path), "name two");
            design_.planes.emplace_back(*x, *y);
        });
    }
    if (design_.planes.empty() && design_.dimensions.size() > 1)
        design_.planes.emplace_back(0, 1);
}

void DesignReader::read_yield(const TomlEntry& entry) {
    DesignYield& yield = design_.yield;
    reader_.read_keys(entry, {{"devices", reader_.into(yield.devices, {2, 1'000'000})},
                              {"seed", [&](const TomlEntry& item) { yield.seed = reader_.count(item); }},
                              {"within", [&](const TomlEntry& item) {
                                   std::tie(yield.least, yield.greatest) = reader_.range(design_.model, item);
                               }}});
}

} // namespace graze
