#include "study/study_reader.hpp"
#include "study/point_limits.hpp"

#include "graze/base/file_name.hpp"
#include "graze/base/printable.hpp"
#include "graze/base/rounded.hpp"
#include "graze/model/catalogue.hpp"
#include "graze/results/name_advice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

namespace graze {

std::string study_name_remedy(const std::string& name, const std::vector<std::string>& known) {
    return name_advice(name, known, "there are none");
}

void require_lines(const std::vector<const std::vector<std::string>*>& lists, const std::string& what,
                   const Place& place) {
    for (const std::vector<std::string>* texts : lists)
        for (const std::string& text : *texts)
            require_plain_line(text, what, place);
}

std::string embedded_text(std::span<const EmbeddedModel> files, const std::string& kind, const std::string& name) {
    std::vector<std::string> names;
    for (const EmbeddedModel& file : files) {
        if (file.name == name)
            return std::string(file.text);
        names.emplace_back(file.name);
    }
    const std::string problem = fmt::format("there is no {} '{}'", kind, shortened(name, 100));
    std::error_code error;
    if (const std::string file = name + ".toml"; std::filesystem::exists(file, error))
        throw InputError(problem, fmt::format("the file is called {}", file));
    throw InputError(problem, study_name_remedy(name, names) + " (the name of a file ends in .toml)");
}

void StudyReader::fail(const TomlEntry& entry, const std::string& problem, const std::string& remedy) const {
    throw InputError(toml_.place(*entry.node), problem, remedy);
}

Place StudyReader::inside(const TomlEntry& entry) const {
    Place place = toml_.place(*entry.node);
    ++place.column;
    return place;
}

double StudyReader::number(const Model& model, const TomlEntry& entry) const {
    double value = std::numeric_limits<double>::quiet_NaN();
    if (const auto* integer = entry.node->as_integer())
        value = static_cast<double>(integer->get());
    else if (const auto* real = entry.node->as_floating_point())
        value = real->get();
    else if (entry.node->is_string())
        return value_of_text(model, toml_.string(entry), inside(entry));
    else
        toml_.fail_type(entry, "a number or an expression");
    if (!std::isfinite(value))
        fail(entry, fmt::format("{} is not a finite number", entry.path), "give a finite number");
    return value;
}

double StudyReader::number(const Model& model, const TomlEntry& entry, const NumberRange& range) const {
    const double value = number(model, entry);
    if (range.least == 0 && !range.includes_least && !(value > 0))
        fail(entry, fmt::format("{} is {}, not positive", entry.path, value), "give a positive number");
    if (!range.contains(value))
        fail(entry, fmt::format("{} is {}, which is out of range", entry.path, value),
             std::isfinite(range.most) ? fmt::format("give a number {}{} to {}",
                                                     range.includes_least ? "from " : "above ", range.least, range.most)
                                       : fmt::format("give {} or more", range.least));
    return value;
}

double StudyReader::positive(const Model& model, const TomlEntry& entry) const {
    return number(model, entry, positive_number);
}

std::string StudyReader::number_text(const Model& model, const TomlEntry& entry) const {
    const double value = number(model, entry); // throws for what is no number
    return entry.node->is_string() ? toml_.string(entry) : fmt::format("{:.17g}", value);
}

std::size_t StudyReader::count(const TomlEntry& entry, std::size_t least, std::size_t most) const {
    const auto* integer = entry.node->as_integer();
    if (const auto* floating = entry.node->as_floating_point())
        fail(entry, fmt::format("{} is {:.6g}", entry.path, floating->get()),
             fmt::format("give a whole number from {} to {}", least, most));
    if (!integer)
        toml_.fail_type(entry, "a whole number");
    if (integer->get() < static_cast<std::int64_t>(least) || integer->get() > static_cast<std::int64_t>(most))
        fail(entry, fmt::format("{} is {}", entry.path, integer->get()),
             fmt::format("give a whole number from {} to {}", least, most));
    return static_cast<std::size_t>(integer->get());
}

std::pair<double, double> StudyReader::range(const Model& model, const TomlEntry& entry) const {
    const auto items = toml_.elements(entry);
    if (items.size() != 2)
        fail(entry, fmt::format("{} has {} items", entry.path, items.size()), "give two numbers: [least, greatest]");
    const std::pair<double, double> result{number(model, items[0]), number(model, items[1])};
    if (!(result.first < result.second))
        fail(entry, fmt::format("{} goes from {} to {}", entry.path, result.first, result.second),
             "give the smaller number first");
    return result;
}

std::vector<std::string> StudyReader::strings(const TomlEntry& entry) const {
    if (entry.node->is_string())
        return {toml_.line(entry)};
    if (!entry.node->is_array())
        fail(entry, fmt::format("{} must be a name or a list of names", entry.path),
             fmt::format("write it as {0} = \"NAME\" or {0} = [\"NAME\"]", entry.name));
    std::vector<std::string> result;
    each(toml_.elements(entry), [&](const TomlEntry& item) { result.push_back(toml_.line(item)); });
    return result;
}

const Model* StudyReader::given_model(const std::string& name) const {
    if (!models_)
        return nullptr;
    const auto found = models_->find(name);
    return found == models_->end() ? nullptr : &found->second;
}

const Model& StudyReader::loaded_model(const std::string& name_or_path) const {
    const auto [found, is_new] = loaded_.try_emplace(name_or_path);
    Loaded& one = found->second;
    if (is_new)
        try {
            one.model = load_model(name_or_path);
        } catch (const InputError&) {
            one.failure = std::current_exception();
        }
    if (one.failure)
        std::rethrow_exception(one.failure);
    return one.model;
}

const Model& StudyReader::no_model() {
    static const Model none;
    return none;
}

void StudyReader::read_keys(const TomlEntry& table, const std::vector<std::pair<std::string, ReadEntry>>& keys) const {
    std::vector<std::string> names;
    for (const auto& key : keys)
        names.push_back(key.first);
    each_of(table, {}, [&](const TomlEntry& entry) {
        toml_.require_known(entry, table.path, names);
        keys[static_cast<std::size_t>(std::ranges::find(names, entry.name) - names.begin())].second(entry);
    });
}

std::vector<TomlEntry> StudyReader::items(const TomlEntry& entry) const {
    return entry.node->is_array() ? toml_.elements(entry) : std::vector<TomlEntry>{entry};
}

std::size_t StudyReader::choice(const TomlEntry& entry, const std::vector<std::string>& words) const {
    const std::string word = toml_.string(entry);
    const auto found = std::find(words.begin(), words.end(), word);
    if (found == words.end())
        fail(entry, fmt::format("{} cannot be '{}'", entry.path, word), study_name_remedy(word, words));
    return static_cast<std::size_t>(found - words.begin());
}

namespace {

/// from + i step, rounded so that decimals give decimals.
double stepped(double from, double step, std::size_t i) {
    const double exact = from + static_cast<double>(i) * step;
    return rounded(exact, 13);
}

void spread(const StudyReader& reader, const TomlEntry& entry, Variation& variation, double from, double to,
            std::optional<double> step, std::size_t points) {
    if (!(from < to))
        reader.fail(entry, fmt::format("{} goes from {} to {}", entry.path, from, to),
                    "let it rise; `direction` says which way a sweep goes");
    if (step) {
        const double count = std::floor((to - from) / *step + 1e-6) + 1;
        if (!(count <= static_cast<double>(most_values)))
            reader.fail(entry, fmt::format("{} has more than {} values", entry.path, most_values), "take larger steps");
        for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i)
            variation.values.push_back(stepped(from, *step, i));
        return;
    }
    if (points < 2 || points > most_values)
        reader.fail(entry, fmt::format("{} has {} points", entry.path, points), "give `step`, or 2 or more `points`");
    for (std::size_t i = 0; i < points; ++i) {
        const double share = static_cast<double>(i) / static_cast<double>(points - 1);
        variation.values.push_back(i + 1 == points         ? to
                                   : variation.logarithmic ? from * std::pow(to / from, share)
                                                           : from + share * (to - from));
    }
}

double step_of(const StudyReader& reader, const Model& model, const TomlEntry& entry) {
    const double step = reader.number(model, entry);
    if (!(step > 0))
        reader.fail(entry, fmt::format("{} is {}, not positive", entry.path, step),
                    "give its size, and `from` below `to`; `direction` says which way a sweep goes");
    return step;
}

void read_variation_table(const StudyReader& reader, const Model& model, const TomlEntry& entry, Variation& variation) {
    std::optional<double> from, to, step;
    std::size_t points = 0;
    double offset = 0;
    std::optional<std::pair<double, double>> draws;
    reader.read_keys(entry, {{"from", reader.into(from, model)},
                             {"to", reader.into(to, model)},
                             {"step", [&](const TomlEntry& item) { step = step_of(reader, model, item); }},
                             {"points", reader.into(points, {2, most_values})},
                             {"scale",
                              [&](const TomlEntry& item) {
                                  variation.logarithmic = reader.choice(item, {"linear", "log"}) == 1;
                              }},
                             {"random", [&](const TomlEntry& item) { draws = reader.range(model, item); }},
                             {"offset", reader.into(offset, model)}});
    const double least = draws ? draws->first : from.value_or(1);
    if (variation.logarithmic && !(least > 0))
        reader.fail(entry, fmt::format("{} begins at {} on a logarithmic scale", entry.path, least),
                    "begin at a positive number");
    if (draws) {
        if (from || to || step || points)
            reader.fail(entry, fmt::format("{} is both random and in steps", entry.path), "choose one of them");
        variation.low = draws->first;
        variation.high = draws->second;
        variation.offset = offset;
        return;
    }
    if (!from || !to)
        reader.fail(entry, fmt::format("{} lacks `{}`", entry.path, from ? "to" : "from"),
                    "write { from = A, to = B, step = S }, or `points` instead of `step`");
    if (step && (points || variation.logarithmic))
        reader.fail(entry, fmt::format("{} has a step and {}", entry.path, points ? "points" : "a logarithmic scale"),
                    "leave one of them out");
    spread(reader, entry, variation, *from, *to, step, points);
    for (double& value : variation.values)
        value += offset;
}

} // namespace

Variation read_variation(const StudyReader& reader, const Model& model, const TomlEntry& entry) {
    Variation variation;
    variation.name = entry.name;
    if (const auto parameter = model.find_independent_parameter(entry.name)) {
        variation.parameter = *parameter;
        variation.unit = model.parameter_unit(entry.name);
    } else if (const auto state = model.find_state(entry.name)) {
        variation.state = *state;
        variation.unit = model.states[*state].unit;
    } else {
        std::vector<std::string> known = model.independent_parameters();
        for (const std::string& name : names_of(model.states))
            known.push_back(name);
        throw InputError(entry.place,
                         model.find_parameter(entry.name)
                             ? fmt::format("parameter '{}' follows from others", entry.name)
                             : fmt::format("the model has no parameter or state '{}'", entry.name),
                         study_name_remedy(entry.name, known));
    }
    if (entry.node->is_array()) {
        reader.each(reader.toml().elements(entry),
                    [&](const TomlEntry& item) { variation.values.push_back(reader.number(model, item)); });
        std::sort(variation.values.begin(), variation.values.end());
        if (variation.values.empty() ||
            std::adjacent_find(variation.values.begin(), variation.values.end()) != variation.values.end())
            reader.fail(entry, fmt::format("{} is empty or has a value twice", entry.path), "list distinct values");
    } else if (entry.node->is_table()) {
        read_variation_table(reader, model, entry, variation);
    } else {
        variation.values.push_back(reader.number(model, entry));
    }
    return variation;
}

} // namespace graze
