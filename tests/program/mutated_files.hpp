#pragma once

#include "graze/base/printable.hpp"
#include "mutated.hpp"
#include "places.hpp"
#include "run_graze.hpp"
#include "separate_run.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

namespace graze::testing {

/// A command that reads a mutated file.
struct UseOfFile {
    std::vector<std::string> words; ///< with `FILE` for the file, and `OUT` for an empty folder
    bool may_be_long = false;       ///< the command may run long and is ended by a signal
};

/// Files in which some bytes, words or cells are changed: the program must use or refuse each of them, in bounded time
/// and memory. The environment variable GRAZE_MUTATIONS is the number of files of each kind, GRAZE_MUTATION_SEED the
/// seed; GRAZE_KEEP is a folder for files with which the program fails.
class MutatedFiles : public ::testing::Test {
protected:
    using Words = std::vector<std::string>;

    static const char* asked() { return std::getenv("GRAZE_MUTATIONS"); }
    /// Number of files of a kind that are tried. @param usual the number without GRAZE_MUTATIONS
    static int count(std::size_t usual) { return asked() != nullptr ? std::atoi(asked()) : static_cast<int>(usual); }
    static std::mt19937 random_numbers() {
        const char* seed = std::getenv("GRAZE_MUTATION_SEED");
        return std::mt19937(seed != nullptr ? static_cast<unsigned>(std::atoi(seed)) : 1);
    }
    static std::string source(const std::string& path) { return contents(std::string(source_folder) + "/" + path); }

    void try_file(const std::string& file, const std::vector<UseOfFile>& uses) {
        const UseOfFile& use = uses[static_cast<std::size_t>(tried) % uses.size()];
        const std::string out = folder / "out";
        std::filesystem::remove_all(out);
        std::filesystem::create_directory(out);
        Words words = use.words;
        for (std::string& word : words)
            word = replaced(replaced(word, "FILE", file), "OUT", out);
        SeparateRunLimits limits;
        limits.end_after = use.may_be_long ? 0.5 : 0;
        const SeparateRun run = run_separately(words, limits);
        ++tried;
        refused += run.code == 2 ? 1 : 0;
        if (!use.may_be_long)
            longest = std::max(longest, run.seconds);
        largest = std::max(largest, run.memory);
        if (const std::string problem = problem_of(run, use); !problem.empty())
            tell(problem, words, file, run);
    }

    /// Tries texts with changed words or, one in four, changed bytes.
    void try_texts(const std::string& name, const std::vector<std::string>& texts, const std::vector<UseOfFile>& uses,
                   std::size_t usual) {
        std::mt19937 random = random_numbers();
        for (int i = 0; i < count(usual); ++i) {
            const std::string& text = texts[static_cast<std::size_t>(i) / uses.size() % texts.size()];
            try_file(folder.write(name, i % 4 == 3 ? mutated_bytes(text, random) : mutated_words(text, random)), uses);
        }
    }
    void try_bytes(const std::string& name, const std::string& whole, const std::vector<UseOfFile>& uses,
                   std::size_t usual) {
        std::mt19937 random = random_numbers();
        for (int i = 0; i < count(usual); ++i)
            try_file(folder.write(name, mutated_bytes(whole, random)), uses);
    }

    void TearDown() override {
        EXPECT_EQ(wrong, 0);
        EXPECT_GT(tried, 0);
        if (asked() != nullptr)
            fmt::print("{} tried, {} refused, {} wrong, longest {:.2f} s, largest {} MiB\n", tried, refused, wrong,
                       longest, largest >> 20);
    }

    Folder folder;

private:
    static std::string replaced(std::string text, const std::string& what, const std::string& by) {
        if (const std::size_t at = text.find(what); at != std::string::npos)
            text.replace(at, what.size(), by);
        return text;
    }

    static std::string problem_of(const SeparateRun& run, const UseOfFile& use) {
        const bool ended = use.may_be_long && run.was_ended;
        if (run.timed_out)
            return "it does not end";
        if (run.signal != 0)
            return ended && run.signal == SIGTERM ? "" : fmt::format("signal {}", run.signal);
        if (run.code != 0 && run.code != 2 && run.code != 3 && !(ended && run.code == 143))
            return fmt::format("exit code {}", run.code);
        const std::vector<std::string> lines = split(run.err, '\n');
        if (run.code == 2 && (lines.empty() || lines.size() > 21))
            return "not some messages";
        if (!is_plain_text(run.err) || !is_plain_text(run.out))
            return "it controls a terminal";
        if (!std::all_of(lines.begin(), lines.end(),
                         [](const std::string& line) { return line.starts_with("graze: "); }))
            return "a message from elsewhere";
        return "";
    }

    void tell(const std::string& problem, const Words& words, const std::string& file, const SeparateRun& run) {
        ++wrong;
        ADD_FAILURE() << problem << ": " << ::testing::PrintToString(words) << "\n" << run.err.substr(0, 2000);
        const char* keep = std::getenv("GRAZE_KEEP");
        if (keep == nullptr)
            return;
        const auto name = fmt::format("{}-{}-{}", getpid(), wrong, std::filesystem::path(file).filename().string());
        std::filesystem::copy_file(file, std::filesystem::path(keep) / name,
                                   std::filesystem::copy_options::overwrite_existing);
    }

    int tried = 0, refused = 0, wrong = 0;
    double longest = 0;
    std::size_t largest = 0;
};

} // namespace graze::testing
