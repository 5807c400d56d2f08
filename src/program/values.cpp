#include "program/values.hpp"

#include "graze/model/named_value.hpp"
#include "graze/model/parameter_file.hpp"
#include "graze/symbolic/input_error.hpp"
#include "graze/symbolic/parser.hpp"
#include "graze/symbolic/trimmed.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <set>

namespace graze {

namespace {

constexpr std::string_view blanks = " \t\n";

struct Assignment {
    std::string name, text;
    Place place; ///< of the text behind "="
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
    return result;
}

/// What options ask for, with what is in files that they name: `@FILE`.
std::vector<std::string> with_files(const std::vector<std::string>& assignments,
                                    ParameterFile::Values ParameterFile::*part, const char* option) {
    std::vector<std::string> all;
    for (std::string& item : split_list(assignments)) {
        if (!item.starts_with('@')) {
            all.push_back(std::move(item));
            continue;
        }
        const std::string path = item.substr(1);
        const ParameterFile file = read_parameter_file(path);
        if ((file.*part).empty())
            throw InputError(Place{path, 0, 0}, fmt::format("it has nothing for {}", option),
                             fmt::format("leave {} {} out", option, item));
        for (const auto& [name, value] : file.*part)
            all.push_back(fmt::format("{}={}", name, value));
    }
    return all;
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

double value_of(const Model& model, std::string_view text, const std::string& option) {
    return value_of_text(model, text, {fmt::format("{} {}", option, text), 1, 1});
}

double positive_value_of(const Model& model, std::string_view text, const std::string& option) {
    const double value = value_of(model, text, option);
    if (!(value > 0))
        throw InputError({option, 0, 0}, fmt::format("{} is not positive", value), "give a positive number");
    return value;
}

ParameterId asked_parameter(const Model& model, const std::string& name) {
    try {
        return model.independent_parameter(name);
    } catch (const InputError& error) {
        throw InputError(Place{"--parameter", 0, 0}, error.problem(), error.remedy());
    }
}

namespace {

/// Of two values one would be ignored.
void require_new(std::set<std::string>& names, const std::string& name, const char* option) {
    if (!names.insert(name).second)
        throw InputError({option, 0, 0}, fmt::format("'{}' is given twice", name), "leave one of them out");
}

} // namespace

void set_parameters(Model& model, const std::vector<std::string>& assignments) {
    std::set<std::string> names;
    for (const std::string& item : with_files(assignments, &ParameterFile::set, "--set")) {
        const Assignment assignment = parse_assignment(item, "--set");
        if (!model.find_parameter(assignment.name) && model.find_state(assignment.name))
            throw InputError({"--set", 0, 0}, fmt::format("'{}' is a state, not a parameter", assignment.name),
                             fmt::format("choose where it starts by --from {}", item));
        if (!model.find_parameter(assignment.name))
            model.set_parameter(assignment.name, 0); // says which names there are
        require_new(names, assignment.name, "--set");
        model.set_parameter(assignment.name, value_of_text(model, assignment.text, assignment.place));
    }
}

std::vector<std::pair<std::string, double>> parameter_values(const std::vector<std::string>& assignments) {
    std::vector<std::pair<std::string, double>> values;
    std::set<std::string> names;
    for (const std::string& item : with_files(assignments, &ParameterFile::set, "--set")) {
        const Assignment assignment = parse_assignment(item, "--set");
        require_new(names, assignment.name, "--set");
        values.emplace_back(assignment.name, value_of_text(Model(), assignment.text, assignment.place));
    }
    return values;
}

void set_initial_state(Model& model, const std::vector<std::string>& assignments) {
    std::set<std::string> names;
    for (const std::string& item : with_files(assignments, &ParameterFile::from, "--from")) {
        const Assignment assignment = parse_assignment(item, "--from");
        if (!model.find_state(assignment.name) && model.find_parameter(assignment.name))
            throw InputError({"--from", 0, 0}, fmt::format("'{}' is a parameter, not a state", assignment.name),
                             fmt::format("choose its value by --set {}", item));
        if (!model.find_state(assignment.name))
            model.set_initial(assignment.name, 0); // says which names there are
        require_new(names, assignment.name, "--from");
        model.set_initial(assignment.name, value_of_text(model, assignment.text, assignment.place));
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
                             fmt::format("choose one of {}", fmt::join(states, ", ")));
        }
        require_new(names, assignment.name, "--disturbance");
        values[*state] = value_of_text(model, assignment.text, assignment.place);
    }
    return values;
}

} // namespace graze
