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

} // namespace

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
    for (std::size_t i = 0; i < files.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            if (!files[i].path.empty() && !files[j].path.empty() && is_regular(files[i].path) &&
                target(files[i].path) == target(files[j].path))
                throw InputError({files[i].name, 0, 0},
                                 fmt::format("'{}' is the file of {} too", files[i].path, files[j].name),
                                 "choose another name");
}

void write_file(const std::string& path, std::string_view contents) {
    FileReplacement file(path);
    errno = 0;
    std::ofstream stream(file.temporary_path(), std::ios::binary);
    stream.write(contents.data(), static_cast<std::streamsize>(contents.size()));
    stream.close();
    if (!stream)
        fail(path, errno != 0 ? std::strerror(errno) : "the device does not take it");
    file.commit();
}

} // namespace graze
