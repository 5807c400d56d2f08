#include "program/atlas_study.hpp"

#include "graze/base/input_errors.hpp"
#include "graze/model/catalogue.hpp"
#include "model/written_text.hpp"
#include "program/values.hpp"

#include <fmt/format.h>

#include <charconv>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace graze {

namespace {

constexpr std::size_t first_points = 61, second_points = 9; ///< values along the parameters, unless they are given

/// Pieces of a text between colons.
std::vector<std::string> pieces_of(const std::string& text) {
    std::vector<std::string> pieces(1);
    for (const char c : text)
        c == ':' ? pieces.emplace_back() : pieces.back() += c;
    return pieces;
}

/// "NAME=REST"
std::pair<std::string, std::string> assignment_of(const std::string& text, const char* option, const char* form) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == text.size())
        throw InputError({option, 0, 0}, fmt::format("'{}' is not {}", text, form),
                         fmt::format("write {} {}", option, form));
    return {text.substr(0, equals), text.substr(equals + 1)};
}

class StudyWriter {
public:
    explicit StudyWriter(const AtlasArguments& arguments) : arguments_(&arguments) {}

    std::string text() {
        const Model model = load_model(arguments_->subject);
        line("", fmt::format("name = {}", toml_string(model.name + "-atlas")));
        line("MODEL", fmt::format("model = {}", toml_string(arguments_->subject)));
        line("", fmt::format("[runs.{}]", atlas_run_name));
        line("", "kind = \"atlas\"");
        for (std::size_t i = 0; i < arguments_->along.size(); ++i)
            write_axis(model, arguments_->along[i], i == 0 ? first_points : second_points);
        for (const std::string& item : split_list(arguments_->from)) {
            const auto [state, value] = assignment_of(item, "--from", "STATE=VALUE");
            line("--from", fmt::format("from.{} = {}", toml_key(state), value_of_written(value)));
        }
        for (const std::string& item : split_list(arguments_->starts))
            write_start(item);
        if (!arguments_->section.empty())
            line("--section", fmt::format("section = {}", toml_string(arguments_->section)));
        write_limits();
        return text_;
    }

    /// The option that stands behind a line of the text; empty: none does.
    std::string option_of(std::size_t number) const {
        return number >= 1 && number <= options_.size() ? options_[number - 1] : "";
    }

private:
    void line(const std::string& option, const std::string& text) {
        options_.push_back(option);
        text_ += text + '\n';
    }

    void write_axis(const Model& model, const std::string& item, std::size_t points) {
        constexpr const char* form = "NAME=FROM:TO or NAME=FROM:TO:POINTS";
        const auto [name, range] = assignment_of(item, "--along", form);
        if (model.find_state(name))
            throw InputError({"--along", 0, 0}, fmt::format("'{}' is a state, and an atlas is of parameters", name),
                             fmt::format("give a range of its initial values: --starts {}=LOW:HIGH", name));
        if (!along_.insert(name).second)
            throw InputError({"--along", 0, 0}, fmt::format("'{}' is given twice", name), "give each parameter once");
        const std::vector<std::string> pieces = pieces_of(range);
        if (pieces.size() < 2 || pieces.size() > 3)
            throw InputError({"--along", 0, 0}, fmt::format("'{}' is no range", range), fmt::format("write {}", form));
        if (pieces.size() == 3) {
            const std::string& count = pieces[2];
            const auto [end, error] = std::from_chars(count.data(), count.data() + count.size(), points);
            if (error != std::errc{} || end != count.data() + count.size() || points < 2)
                throw InputError({"--along", 0, 0}, fmt::format("'{}' is no number of values", count),
                                 "give a whole number, 2 or more");
        }
        line("--along", fmt::format("vary.{} = {{ from = {}, to = {}, points = {} }}", toml_key(name),
                                    value_of_written(pieces[0]), value_of_written(pieces[1]), points));
    }

    void write_start(const std::string& item) {
        const auto [state, range] = assignment_of(item, "--starts", "STATE=LEAST:GREATEST");
        const std::vector<std::string> pieces = pieces_of(range);
        if (pieces.size() != 2)
            throw InputError({"--starts", 0, 0}, fmt::format("'{}' is no range", range),
                             "write --starts STATE=LEAST:GREATEST");
        line("--starts", fmt::format("starts.{} = [{}, {}]", toml_key(state), value_of_written(pieces[0]),
                                     value_of_written(pieces[1])));
    }

    void write_limits() {
        const auto limit = [&](const char* key, const auto& value) {
            if (value)
                line(fmt::format("--{}", key), fmt::format("{} = {}", key, *value));
        };
        limit("contacts", arguments_->contacts);
        limit("multiple", arguments_->multiple);
        limit("branches", arguments_->branches);
        limit("curves", arguments_->curves);
        limit("draws", arguments_->draws);
        limit("seed", arguments_->seed);
        limit("minutes", arguments_->minutes);
    }

    const AtlasArguments* arguments_;
    std::string text_;
    std::vector<std::string> options_; ///< of each line
    std::set<std::string> along_;      ///< parameters
};

} // namespace

Study atlas_study(const AtlasArguments& arguments) {
    if (arguments.along.size() > 2)
        throw InputError({"--along", 0, 0},
                         fmt::format("an atlas is of one or two parameters, and {} are given", arguments.along.size()),
                         "give the others values by --set");
    StudyWriter writer(arguments);
    const std::string text = writer.text();
    const std::string file = "graze-atlas"; // without a folder: models are looked for in the current one
    const auto at_option = [&](const InputError& error) {
        const std::string option = error.place().file == file ? writer.option_of(error.place().line) : "";
        return option.empty() ? error : InputError({option, 0, 0}, error.problem(), error.remedy());
    };
    try {
        Study study;
        with_places_of(arguments.set, [&] { study = parse_study(text, file, parameter_values(arguments.set)); });
        require_models_of_files(arguments.set, {study.runs.front().model.name});
        return study;
    } catch (const InputErrors& errors) {
        Mistakes mistakes;
        for (const InputError& error : errors.all())
            mistakes.attempt([&] { throw at_option(error); });
        mistakes.throw_noted();
        throw; // not reached: there are mistakes
    } catch (const InputError& error) {
        throw at_option(error);
    }
}

} // namespace graze
