#include "program/commands.hpp"

#include "graze/study/study_catalogue.hpp"
#include "graze/study/study_keys.hpp"
#include "program/table.hpp"
#include "program/wrapped_text.hpp"

#include <fmt/ranges.h>

namespace graze {

int list_studies(const RunArguments& arguments, const Console& console) {
    Table table({{"study", ""}, {"runs", ""}, {"what it does", ""}});
    for (const std::string& name : shipped_studies()) {
        const Study study = load_study(name);
        table.add(name, study.runs.size(), study.text);
    }
    deliver(table, arguments.output, {}, console);
    return exit_success;
}

namespace {

/// The allowed values of a key as "whole number from 1 to 1000" or "one of up, down, both"
std::string type_in_words(const StudyKey& key) {
    if (!key.words.empty())
        return fmt::format("one of {}", fmt::join(key.words, ", "));
    const bool from_least = key.least && key.includes_least;
    const bool bounded = key.most && *key.most < 1e9;
    return key.type +
           (from_least  ? fmt::format(" from {:.12g}", *key.least)
            : key.least ? fmt::format(" above {:.12g}", *key.least)
                        : "") +
           (bounded ? fmt::format(" to {:.12g}", *key.most) : "");
}

/// A readable list of keys: the allowed values of each, then its meaning.
std::string keys_in_words(const std::string& kind, const std::vector<StudyKey>& keys) {
    std::string text = fmt::format("Keys of runs of kind \"{}\":\n\n", kind);
    for (const StudyKey& key : keys) {
        const std::string standard = key.standard.empty() ? "" : " (" + key.standard + ")";
        text += fmt::format("  {:<16}{}{}\n", key.name, type_in_words(key), standard);
        text += std::string(18, ' ') + wrapped(key.meaning, common_line_width, 18) + '\n';
    }
    return text;
}

} // namespace

int list_study_keys(const RunArguments& arguments, const Console& console) {
    Table table(
        {{"kind", ""}, {"key", ""}, {"type", ""}, {"default", ""}, {"least", ""}, {"most", ""}, {"meaning", ""}});
    const bool for_people = arguments.output.format == TableFormat::table;
    for (std::size_t index = 0; index < kinds_of_runs().size(); ++index) {
        const std::string& kind = kinds_of_runs()[index];
        if (arguments.keys != "all" && arguments.keys != kind)
            continue;
        const std::vector<StudyKey> keys = study_keys(static_cast<RunKind>(index));
        if (for_people)
            console.out << keys_in_words(kind, keys);
        for (const StudyKey& key : keys) {
            table.add(kind, key.name, key.words.empty() ? key.type : fmt::format("{}", fmt::join(key.words, ", ")),
                      key.standard, key.least, key.most, key.meaning);
        }
    }
    if (!for_people)
        deliver(table, arguments.output, {}, console);
    return exit_success;
}

} // namespace graze
