#include "program/output_file.hpp"

#include "graze/base/input_error.hpp"
#include "program/kept_inputs.hpp"
#include "program/temporary_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <random>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>

namespace graze {

namespace {

[[noreturn]] void fail(const std::string& path, const std::string& reason) {
    throw InputError(fmt::format("'{}' cannot be written: {}", path, reason),
                     "choose another file or change the permissions");
}

/// True for a database and for the files that SQLite keeps beside it: results of days may be in them.
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
    // The target of a link is replaced, not the link.
    const std::filesystem::path target = std::filesystem::weakly_canonical(given, error);
    if (error)
        fail(path, error.message());
    target_ = target.string();
    if (belongs_to_database(target_))
        throw InputError(fmt::format("'{}' is a result file or another database, which is not overwritten", path),
                         "choose another file");
    KeptInputs::require_none_at(path);
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
    make_temporary(target);
    // The new file keeps the permissions of the old one.
    if (std::filesystem::exists(status))
        fchmod(file_, static_cast<mode_t>(status.permissions()) & 0777);
}

FileReplacement::~FileReplacement() {
    if (file_ >= 0)
        close(file_);
    if (direct_ || temporary_.empty())
        return;
    unlink(temporary_.c_str());
    TemporaryFiles::take_out(temporary_);
}

/// Makes the temporary file beside the target. Its name is random, so that nobody can put a link there beforehand.
void FileReplacement::make_temporary(const std::filesystem::path& target) {
    constexpr std::size_t longest_stem = 100; // file systems allow names of 255 bytes
    const std::string stem = target.stem().string().substr(0, longest_stem), ending = target.extension().string();
    std::random_device random;
    for (int attempt = 0; attempt < 100; ++attempt) {
        const std::string name = fmt::format(".{}.{:08x}{:08x}{}", stem, random(), random(), ending);
        temporary_ = (target.parent_path() / name).string();
        TemporaryFiles::add(temporary_); // before it exists, so that a signal in between removes it too
        file_ = open(temporary_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
        if (file_ >= 0)
            return;
        const int reason = errno;
        TemporaryFiles::take_out(temporary_);
        errno = reason;
        if (reason != EEXIST)
            break;
    }
    const int reason = errno;
    temporary_.clear();
    fail(path_, std::strerror(reason));
}

void FileReplacement::written_by(const std::function<void(const std::string& path)>& work) const {
    try {
        work(temporary_);
    } catch (const InputError& error) {
        if (error.place().file != temporary_)
            throw;
        throw InputError(Place{path_, 0, 0}, error.problem(), error.remedy());
    }
}

void FileReplacement::commit() {
    if (direct_)
        return;
    struct stat made {
    }, there{};
    if (fstat(file_, &made) != 0 || lstat(temporary_.c_str(), &there) != 0 || made.st_dev != there.st_dev ||
        made.st_ino != there.st_ino)
        fail(path_, "another program has moved what was written");
    // Errors of the disk may appear only now. Some file systems do not support fsync, which is no error.
    if (fsync(file_) != 0 && errno != EINVAL && errno != ENOSYS)
        fail(path_, std::strerror(errno));
    if (std::rename(temporary_.c_str(), target_.c_str()) != 0)
        fail(path_, std::strerror(errno));
    TemporaryFiles::take_out(temporary_);
    temporary_.clear();
}

void require_writable(const std::string& path) {
    const FileReplacement attempt(path);
}

void make_folder(const std::string& folder, const std::string& option) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    std::error_code none;
    if (error || !std::filesystem::is_directory(folder, none))
        throw InputError(
            {option, 0, 0},
            fmt::format("folder '{}' cannot be made{}", folder, error ? " (" + error.message() + ")" : std::string()),
            "choose another one");
}

void require_distinct(const std::vector<NamedFile>& files) {
    const auto is_regular = [](const std::string& path) { // or does not exist yet, unlike /dev/null
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
    // Links are refused even if their target does not exist: writing would create it.
    std::error_code none;
    if (error || target.parent_path() != root || std::filesystem::is_symlink(path, none))
        throw InputError(fmt::format("'{}' leads out of the folder '{}'", path, folder),
                         "remove what is there under that name");
}

void FileReplacement::write(std::string_view contents) const {
    if (direct_) {
        errno = 0;
        std::ofstream stream(temporary_, std::ios::binary);
        stream.write(contents.data(), static_cast<std::streamsize>(contents.size()));
        stream.close();
        if (!stream)
            fail(path_, errno != 0 ? std::strerror(errno) : "the device does not take it");
        return;
    }
    if (ftruncate(file_, 0) != 0 || lseek(file_, 0, SEEK_SET) != 0)
        fail(path_, std::strerror(errno));
    while (!contents.empty()) {
        const ssize_t count = ::write(file_, contents.data(), contents.size());
        if (count < 0 && errno != EINTR)
            fail(path_, std::strerror(errno));
        contents.remove_prefix(static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
    }
}

void write_file(const std::string& path, std::string_view contents) {
    FileReplacement file(path);
    file.write(contents);
    file.commit();
}

} // namespace graze
