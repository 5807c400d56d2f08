#include "page/study_file.hpp"

#include "graze/base/file_name.hpp"
#include "graze/base/text_file.hpp"
#include "page/error_answer.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fmt/format.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <vector>

namespace graze {

std::string file_trace(const std::string& path) {
    struct stat status {};
    if (::stat(path.c_str(), &status) != 0)
        return "";
    return fmt::format("{} {} {}.{}", status.st_ino, status.st_size, status.st_mtim.tv_sec, status.st_mtim.tv_nsec);
}

std::string results_trace(const std::string& path) {
    return file_trace(path) + ';' + file_trace(path + "-wal");
}

namespace {

[[noreturn]] void refuse_file(const std::string& path, int reason) {
    throw FileError(path, fmt::format("it cannot be written ({})", std::strerror(reason)),
                    reason == ENOSPC || reason == EDQUOT || reason == EFBIG || reason == EIO
                        ? "make room on the disk, and save again"
                        : "look at the permissions of the folder");
}

/// Writes to a descriptor and closes it. @return 0, or the number of the error
int write_and_close(int file, std::string_view text) {
    int wrong = 0;
    while (wrong == 0 && !text.empty()) {
        const ssize_t count = ::write(file, text.data(), text.size());
        if (count < 0 && errno != EINTR)
            wrong = errno;
        text.remove_prefix(static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
    }
    if (wrong == 0 && ::fsync(file) != 0)
        wrong = errno;
    if (::close(file) != 0 && wrong == 0)
        wrong = errno;
    return wrong;
}

/// The file appears under its name complete, with the permissions of the one that it replaces.
void replace_file(const std::string& path, std::string_view text) {
    std::string temporary = path + ".XXXXXX";
    const int file = ::mkstemp(temporary.data());
    if (file < 0)
        refuse_file(path, errno);
    struct stat status {};
    if (::stat(path.c_str(), &status) == 0)
        ::fchmod(file, status.st_mode & 07777U);
    int wrong = write_and_close(file, text);
    if (wrong == 0 && ::rename(temporary.c_str(), path.c_str()) != 0)
        wrong = errno;
    if (wrong != 0) {
        ::unlink(temporary.c_str());
        refuse_file(path, wrong);
    }
}

} // namespace

StudyFile::StudyFile(std::string path, std::string text) : path_(std::move(path)), text_(std::move(text)) {
    std::error_code error;
    const auto canonical = std::filesystem::canonical(path_, error);
    if (!error)
        path_ = canonical.string();
    seen_ = file_trace(path_);
}

bool StudyFile::is_there() const {
    std::error_code error;
    return exists() && std::filesystem::is_regular_file(path_, error);
}

bool StudyFile::look() {
    const std::string seen = file_trace(path_);
    if (!exists() || seen == seen_ || seen.empty())
        return false;
    std::string text = read_text_file(path_, "study", longest_model);
    seen_ = seen;
    const bool other = text != text_;
    text_ = std::move(text);
    return other;
}

void StudyFile::save(std::string_view text, bool replace) {
    StudyFile now = *this;
    const bool there = std::filesystem::exists(path_);
    if (!replace && (!there || now.look()))
        throw RefusedRequest(409, fmt::format("another program has {} {}", there ? "changed" : "removed", path_),
                             "look at its text first, or save over it deliberately");
    replace_file(path_, text);
    text_ = text;
    seen_ = file_trace(path_);
}

void StudyFile::save_as(std::string_view text, const std::string& folder, const std::string& name) {
    require_file_name(name, "name of a study's file", {});
    if (!name.ends_with(".toml"))
        throw InputError(fmt::format("the name '{}' does not end in .toml", name), "add that ending");
    const std::string path = (std::filesystem::path(folder) / name).string();
    std::error_code error; // of a folder that cannot be made, opening the file tells more
    std::filesystem::create_directories(folder, error);
    const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
    if (file < 0 && errno == EEXIST)
        throw RefusedRequest(409, fmt::format("there is a file {} already", path), "choose another name");
    if (file < 0)
        refuse_file(path, errno);
    if (const int wrong = write_and_close(file, text); wrong != 0) {
        ::unlink(path.c_str());
        refuse_file(path, wrong);
    }
    *this = StudyFile(path, std::string(text));
}

} // namespace graze
