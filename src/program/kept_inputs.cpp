#include "program/kept_inputs.hpp"

#include "graze/base/input_error.hpp"
#include "program/output_file.hpp"
#include "program/values.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <mutex>
#include <optional>
#include <sys/stat.h>
#include <system_error>
#include <vector>

namespace graze {

namespace {

struct KeptFile {
    std::string what;
    std::filesystem::path canonical;
    dev_t device = 0;
    ino_t inode = 0;
};

struct KeptFiles {
    std::mutex mutex;
    std::optional<std::vector<KeptFile>> files; ///< none: no command is running, nothing is protected
    std::vector<NamedFile> outputs;
};

KeptFiles& kept_files() {
    static KeptFiles kept;
    return kept;
}

/// The regular file at a path, links followed; none if there is no such file.
std::optional<KeptFile> file_at(const std::string& path) {
    struct stat status {};
    if (path.empty() || stat(path.c_str(), &status) != 0 || !S_ISREG(status.st_mode))
        return std::nullopt;
    std::error_code error;
    const auto canonical = std::filesystem::canonical(path, error);
    return KeptFile{"", error ? std::filesystem::path(path) : canonical, status.st_dev, status.st_ino};
}

bool are_same(const KeptFile& one, const KeptFile& other) {
    return (one.device == other.device && one.inode == other.inode) || one.canonical == other.canonical;
}

/// An option or argument in messages: "the model" for MODEL, "an input" for FILE, "--plot" for an option
std::string words_for(const CLI::Option& option) {
    if (!option.get_positional())
        return "--" + option.get_lnames().front();
    const std::string name = option.get_name();
    return name == "MODEL"        ? "the model"
           : name == "STUDY"      ? "the study"
           : name == "DESIGN"     ? "the design"
           : name == "EXPERIMENT" ? "the experiment"
                                  : "an input";
}

void add_inputs_of(const CLI::Option& option) {
    const bool has_files = option.get_type_name().starts_with("FILE:");
    for (const std::string& value : option.results()) {
        if (option.get_positional())
            KeptInputs::add(words_for(option), value);
        for (const std::string& item : split_list({value}))
            if (item.starts_with('@'))
                KeptInputs::add(words_for(option), item.substr(1));
        if (has_files)
            KeptInputs::add(words_for(option), value.substr(0, value.find(':')));
    }
}

/// All files that are written for a path: a picture for LaTeX has a second file with its lines.
std::vector<std::string> files_written_as(const std::string& path) {
    if (!path.ends_with(".tex"))
        return {path};
    return {path, path.substr(0, path.size() - 4) + ".pdf"};
}

} // namespace

KeptInputs::KeptInputs() {
    const std::lock_guard lock(kept_files().mutex);
    kept_files().files.emplace();
}

KeptInputs::~KeptInputs() {
    const std::lock_guard lock(kept_files().mutex);
    kept_files().files.reset();
    kept_files().outputs.clear();
}

void KeptInputs::expect_output(const std::string& option, const std::string& path) {
    try {
        require_none_at(path);
    } catch (const InputError& error) {
        throw InputError({option, 0, 0}, error.problem(), error.remedy());
    }
    const std::lock_guard lock(kept_files().mutex);
    if (!kept_files().files)
        return;
    kept_files().outputs.push_back({option, path});
    require_distinct(kept_files().outputs);
}

void KeptInputs::add(const std::string& what, const std::string& path) {
    std::optional<KeptFile> file = file_at(path);
    const std::lock_guard lock(kept_files().mutex);
    if (!file || !kept_files().files)
        return;
    for (const NamedFile& output : kept_files().outputs)
        if (const auto there = file_at(output.path); there && are_same(*file, *there))
            throw InputError({output.name, 0, 0}, fmt::format("'{}' is the file of {} too", output.path, what),
                             "choose another name");
    file->what = what;
    kept_files().files->push_back(std::move(*file));
}

void KeptInputs::require_none_at(const std::string& path) {
    const std::optional<KeptFile> file = file_at(path);
    const std::lock_guard lock(kept_files().mutex);
    if (!file || !kept_files().files)
        return;
    for (const KeptFile& kept : *kept_files().files)
        if (are_same(kept, *file))
            throw InputError(fmt::format("'{}' is the file of {} too", path, kept.what), "choose another name");
}

void keep_inputs_of(const CLI::App& command) {
    for (const CLI::Option* option : command.get_options())
        if (option->get_type_name() == "FILE" && !option->empty())
            for (const std::string& path : files_written_as(option->results().back()))
                KeptInputs::expect_output(words_for(*option), path);
    for (const CLI::Option* option : command.get_options())
        if (option->get_type_name() != "FILE" && !option->empty())
            add_inputs_of(*option);
}

void keep_inputs_of(const Study& study) {
    for (const std::string& file : input_files(study))
        KeptInputs::add("the study, or what it reads,", file);
}

void keep_inputs_of(const Design& design) {
    for (const std::string& file : {design.file, design.model_path, design.approach.study})
        KeptInputs::add("the design, or what it reads,", file);
}

} // namespace graze
