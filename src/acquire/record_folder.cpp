#include "graze/acquire/record_folder.hpp"

#include "base/read_whole.hpp"
#include "graze/base/printable.hpp"
#include "graze/base/text_file.hpp"
#include "record/text_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <optional>
#include <string_view>
#include <sys/file.h>
#include <sys/stat.h>
#include <system_error>
#include <thread>
#include <unistd.h>

namespace graze {

namespace {

constexpr const char* list_name = "manifest.txt";
constexpr const char* settings_name = "settings.txt";
constexpr std::string_view part_prefix = ".part.";
constexpr std::string_view heading =
    "number,file,frequency [Hz],amplitude [V],direction,told [V],settled,settling [s],samples,bytes\n";

[[noreturn]] void fail_to_write(const std::string& path, const char* what, int reason) {
    throw FileError(path, fmt::format("it cannot be {} ({})", what, std::strerror(reason)),
                    "look at the permissions of the folder and the space on the disk; existing records are complete");
}

/// Flushes a file to the disk, not only to the system.
void flush_file(const std::string& path) {
    const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW);
    if (file < 0)
        fail_to_write(path, "opened", errno);
    const int result = fsync(file), reason = errno;
    close(file);
    if (result != 0 && reason != EINVAL) // some network file systems do not support it
        fail_to_write(path, "written", reason);
}

std::optional<std::uint64_t> size_of(const std::string& path) {
    struct stat status {};
    if (lstat(path.c_str(), &status) != 0 || !S_ISREG(status.st_mode))
        return std::nullopt;
    return static_cast<std::uint64_t>(status.st_size);
}

/// Describes the first line in which two texts differ.
std::string difference(std::string_view one, std::string_view other) {
    const auto line_at = [](std::string_view text, std::size_t at) {
        const std::size_t end = std::min(text.find('\n', at), text.size());
        return shortened(printable_line(text.substr(at, end - at)), 100);
    };
    std::size_t begin = 0;
    for (std::size_t i = 0; i < std::min(one.size(), other.size()) && one[i] == other[i]; ++i)
        if (one[i] == '\n')
            begin = i + 1;
    return fmt::format("'{}' there, '{}' here", line_at(one, begin), line_at(other, begin));
}

} // namespace

RecordFolder::RecordFolder(std::string path, Experiment experiment, double wait)
    : path_(std::move(path)), experiment_(std::move(experiment)) {
    std::error_code error;
    std::filesystem::create_directories(path_, error);
    lock_ = open(path_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (lock_ < 0)
        fail_to_write(path_, "opened as a folder", error ? error.value() : errno);
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(wait);
    while (flock(lock_, LOCK_EX | LOCK_NB) != 0) {
        if (std::chrono::steady_clock::now() >= end) {
            close(lock_);
            throw FileError(path_, "another experiment is recorded into this folder",
                            "wait for its end, or choose another folder");
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    try {
        const std::string settings = experiment_.settings(), name = path_ + "/" + settings_name;
        if (size_of(name)) {
            const std::string there = read_text_file(name, "list of settings", longest_model);
            if (there != settings)
                throw InputError(Place{path_, 0, 0},
                                 "the folder has records of other settings: " + difference(there, settings),
                                 "choose another folder, or the experiment that it belongs to");
            read_manifest();
        } else {
            write_whole(settings_name, settings);
        }
        finish_records();
    } catch (...) {
        close(lock_);
        throw;
    }
}

RecordFolder::~RecordFolder() {
    if (!begun_.empty())
        unlink(part_of(begun_).c_str());
    close(lock_);
}

void RecordFolder::finish() {
    entries_.clear();
    read_manifest();
    finish_records();
}

std::string RecordFolder::path_of(const Level& level) const {
    return path_ + "/" + experiment_.record_name(level);
}

/// FNV-1a; the last bits stay 0 so that record numbers can be added (G. Fowler, L. C. Noll and K.-P. Vo).
std::uint64_t RecordFolder::identity() const {
    std::error_code error;
    std::uint64_t hash = 0xcbf29ce484222325ULL;
    for (const char letter : std::filesystem::canonical(path_, error).string() + '\n' + experiment_.settings())
        hash = (hash ^ static_cast<unsigned char>(letter)) * 0x100000001b3ULL;
    constexpr int counting = 16;
    return hash << counting;
}

std::string RecordFolder::part_of(const std::string& name) const {
    return path_ + "/" + std::string(part_prefix) + name;
}

void RecordFolder::write_whole(const std::string& name, const std::string& text) const {
    const std::string part = part_of(name);
    unlink(part.c_str());
    const int file = open(part.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (file < 0)
        fail_to_write(part, "made", errno);
    std::size_t written = 0;
    int reason = 0;
    while (written < text.size() && reason == 0) {
        const ssize_t count = write(file, text.data() + written, text.size() - written);
        if (count >= 0)
            written += static_cast<std::size_t>(count);
        else if (errno != EINTR)
            reason = errno;
    }
    if (reason == 0 && fsync(file) != 0 && errno != EINVAL)
        reason = errno;
    if (close(file) != 0 && reason == 0)
        reason = errno;
    if (reason != 0) {
        unlink(part.c_str());
        fail_to_write(path_ + "/" + name, "written", reason);
    }
    move_into_place(name);
}

void RecordFolder::move_into_place(const std::string& name) const {
    const std::string target = path_ + "/" + name;
    if (std::rename(part_of(name).c_str(), target.c_str()) != 0)
        fail_to_write(target, "written", errno);
    fsync(lock_); // flush the folder itself
}

std::string RecordFolder::manifest() const {
    std::string text(heading);
    for (const auto& [number, entry] : entries_)
        text += fmt::format("{},{},{},{},{},{},{},{},{},{}\n", number, experiment_.record_name(entry.level),
                            entry.level.frequency, entry.level.amplitude, entry.level.direction, entry.told,
                            entry.settled ? 1 : 0, entry.settling, entry.samples, entry.bytes);
    return text;
}

void RecordFolder::read_manifest() {
    const std::string path = path_ + "/" + list_name;
    if (!size_of(path))
        return;
    const std::string text = read_text_file(path, "list of records", longest_model);
    int number = 0;
    for (std::size_t begin = 0; begin < text.size();) {
        const std::size_t end = std::min(text.find('\n', begin), text.size());
        const std::string_view line = std::string_view(text).substr(begin, end - begin);
        begin = end + 1;
        if (++number == 1)
            continue;
        const auto cells = row_fields(line, ',');
        RecordEntry entry;
        std::size_t level = 0;
        int settled = 0;
        const bool good = cells.size() == 10 && read_whole(cells[0], level) && level >= 1 &&
                          level <= experiment_.levels.size() && read_whole(cells[5], entry.told) &&
                          read_whole(cells[6], settled) && read_whole(cells[7], entry.settling) &&
                          read_whole(cells[8], entry.samples) && read_whole(cells[9], entry.bytes);
        if (!good || cells[1] != experiment_.record_name(experiment_.levels[level - 1]))
            throw InputError(Place{path, number, 1}, "this is not a line of a list of this experiment's records",
                             "restore the list, or choose another folder");
        entry.level = experiment_.levels[level - 1];
        entry.settled = settled != 0;
        entries_[level] = entry;
    }
}

/// Renames complete records, and drops list entries of records that are not usable.
void RecordFolder::finish_records() {
    const std::size_t listed = entries_.size();
    for (auto it = entries_.begin(); it != entries_.end();) {
        const std::string name = experiment_.record_name(it->second.level);
        if (size_of(path_ + "/" + name) == it->second.bytes) {
            ++it;
        } else if (size_of(part_of(name)) == it->second.bytes) {
            move_into_place(name);
            ++it;
        } else {
            it = entries_.erase(it);
        }
    }
    std::error_code error;
    for (const Level& level : experiment_.levels)
        if (const std::string part = part_of(experiment_.record_name(level)); size_of(part))
            std::filesystem::remove(part, error);
    if (entries_.size() != listed)
        write_whole(list_name, manifest());
}

std::unique_ptr<RecordWriter> RecordFolder::begin(const Level& level, const RecordHeader& header) {
    const std::string name = experiment_.record_name(level), path = path_ + "/" + name;
    struct stat status {};
    if (!has(level) && lstat(path.c_str(), &status) == 0)
        throw InputError(Place{path, 0, 0}, "it exists already, and is not in the list of records",
                         "move it elsewhere");
    unlink(part_of(name).c_str()); // also if it is a link
    begun_ = name;
    return std::make_unique<RecordWriter>(part_of(name), header);
}

void RecordFolder::commit(RecordEntry entry) {
    const std::string name = experiment_.record_name(entry.level);
    flush_file(part_of(name));
    const auto bytes = size_of(part_of(name));
    if (!bytes)
        fail_to_write(part_of(name), "found", ENOENT);
    entry.bytes = *bytes;
    entries_[entry.level.number] = entry;
    try {
        write_whole(list_name, manifest());
    } catch (...) {
        entries_.erase(entry.level.number);
        throw;
    }
    begun_.clear();
    move_into_place(name);
}

} // namespace graze
