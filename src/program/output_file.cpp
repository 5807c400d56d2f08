#include "program/output_file.hpp"

#include "graze/symbolic/input_error.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>

namespace graze {

namespace {

[[noreturn]] void fail(const std::string& path, const std::string& reason) {
    throw InputError(fmt::format("'{}' cannot be written: {}", path, reason),
                     "choose another file or change the permissions");
}

/// Results of days, or what SQLite keeps beside them.
bool belongs_to_database(const std::string& path) {
    for (const std::string_view ending : {"", "-wal", "-shm", "-journal", ".lock"})
        if (path.ends_with(ending) && is_database(path.substr(0, path.size() - ending.size())))
            return true;
    return false;
}

} // namespace

bool is_database(const std::string& path) {
    constexpr std::string_view signature("SQLite format 3\0", 16);
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error))
        return false;
    std::string start(signature.size(), ' ');
    std::ifstream stream(path, std::ios::binary);
    return stream.read(start.data(), static_cast<std::streamsize>(start.size())) && start == signature;
}

FileReplacement::FileReplacement(const std::string& path) : path_(path) {
    std::error_code error;
    const std::filesystem::path given(path);
    if (path.empty())
        fail(path, "the name is empty");
    // Through a link the file that it leads to is replaced, not the link.
    const std::filesystem::path target = std::filesystem::weakly_canonical(given, error);
    if (error)
        fail(path, error.message());
    target_ = target.string();
    if (belongs_to_database(target_))
        throw InputError(fmt::format("'{}' is a result file or another database, which is not overwritten", path),
                         "choose another file");
    const std::filesystem::file_status status = std::filesystem::status(target, error);
    if (std::filesystem::is_directory(status))
        fail(path, "it is a folder");
    if (std::filesystem::exists(status) && access(target_.c_str(), W_OK) != 0)
        fail(path, std::strerror(errno));
    direct_ = std::filesystem::exists(status) && !std::filesystem::is_regular_file(status);
    if (direct_) {
        temporary_ = target_;
        return;
    }
    const std::string stem = target.stem().string(), ending = target.extension().string();
    for (int attempt = 0;; ++attempt) {
        temporary_ = (target.parent_path() / fmt::format(".{}.{}-{}{}", stem, getpid(), attempt, ending)).string();
        const int file = open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (file >= 0) {
            // Who may read what is there now may read what replaces it, and nobody else.
            if (std::filesystem::exists(status))
                fchmod(file, static_cast<mode_t>(status.permissions()) & 0777);
            close(file);
            return;
        }
        if (errno != EEXIST || attempt == 100) {
            const int reason = errno;
            temporary_.clear();
            fail(path, std::strerror(reason));
        }
    }
}

FileReplacement::~FileReplacement() {
    if (!direct_ && !temporary_.empty())
        unlink(temporary_.c_str());
}

void FileReplacement::commit() {
    if (direct_)
        return;
    if (std::rename(temporary_.c_str(), target_.c_str()) != 0)
        fail(path_, std::strerror(errno));
    temporary_.clear();
}

void require_writable(const std::string& path) {
    const FileReplacement attempt(path);
}

void make_folder(const std::string& folder, const std::string& option) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error || !std::filesystem::is_directory(folder))
        throw InputError(
            {option, 0, 0},
            fmt::format("folder '{}' cannot be made{}", folder, error ? " (" + error.message() + ")" : std::string()),
            "choose another one");
}

void require_distinct(const std::vector<NamedFile>& files) {
    const auto is_regular = [](const std::string& path) { // or may become so, unlike /dev/null
        std::error_code error;
        return std::filesystem::is_regular_file(path, error) || !std::filesystem::exists(path, error);
    };
    const auto target = [](const std::string& path) {
        std::error_code error;
        const auto absolute = std::filesystem::absolute(path, error);
        const auto canonical = std::filesystem::weakly_canonical(absolute, error);
        return error ? absolute : canonical;
    };
    const auto linked = [](const std::string& one, const std::string& other) {
        std::error_code error;
        return std::filesystem::equivalent(one, other, error);
    };
    for (std::size_t i = 0; i < files.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            if (!files[i].path.empty() && !files[j].path.empty() && is_regular(files[i].path) &&
                (target(files[i].path) == target(files[j].path) || linked(files[i].path, files[j].path)))
                throw InputError({files[i].name, 0, 0},
                                 fmt::format("'{}' is the file of {} too", files[i].path, files[j].name),
                                 "choose another name");
}

void require_inside(const std::string& path, const std::string& folder) {
    std::error_code error;
    const auto root = std::filesystem::canonical(folder, error);
    const auto target = error ? root : std::filesystem::weakly_canonical(path, error);
    // A link that leads nowhere yet, too, would be written through.
    if (error || target.parent_path() != root || std::filesystem::is_symlink(path))
        throw InputError(fmt::format("'{}' leads out of the folder '{}'", path, folder),
                         "remove what is there under that name");
}

void FileReplacement::write(std::string_view contents) const {
    errno = 0;
    std::ofstream stream(temporary_, std::ios::binary);
    stream.write(contents.data(), static_cast<std::streamsize>(contents.size()));
    stream.close();
    if (!stream)
        fail(path_, errno != 0 ? std::strerror(errno) : "the device does not take it");
}

void write_file(const std::string& path, std::string_view contents) {
    FileReplacement file(path);
    file.write(contents);
    file.commit();
}

} // namespace graze
