#pragma once

#include "graze/acquire/experiment.hpp"
#include "graze/record/record_writer.hpp"

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <string>

namespace graze {

/// Properties of a record in the list of records.
struct RecordEntry {
    Level level{};
    double told = 0; ///< amplitude reported by the generator
    bool settled = false;
    double settling = 0; ///< time from the setting to the record, in s
    std::size_t samples = 0;
    std::uint64_t bytes = 0;
};

/// A folder with an experiment's records and their list, manifest.txt. A record and its line in the list are committed
/// together, even if the process or the machine stops: the list is written first, and a complete record that has not
/// been renamed yet is renamed when the folder is finished or opened again. A record that was begun and not committed
/// is removed by the destructor.
class RecordFolder {
public:
    /// Opens a folder, and creates it if necessary. It is locked for as long as this object, or a copy of this process,
    /// lives.
    /// @param wait time in s to wait for another process to release it
    /// @throws InputError when it cannot be created or written, is in use, or has records of another experiment
    RecordFolder(std::string path, Experiment experiment, double wait = 10);
    ~RecordFolder();
    RecordFolder(const RecordFolder&) = delete;
    RecordFolder& operator=(const RecordFolder&) = delete;

    bool has(const Level& level) const { return entries_.contains(level.number); }
    const std::map<std::size_t, RecordEntry>& entries() const { return entries_; }
    std::string path_of(const Level& level) const;
    /// Returns a hash of this experiment and this folder.
    std::uint64_t identity() const;

    /// Begins a record under a temporary name.
    /// @throws InputError, here and below, when it cannot be written
    std::unique_ptr<RecordWriter> begin(const Level& level, const RecordHeader& header);
    /// Commits the record that was begun and has been closed.
    void commit(RecordEntry entry);
    /// Makes list and records agree, for a copy of the process that used the folder and has ended at any point.
    void finish();

private:
    std::string part_of(const std::string& name) const;
    std::string manifest() const;
    void read_manifest();
    void finish_records();
    void write_whole(const std::string& name, const std::string& text) const;
    void move_into_place(const std::string& name) const;

    std::string path_;
    Experiment experiment_;
    int lock_ = -1;
    std::string begun_; ///< name of the record that is not committed yet
    std::map<std::size_t, RecordEntry> entries_;
};

} // namespace graze
