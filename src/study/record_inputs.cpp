#include "study/record_inputs.hpp"

#include "base/random_number.hpp"
#include "graze/base/file_name.hpp"
#include "graze/base/printable.hpp"
#include "graze/model/model_file.hpp"
#include "graze/symbolic/parser.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>

namespace graze {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t most_files = 100'000;

/// True when a name matches a pattern in which `*` stands for any text.
bool fits(std::string_view name, std::string_view pattern) {
    std::size_t n = 0, p = 0, star = std::string_view::npos, after = 0;
    while (n < name.size())
        if (p < pattern.size() && pattern[p] == '*') {
            star = p++;
            after = n;
        } else if (p < pattern.size() && pattern[p] == name[n]) {
            ++n;
            ++p;
        } else if (star != std::string_view::npos) {
            p = star + 1;
            n = ++after;
        } else {
            return false;
        }
    return std::all_of(pattern.begin() + static_cast<std::ptrdiff_t>(p), pattern.end(),
                       [](char c) { return c == '*'; });
}

/// True when a path, with all links followed, lies in a folder.
bool is_within(const fs::path& path, const fs::path& folder) {
    std::error_code none;
    const fs::path real = fs::weakly_canonical(path, none), home = fs::weakly_canonical(folder, none);
    const auto [in_home, in_real] = std::mismatch(home.begin(), home.end(), real.begin(), real.end());
    return !home.empty() && in_home == home.end();
}

} // namespace

std::vector<RecordInput> record_inputs(const std::string& study, const std::string& name, const Place& place) {
    require_plain_line(name, "name of a record", place);
    const fs::path relative(name);
    const bool leads_up = std::find(relative.begin(), relative.end(), "..") != relative.end();
    const std::string stay = "keep records in the study's folder or below it, and name them relative to it";
    if (name.empty())
        throw InputError(place, "a record has no name", "write it as \"run.csv\" or \"run*.csv\"");
    if (relative.is_absolute() || leads_up)
        throw InputError(
            place, fmt::format("the record '{}' would be outside of the study's folder", shortened(name, 100)), stay);
    const fs::path folder = fs::path(study).parent_path().empty() ? fs::path(".") : fs::path(study).parent_path();
    std::vector<std::string> names;
    const std::string pattern = relative.filename().string();
    if (pattern.find('*') == std::string::npos) {
        names.push_back(name);
    } else {
        std::error_code error;
        const fs::path parent = relative.parent_path();
        if (!is_within(folder / parent, folder))
            throw InputError(place, fmt::format("'{}' leads out of the study's folder", name), stay);
        for (fs::directory_iterator at(folder / parent, error), end; !error && at != end; at.increment(error)) {
            const std::string found = at->path().filename().string();
            if (found.front() != '.' && fits(found, pattern) && at->is_regular_file(error))
                names.push_back((parent / found).string());
            if (names.size() > most_files)
                throw InputError(place, fmt::format("'{}' are more than {} files", name, most_files),
                                 "make several runs");
        }
        if (names.empty())
            throw InputError(place, fmt::format("there is no record '{}'", shortened(name, 100)),
                             "records are looked for relative to the study");
        std::sort(names.begin(), names.end());
    }
    std::vector<RecordInput> inputs;
    for (const std::string& one : names) {
        require_plain_line(one, "name of a record", place);
        const fs::path path = folder / one;
        std::error_code error;
        if (fs::is_symlink(path, error) && !fs::exists(path, error))
            throw InputError(place, fmt::format("'{}' is a link that leads to no file", shortened(one, 100)),
                             "let it lead to a record, or name the record itself");
        if (!fs::exists(path, error))
            throw InputError(place, fmt::format("there is no record '{}'", shortened(one, 100)),
                             "records are looked for relative to the study");
        if (!is_within(path, folder))
            throw InputError(place, fmt::format("'{}' leads out of the study's folder", one), stay);
        if (!fs::is_regular_file(path, error))
            throw InputError(place, fmt::format("'{}' is no plain file", one), "name a record");
        RecordInput& input = inputs.emplace_back();
        input.name = one;
        input.path = path.string();
    }
    return inputs;
}

void fingerprint_record(RecordInput& input) {
    std::ifstream file(input.path, std::ios::binary);
    std::vector<char> part(1 << 20);
    std::uint64_t one = 0x9e3779b97f4a7c15ULL, other = 0x2545f4914f6cdd1dULL, length = 0;
    while (file) {
        file.read(part.data(), static_cast<std::streamsize>(part.size()));
        const auto count = static_cast<std::size_t>(file.gcount());
        length += count;
        std::fill(part.begin() + static_cast<std::ptrdiff_t>(count), part.end(), '\0');
        for (std::size_t i = 0; i < count; i += sizeof(std::uint64_t)) {
            std::uint64_t word = 0;
            std::memcpy(&word, part.data() + i, sizeof word);
            one = mixed(one ^ word);
            other = (other + word) * 0x100000001b3ULL ^ (other >> 29);
        }
    }
    std::error_code error;
    if (file.bad() || (!file.eof() && file.fail()) || !std::filesystem::exists(input.path, error))
        throw FileError(input.path, "the record cannot be read", "look at the file and its permissions");
    input.bytes = length;
    input.hash = fmt::format("{:016x}{:016x}", mixed(one ^ length), mixed(other ^ length));
}

Model model_of_record(const std::vector<RecordedName>& states, const std::vector<RecordedName>& parameters,
                      const std::string& time_unit) {
    // The model is made from a text since that text is stored with the results and read again.
    const auto quoted = [](const std::string& text) {
        std::string result = "\"";
        for (const char c : text)
            result += c == '"' || c == '\\' ? std::string("\\") + c : std::string(1, c == '\n' || c == '\t' ? ' ' : c);
        return result + '"';
    };
    std::string text = "name = \"record\"\ntext = \"names and units of what was recorded\"\n";
    text += fmt::format("time_unit = {}\n[parameters]\n", quoted(time_unit));
    const auto described = [&](const RecordedName& one) {
        const std::string words = one.text.empty() ? "" : ", text = " + quoted(one.text);
        return fmt::format("unit = {}{} }}\n", quoted(one.unit), words);
    };
    for (const RecordedName& one : parameters)
        text += fmt::format("{} = {{ value = 0, {}", one.name, described(one));
    text += "[states]\n";
    for (const RecordedName& one : states)
        text += fmt::format("{} = {{ initial = 0, {}", one.name, described(one));
    text += "[modes.rest]\nrates = {";
    for (std::size_t i = 0; i < states.size(); ++i)
        text += fmt::format("{} {} = 0", i > 0 ? "," : "", states[i].name);
    return parse_model(text + " }\n", "record");
}

} // namespace graze
