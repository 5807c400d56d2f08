#pragma once

#include "graze/acquire/experiment.hpp"
#include "graze/record/record_writer.hpp"

#include <cstdint>
#include <map>
#include <memory>
#include <string>

namespace graze {

/// What is known of a record besides its samples.
struct RecordEntry {
    Level level;
    double told = 0; ///< amplitude that the generator has told
    bool settled = false;
    double settling = 0; ///< s, from the setting to the record
    std::size_t samples = 0;
    std::uint64_t bytes = 0;
};

/// A folder with an experiment's records and their list, manifest.txt. A record and its line in the list come into
/// being together, whenever the process or the machine stops: the list is written first, and a record that is whole but
/// has not got its name yet gets it when the folder is finished or opened again. What was begun and does not count goes
/// with the object.
class RecordFolder {
public:
    /// Opens a folder, and makes it where there is none. Nobody else can use it as long as this lives, nor can copies
    /// of this process that outlive it be overlooked.
    /// @param wait s, for somebody else who is about to end
    /// @throws InputError when it cannot be made or written, is in use, or has records of another experiment
    RecordFolder(std::string path, Experiment experiment, double wait = 10);
    ~RecordFolder();
    RecordFolder(const RecordFolder&) = delete;
    RecordFolder& operator=(const RecordFolder&) = delete;

    bool has(const Level& level) const { return entries_.contains(level.number); }
    const std::map<std::size_t, RecordEntry>& entries() const { return entries_; }
    std::string path_of(const Level& level) const;
    /// A number that belongs to this experiment in this folder; others hardly have it.
    std::uint64_t identity() const;

    /// Begins a record under a name that does not count.
    /// @throws InputError, here and below, when it cannot be written
    std::unique_ptr<RecordWriter> begin(const Level& level, const RecordHeader& header);
    /// The record that was begun, and closed, counts from now on.
    void commit(RecordEntry entry);
    /// For a copy of the process that used the folder and has ended, whenever that was: makes list and records agree.
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
    std::string begun_; ///< name of a record that does not count yet
    std::map<std::size_t, RecordEntry> entries_;
};

} // namespace graze
