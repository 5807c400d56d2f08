#include "program/values.hpp"

#include "base/read_whole.hpp"
#include "graze/base/input_error.hpp"
#include "graze/base/name_list.hpp"
#include "graze/base/trimmed.hpp"
#include "graze/layout/device_file.hpp"
#include "graze/model/named_value.hpp"
#include "graze/model/parameter_file.hpp"
#include "graze/study/study.hpp"
#include "graze/symbolic/parser.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

namespace graze {

namespace {

constexpr std::string_view blanks = " \t\n";

struct Assignment {
    std::string name, text;
    Place place;      ///< place of the text after "="
    Place name_place; ///< the option, or the line of a file of parameters
    bool in_file = false;
};

Assignment parse_assignment(const std::string& item, const std::string& option) {
    const std::size_t equals = item.find('=');
    if (equals == std::string::npos)
        throw InputError({option, 0, 0}, fmt::format("'{}' sets nothing", item),
                         fmt::format("write {}=VALUE (what is to be computed comes before the options)",
                                     is_valid_name(item) ? item : "NAME"));
    Assignment result;
    result.name = trimmed(std::string_view(item).substr(0, equals), blanks);
    result.text = item.substr(equals + 1);
    result.place = {fmt::format("{} {}", option, item), 1, static_cast<int>(equals) + 2};
    result.name_place = {option, 0, 0};
    return result;
}

void require_model(const ParameterFile& file, const std::vector<std::string>& models) {
    if (!file.model.empty() && std::find(models.begin(), models.end(), file.model) == models.end())
        throw InputError(file.places.at("model"),
                         fmt::format("these values were found for the model '{}', not for '{}'", file.model,
                                     fmt::join(models, "', '")),
                         "give those of this model, or leave out the line that names it");
}

/// The assignments in a file of parameters for --set or --from.
/// @param model the model that is used; null: not known yet
std::vector<Assignment> assignments_in(const std::string& path, const std::string& option, const Model* model) {
    const ParameterFile file = read_parameter_file(path);
    if (model != nullptr)
        require_model(file, {model->name});
    const std::string table = option.substr(2); // "--set", "--from"
    std::vector<Assignment> all;
    for (const auto& [name, value] : table == "set" ? file.set : file.from) {
        const Place place = file.places.at(table + "." + name);
        all.push_back({name, fmt::format("{}", value), place, place, true});
    }
    if (all.empty())
        throw InputError(Place{path, 0, 0}, fmt::format("it has nothing for {}", option),
                         fmt::format("leave {} @{} out", option, path));
    return all;
}

/// All assignments of an option, with those of files that it names as `@FILE`. A later value of the same name replaces
/// one of a file; two values on the command line are an error, since one would be ignored.
std::vector<Assignment> all_assignments(const std::vector<std::string>& arguments, const std::string& option,
                                        const Model* model) {
    std::vector<Assignment> all;
    for (const std::string& item : split_list(arguments))
        for (Assignment& one : item.starts_with('@') ? assignments_in(item.substr(1), option, model)
                                                     : std::vector{parse_assignment(item, option)}) {
            const auto before =
                std::find_if(all.begin(), all.end(), [&](const Assignment& other) { return other.name == one.name; });
            if (before != all.end() && !before->in_file)
                throw InputError({option, 0, 0}, fmt::format("'{}' is given twice", one.name),
                                 one.in_file ? "name the file first: what comes later takes the place of what it says"
                                             : "leave one of them out");
            if (before != all.end())
                all.erase(before);
            all.push_back(std::move(one));
        }
    return all;
}

/// Calls a function; its error about a name of a file gets the line of that file as place.
template <class Work>
void at_name(const Assignment& assignment, const Work& work) {
    try {
        work();
    } catch (const InputError& error) {
        if (!assignment.in_file || !error.place().file.empty())
            throw;
        throw InputError(assignment.name_place, error.problem(), error.remedy());
    }
}

} // namespace

std::vector<std::string> split_list(const std::vector<std::string>& arguments) {
    std::vector<std::string> items;
    for (const std::string& argument : arguments)
        for (std::size_t start = 0; start <= argument.size();) {
            const std::size_t end = std::min(argument.find(',', start), argument.size());
            if (const std::string_view item = trimmed(std::string_view(argument).substr(start, end - start), blanks);
                !item.empty())
                items.emplace_back(item);
            start = end + 1;
        }
    return items;
}

double positive_value_of(const Model& model, std::string_view text, const std::string& option) {
    const double value = value_of(model, text, option);
    if (!(value > 0))
        throw InputError({option, 0, 0}, fmt::format("{} is not positive", value), "give a positive number");
    return value;
}

void set_parameters(Model& model, const std::vector<std::string>& assignments) {
    for (const Assignment& assignment : all_assignments(assignments, "--set", &model)) {
        if (!model.find_parameter(assignment.name) && model.find_state(assignment.name))
            throw InputError(assignment.name_place, fmt::format("'{}' is a state, not a parameter", assignment.name),
                             assignment.in_file ? "write it under [from]"
                                                : fmt::format("choose where it starts by --from {}={}", assignment.name,
                                                              assignment.text));
        at_name(assignment, [&] {
            if (!model.find_parameter(assignment.name))
                model.set_parameter(assignment.name, 0); // throws, with the names of parameters
            model.set_parameter(assignment.name, value_of_text(model, assignment.text, assignment.place));
        });
    }
}

std::vector<std::pair<std::string, double>> parameter_values(const std::vector<std::string>& assignments,
                                                             const ValueReader& read) {
    std::vector<std::pair<std::string, double>> values;
    for (const Assignment& one : all_assignments(assignments, "--set", nullptr))
        values.emplace_back(one.name,
                            read ? read(one.name, one.text, one.place) : value_of_text(Model(), one.text, one.place));
    return values;
}

void with_places_of(const std::vector<std::string>& assignments, const std::function<void()>& work) {
    try {
        work();
    } catch (const InputError& error) {
        const std::string& file = error.place().file;
        if (assignments.empty() || !(file.empty() || file.starts_with("--set") || is_given_place(error.place())))
            throw;
        for (const Assignment& assignment : all_assignments(assignments, "--set", nullptr))
            if (assignment.in_file && (file == given_place(assignment.name).file ||
                                       error.problem().find("'" + assignment.name + "'") != std::string::npos))
                throw InputError(assignment.name_place, error.problem(), error.remedy());
        if (!file.empty())
            throw;
        throw InputError(Place{"--set", 0, 0}, error.problem(), error.remedy());
    }
}

void require_models_of_files(const std::vector<std::string>& assignments, const std::vector<std::string>& models) {
    for (const std::string& item : split_list(assignments))
        if (item.starts_with('@'))
            require_model(read_parameter_file(item.substr(1)), models);
}

void set_initial_state(Model& model, const std::vector<std::string>& assignments) {
    for (const Assignment& assignment : all_assignments(assignments, "--from", &model)) {
        if (!model.find_state(assignment.name) && model.find_parameter(assignment.name))
            throw InputError(assignment.name_place, fmt::format("'{}' is a parameter, not a state", assignment.name),
                             assignment.in_file
                                 ? "write it under [set]"
                                 : fmt::format("choose its value by --set {}={}", assignment.name, assignment.text));
        at_name(assignment, [&] {
            if (!model.find_state(assignment.name))
                model.set_initial(assignment.name, 0); // throws, with the names of states
            model.set_initial(assignment.name, value_of_text(model, assignment.text, assignment.place));
        });
    }
}

std::vector<double> disturbance_of(const Model& model, const std::vector<std::string>& assignments) {
    const std::vector<std::string> items = split_list(assignments);
    std::vector<double> values(items.empty() ? 0 : model.states.size(), 0.0);
    std::set<std::string> names;
    for (const std::string& item : items) {
        const Assignment assignment = parse_assignment(item, "--disturbance");
        const std::optional<std::size_t> state = model.find_state(assignment.name);
        if (!state) {
            std::vector<std::string> states;
            for (const State& one : model.states)
                states.push_back(one.name);
            throw InputError({"--disturbance", 0, 0}, fmt::format("'{}' is not a state", assignment.name),
                             fmt::format("choose one of {}", name_list(states, assignment.name)));
        }
        if (!names.insert(assignment.name).second)
            throw InputError({"--disturbance", 0, 0}, fmt::format("'{}' is given twice", assignment.name),
                             "leave one of them out");
        values[*state] = value_of_text(model, assignment.text, assignment.place);
    }
    return values;
}

std::vector<RequestedQuantity> requested_quantities(const Model& model, const std::vector<std::string>& texts,
                                                    const std::string& option) {
    std::vector<RequestedQuantity> result;
    for (const std::string& text : texts)
        result.push_back(requested_quantity(model, text, option));
    return result;
}

std::optional<double> finite_number_in(std::string_view text) {
    double value = 0;
    return read_whole(text, value) && std::isfinite(value) ? std::optional(value) : std::nullopt;
}

double number_of_option(const std::string& text, const char* option) {
    if (const std::optional<double> value = finite_number_in(text))
        return *value;
    throw InputError({option, 0, 0}, fmt::format("'{}' is not a number", text), "give a number");
}

FigureStyle figure_style(const StyleArguments& arguments) {
    FigureStyle style;
    style.grey = arguments.grey;
    if (!arguments.size.empty()) {
        const std::size_t cross = arguments.size.find('x');
        if (arguments.size.find_first_not_of("0123456789.x") != std::string::npos)
            throw InputError({"--size", 0, 0}, fmt::format("'{}' is no size", arguments.size),
                             "write the width in mm, as 85, or WIDTHxHEIGHT, as 254x143");
        style.width = number_of_option(arguments.size.substr(0, cross), "--size");
        if (cross != std::string::npos)
            style.height = number_of_option(arguments.size.substr(cross + 1), "--size");
        if (style.width == 0 || (cross != std::string::npos && style.height == 0)) // 0 would mean the default
            throw InputError({"--size", 0, 0}, fmt::format("'{}' is no size", arguments.size), "give millimetres");
    }
    const std::string& font = arguments.font;
    const std::size_t comma = font.find(',');
    const bool only_size = !font.empty() && font.find_first_not_of("0123456789.") == std::string::npos;
    if (only_size || comma != std::string::npos)
        style.font_size = number_of_option(only_size ? font : font.substr(comma + 1), "--font");
    if (!only_size)
        style.font = font.substr(0, comma);
    check_style(style, {arguments.size.empty() ? "--font" : "--size", 0, 0});
    return style;
}

} // namespace graze
