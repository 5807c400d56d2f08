#include "places.hpp"
#include "run_graze.hpp"

#include <gmock/gmock.h>

#include <filesystem>
#include <map>
#include <regex>
#include <set>

namespace graze::testing::remedies_test {

/// The string literals of a source file; raw ones have all their lines.
std::vector<std::string> literals(const std::string& source) {
    std::vector<std::string> found;
    for (std::size_t i = 0; i < source.size(); ++i) {
        if (source.compare(i, 2, "//") == 0) {
            i = std::min(source.find('\n', i), source.size());
        } else if (source.compare(i, 3, "R\"(") == 0) {
            const std::size_t end = source.find(")\"", i);
            found.push_back(source.substr(i + 3, end - i - 3));
            i = end + 1;
        } else if (source[i] == '\'') {
            i += source[i + 1] == '\\' ? 3 : source[i + 2] == '\'' ? 2 : 0; // or a separator of digits
        } else if (source[i] == '"') {
            std::string text;
            for (++i; i < source.size() && source[i] != '"'; ++i)
                text += source[i] != '\\' ? source[i] : source[++i] == 'n' ? '\n' : source[i];
            found.push_back(text);
        }
    }
    return found;
}

/// The code in a page of the documentation: lines of blocks that a shell runs, and texts between backticks.
std::vector<std::string> code_of(const std::string& page) {
    std::vector<std::string> found;
    std::istringstream lines(page);
    std::string fence;
    bool inside = false;
    for (std::string line; std::getline(lines, line);) {
        if (line.starts_with("```")) {
            inside = !inside;
            fence = line;
        } else if (inside && fence.starts_with("```sh")) {
            found.push_back(line);
        } else if (!inside) {
            for (std::size_t begin = line.find('`'); begin != std::string::npos;) {
                const std::size_t end = line.find('`', begin + 1);
                if (end == std::string::npos)
                    break;
                found.push_back(line.substr(begin + 1, end - begin - 1));
                begin = line.find('`', end + 1);
            }
        }
    }
    return found;
}

struct Text {
    std::string file, text;
};

/// All texts that may name commands: messages, help and documentation.
std::vector<Text> texts() {
    std::vector<Text> all;
    const std::filesystem::path root = source_folder;
    for (const char* folder : {"src", "docs"})
        for (const auto& entry : std::filesystem::recursive_directory_iterator(root / folder)) {
            const auto extension = entry.path().extension();
            const bool source = extension == ".cpp" || extension == ".hpp";
            if (!source && extension != ".md")
                continue;
            const std::string content = contents(entry.path());
            for (std::string& text : source ? literals(content) : code_of(content))
                all.push_back({entry.path().string(), std::move(text)});
        }
    for (std::string& text : code_of(contents(root / "README.md")))
        all.push_back({"README.md", std::move(text)});
    return all;
}

/// The help of each command, by its name.
std::map<std::string, std::string> commands() {
    std::map<std::string, std::string> result;
    for (const char* name :
         {"models", "check",     "simulate", "run",    "points",     "orbit",    "grazing", "trip",
          "ladder", "tolerance", "design",   "layout", "record",     "identify", "bench",   "acquire",
          "export", "plot",      "info",     "help",   "completion", "view",     "merge",   "atlas"}) {
        const std::string help = done(std::string(name) + " --help");
        result[name] = help;
    }
    return result;
}

/// The options of which each command's help speaks.
std::map<std::string, std::set<std::string>> options_of(const std::map<std::string, std::string>& helps) {
    const std::regex option("--[a-z][a-z-]*");
    std::map<std::string, std::set<std::string>> result;
    for (const auto& [name, help] : helps)
        for (std::sregex_iterator it(help.begin(), help.end(), option), end; it != end; ++it)
            result[name].insert(it->str());
    return result;
}

TEST(Remedies, NameCommandsThatExist) {
    const auto known = commands();
    const std::regex use("(^|[^a-z/.'_-])(\\w*) ?graze ([a-z]+)");
    const std::set<std::string> nouns{"of", "with", "another", "by", "to", "this"};
    std::size_t found = 0;
    for (const Text& text : texts())
        for (std::sregex_iterator it(text.text.begin(), text.text.end(), use), end; it != end; ++it) {
            if (nouns.contains((*it)[2]))
                continue;
            ++found;
            EXPECT_TRUE(known.contains((*it)[3])) << text.file << ": " << text.text;
        }
    EXPECT_GT(found, 60u);
}

TEST(Remedies, NameOptionsThatExist) {
    const auto known = options_of(commands());
    const std::regex option("--[a-z][a-z-]*");
    const std::regex command("graze ([a-z]+)");
    std::size_t found = 0, of_commands = 0;
    for (const Text& text : texts()) {
        // Options of other programs, in blocks for a shell, and those that SLURM's programs are given.
        if (text.file.find("/clusters.md") != std::string::npos || text.file.find("/slurm") != std::string::npos ||
            text.text.find("cmake") != std::string::npos || text.text.find("ctest") != std::string::npos ||
            text.text.find("gnuplot") != std::string::npos || text.text.find("./run") != std::string::npos ||
            text.text.find("pip install") != std::string::npos || text.text.find("dask-worker") != std::string::npos ||
            text.text.find("srun --mpi") != std::string::npos)
            continue;
        for (std::sregex_iterator it(text.text.begin(), text.text.end(), option), end; it != end; ++it) {
            const std::string name = it->str();
            if (name == "--help" || name == "--version" || name == "--contact-table" ||
                name == "--sbatch") // the last two are not for users
                continue;
            ++found;
            EXPECT_TRUE(
                std::any_of(known.begin(), known.end(), [&](const auto& one) { return one.second.contains(name); }))
                << text.file << ": " << name << " in: " << text.text;
            // The command that the text names before the option, if any, must have the option.
            const std::string before = text.text.substr(0, static_cast<std::size_t>(it->position()));
            std::smatch last;
            std::string remaining = before, owner;
            while (std::regex_search(remaining, last, command)) {
                owner = last[1];
                remaining = last.suffix();
            }
            if (!known.contains(owner) || remaining.find_first_of(";\n|,") != std::string::npos)
                continue;
            ++of_commands;
            EXPECT_TRUE(known.at(owner).contains(name)) << text.file << ": " << text.text;
        }
    }
    EXPECT_GT(found, 150u);
    EXPECT_GT(of_commands, 60u);
}

} // namespace graze::testing::remedies_test
